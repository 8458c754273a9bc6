#pragma once

#include "holdfast/v1/denoise_service.grpc.pb.h"
#include "server/denoise_stream.h"

namespace holdfast::server {

/// The streaming call: one DenoiseStream for each. Messages are bytes here; the stream reads and
/// writes them (proto/chunk_message.h).
class DenoiseService final
    : public v1::DenoiseService::WithRawCallbackMethod_Denoise<v1::DenoiseService::Service> {
 public:
  explicit DenoiseService(ServiceState& state) : state_(state) {}

  grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* Denoise(
      grpc::CallbackServerContext* context) override {
    return DenoiseStream::start(state_, context->peer());
  }

 private:
  ServiceState& state_;
};

}  // namespace holdfast::server
