#include "core/kernels/isa.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/kernels/machine_limits.h"
#include "tests/core/isa_guard.h"

namespace holdfast {
namespace {

TEST(Isa, ScalarAndPortableAreAlwaysAvailableAndPlainest) {
  const auto isas = available_isas();
  ASSERT_GE(isas.size(), 2u);
  EXPECT_EQ(isas[0], Isa::kScalar);
  EXPECT_EQ(isas[1], Isa::kPortable);
  EXPECT_TRUE(std::is_sorted(isas.begin(), isas.end()));
}

TEST(Isa, SelectionCanBeOverridden) {
  const Isa before = selected_isa();
  select_isa(Isa::kPortable);
  EXPECT_EQ(selected_isa(), Isa::kPortable);
  select_isa(before);
}

TEST(Isa, NamesAreThoseOfTheDocumentation) {
  EXPECT_EQ(isa_name(Isa::kScalar), "scalar");
  EXPECT_EQ(isa_name(Isa::kPortable), "portable");
  EXPECT_EQ(isa_name(Isa::kX86_64V2), "x86-64-v2");
  EXPECT_EQ(isa_name(Isa::kX86_64V3), "x86-64-v3");
  EXPECT_EQ(isa_name(Isa::kX86_64V4), "x86-64-v4");
}

// Sanitized builds have one variant for all.
#if !defined(HOLDFAST_ONE_VARIANT)
TEST(MachineLimits, GrowWithTheWidthOfVectors) {
  const test::IsaGuard guard;
  select_isa(Isa::kScalar);
  const MachineLimits scalar = measure_machine_limits();
  select_isa(available_isas().back());
  const MachineLimits widest = measure_machine_limits();
  EXPECT_GT(scalar.multiply_adds_per_ns, 0);
  EXPECT_GT(scalar.copy_gb_per_s, 0);
  EXPECT_GT(widest.multiply_adds_per_ns, 2 * scalar.multiply_adds_per_ns);
}
#endif

}  // namespace
}  // namespace holdfast
