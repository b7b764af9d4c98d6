"""Numbers that do not come from a single run: the command chain that makes a map, and programs that print tables."""

import json
import os
import re
import statistics
import subprocess
import tempfile
from pathlib import Path

from .expressions import NotRun, TableError
from .table import ROOT, Run

ROW = re.compile(r"^(.{44}) (lat .*)$")


def rows_of_study(output: str) -> dict:
    """Lines of localisation_study: name -> {lat, lon, nees, cov, set, mean_lat, mean_lon, lost, of}."""
    result = {}
    for line in output.splitlines():
        found = ROW.match(line)
        if not found:
            continue
        words = found.group(2).split()
        numbers = {words[i]: float(words[i + 1]) for i in (0, 2, 4, 6, 8)}
        at = words.index("mean")
        numbers["mean_lat"], numbers["mean_lon"] = float(words[at + 1]), float(words[at + 2])
        numbers["lost"], numbers["of"] = map(float, words[-1].split("/"))
        result[found.group(1).strip()] = numbers
    return result


def comparison_numbers(output: str) -> dict:
    """Errors of a map, from the output of `vinerow map --truth`."""
    patterns = {
        ("rows_found", "rows"): r"rows found +(\d+) of (\d+)",
        ("bearing_deg",): r"direction +([-+.\d]+) deg",
        ("spacing_m",): r"spacing +([-+.\d]+) m",
        ("end_mean_m", "end_worst_m"): r"row ends +([.\d]+) m mean error, ([.\d]+) m maximum",
        ("volume_percent", "seen_volume_percent"): r"volume +([-+.\d]+) % .* seen ([-+.\d]+) %",
    }
    told = output[output.index("against the truth"):]
    result = {}
    for names, pattern in patterns.items():
        result |= zip(names, map(float, re.search(pattern, told).groups()))
    return result


def benchmark_numbers(output: str) -> dict:
    """Counters of google benchmark, without the times."""
    runs = json.loads(output)["benchmarks"]
    return {run["name"].split("/")[0]: {k: v for k, v in run.items() if isinstance(v, (int, float))} for run in runs}


class Programs:
    def __init__(self, build: Path):
        self.bin = build / "bin"
        self.results: dict[str, dict] = {}
        self.cpu_s = 0.0

    def program(self, run: Run) -> Path:
        return self.bin / {"program": run.what, "benchmark": "vinerow_bench", "map": "vinerow"}[run.kind]

    def make(self, runs: list[Run]) -> None:
        """Times are taken by themselves, after all else. @throws TableError with the command and its last words"""
        for run in sorted(runs, key=lambda run: run.kind == "benchmark"):
            print(f"{run.kind} {run.name}", flush=True)
            with tempfile.TemporaryDirectory() as folder:
                self.results[run.name] = getattr(self, f"_{run.kind}")(run, Path(folder))

    def _call(self, *command) -> str:
        words = [str(word) for word in command]
        with tempfile.TemporaryFile("w+") as told, tempfile.TemporaryFile("w+") as warned:
            process = subprocess.Popen(words, cwd=ROOT, stdout=told, stderr=warned)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            told.seek(0)
            warned.seek(0)
            output, warnings = told.read(), warned.read()
        self.cpu_s += usage.ru_utime + usage.ru_stime
        if process.returncode != 0:
            last = (warnings.strip() or output.strip()).splitlines()[-1:]
            raise TableError(f"{' '.join(words)}: status {process.returncode}: {' '.join(last)}")
        return output

    def _map(self, run: Run, work: Path) -> dict:
        """The chain of docs/guides/mapping.md: flight, cloud of its pictures, map of the cloud."""
        vinerow = self.program(run)
        self._call(vinerow, "run", run.scenario, "--quiet", "--no-pictures", "--seed", 1, "--out", work / "survey")
        self._call(vinerow, "cloud", run.scenario, "--log", work / "survey", "--out", work / "cloud.las")
        told = self._call(vinerow, "map", work / "cloud.las", "--no-pictures", "--truth", work / "cloud.truth.json", "--out", work / "map")
        report = json.loads((work / "map" / "report.json").read_text())
        return {"report": report, "errors": comparison_numbers(told),
                "rows": {"mean_length_m": statistics.fmean(row["length_m"] for row in report["rows"])}}

    def _program(self, run: Run, work: Path) -> dict:
        return rows_of_study(self._call(self.program(run), *run.arguments))

    def _benchmark(self, run: Run, work: Path) -> dict:
        return benchmark_numbers(self._call(self.program(run), f"--benchmark_filter={run.what}", "--benchmark_format=json"))

    def values(self, run: Run, path: str) -> list:
        """@param path  a.b.c, or row/number of a program's table. @throws NotRun, TableError"""
        if run.name not in self.results:
            raise NotRun("not run")
        node = self.results[run.name]
        for key in path.rsplit("/", 1) if run.kind == "program" else path.split("."):
            if not isinstance(node, dict) or key not in node:
                known = ", ".join(node) if isinstance(node, dict) else "nothing"
                raise TableError(f"{run.name} has no {path}: no {key}, there is {known}")
            node = node[key]
        return [node]
