#pragma once

#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

namespace holdfast::test {

/// A line of the table that tests/faults.sh prints: what the client saw, how long it took to be
/// answered again (negative: nothing had to recover), frames that were lost.
inline void tell_fault(const char* saw, double recovery_s, int lost) {
  EXPECT_EQ(lost, 0);
  if (std::getenv("HOLDFAST_FAULT_TABLE") == nullptr) return;
  const char* const name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  char recovery[32] = "-";
  if (recovery_s >= 0) std::snprintf(recovery, sizeof(recovery), "%.2f s", recovery_s);
  std::printf("FAULT|%s|%s|%s|%d\n", name, saw, recovery, lost);
}

}  // namespace holdfast::test
