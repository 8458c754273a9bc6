# Warnings, sanitizers and the compiler cache: everything that is the same for every target.

find_program(HOLDFAST_CCACHE ccache)
if(HOLDFAST_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${HOLDFAST_CCACHE})
endif()

add_library(holdfast_warnings INTERFACE)
target_compile_options(holdfast_warnings INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wdouble-promotion
  -Wno-restrict  # g++ 12 reports it falsely for concatenated strings (GCC bug 105651)
  $<$<BOOL:${HOLDFAST_WERROR}>:-Werror>)

if(HOLDFAST_SANITIZE)
  add_compile_options(-fsanitize=${HOLDFAST_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${HOLDFAST_SANITIZE})
  # Kernels are compiled once, for the portable instruction set, and no harder than the rest: what a
  # sanitizer looks for is in the source, which all variants share, and five checked variants of one
  # filter took the compiler more than ten minutes.
  add_compile_definitions(HOLDFAST_ONE_VARIANT)
  set(holdfast_kernel_level -O1)
else()
  set(holdfast_kernel_level -O3)
endif()

# holdfast_add_library(NAME SOURCES ... [LINK ...]): one static library for one folder, included by
# paths from the top of the repository.
function(holdfast_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE $<BUILD_INTERFACE:holdfast_warnings>)
endfunction()

# Kernel files alone may assume that arithmetic does not trap, which lets the compiler vectorise
# selects, and may fuse a product with the sum that follows it, which rounds once instead of twice.
# Loops that copy or fill stay loops: their rows are too short for a call, or for "rep movs".
# Never -ffast-math: tests for NaN must keep working.
function(holdfast_kernel_sources)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS
    "${holdfast_kernel_level};-fno-trapping-math;-fno-math-errno;-ffp-contract=fast;-fno-tree-loop-distribute-patterns")
endfunction()

# The same without fused sums, for kernels whose results decide what is followed: such a choice must
# not depend on the instruction set.
function(holdfast_exact_kernel_sources)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS
    "${holdfast_kernel_level};-fno-trapping-math;-fno-math-errno;-ffp-contract=off;-fno-tree-loop-distribute-patterns")
endfunction()
