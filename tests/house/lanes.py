"""Checks that kernels work on vectors: lanes.py PROGRAM.

A body compiled for AVX-512 may still run one value at a time, for a bound that the compiler reads
anew or rows that it cannot tell apart; results do not show it. Every kernel's variant for
x86-64-v4 (core/kernels/variants.h) must do something with 512 bits that is no mere move.
"""

import re
import subprocess
import sys

FUNCTION = re.compile(r"^[0-9a-f]+ <(.*)>:$")
VARIANT = re.compile(r"(\w+)_v4\(")
MOVE = re.compile(r"\tv(mov|pxor|broadcast|pbroadcast)")


def kernels_of(lines):
    """How many instructions of 512 bits each kernel has, by name, from lines of a disassembly."""
    found = {}
    kernel = None
    for line in lines:
        function = FUNCTION.match(line)
        if function:
            variant = VARIANT.search(function.group(1))
            kernel = function.group(1) if variant else None
            if kernel:
                found.setdefault(kernel, 0)
        elif kernel and "%zmm" in line and not MOVE.search(line):
            found[kernel] += 1
    return found


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    command = ["objdump", "--disassemble", "--no-show-raw-insn", "--demangle", sys.argv[1]]
    listing = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    kernels = kernels_of(listing.splitlines())
    if not kernels:
        sys.exit(f"{sys.argv[1]}: no kernels found")
    scalar = sorted(name for name, count in kernels.items() if count == 0)
    for name in scalar:
        print(f"{name}: runs one value at a time")
    print(f"lanes: {len(kernels)} kernels, {len(scalar)} violations")
    sys.exit(1 if scalar else 0)


if __name__ == "__main__":
    main()
