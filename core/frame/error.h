#pragma once

#include <stdexcept>
#include <string>

namespace holdfast {

/// Input that breaks a stated rule. Names the thing, the rule and the value found, so that a user
/// can tell which of many inputs is wrong. Thrown at public doors only, before any state changes.
class InputError : public std::invalid_argument {
 public:
  /// `subject` is the thing ("plane light0.visibility"), `rule` what must hold ("must be 480x270"),
  /// `value` what was found ("480x269").
  InputError(std::string subject, std::string rule, std::string value)
      : std::invalid_argument(subject + " " + rule + ", but it is " + value),
        subject_(std::move(subject)),
        rule_(std::move(rule)),
        value_(std::move(value)) {}

  const std::string& subject() const noexcept { return subject_; }
  const std::string& rule() const noexcept { return rule_; }
  const std::string& value() const noexcept { return value_; }

 private:
  std::string subject_, rule_, value_;
};

}  // namespace holdfast
