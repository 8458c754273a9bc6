#include "core/history/guide_pair.h"

#include <algorithm>
#include <utility>

#include "core/history/guide_block.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

Guides make_guides(int width, int height, bool roughness, bool motion, Memory memory) {
  Guides guides(width, height, memory);
  if (roughness) guides.roughness = Channels<float>(width, height, 1, memory);
  if (motion) guides.motion = Channels<float>(width, height, 2, memory);
  return guides;
}

template <class T>
void copy_row(const Channels<T>& from, int y, Channels<T>& to) {
  for (int c = 0; c < from.count(); ++c) std::copy_n(from[c].row(y), from.width(), to[c].row(y));
}

}  // namespace

GuidePair::GuidePair(int width, int height, bool roughness, bool motion, HistoryFormat format)
    : format_(format) {
  const Memory memory = format == HistoryFormat::kFloat ? Memory::kOwned : Memory::kLent;
  guides_[0] = make_guides(width, height, roughness, motion, memory);
  if (format == HistoryFormat::kNone) return;
  guides_[1] = make_guides(width, height, roughness, motion, memory);
  if (format == HistoryFormat::kFloat) return;
  for (Guides& guides : guides_) guides.normal_error = kPackedNormalError;
  depth_ = Channels<float>(width, height, 1);
  normal_ = Channels<std::uint32_t>(width, height, 1);
  id_ = Channels<std::uint32_t>(width, height, 1);
  if (roughness) roughness_ = Channels<std::uint8_t>(width, height, 1);
  if (motion) motion_ = Channels<float>(width, height, 2);
}

Guides& GuidePair::advance(bool has_past) {
  if (format_ != HistoryFormat::kNone) now_ = 1 - now_;
  if (has_past && format_ == HistoryFormat::kPacked) unpack(guides_[1 - now_]);
  return guides_[now_];
}

void GuidePair::keep() {
  if (format_ == HistoryFormat::kPacked) pack(now());
}

void GuidePair::unpack(Guides& out) const {
  for_each_row(depth_.height(), [&](int y) {
    std::copy_n(depth_[0].row(y), depth_.width(), out.depth_normal[0].row(y));
    copy_row(id_, y, out.id);
    if (motion_) copy_row(motion_, y, out.motion);
    GuideUnpacking row{depth_[0].row(y), normal_[0].row(y), nullptr, depth_.width(), {}, nullptr};
    for (int axis = 0; axis < 3; ++axis) row.normal[axis] = out.depth_normal[1 + axis].row(y);
    if (roughness_) {
      row.packed_roughness = roughness_[0].row(y);
      row.roughness = out.roughness[0].row(y);
    }
    unpack_guides(row);
  });
}

void GuidePair::pack(const Guides& in) {
  for_each_row(depth_.height(), [&](int y) {
    std::copy_n(in.depth().row(y), depth_.width(), depth_[0].row(y));
    copy_row(in.id, y, id_);
    if (motion_) copy_row(in.motion, y, motion_);
    GuidePacking row{{}, nullptr, depth_.width(), normal_[0].row(y), nullptr};
    for (int axis = 0; axis < 3; ++axis) row.normal[axis] = in.normal(axis).row(y);
    if (roughness_) {
      row.roughness = in.roughness[0].row(y);
      row.packed_roughness = roughness_[0].row(y);
    }
    pack_guides(row);
  });
}

Guides GuidePair::blank() const {
  const Guides& like = now();
  return make_guides(like.depth_normal.width(), like.depth_normal.height(),
                     static_cast<bool>(like.roughness), static_cast<bool>(like.motion),
                     Memory::kOwned);
}

Guides GuidePair::last() const {
  const Guides& from = now();
  Guides copy = blank();
  copy.view = from.view;
  copy.rays = from.rays;
  copy.normal_error = from.normal_error;
  if (format_ == HistoryFormat::kPacked) {
    unpack(copy);
  } else {
    for_each_row(copy.depth_normal.height(), [&](int y) {
      copy_row(from.depth_normal, y, copy.depth_normal);
      copy_row(from.id, y, copy.id);
      copy_row(from.roughness, y, copy.roughness);
      copy_row(from.motion, y, copy.motion);
    });
  }
  return copy;
}

void GuidePair::set_last(Guides guides) {
  Guides& last = now();
  last.view = guides.view;
  last.rays = guides.rays;
  if (format_ == HistoryFormat::kPacked)
    pack(guides);
  else if (format_ == HistoryFormat::kFloat)
    last = std::move(guides);
}

std::size_t GuidePair::kept_bytes() const {
  if (format_ == HistoryFormat::kFloat) return now().bytes();
  return depth_.bytes() + normal_.bytes() + id_.bytes() + roughness_.bytes() + motion_.bytes();
}

}  // namespace holdfast
