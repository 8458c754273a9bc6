#pragma once

#include <span>

#include <holdfast/client.h>

#include "client/sdk/exchange.h"
#include "holdfast/v1/denoise_service.pb.h"
#include "holdfast/v1/session_service.pb.h"
#include "proto/plane_coder.h"

/// Protocol <-> core on the client's side.
namespace holdfast::client {

void write_create_request(const SessionOptions& options, v1::CreateSessionRequest& request);

/// Everything of a frame but its planes' data. `codings`: of `planes`, by position.
void write_frame_begin(const OutgoingFrame& frame, const std::vector<PlaneId>& planes,
                       std::span<const wire::PlaneCoding> codings, v1::FrameBegin& begin);

/// Everything of an answer but its planes' data.
void read_frame_result(const v1::FrameResult& result, FrameOutput& output);

/// Throws InputError unless `frame` has exactly `planes`, each of the session's size.
void check_planes(const Frame& frame, const std::vector<PlaneId>& planes, int width, int height);

}  // namespace holdfast::client
