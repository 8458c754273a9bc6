#pragma once

#include "core/kernels/isa.h"

namespace holdfast::test {

/// Restores the selected instruction set.
class IsaGuard {
 public:
  IsaGuard() : before_(selected_isa()) {}
  ~IsaGuard() { select_isa(before_); }

 private:
  Isa before_;
};

}  // namespace holdfast::test
