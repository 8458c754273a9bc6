#pragma once

#include <gtest/gtest.h>

#include "client/stability/oracle_study.h"

namespace holdfast::test {

/// Fails for each plane whose errors are beyond its budget, and says by how much.
inline void expect_within_budget(const stability::Results& floats,
                                 const stability::Results& doubles) {
  for (const stability::OracleErrors& errors : stability::oracle_errors(floats, doubles))
    EXPECT_TRUE(errors.within_budget())
        << plane_name(errors.plane) << ": rms " << errors.rms << ", tipped " << errors.tipped_share
        << " of the pixels by up to " << errors.largest_tip;
}

}  // namespace holdfast::test
