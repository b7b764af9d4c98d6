#!/usr/bin/env python3
"""Every elementary function that a program or a library of its calls is ours, not the C library's.

usage: bindings.py VINEROW IO_TEST
       bindings.py VINEROW PYTHON --python

The dynamic linker prints where it binds each symbol (LD_DEBUG=bindings). The C library chooses its functions by what the
processor offers, so a single call that reaches it makes the digest of a run that of one kind of processor. GDAL and PROJ come when
a file needs them, so the program reads one; so does IO_TEST, which has the functions without the shared library. OpenCV comes with
the first neural network.

With --python, the same for an interpreter that imports the package vinerow. It has loaded the C library before, and its own
modules may call that.
"""

import os
import re
import subprocess
import sys
import tempfile

SCENARIO_WITH_NET = os.path.join(os.path.dirname(__file__), "../../../assets/scenarios/vineyard_row_net.yaml")
FUNCTIONS = """sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 exp10 expm1 log log2 log10 log1p pow cbrt
hypot erf erfc tgamma sincos""".split()
NAMES = {name + ending for name in FUNCTIONS for ending in ("", "f")}
BINDING = re.compile(r"binding file (\S+) \[\d+\] to (\S+) \[\d+\]: normal symbol `(\w+)'")
# Libraries that state passes on its way: they do call elementary functions, so the test sees something.
GEODATA = ("libproj", "libgdal")
WITNESSES = ("libompl", "libGeographic", "libassimp")
NETS = ("libopencv_dnn",)
OURS = (*WITNESSES, *GEODATA, *NETS, "libvinerow", "libBullet", "libLinearMath")


def bindings(command):
    """(library, target, function) of each elementary function that a program has bound."""
    environment = dict(os.environ, LD_DEBUG="bindings", LD_BIND_NOW="1")
    printed = subprocess.run(command, env=environment, capture_output=True, text=True).stderr
    return [found for found in BINDING.findall(printed) if found[2] in NAMES and "/libm.so" not in found[0]]


def faults(name, command, witnesses, is_python=False):
    """Prints what calls what; returns a sentence for each call of another library's function."""
    seen, wrong = {}, []
    for source, target, symbol in bindings(command):
        library = os.path.basename(source)
        if is_python and not library.startswith(OURS):
            continue
        seen.setdefault(library, set()).add(symbol)
        if "libvinerow" not in target and (is_python or os.path.realpath(target) != os.path.realpath(command[0])):
            wrong.append(f"{name}: {source} takes {symbol} from {target}")
    for library in sorted(seen):
        print(f"{name}: {library}: {' '.join(sorted(seen[library]))}")
    for witness in witnesses:
        if not any(library.startswith(witness) for library in seen):
            wrong.append(f"{name}: {witness} calls no elementary function: does the dynamic linker still print its bindings?")
    return wrong


def main():
    vinerow, other = sys.argv[1:3]
    if sys.argv[3:] == ["--python"]:
        wrong = faults("Python", [other, "-c", "import vinerow"], WITNESSES + GEODATA, is_python=True)
    else:
        with tempfile.TemporaryDirectory() as folder:
            cloud = os.path.join(folder, "cloud.xyz")
            with open(cloud, "w") as file:
                file.write("500000 5000000 100\n500001 5000000 100\n500000 5000001 100\n")
            mapping = [vinerow, "map", cloud, "--crs", "EPSG:25832", "--out", os.path.join(folder, "map")]
            wrong = faults("map", mapping, WITNESSES + GEODATA)
        if os.path.exists(os.path.join(os.path.dirname(vinerow), "../lib/libvinerow_net_host.so")):
            with tempfile.TemporaryDirectory() as folder:
                run = [vinerow, "run", SCENARIO_WITH_NET, "--set", "duration_s=0.1", "--out", folder, "--no-pictures", "--no-report", "--quiet"]
                wrong += faults("net", run, NETS)
        wrong += faults("io_test", [other, "--gtest_filter=LocalToCrs.*"], GEODATA)
        # Loading these would take most of the time that a program needs until main().
        loaded = {os.path.basename(source) for source, _, _ in bindings([vinerow, "--version"])}
        wrong += [f"the program loads {library} at its start" for library in loaded if library.startswith(GEODATA + NETS)]
    for fault in wrong:
        print(fault)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
