#pragma once

#include "core/kernels/isa.h"
#include "core/kernels/math.h"

/// HOLDFAST_KERNEL(name, Args): defines `void name(const Args&) noexcept`, which runs the
/// always-inlined `name_body(const Args&)` compiled for the selected instruction set. A body calls
/// only always-inlined functions and contains no lambdas, so that all of it takes the target.
#if defined(__clang__)
#define HOLDFAST_SCALAR  // no attribute says so: as the portable variant
#define HOLDFAST_TARGET_V4 __attribute__((target("arch=x86-64-v4")))
#else
#define HOLDFAST_SCALAR __attribute__((optimize("no-tree-vectorize")))
#define HOLDFAST_TARGET_V4 __attribute__((target("arch=x86-64-v4,prefer-vector-width=512")))
#endif

#define HOLDFAST_PLAIN_KERNEL(name, Args)                                                     \
  HOLDFAST_SCALAR static void name##_scalar(const Args& args) noexcept { name##_body(args); } \
  static void name##_portable(const Args& args) noexcept { name##_body(args); }

#if defined(HOLDFAST_ONE_VARIANT)  // sanitized builds: one body stands for all instruction sets
#define HOLDFAST_KERNEL(name, Args) \
  void name(const Args& args) noexcept { name##_body(args); }
#elif defined(__x86_64__)
#define HOLDFAST_KERNEL(name, Args)                                                            \
  HOLDFAST_PLAIN_KERNEL(name, Args)                                                            \
  __attribute__((target("arch=x86-64-v2"))) static void name##_v2(const Args& args) noexcept { \
    name##_body(args);                                                                         \
  }                                                                                            \
  __attribute__((target("arch=x86-64-v3"))) static void name##_v3(const Args& args) noexcept { \
    name##_body(args);                                                                         \
  }                                                                                            \
  HOLDFAST_TARGET_V4 static void name##_v4(const Args& args) noexcept { name##_body(args); }   \
  void name(const Args& args) noexcept {                                                       \
    switch (selected_isa()) {                                                                  \
      case Isa::kScalar: return name##_scalar(args);                                           \
      case Isa::kPortable: return name##_portable(args);                                       \
      case Isa::kX86_64V2: return name##_v2(args);                                             \
      case Isa::kX86_64V3: return name##_v3(args);                                             \
      case Isa::kX86_64V4: return name##_v4(args);                                             \
    }                                                                                          \
  }
#else
#define HOLDFAST_KERNEL(name, Args)                                                      \
  HOLDFAST_PLAIN_KERNEL(name, Args)                                                      \
  void name(const Args& args) noexcept {                                                 \
    return selected_isa() == Isa::kScalar ? name##_scalar(args) : name##_portable(args); \
  }
#endif
