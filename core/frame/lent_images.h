#pragma once

#include <cstddef>

#include "core/frame/plane.h"

/// Visitors of images (`each_image` of whatever holds them) that divide memory among those without
/// memory of their own.
namespace holdfast {

/// What images take, bytes: those with memory of their own, and those that are lent it.
struct ImageBytes {
  static constexpr std::size_t kAlignment = 64;  ///< of lent images

  std::size_t owned = 0, lent = 0;

  /// `images`: Channels or a Plane; so for the others.
  void operator()(const auto& images) {
    if (images.memory() == Memory::kOwned)
      owned += images.bytes();
    else
      lent += rounded(images.bytes());
  }
  static std::size_t rounded(std::size_t bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
  }
};

/// Lends memory from `at` on, ImageBytes::lent of it. `as_left`: it is as the same images left it,
/// their aprons included.
struct LendImages {
  std::byte* at;
  bool as_left = false;
  void operator()(auto& images) {
    if (images.memory() == Memory::kOwned) return;
    images.lend(at);
    if (!as_left) images.clear_apron();
    at += ImageBytes::rounded(images.bytes());
  }
};

/// Takes it back.
struct TakeBackImages {
  void operator()(auto& images) const noexcept {
    if (images.memory() == Memory::kLent) images.lend(nullptr);
  }
};

}  // namespace holdfast
