#include "core/denoiser/frame_check.h"

#include <algorithm>

#include "core/frame/error.h"
#include "core/frame/plane_size.h"

namespace holdfast {

void check_frame_planes(const DenoiserConfig& config, const PlaneSet& planes) {
  for (const PlaneId id : config.planes) {
    const Plane& plane = planes.at(id);
    const PlaneSize size = plane_size(id, config.width, config.height);
    const PlaneSize found{plane.width(), plane.height()};
    if (found != size)
      throw InputError("plane " + plane_name(id), "must be " + size_text(size), size_text(found));
  }
  for (const Plane& plane : planes)
    if (std::find(config.planes.begin(), config.planes.end(), plane.id()) == config.planes.end())
      throw InputError("plane " + plane_name(plane.id()), "must be one of the session's planes",
                       "not among them");
}

}  // namespace holdfast
