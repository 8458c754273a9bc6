#pragma once

#include <memory>
#include <string>

#include "proto/shared_memory.h"

namespace holdfast::client {

/// Throws InputError unless a socket can have that path.
void check_shared_memory_path(const std::string& path);

/// Memory that a server shares with one stream of ours.
struct SharedMemoryOffer {
  std::string name;                            ///< for Hello
  std::shared_ptr<wire::SharedMemory> memory;  ///< null if there is none
};

/// Asks the server's side socket at `path` for memory for the next stream of the session. Nothing,
/// after at most two seconds, if there is none to be had: the stream does without. The secret goes
/// to a process of our own user or of root only.
SharedMemoryOffer ask_for_shared_memory(const std::string& path, const std::string& session_id,
                                        const std::string& token);

}  // namespace holdfast::client
