#!/usr/bin/env python3
"""Lists what the compiler made badly of vector code, by the functions of a program.

    cargo build --release
    python3 benches/vector_code.py target/release/bothways

*Calls* of single vector instructions. A closure, or what `map` and `from_fn` make of arrays, is compiled without the instructions
of the function around it, unless it is inlined; then each sum of two vectors is a call, through memory, and the loop takes
several times as long. Write such a closure as a function with `#[inline(always)]`, or by the macro `each!`.

*Masked stores* of AVX2, which the compiler makes of a choice between floating-point numbers, one of which was loaded from where
the other goes. Some processors take some forty steps for one. Choose between bits (`u32x16`) there.

Needs `objdump`, of binutils.
"""

import collections
import re
import subprocess
import sys

KINDS = {
    "calls of single vector instructions": re.compile(r"\scallq?\s.*__fearless_simd_kernel"),
    # A load has the memory first.
    "masked stores": re.compile(r"\svp?maskmov\w+\s+%\w+,%\w+,"),
}

if len(sys.argv) != 2:
    sys.exit(__doc__)
found, function = {kind: collections.Counter() for kind in KINDS}, ""
objdump = ["objdump", "-d", "--no-show-raw-insn", "-C", sys.argv[1]]
with subprocess.Popen(objdump, stdout=subprocess.PIPE, text=True) as process:
    for line in process.stdout:
        if line.endswith(">:\n"):
            function = line.split("<", 1)[1][:-3]
            continue
        for kind, pattern in KINDS.items():
            if pattern.search(line):
                found[kind][function] += 1
if process.returncode != 0:
    sys.exit(f"objdump cannot read {sys.argv[1]}")
for kind, functions in found.items():
    print(f"{sum(functions.values())} {kind}, in {len(functions)} functions")
    for function, count in functions.most_common():
        print(f"{count:5}  {function}")
