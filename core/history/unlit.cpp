#include "core/history/unlit.h"

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

template <class Body>
void for_each_unlit(const Plane& unshadowed, const Body& body) {
  for_each_row(unshadowed.height(), [&](int y) {
    const float *r = unshadowed.channel(0).row(y), *g = unshadowed.channel(1).row(y),
                *b = unshadowed.channel(2).row(y);
    for (int x = 0; x < unshadowed.width(); ++x)
      if (r[x] <= 0.0f && g[x] <= 0.0f && b[x] <= 0.0f) body(x, y);
  });
}

}  // namespace

void set_unlit(const Plane& unshadowed, float value, ChannelView<float> samples) noexcept {
  for_each_unlit(unshadowed, [&](int x, int y) { samples.at(x, y) = value; });
}

void pass_unlit(const Plane& unshadowed, ChannelView<const float> noisy,
                ChannelView<float> out) noexcept {
  for_each_unlit(unshadowed, [&](int x, int y) { out.at(x, y) = noisy.at(x, y); });
}

}  // namespace holdfast
