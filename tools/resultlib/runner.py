"""Makes the runs of the table, several at once, and keeps what they gave under runs/results.

A result is kept by what was run and by what with: the scenario with all files it names, the overrides, the seed, and
the program to the byte. The same again is read back.
"""

import hashlib
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from .expressions import NotRun, TableError
from .table import ROOT, Run

NAMED_FILE = re.compile(r"[\w./-]+\.(?:yaml|geojson|csv|plan|tif|urdf|obj|ply)\b")
STUDY_LINE = re.compile(r"^(.{44}) (lat .*)$")


def digest(*parts: bytes) -> str:
    total = hashlib.sha256()
    for part in parts:
        total.update(len(part).to_bytes(8, "little") + part)
    return total.hexdigest()[:16]


def files_named_by(file: Path, seen: dict[Path, bytes] | None = None) -> dict[Path, bytes]:
    """A scenario and all files that it includes or names, one through the other."""
    seen = {} if seen is None else seen
    file = file.resolve()
    if file in seen:
        return seen
    seen[file] = file.read_bytes()
    if file.suffix == ".yaml":
        for name in NAMED_FILE.findall(seen[file].decode()):
            if (file.parent / name).is_file():
                files_named_by(file.parent / name, seen)
    return seen


def study_numbers(output: str) -> dict:
    """Lines of localisation_study: name -> {lat, lon, nees, cov, set, mean_lat, mean_lon, lost, of}."""
    result = {}
    for line in output.splitlines():
        found = STUDY_LINE.match(line)
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
    """What `vinerow map --truth` tells of the map's errors."""
    patterns = {
        ("rows_found", "rows"): r"rows found +(\d+) of (\d+)",
        ("bearing_deg",): r"direction +([-+.\d]+) deg",
        ("spacing_m",): r"spacing +([-+.\d]+) m",
        ("end_mean_m", "end_worst_m"): r"row ends +([.\d]+) m off in the mean, ([.\d]+) m",
        ("volume_percent", "seen_volume_percent"): r"volume +([-+.\d]+) % .* seen ([-+.\d]+) %",
    }
    told = output[output.index("against the truth"):]
    result = {}
    for names, pattern in patterns.items():
        result |= zip(names, map(float, re.search(pattern, told).groups()))
    return result


def benchmark_numbers(output: str) -> dict:
    """Counters of google benchmark, beside the times."""
    runs = json.loads(output)["benchmarks"]
    return {run["name"].split("/")[0]: {k: v for k, v in run.items() if isinstance(v, (int, float))} for run in runs}


class Runner:
    """@param any_program  take results of other builds of the programs where there are any"""

    def __init__(self, build: Path, jobs: int, any_program: bool = False):
        self.build, self.jobs, self.any_program = build, jobs, any_program
        self.kept = ROOT / "runs" / "results"
        self.results: dict[tuple[str, int], dict] = {}
        self.left_out: dict[str, str] = {}  # run -> why
        self.from_other_builds = 0
        self._programs: dict[str, str] = {}
        self._spent = threading.local()  # processor time of the task at hand
        self._lock = threading.Lock()
        self._done = 0

    def program(self, run: Run) -> Path:
        name = {"study": run.what, "benchmark": "vinerow_bench"}.get(run.kind, "vinerow")
        return self.build / "bin" / name

    def program_digest(self, run: Run) -> str:
        program = self.program(run)
        if program.name not in self._programs:
            libraries = [] if run.kind == "study" else sorted((self.build / "lib").glob("libvinerow.so*"))[:1]
            self._programs[program.name] = digest(*[f.read_bytes() for f in [program, *libraries]])
        return self._programs[program.name]

    def keep_file(self, run: Run, seed: int) -> Path:
        """Where a result is kept: <run>.<digest of what is run>.<digest of the program>.json"""
        inputs = [run.kind, run.what, *run.sets, *run.arguments, str(seed)]
        named = files_named_by(run.scenario) if run.scenario else {}
        inputs_digest = digest(*[text.encode() for text in inputs], *[named[f] for f in sorted(named)])
        folder = self.kept / run.group
        exact = folder / f"{inputs_digest}.{self.program_digest(run)}.json"
        if self.any_program and not exact.exists():
            others = sorted(folder.glob(f"{inputs_digest}.*.json"), key=lambda f: f.stat().st_mtime)
            if others:
                self.from_other_builds += 1
                return others[-1]
        return exact

    def reason_to_leave_out(self, run: Run) -> str | None:
        if run.scenario and not run.scenario.exists():
            return f"{run.scenario.relative_to(ROOT)} does not exist"
        if not self.program(run).exists():
            return f"{self.program(run).name} is not built"
        return None

    def make(self, runs: list[Run]) -> None:
        """Runs what is not kept. @throws TableError with the command and its last words if one fails"""
        wanted = []
        for run in runs:
            reason = self.left_out.get(run.name) or self.reason_to_leave_out(run)
            if reason:
                self.left_out[run.name] = reason
                continue
            for seed in range(1, run.seeds + 1):
                kept = self.keep_file(run, seed)
                if kept.exists():
                    self.results[run.name, seed] = json.loads(kept.read_text())
                else:
                    wanted.append((run, seed, kept))
        # Times are taken by themselves, after all else.
        alone = [task for task in wanted if task[0].kind == "benchmark"]
        together = [task for task in wanted if task[0].kind != "benchmark"]
        self._done, total = 0, len(wanted)
        with ThreadPoolExecutor(self.jobs) as pool:
            for future in [pool.submit(self._make_one, *task, total) for task in together]:
                future.result()
        for task in alone:
            self._make_one(*task, total)

    def _make_one(self, run: Run, seed: int, kept: Path, total: int) -> None:
        work = self.kept / "work" / f"{run.name.replace('/', '_')}.{seed}"
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)
        self._spent.cpu_s = 0.0
        result = getattr(self, f"_{run.kind}")(run, seed, work)
        result["cpu_s"] = self._spent.cpu_s
        shutil.rmtree(work)
        kept.parent.mkdir(parents=True, exist_ok=True)
        part = kept.with_suffix(".part")
        part.write_text(json.dumps(result))
        part.rename(kept)
        with self._lock:
            self.results[run.name, seed] = result
            self._done += 1
            print(f"{self._done:4} of {total}  {result['cpu_s']:6.1f} s  {run.name}, seed {seed}", file=sys.stderr)

    def _call(self, command: list, good: tuple[int, ...] = (0,)) -> str:
        with tempfile.TemporaryFile("w+") as told, tempfile.TemporaryFile("w+") as warned:
            process = subprocess.Popen([str(c) for c in command], cwd=ROOT, stdout=told, stderr=warned)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            told.seek(0)
            warned.seek(0)
            output, warnings = told.read(), warned.read()
        self._spent.cpu_s += usage.ru_utime + usage.ru_stime
        if process.returncode not in good:
            last = (warnings.strip() or output.strip()).splitlines()[-1:]
            raise TableError(f"{' '.join(map(str, command))}: status {process.returncode}: {' '.join(last)}")
        return output

    def _scenario(self, run: Run, seed: int, work: Path) -> dict:
        sets = [word for text in run.sets for word in ("--set", text)]
        # Status 1, a criterion that is not met, is a result as well.
        self._call([self.program(run), "run", run.scenario, "--quiet", "--no-log", "--no-pictures", "--seed", seed,
                    "--out", work, *sets], good=(0, 1))
        return self._summary(work)

    @staticmethod
    def _summary(folder: Path) -> dict:
        summary = json.loads((folder / "summary.json").read_text())
        result = dict(summary["metrics"])
        for key in ("status", "exit_status", "simulated_s", "real_time_factor", "planning"):
            result[key] = summary.get(key)
        phases = {p["name"]: p for p in summary.get("phases", [])}
        if phases:
            result["phases"] = phases
            result["phase_count"] = len(phases)
            result["phases_succeeded"] = sum(p["state"] == "succeeded" for p in phases.values())
        return result

    def _map(self, run: Run, seed: int, work: Path) -> dict:
        """The chain of docs/mapping.md: flight, cloud of its pictures, map of the cloud."""
        vinerow = self.program(run)
        self._call([vinerow, "run", run.scenario, "--quiet", "--no-pictures", "--seed", seed, "--out", work / "survey"])
        self._call([vinerow, "cloud", run.scenario, "--log", work / "survey", "--out", work / "cloud.las"])
        told = self._call([vinerow, "map", work / "cloud.las", "--no-pictures", "--truth", work / "cloud.truth.json",
                           "--out", work / "map"])
        result = self._summary(work / "survey")
        result["report"] = json.loads((work / "map" / "report.json").read_text())
        result["errors"] = comparison_numbers(told)
        result["rows"] = {"mean_length_m": statistics.fmean(row["length_m"] for row in result["report"]["rows"])}
        return result

    def _study(self, run: Run, seed: int, work: Path) -> dict:
        return study_numbers(self._call([self.program(run), *run.arguments]))

    def _benchmark(self, run: Run, seed: int, work: Path) -> dict:
        return benchmark_numbers(
            self._call([self.program(run), f"--benchmark_filter={run.what}", "--benchmark_format=json"]))

    def values(self, run: Run, path: str) -> list:
        """What each seed gave. @param path  a.b.c, or name/number of a study"""
        if run.name in self.left_out:
            raise NotRun(self.left_out[run.name])
        values = []
        for seed in range(1, run.seeds + 1):
            node = self.results[run.name, seed]
            for key in path.rsplit("/", 1) if run.kind == "study" else path.split("."):
                if not isinstance(node, dict) or key not in node:
                    known = ", ".join(node) if isinstance(node, dict) else "nothing"
                    raise TableError(f"{run.name} has no {path}: no {key}, there is {known}")
                node = node[key]
            values.append(node)
        return values

    def cpu_s(self) -> float:
        return sum(result["cpu_s"] for result in self.results.values())
