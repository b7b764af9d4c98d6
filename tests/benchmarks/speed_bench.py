#!/usr/bin/env python3
"""Speed and memory of whole runs, and ratios to another build.

    speed_bench.py VINEROW [--against OTHER_VINEROW] [--repeats N] [NAME...]

Runs shipped scenarios on one core with log, without pictures and report, and prints a table: simulated seconds per CPU second of the
whole process, its CPU time and its peak memory. --against runs both programs in turn, so that ratios hold on a noisy machine. The
smallest CPU time of the repeats counts: other programs only ever add to it.
"""

import argparse
import json
import os
import pathlib
import platform
import shutil
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
# Aims of simulated seconds per CPU second.
AIMS = {
    "riseholme_rover": 300,
    "vineyard_4ws_two_rows": 200,
    "vineyard_quadrotor_two_rows": 250,
    "survey_turbulence": 500,
    "cooperative_parcel_f": 110,
    "ten_vehicles": 25,
}


def scenario_file(name: str) -> pathlib.Path:
    for folder in (ROOT / "assets/scenarios", HERE):
        if (folder / f"{name}.yaml").exists():
            return folder / f"{name}.yaml"
    sys.exit(f"speed_bench.py: no scenario '{name}'")


def run(program: str, name: str, folder: pathlib.Path) -> dict:
    """One run in a process of its own, on the first of this process's cores."""
    out = folder / name
    shutil.rmtree(out, ignore_errors=True)
    command = [program, "run", str(scenario_file(name)), "--no-pictures", "--no-report", "--quiet", "--out", str(out)]
    core = min(os.sched_getaffinity(0))
    child = os.fork()
    if child == 0:
        os.sched_setaffinity(0, {core})
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1)
        os.execv(command[0], command)
    _, status, usage = os.wait4(child, 0)
    code = os.waitstatus_to_exitcode(status)
    if code not in (0, 1):
        sys.exit(f"speed_bench.py: {' '.join(command)}: exit status {code}")
    summary = json.loads((out / "summary.json").read_text())
    return {
        "cpu_s": usage.ru_utime + usage.ru_stime,
        "peak_MB": usage.ru_maxrss / 1024,
        "simulated_s": summary["simulated_s"],
        "digest": summary["digest"],
    }


def best(runs: list) -> dict:
    return min(runs, key=lambda run: run["cpu_s"])


def processor() -> str:
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--against")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("names", nargs="*", default=list(AIMS))
    arguments = parser.parse_intermixed_args()
    programs = [os.path.abspath(program) for program in (arguments.program, arguments.against) if program]
    print(f"{processor()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}, {platform.system()} {platform.release()}\n")
    heading = ["scenario", "simulated s per CPU s", "aim", "CPU s", "peak MB"]
    if arguments.against:
        heading += ["CPU s of the other", "ratio", "same bits"]
    print("| " + " | ".join(heading) + " |")
    print("|---" * len(heading) + "|")
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.names:
            results = [[] for _ in programs]
            for _ in range(arguments.repeats):
                for k, program in enumerate(programs):
                    results[k].append(run(program, name, pathlib.Path(folder)))
            ours = best(results[0])
            row = [f"`{name}`", f"{ours['simulated_s'] / ours['cpu_s']:.0f}", str(AIMS.get(name, "")), f"{ours['cpu_s']:.2f}", f"{ours['peak_MB']:.0f}"]
            if arguments.against:
                other = best(results[1])
                row += [f"{other['cpu_s']:.2f}", f"{other['cpu_s'] / ours['cpu_s']:.2f}", "yes" if other["digest"] == ours["digest"] else "no"]
            print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
