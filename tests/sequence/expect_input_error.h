#pragma once

#include <initializer_list>
#include <string>

#include <gtest/gtest.h>

#include "core/frame/error.h"

namespace holdfast::test {

/// Expects that `work` throws an InputError whose message holds each of `parts`.
template <class Work>
void expect_input_error(Work work, std::initializer_list<std::string> parts) {
  try {
    work();
    FAIL() << "no error was thrown";
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const std::string& part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << "no '" << part << "' in: " << message;
  }
}

}  // namespace holdfast::test
