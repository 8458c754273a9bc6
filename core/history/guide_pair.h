#pragma once

#include "core/frame/guides.h"
#include "core/history/kept_images.h"

namespace holdfast {

/// Guides of a frame and of the one before. Floats are kept as they are, in two sets of images that
/// take turns. Where histories are packed, the images of both are lent for a frame, and between
/// frames there is what `guide_block.h` makes of them: depth and ids exact, normals in 32 bits,
/// roughness in 8. Where no history is kept, nothing is left of a frame.
class GuidePair {
 public:
  GuidePair() = default;
  /// `roughness`, `motion`: whether guides have them.
  GuidePair(int width, int height, bool roughness, bool motion, HistoryFormat format);

  /// Begins a frame, whose guides are to be filled: those of the last one become those before.
  /// `has_past`: they are needed.
  Guides& advance(bool has_past);
  Guides& now() { return guides_[now_]; }
  const Guides& now() const { return guides_[now_]; }
  const Guides& previous() const { return guides_[1 - now_]; }
  /// Ends the frame: `now` is what the next frame finds.
  void keep();

  /// Guides of that kind with memory of their own, all 0.
  Guides blank() const;
  /// Between frames: a copy of the guides of the last one; others in their place.
  Guides last() const;
  void set_last(Guides guides);

  /// What one frame leaves for the next.
  std::size_t kept_bytes() const;
  /// Calls `visit` for all images of `g`, a GuidePair.
  static void each_image(auto& g, auto&& visit) {
    for (auto& guides : g.guides_) Guides::each_image(guides, visit);
    visit(g.depth_);
    visit(g.normal_);
    visit(g.id_);
    visit(g.roughness_);
    visit(g.motion_);
  }

 private:
  void unpack(Guides& out) const;
  void pack(const Guides& in);

  HistoryFormat format_ = HistoryFormat::kNone;
  Guides guides_[2];
  int now_ = 0;
  // What is kept packed.
  Channels<float> depth_, motion_;
  Channels<std::uint32_t> normal_, id_;
  Channels<std::uint8_t> roughness_;
};

}  // namespace holdfast
