#pragma once

#include "core/oracle/frame_view.h"

namespace holdfast::oracle {

/// history/dual_history.h: what stands in for surfaces that were hidden one frame ago.
Past dual_past(const FrameView& frame);

}  // namespace holdfast::oracle
