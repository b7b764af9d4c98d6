#!/usr/bin/env python3
"""Compares what a shipped scenario gives with golden.json: digest, metrics, phases and exit status.

usage: golden.py check  VINEROW SCENARIO     one scenario against the file; exit status 1 tells what differs
       golden.py record VINEROW [SCENARIO…]  writes the file anew (all of them, or those named)

Each entry of the file holds the overrides (`set`) of its run: a run that is too long for every test run is shortened there.
A golden value changes in a commit that says why, never along with something else.

Digests hold on one kind of processor: the C library and the ray tracer choose their code by what the processor offers
(docs/architecture.md). The file therefore holds a fingerprint of where it was recorded. On another kind of machine only the
exit status, the end of the mission and the phases are compared, and the test says so.
"""

import hashlib
import json
import math
import os
import platform
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
GOLDEN = Path(__file__).with_name("golden.json")
SCENARIOS = TREE / "assets" / "scenarios"

def fingerprint():
    """What decides how a machine rounds: instruction sets, C library, and its elementary functions on a fixed grid."""
    flags = set(re.search(r"^flags\s*:(.*)$", Path("/proc/cpuinfo").read_text(), re.M).group(1).split())
    probe = hashlib.sha256()
    for i in range(4000):
        x = 1e-3 + 0.0173 * i
        for value in (math.sin(x), math.cos(x), math.tan(x), math.atan2(x, 3.7), math.exp(-0.1 * x), math.log(x), x**0.37):
            probe.update(struct.pack("<d", value))
    return {
        "instruction_sets": sorted(flags & {"sse4_2", "avx", "avx2", "fma", "avx512f", "avx512dq", "avx512vl"}),
        "libc": " ".join(platform.libc_ver()),
        "elementary_functions": probe.hexdigest()[:16],
    }


def run(vinerow, name, settings):
    """The comparable part of summary.json."""
    with tempfile.TemporaryDirectory() as folder:
        command = [vinerow, "run", str(SCENARIOS / f"{name}.yaml"), "--out", folder]
        command += ["--no-log", "--no-pictures", "--no-report", "--quiet"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True)
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


def robust(entry):
    """What another processor's rounding leaves as it is."""
    phases = [(phase["name"], phase["state"]) for phase in entry.get("phases", [])]
    return {"exit_status": entry["exit_status"], "finished": entry["finished"], "phases": phases}


def check(vinerow, name):
    golden = json.loads(GOLDEN.read_text())
    if name not in golden["scenarios"]:
        sys.exit(f"{name} is not in golden.json: record it with golden.py record VINEROW {name}")
    expected = golden["scenarios"][name]
    found = run(vinerow, name, expected["set"])
    here = fingerprint()
    if here != golden["recorded_on"]:
        print(f"digest and metrics not compared: recorded on {golden['recorded_on']}, this is {here}")
        expected, found = robust(expected), robust(found)
    faults = list(differences(expected, found))
    for fault in faults:
        print(f"{name}: {fault}")
    sys.exit(1 if faults else 0)


def record(vinerow, names):
    golden = json.loads(GOLDEN.read_text()) if GOLDEN.exists() else {"scenarios": {}}
    golden["recorded_on"] = fingerprint()
    shipped = sorted(path.stem for path in SCENARIOS.glob("*.yaml"))
    settings = {name: golden["scenarios"].get(name, {}).get("set", []) for name in shipped}
    golden["scenarios"] = {name: entry for name, entry in golden["scenarios"].items() if name in shipped}
    for name in names or shipped:
        before = os.times()
        golden["scenarios"][name] = run(vinerow, name, settings[name])
        after = os.times()
        cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
        print(f"{name}: {golden['scenarios'][name]['digest']} ({cpu_s:.1f} s of CPU)")
    golden["scenarios"] = dict(sorted(golden["scenarios"].items()))
    GOLDEN.write_text(json.dumps(golden, indent=1) + "\n")


def main():
    if len(sys.argv) == 4 and sys.argv[1] == "check":
        check(sys.argv[2], sys.argv[3])
    elif len(sys.argv) >= 3 and sys.argv[1] == "record":
        record(sys.argv[2], sys.argv[3:])
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
