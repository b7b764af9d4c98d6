#!/usr/bin/env python3
"""Every elementary function that the program or a library of its calls is ours, not the C library's.

usage: bindings.py VINEROW [PYTHON]

The dynamic linker prints where it binds each symbol (LD_DEBUG=bindings). The C library chooses its functions by what the
processor offers, so a single call that reaches it makes the digest of a run that of one kind of processor.

With PYTHON, the same for an interpreter that imports the package vinerow. It has loaded the C library before, and its own
modules may call that.
"""

import os
import re
import subprocess
import sys

FUNCTIONS = """sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 exp10 expm1 log log2 log10 log1p pow cbrt
hypot erf erfc tgamma sincos""".split()
NAMES = {name + ending for name in FUNCTIONS for ending in ("", "f")}
BINDING = re.compile(r"binding file (\S+) \[\d+\] to (\S+) \[\d+\]: normal symbol `(\w+)'")
# Libraries that state passes on its way: they do call elementary functions, so the test sees something.
WITNESSES = ("libompl", "libGeographic", "libproj", "libassimp", "libgdal")
OURS = (*WITNESSES, "libvinerow", "libBullet", "libLinearMath")


def main():
    environment = dict(os.environ, LD_DEBUG="bindings", LD_BIND_NOW="1")
    python = sys.argv[2:]
    command = [*python, "-c", "import vinerow"] if python else [sys.argv[1], "--version"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    seen, wrong = {}, []
    for source, target, symbol in BINDING.findall(done.stderr):
        if symbol not in NAMES or "/libm.so" in source or (python and not os.path.basename(source).startswith(OURS)):
            continue
        seen.setdefault(os.path.basename(source), set()).add(symbol)
        if "libvinerow" not in target and os.path.realpath(target) != os.path.realpath(sys.argv[1]):
            wrong.append(f"{source} takes {symbol} from {target}")
    for library in sorted(seen):
        print(f"{library}: {' '.join(sorted(seen[library]))}")
    for fault in wrong:
        print(fault)
    for witness in WITNESSES:
        if not any(library.startswith(witness) for library in seen):
            wrong.append(witness)
            print(f"{witness} calls no elementary function: does the dynamic linker still print its bindings?")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
