#include "client/sdk/status.h"

#include <holdfast/client.h>

#include "holdfast/v1/error.pb.h"

namespace holdfast::client {

void throw_status(const std::string& address, const grpc::Status& status) {
  const std::string server = "server " + address;
  switch (status.error_code()) {
    case grpc::StatusCode::INVALID_ARGUMENT: {
      v1::InputViolation violation;
      if (violation.ParseFromString(status.error_details()) && !violation.subject().empty())
        throw InputError(violation.subject(), violation.rule(), violation.value());
      throw RefusedError(server + " refuses: " + status.error_message());
    }
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::UNKNOWN:
      throw ConnectionError(server + " cannot be reached: " + status.error_message());
    case grpc::StatusCode::CANCELLED:
      throw ConnectionError("the connection to " + server +
                            " was closed: " + status.error_message());
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      throw ConnectionError(server + " did not answer in time");
    default: throw RefusedError(server + " refuses: " + status.error_message());
  }
}

}  // namespace holdfast::client
