#pragma once

#include <string>
#include <vector>

#include "core/denoiser/denoiser.h"

namespace holdfast::server {

/// What a client fixes when it makes a session, and what it changes in mid-session.
struct SessionConfig {
  DenoiserConfig denoiser;
  std::vector<PlaneId> results;   ///< result planes to send, in order
  double budget_ms = 0;           ///< 0 = none
  std::vector<double> preset_ms;  ///< with a budget: what a frame should take in each preset,
                                  ///< fastest first, up to that of `denoiser`
  double frames_per_second = 0;   ///< that the client has told; 0 = none
  double load = 0;                ///< share of the filtering threads' time that this should take
  std::string wire = "exact";
  bool shared_memory = false;  ///< its streams may ask for it
  bool latest = false;         ///< a frame is dropped if a newer one waits behind it
};

}  // namespace holdfast::server
