"""Runs with files."""

from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Iterable, NamedTuple

from . import _arguments, _core, display
from .errors import ConfigError
from .logs import Log, read_log
from .messages import Crash, Event, Phase
from .pictures import Pictures


class Criterion(NamedTuple):
    """A limit on a metric. kind: "min" or "max"; value is NaN if it was not measured."""

    name: str
    metric: str
    kind: str
    value: float
    limit: float
    met: bool


def _number(value: float | None) -> float:
    """JSON has null for NaN."""
    return float("nan") if value is None else value


def _criteria(entries: list[dict[str, Any]]) -> list[Criterion]:
    return [Criterion(c["name"], c["metric"], c["kind"], _number(c["value"]), _number(c["limit"]), c["met"]) for c in entries]


_LEVELS = {"info": "INFO", "warning": "WARN", "error": "ERROR"}


class Run:
    """Results of a run, read from its folder.

    folder: with the files that `vinerow run` writes
    name: of the scenario
    scenario: its text, with includes, overrides and defaults written out
    verdict: "all criteria met", or what failed
    met: every criterion and phase was met, and no vehicle crashed
    error: one sentence if the run broke off or a vehicle crashed, else ""
    digest: of every signal
    criteria: list of Criterion
    metrics: {vehicle: {metric: number}}; NaN if not applicable
    phases, crashes: of a mission; lists of Phase and Crash
    missing: sentences about files that could not be made; empty for a run that was only read
    summary: all of summary.json
    """

    def __init__(self, folder: str | os.PathLike[str], missing: Iterable[str] = ()):
        self.folder = pathlib.Path(_arguments.path("folder", folder))
        file = self.folder / "summary.json"
        try:
            summary = json.loads(file.read_text(encoding="utf-8"))
            self.summary: dict[str, Any] = summary
            self.name: str = summary["scenario"]
            self.verdict: str = summary["status"]
            self.met: bool = summary["exit_status"] == 0
            self.error: str = summary.get("error", "")
            self.seed: int = summary["seed"]
            self.digest: str = summary["digest"]
            self.simulated_s: float = summary["simulated_s"]
            self.finished: bool = summary["finished"]
            self.criteria = _criteria(summary["criteria"])
            self.metrics = {vehicle: {name: _number(value) for name, value in metrics.items()}
                            for vehicle, metrics in summary["metrics"].items()}
            self.phases = [Phase(p["name"], p["state"], p["begin_s"], p["end_s"], p["reason"], p["numbers"])
                           for p in summary.get("phases", [])]
            self.crashes = [Crash(c["vehicle"], c["time_s"], c["text"]) for c in summary.get("crashes", [])]
        except FileNotFoundError:
            raise ConfigError(f"{self.folder}: contains no summary.json, so it is not the folder of a run") from None
        except OSError as error:
            raise ConfigError(f"{file}: cannot be read: {error.strerror}", file=str(file)) from None
        except ValueError as error:
            raise ConfigError(f"{file}: is not JSON: {error}", file=str(file)) from None
        except (KeyError, TypeError, AttributeError):
            raise ConfigError(f"{file}: is not the summary of a run", file=str(file)) from None
        self.missing = list(missing)
        self._log: Log | None = None

    @property
    def scenario(self) -> str:
        return self._text("scenario.resolved.yaml")

    @property
    def log(self) -> Log:
        """The log. Raises ConfigError if the run has none."""
        if self._log is None:
            self._log = read_log(self.folder / "log.mcap")
        return self._log

    @property
    def events(self) -> list[Event]:
        entries = [json.loads(line) for line in self._text("events.jsonl").splitlines()]
        return [Event(e["t_s"], _LEVELS[e["level"]], e["source"], e["text"]) for e in entries]

    @property
    def pictures(self) -> Pictures:
        """Mapping of names to arrays (h, w, 3)."""
        return Pictures(self.folder)

    @property
    def report(self) -> pathlib.Path | None:
        """The page report.html, or None."""
        return self._existing("report.html")

    @property
    def replay(self) -> pathlib.Path | None:
        """The page replay.html, or None."""
        return self._existing("replay.html")

    def write_report(self) -> pathlib.Path:
        """Writes report.html, as `vinerow report` does."""
        _core.write_report(str(self.folder))
        return self.folder / "report.html"

    def write_replay(self) -> pathlib.Path:
        """Writes replay.html, as `vinerow replay` does."""
        _core.write_replay(str(self.folder))
        return self.folder / "replay.html"

    def show_report(self, height: int = 800) -> display.Page:
        """The report in a frame of a notebook, of a height in pixels; written first if it is missing."""
        return display.Page(self.report or self.write_report(), height)

    def show_replay(self, height: int = 600) -> display.Page:
        """The replay in a frame of a notebook, of a height in pixels; written first if it is missing."""
        return display.Page(self.replay or self.write_replay(), height)

    def _existing(self, name: str) -> pathlib.Path | None:
        file = self.folder / name
        return file if file.is_file() else None

    def _text(self, name: str) -> str:
        file = self.folder / name
        try:
            return file.read_text(encoding="utf-8")
        except OSError as error:
            raise ConfigError(f"{file}: cannot be read: {error.strerror}", file=str(file)) from None

    def __repr__(self) -> str:
        return f"Run('{self.folder}', {self.verdict})"

    def _repr_html_(self) -> str:
        return display.run_html(self)


def read_run(folder: str | os.PathLike[str]) -> Run:
    """Opens the folder of an earlier run. Raises ConfigError."""
    return Run(folder)


def run_scenario(scenario: _core.Scenario, out: str | os.PathLike[str] | None, log: bool, pictures: bool, report: bool) -> Run:
    """vinerow.run() for a loaded scenario."""
    folder = pathlib.Path("runs") / scenario.name if out is None else pathlib.Path(_arguments.path("out", out))
    return Run(folder, _core.run_files(scenario, str(folder), log, pictures, report))


