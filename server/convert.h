#pragma once

#include <span>

#include "holdfast/v1/denoise_service.pb.h"
#include "holdfast/v1/session_service.pb.h"
#include "proto/plane_coder.h"
#include "server/frame_slot.h"
#include "server/session.h"

/// Protocol <-> core on the server's side. Everything that comes from the wire is checked here, or
/// by the core behind it, before anything of its size is allocated.
namespace holdfast::server {

/// Throws InputError naming what breaks a rule.
SessionConfig session_config_from(const v1::CreateSessionRequest& request);

/// `config` as `change` makes it; its `preset_ms` are those of before. Throws InputError.
SessionConfig changed_config(const v1::SessionChange& change, SessionConfig config);

/// Index, cut, camera and transforms of a frame; its planes are untouched. Throws InputError.
void read_frame_header(const v1::FrameBegin& begin, const SessionConfig& config, Frame& frame);

/// The message that answers a frame, with or without an error. `codings`: of the planes that
/// follow, by position in the session's results.
void write_frame_result(const FrameSlot& slot, const SessionConfig& config,
                        std::span<const wire::PlaneCoding> codings, v1::FrameResult& result);

}  // namespace holdfast::server
