#pragma once

namespace holdfast {

/// What kernels could do at most on one thread of this machine, on the selected instruction set.
struct MachineLimits {
  double multiply_adds_per_ns = 0;  ///< of floats, in registers
  double copy_gb_per_s = 0;  ///< bytes read and written of images larger than a core's caches
};

/// Measures it in about a fifth of a second, in processor time, so that other work on the machine
/// counts as little as in what is compared with it.
MachineLimits measure_machine_limits();

}  // namespace holdfast
