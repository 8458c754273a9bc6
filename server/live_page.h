#pragma once

#include <string>
#include <string_view>

namespace holdfast::server {

/// The live page, self-contained; its style and its script bear the nonce of the answer, which its
/// policy names.
std::string live_page(std::string_view nonce);

/// Value of Content-Security-Policy for that page: its own style and script, data and pictures of
/// the same port, nothing else.
std::string live_page_policy(std::string_view nonce);

}  // namespace holdfast::server
