#pragma once

#include <optional>

#include "core/oracle/frame_view.h"
#include "core/oracle/quads.h"

namespace holdfast::oracle {

/// A frame and the one before it at half their resolution.
class HalfFrame {
 public:
  /// Takes the next frame; of its `planes`, those that components read beside their samples.
  void advance(const Surfaces& full, const Scene& scene, const PlaneSet& planes, bool has_past);

  FrameView view() const {
    return {now_, has_past_ ? previous_ : now_, scene_, surface_ ? &*surface_ : nullptr};
  }
  const Quads& quads() const { return quads_; }
  const PlaneSet& planes() const { return planes_; }
  std::size_t bytes() const { return now_.bytes() + previous_.bytes(); }

 private:
  Quads quads_;
  Surfaces now_, previous_;
  Scene scene_;
  bool has_past_ = false;
  std::optional<Past> surface_;
  PlaneSet planes_;  ///< the representatives'
};

}  // namespace holdfast::oracle
