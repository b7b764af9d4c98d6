#!/usr/bin/env python3
"""Compares what a shipped scenario gives with golden.json: digest, metrics, phases and exit status.

usage: golden.py check  VINEROW SCENARIO... [--plain]     against the file; exit status 1: prints what differs
       golden.py start  VINEROW SCENARIO... [--plain] [--under EMULATOR]  the digest of the first seconds alone
       golden.py record VINEROW [SCENARIO...]             writes the file again (all of them, or those named)

--plain   hides AVX, AVX2, FMA and AVX-512 from the C library (Embree asks the processor itself: for that, --under)
--under   runs the program by an emulator: --under "qemu-x86_64-static -cpu Nehalem"

The values are the same on every processor. Each entry of the file holds the overrides (`set`) of its run: a run that is too
long for every test run is shortened there. A golden value changes in a commit that says why, never along with something else.
"""

import argparse
import json
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
GOLDEN = Path(__file__).with_name("golden.json")
SCENARIOS = TREE / "assets" / "scenarios"

# The start of a run, for emulators, which are some thirty times slower.
START = ["duration_s=3"]
# What glibc chooses its functions by.
PLAIN = "glibc.cpu.hwcaps=" + ",".join(
    f"-{feature}" for feature in ("AVX", "AVX2", "FMA", "FMA4", "AVX512F", "AVX_Usable", "AVX2_Usable", "FMA_Usable", "AVX512F_Usable"))


def run(vinerow, name, settings, under=(), plain=False):
    """The comparable part of summary.json."""
    environment = dict(os.environ, GLIBC_TUNABLES=PLAIN) if plain else None
    with tempfile.TemporaryDirectory() as folder:
        command = [*under, vinerow, "run", str(SCENARIOS / f"{name}.yaml"), "--out", folder]
        command += ["--no-log", "--no-pictures", "--no-report", "--quiet"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
        summary = Path(folder) / "summary.json"
        if not summary.exists():
            sys.exit(f"{name}: no summary.json; exit status {done.returncode}: {done.stderr.strip()}")
        result = json.loads(summary.read_text())
    phases = [{key: phase[key] for key in ("name", "state", "begin_s", "end_s", "numbers")} for phase in result.get("phases", [])]
    return {
        "set": settings,
        "exit_status": done.returncode,
        "digest": result["digest"],
        "finished": result["finished"],
        "simulated_s": result["simulated_s"],
        "metrics": result["metrics"],
        **({"phases": phases} if phases else {}),
    }


def differences(expected, found, path=""):
    """Every leaf that differs, as "path: expected, found"."""
    if isinstance(expected, dict) and isinstance(found, dict):
        for key in sorted(expected.keys() | found.keys()):
            yield from differences(expected.get(key), found.get(key), f"{path}.{key}" if path else key)
    elif isinstance(expected, list) and isinstance(found, list) and len(expected) == len(found):
        for index, pair in enumerate(zip(expected, found)):
            yield from differences(*pair, f"{path}[{index}]")
    elif expected != found:
        yield f"{path}: expected {expected}, found {found}"


def golden_of(name):
    golden = json.loads(GOLDEN.read_text())
    if name not in golden:
        sys.exit(f"{name} is not in golden.json: record it with golden.py record VINEROW {name}")
    return golden[name]


def check(vinerow, names, plain):
    failed = False
    for name in names:
        expected = golden_of(name)
        expected.pop("start_digest")
        for fault in differences(expected, run(vinerow, name, expected["set"], plain=plain)):
            print(f"{name}: {fault}", flush=True)
            failed = True
    sys.exit(1 if failed else 0)


def check_start(vinerow, names, plain, under):
    failed = False
    for name in names:
        expected = golden_of(name)["start_digest"]
        found = run(vinerow, name, START, under=under, plain=plain)["digest"]
        print(f"{name}: {found}" + ("" if found == expected else f", expected {expected}"), flush=True)
        failed = failed or found != expected
    sys.exit(1 if failed else 0)


def record(vinerow, names):
    golden = json.loads(GOLDEN.read_text()) if GOLDEN.exists() else {}
    shipped = sorted(path.stem for path in SCENARIOS.glob("*.yaml"))
    golden = {name: entry for name, entry in golden.items() if name in shipped}
    for name in names or shipped:
        before = os.times()
        entry = run(vinerow, name, golden.get(name, {}).get("set", []))
        after = os.times()
        golden[name] = {**entry, "start_digest": run(vinerow, name, START)["digest"]}
        cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
        print(f"{name}: {golden[name]['digest']} ({cpu_s:.1f} s of CPU)", flush=True)
        GOLDEN.write_text(json.dumps(dict(sorted(golden.items())), indent=1) + "\n")


def main():
    arguments = argparse.ArgumentParser(usage=__doc__)
    arguments.add_argument("work", choices=("check", "start", "record"))
    arguments.add_argument("vinerow")
    arguments.add_argument("scenarios", nargs="*")
    arguments.add_argument("--plain", action="store_true")
    arguments.add_argument("--under", type=shlex.split, default=[])
    given = arguments.parse_args()
    if given.work == "record":
        record(given.vinerow, given.scenarios)
    elif given.work == "start" and given.scenarios:
        check_start(given.vinerow, given.scenarios, given.plain, given.under)
    elif given.work == "check" and given.scenarios:
        check(given.vinerow, given.scenarios, given.plain)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
