#pragma once

#include <string>

namespace holdfast::wire {

/// Gives the connections of this process to or at the unix socket `address` ("unix:PATH", as
/// gRPC has it) a send buffer of 1 MiB, or as large a one as the system allows: twice
/// net.core.wmem_max. The usual 208 KiB let so little of a frame in at once that both ends
/// mostly wake each other. Nothing happens for other addresses, nor for connections whose buffer
/// is as large already. gRPC has no argument for it.
void widen_unix_buffers(const std::string& address);

}  // namespace holdfast::wire
