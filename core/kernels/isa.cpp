#include "core/kernels/isa.h"

#include <array>
#include <atomic>
#include <cstdlib>
#include <string>

#include "core/frame/error.h"

namespace holdfast {
namespace {

constexpr std::array<std::string_view, 5> kNames{"scalar", "portable", "x86-64-v2", "x86-64-v3",
                                                 "x86-64-v4"};

Isa from_environment() {
  const std::vector<Isa> available = available_isas();
  const char* wanted = std::getenv("HOLDFAST_ISA");
  if (wanted == nullptr || *wanted == '\0') return available.back();
  std::string rule = "must be one of";
  for (const Isa isa : available) {
    if (isa_name(isa) == wanted) return isa;
    rule += " " + std::string(isa_name(isa));
  }
  throw InputError("environment variable HOLDFAST_ISA", rule, "'" + std::string(wanted) + "'");
}

std::atomic<Isa>& selection() {
  static std::atomic<Isa> selected{from_environment()};
  return selected;
}

}  // namespace

std::string_view isa_name(Isa isa) { return kNames[static_cast<std::size_t>(isa)]; }

std::vector<Isa> available_isas() {
  std::vector<Isa> isas{Isa::kScalar, Isa::kPortable};
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt"))
    isas.push_back(Isa::kX86_64V2);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi2"))
    isas.push_back(Isa::kX86_64V3);
  if (isas.back() == Isa::kX86_64V3 && __builtin_cpu_supports("avx512f") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    isas.push_back(Isa::kX86_64V4);
#endif
  return isas;
}

Isa selected_isa() { return selection().load(std::memory_order_relaxed); }

void select_isa(Isa isa) { selection().store(isa, std::memory_order_relaxed); }

}  // namespace holdfast
