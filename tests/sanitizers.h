#pragma once

namespace holdfast::test {

/// Whether ThreadSanitizer watches this build, or any sanitizer that makes it slower.
#if defined(__SANITIZE_THREAD__)
inline constexpr bool kThreadSanitized = true;
#else
inline constexpr bool kThreadSanitized = false;
#endif
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// How much slower sanitizers may make what a test times, and a machine that others use as well.
inline constexpr double kSlowness = kSanitized ? 20 : 3;

}  // namespace holdfast::test
