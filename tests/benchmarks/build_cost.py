#!/usr/bin/env python3
"""Prints what building costs, in CPU seconds (user and system) without a compiler cache. Table of docs/contributing/performance.md.

usage: build_cost.py FOLDER [command] [tests] [sanitized] [touched]

FOLDER takes the builds (2 GB each) and is not emptied. Without further words everything is measured:
  command    the command from nothing, as tools/demo builds it
  tests      everything else that tools/test builds, after the command
  sanitized  what tools/sanitize builds
  touched    the same build after one file was touched: units compiled, seconds to the linked command
"""

import os
import subprocess
import sys
import time
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
TOUCHED = [
    "engine/api/map.h",
    "engine/api/mesh.h",
    "engine/api/height_field.h",
    "engine/api/parameters.h",
    "engine/api/signal.h",
    "controllers/pure_pursuit/pure_pursuit.cpp",
    "controllers/quadrotor_mpc/quadrotor_mpc_law.cpp",
]


def cost(command, **options):
    """CPU seconds, wall seconds and output of a command."""
    environment = {**os.environ, "CCACHE_DISABLE": "1"}
    before, begin = os.times(), time.monotonic()
    done = subprocess.run(command, cwd=TREE, env=environment, capture_output=True, text=True, **options)
    after = os.times()
    if done.returncode != 0:
        sys.exit(done.stdout[-4000:] + done.stderr)
    cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
    return cpu_s, time.monotonic() - begin, done.stdout


def build(folder, targets=()):
    return cost(["cmake", "--build", str(folder), "-j", str(os.cpu_count()), *(["--target", *targets] if targets else [])])


def configure(preset, folder, *definitions):
    cost(["cmake", "--preset", preset, "-B", str(folder), *definitions])


def report(what, cpu_s, wall_s, output):
    units = output.count("Building C")
    print(f"{what:58} {cpu_s / 60:6.1f} CPU min {wall_s:7.0f} s  {units:4} units", flush=True)


def touched(folder):
    for name in TOUCHED:
        (TREE / name).touch()
        report(f"vinerow after touching {name}", *build(folder, ["vinerow_command"]))
        (TREE / name).touch()
        report(f"all after touching {name}", *build(folder))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folder, what = Path(sys.argv[1]).resolve(), sys.argv[2:] or ["command", "tests", "sanitized", "touched"]
    configure("release", folder / "release")
    if "command" in what:
        report("the command", *build(folder / "release", ["vinerow_command"]))
    if "tests" in what:
        report("everything else that tools/test builds", *build(folder / "release"))
    if "touched" in what:
        touched(folder / "release")
    if "sanitized" in what:
        configure("asan", folder / "asan", "-DVINEROW_BENCHMARKS=OFF", "-DVINEROW_NUMERIC_TESTS=OFF")
        report("sanitized", *build(folder / "asan"))


if __name__ == "__main__":
    main()
