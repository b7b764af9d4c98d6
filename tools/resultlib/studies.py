"""Runs of scenarios, as settings of studies: shipped ones, or one made for each run of the table, its axes as alternatives.

Studies keep what they have run under runs/results: the same again is read back.
"""

import csv
import subprocess
import sys
from pathlib import Path

from .expressions import NotRun, TableError
from .table import ROOT, Run

KEPT = ROOT / "runs" / "results"


def study_text(runs: list[Run], metrics: list[str]) -> str:
    """Study of runs of one scenario with different overrides. @param metrics  the numbers to keep"""
    alternatives = [f"      {run.name}: {{{', '.join(text.replace('=', ': ', 1) for text in run.sets)}}}\n" for run in runs]
    return (f"vinerow_study: 1\nscenario: {runs[0].scenario}\nseeds: {runs[0].seeds}\n"
            f"metrics: [{', '.join(metrics)}]\nfactors:\n  run:\n    alternatives:\n{''.join(alternatives)}")


class Studies:
    def __init__(self, vinerow: Path, jobs: int, asked: dict[str, list[str]]):
        """@param asked  numbers that are asked of each run"""
        self.vinerow, self.jobs, self.asked = vinerow, jobs, asked
        self.cells: dict[str, list[dict]] = {}  # run -> a row of cells.csv for each seed
        self.cpu_s = 0.0

    def files(self, runs: list[Run], folder: Path = KEPT) -> dict[Path, list[Run]]:
        """The studies that hold these runs; those that are not shipped are written."""
        files = {}
        for run in runs:
            if run.kind == "study":
                files.setdefault(run.study, []).append(run)
        runs = [run for run in runs if run.kind == "scenario"]
        together: dict[tuple[str, Path], list[Run]] = {}
        for run in runs:
            together.setdefault((run.group, run.scenario), []).append(run)
        folder.mkdir(parents=True, exist_ok=True)
        for (group, scenario), members in together.items():
            several = sum(other == group for other, _ in together) > 1
            file = folder / f"{group}{'_' + scenario.stem if several else ''}.yaml"
            metrics = sorted({path for run in members for path in self.asked.get(run.name, [])})
            file.write_text(study_text(members, metrics))
            files[file] = members
        return files

    def make(self, runs: list[Run]) -> None:
        """@throws TableError with the study's last line if a run did not run to the end"""
        for file, members in self.files(runs).items():
            out = KEPT / file.stem
            # A changed list of cells, program or scenario starts a new index; unchanged cells are reused.
            command = [self.vinerow, "study", "run", file, "--out", out, "--cells", KEPT / "cells", "--fresh", "--jobs", self.jobs]
            print(f"study {file.stem}", flush=True)
            command += [] if sys.stderr.isatty() else ["--quiet"]
            done = subprocess.run([str(word) for word in command], cwd=ROOT, stdout=subprocess.PIPE, text=True)
            # Status 1, a criterion that is not met, is a result as well.
            if done.returncode not in (0, 1):
                raise TableError(f"{' '.join(map(str, command))}: status {done.returncode}: {done.stdout.strip()}")
            rows = list(csv.DictReader((out / "cells.csv").read_text().splitlines()))
            for run in members:
                levels = run.levels if run.kind == "study" else (("run", run.name),)
                self.cells[run.name] = [row for row in rows if all(row[column] == text for column, text in levels)]
                if len(self.cells[run.name]) != run.seeds:
                    raise TableError(f"{run.name}: {file.name} has {len(self.cells[run.name])} runs of it, not {run.seeds}")
            self.cpu_s += sum(float(row["cpu_s"] or 0.0) for row in csv.DictReader((out / "costs.csv").read_text().splitlines()))

    def values(self, run: Run, path: str) -> list[float | None]:
        """Values of all seeds. @throws NotRun"""
        if run.name not in self.cells:
            raise NotRun("not run")
        rows = self.cells[run.name]
        if path not in rows[0]:
            raise TableError(f"{run.name}: its study keeps no {path}")
        return [float(row[path]) if row[path] else None for row in rows]
