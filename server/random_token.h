#pragma once

#include <string>
#include <string_view>

namespace holdfast::server {

/// `bytes` random bytes from the kernel as lower-case hexadecimal digits. Throws std::system_error
/// if the kernel gives none.
std::string random_hex(int bytes);

/// Compares secrets in a time that depends on their lengths only.
bool equal_secrets(std::string_view a, std::string_view b);

}  // namespace holdfast::server
