#!/usr/bin/env python3
"""Prints what studies cost. Table of docs/contributing/performance.md.

usage: study_bench.py [--build FOLDER] [loop] [scaling] [worlds] [many]

  loop     CPU time of a cell against a bare loop over the same runs in one process
  scaling  wall clock on one core against two; wants a quiet machine of two cores
  worlds   cells that share a world against a process for each
  many     a study of 100,000 cells: listed, its finished cells taken over, resumed
"""

import argparse
import json
import os
import re
import resource
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
SCENARIOS = TREE / "assets" / "scenarios"


class Bench:
    def __init__(self, build: Path, folder: Path):
        self.vinerow, self.bench, self.folder = build / "bin" / "vinerow", build / "bin" / "vinerow_bench", folder

    def study(self, text: str, name: str = "s") -> Path:
        file = self.folder / f"{name}.yaml"
        file.write_text("vinerow_study: 1\n" + text)
        return file

    def call(self, *words, good=(0, 1)) -> tuple[float, float, float, str]:
        """CPU seconds, wall seconds, peak memory in MB and output of a command with all that it starts."""
        before, begin = os.times(), time.monotonic()
        with tempfile.TemporaryFile("w+") as told:
            process = subprocess.Popen([str(word) for word in words], cwd=self.folder, stdout=told, stderr=subprocess.DEVNULL)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            told.seek(0)
            output = told.read()
        after = os.times()
        if process.returncode not in good:
            sys.exit(f"{' '.join(map(str, words))}: status {process.returncode}: {output[-2000:]}")
        cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
        return cpu_s, time.monotonic() - begin, usage.ru_maxrss / 1e3, output

    def run(self, file: Path, out: str, jobs: int):
        return self.call(self.vinerow, "study", "run", file, "--out", self.folder / out, "--jobs", jobs, "--quiet")

    def loop(self) -> None:
        for scenario, cells in (("orchard_rover", 100), ("riseholme_rover", 20)):
            text, turns = f"scenario: {SCENARIOS}/{scenario}.yaml\nset: {{criteria: []}}\nseeds: {cells}\n", []
            for turn in range(5):
                told = self.call(self.bench, f"--benchmark_filter=study_bare_loop/{scenario}/", "--benchmark_format=json")[3]
                bare_s = json.loads(told)["benchmarks"][0]["cpu_time"]
                file = self.study(text, f"{scenario}{turn}")
                whole_s = self.run(file, file.stem, 1)[0]
                # What every study takes, however many its cells: reading, checking, tables, report.
                fixed_s = self.run(file, file.stem, 1)[0]
                turns.append(((whole_s - fixed_s) / bare_s - 1.0, bare_s / cells, fixed_s))
            share, bare_s, fixed_s = (statistics.median(column) for column in zip(*turns))
            shares = [turn[0] for turn in turns]
            print(f"a cell against a bare loop   {share:+.1%} ({min(shares):+.1%} to {max(shares):+.1%} in 5 turns) of {1e3 * bare_s:.0f} ms of CPU time, "
                  f"{scenario}; a study itself {fixed_s:.2f} s")

    def scaling(self) -> None:
        file = self.study(f"scenario: {SCENARIOS}/orchard_rover.yaml\nset: {{criteria: []}}\nseeds: 400\n")
        ratios = []
        for turn in range(3):
            walls = [float(re.search(r"cells in ([\d.]+) s", self.run(file, f"scaling{turn}{jobs}", jobs)[3]).group(1)) for jobs in (1, 2)]
            ratios.append(walls[0] / walls[1])
        print(f"two cores against one        {statistics.median(ratios):.2f} times as fast ({min(ratios):.2f} to {max(ratios):.2f} in 3 turns)")

    def worlds(self) -> None:
        cells = 20
        file = self.study(f"scenario: {SCENARIOS}/vineyard_4ws_two_rows.yaml\nset: {{criteria: [], duration_s: 10}}\nseeds: {cells}\n")
        # The first process that needs the files of plants makes them, once.
        self.call(self.vinerow, "study", "cell", file, 0, "--out", self.folder / "first")
        shared_s = self.run(file, "shared", 1)[0]
        alone_s = sum(self.call(self.vinerow, "study", "cell", file, cell, "--out", self.folder / "alone")[0] for cell in range(cells))
        print(f"worlds shared                {alone_s / cells:.2f} s of CPU time for a cell in a process of its own, {shared_s / cells:.2f} s on one worker: "
              f"{alone_s / shared_s:.1f} times")

    def many(self) -> None:
        file = self.study(f"scenario: {SCENARIOS}/orchard_rover.yaml\nset: {{criteria: [], duration_s: 0.1}}\nseeds: 1000\n"
                          "metrics: [rover.time_s, rover.distance_m]\n"
                          "factors:\n  a: {key: rover.controller.lookahead_m, from: 0.5, to: 2, count: 100}\n", "many")
        out = self.folder / "many"
        listing = self.call(self.vinerow, "study", "list", file, "--out", out)
        assert len(listing[3].split()) == 100_000
        # A driver that is ended at once leaves the index; the cells' files are then those of one cell that ran, under all names.
        driver = subprocess.Popen([self.vinerow, "study", "run", file, "--out", out, "--jobs", "1", "--quiet"], stdout=subprocess.DEVNULL)
        while not list((out / "cells").glob("*/*.json")):
            time.sleep(0.01)
        driver.kill()
        driver.wait()
        text = next((out / "cells").glob("*/*.json")).read_bytes()
        with sqlite3.connect(out / "study.sqlite") as index:
            names = [row[0] for row in index.execute("SELECT identity FROM cells")]
        index.close()
        for name in names:
            place = out / "cells" / name[:2] / f"{name}.json"
            place.parent.mkdir(exist_ok=True)
            place.write_bytes(text)
        taken = self.call(self.vinerow, "study", "resume", file, "--out", out, "--jobs", 1, "--quiet")
        assert "100000 were already finished" in taken[3], taken[3]
        again = self.call(self.vinerow, "study", "resume", file, "--out", out, "--jobs", 1, "--quiet")
        status = self.call(self.vinerow, "study", "status", file, "--out", out)
        for what, (cpu_s, wall_s, peak_MB, _) in (("listed", listing), ("resumed, files of cells", taken), ("resumed, index", again), ("status", status)):
            print(f"100,000 cells, {what:24} {wall_s:5.1f} s, {cpu_s:5.1f} s of CPU time, {peak_MB:4.0f} MB")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", choices=[[], "loop", "scaling", "worlds", "many"])
    parser.add_argument("--build", type=Path, default=TREE / "build" / "release")
    arguments = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments.build.resolve(), Path(folder))
        for what in arguments.what or ["loop", "scaling", "worlds", "many"]:
            getattr(bench, what)()


if __name__ == "__main__":
    main()
