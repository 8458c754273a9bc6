#pragma once

#include <memory>
#include <optional>

#include "holdfast/v1/denoise_service.pb.h"
#include "server/service_state.h"

namespace holdfast::server {

/// Takes what a frame says of the configuration into `config`, that of the frame before, and
/// reserves the memory for it, if it is another. What is refused, for a rule or a limit, is
/// returned as the error of the frame, and nothing has changed.
std::optional<v1::FrameError> take_change(ServiceState& state,
                                          const std::shared_ptr<Session>& session,
                                          const v1::FrameBegin& frame,
                                          std::shared_ptr<const SessionConfig>& config,
                                          std::shared_ptr<void>& reserved);

}  // namespace holdfast::server
