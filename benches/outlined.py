#!/usr/bin/env python3
"""Lists the functions of a program that call single vector instructions, which the compiler should have put in line.

    cargo build --release
    python3 benches/outlined.py target/release/bothways

A closure, or what `map` and `from_fn` make of arrays, is compiled without the instructions of the function around it, unless it
is inlined; then each sum of two vectors is a call, through memory, and the loop takes several times as long. Write such a
closure as a function with `#[inline(always)]`, or by the macro `each!`. Needs `objdump`, of binutils.
"""

import collections
import subprocess
import sys

if len(sys.argv) != 2:
    sys.exit(__doc__)
calls, function = collections.Counter(), ""
objdump = ["objdump", "-d", "--no-show-raw-insn", "-C", sys.argv[1]]
with subprocess.Popen(objdump, stdout=subprocess.PIPE, text=True) as process:
    for line in process.stdout:
        if line.endswith(">:\n"):
            function = line.split("<", 1)[1][:-3]
        elif "call" in line and "__fearless_simd_kernel" in line:
            calls[function] += 1
if process.returncode != 0:
    sys.exit(f"objdump cannot read {sys.argv[1]}")
print("calls  function")
for function, count in calls.most_common():
    print(f"{count:5}  {function}")
print(f"{sum(calls.values())} calls of vector instructions in {len(calls)} functions")
