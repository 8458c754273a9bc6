#pragma once

#include <string>

#include <gtest/gtest.h>

#include "core/frame/error.h"

namespace holdfast::test {

/// Succeeds if `action` throws an InputError about `subject` whose rule and value hold these words.
template <class Action>
void expect_input_error(const Action& action, const std::string& subject, const std::string& rule,
                        const std::string& value) {
  try {
    action();
    ADD_FAILURE() << "no InputError about " << subject;
  } catch (const InputError& error) {
    EXPECT_EQ(error.subject(), subject) << error.what();
    EXPECT_NE(error.rule().find(rule), std::string::npos) << error.what();
    EXPECT_NE(error.value().find(value), std::string::npos) << error.what();
  }
}

}  // namespace holdfast::test
