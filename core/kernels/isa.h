#pragma once

#include <string_view>
#include <vector>

namespace holdfast {

/// Instruction sets that the kernels are compiled for. Each runs the same source. kScalar is the
/// portable one without vectors: what the others are measured against.
enum class Isa { kScalar, kPortable, kX86_64V2, kX86_64V3, kX86_64V4 };

/// "scalar", "portable", "x86-64-v2", "x86-64-v3", "x86-64-v4".
std::string_view isa_name(Isa isa);

/// The instruction sets that this machine can run, plainest first.
std::vector<Isa> available_isas();

/// The instruction set in use: the richest available one, or the one that the environment variable
/// HOLDFAST_ISA names. Throws InputError if that names none or one this machine lacks.
Isa selected_isa();

/// Overrides the selection, for tests and benchmarks. Not to be called while a frame is filtered.
void select_isa(Isa isa);

}  // namespace holdfast
