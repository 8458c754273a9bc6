#pragma once

#include "holdfast/v1/denoise_service.grpc.pb.h"
#include "server/denoise_stream.h"

namespace holdfast::server {

/// The streaming call: one DenoiseStream for each.
class DenoiseService final : public v1::DenoiseService::CallbackService {
 public:
  explicit DenoiseService(ServiceState& state) : state_(state) {}

  grpc::ServerBidiReactor<v1::DenoiseRequest, v1::DenoiseResponse>* Denoise(
      grpc::CallbackServerContext*) override {
    return DenoiseStream::start(state_);
  }

 private:
  ServiceState& state_;
};

}  // namespace holdfast::server
