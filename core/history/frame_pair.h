#pragma once

#include "core/frame/guides.h"
#include "core/frame/scene_motion.h"

namespace holdfast {

/// Two successive frames of a session: what any reprojection needs.
struct FramePair {
  const Guides& now;
  const Guides& previous;
  const SceneMotion& scene;
};

}  // namespace holdfast
