#pragma once

#include "server/cost_model.h"

namespace holdfast::server {

/// Measures what every preset takes on this machine: three frames of 160x90 pixels each, with one
/// light, reflections and indirect light, all noise, so that no tile rests. About a tenth of a
/// second on one thread; uses the threads that call it, and as many others as oneTBB lends.
CostTable calibrate();

}  // namespace holdfast::server
