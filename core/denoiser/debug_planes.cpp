#include "core/denoiser/debug_planes.h"

#include "core/history/component_history.h"
#include "core/kernels/parallel.h"

namespace holdfast {

void write_debug_planes(const Channels<float>& recorded, bool halved, Component component,
                        int width, int height, PlaneSet& results) {
  const int shrink = halved ? 2 : 1;
  const auto copy = [&](PlaneKind kind, int first, float scale) {
    Plane& out = results.add({kind, component}, width, height);
    for (int c = 0; c < out.channels(); ++c)
      for_each_row(height, [&](int y) {
        const float* in = recorded[first + c].row(y / shrink);
        float* to = out.channel(c).row(y);
        for (int x = 0; x < width; ++x) to[x] = scale * in[x / shrink];
      });
  };
  copy(PlaneKind::kDebugMotion, kDebugX, static_cast<float>(shrink));
  copy(PlaneKind::kDebugHistory, kDebugFrames, 1.0f);
  copy(PlaneKind::kDebugConfidence, kDebugTrust, 1.0f);
}

}  // namespace holdfast
