#pragma once

#include "holdfast/v1/session_service.grpc.pb.h"
#include "server/service_state.h"

namespace holdfast::server {

/// The unary calls: each converts, asks the session table, and converts back. Those that take time
/// do so on a thread of their own.
class SessionService final : public v1::SessionService::CallbackService {
 public:
  explicit SessionService(ServiceState& state) : state_(state) {}

  grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                          const v1::GetServerInfoRequest* request,
                                          v1::GetServerInfoResponse* response) override;
  grpc::ServerUnaryReactor* CreateSession(grpc::CallbackServerContext* context,
                                          const v1::CreateSessionRequest* request,
                                          v1::CreateSessionResponse* response) override;
  grpc::ServerUnaryReactor* GetSession(grpc::CallbackServerContext* context,
                                       const v1::GetSessionRequest* request,
                                       v1::GetSessionResponse* response) override;
  grpc::ServerUnaryReactor* DeleteSession(grpc::CallbackServerContext* context,
                                          const v1::DeleteSessionRequest* request,
                                          v1::DeleteSessionResponse* response) override;

 private:
  void create(const grpc::CallbackServerContext& context, const v1::CreateSessionRequest& request,
              v1::CreateSessionResponse& response);

  ServiceState& state_;
};

}  // namespace holdfast::server
