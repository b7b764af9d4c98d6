"""Results of studies."""

from __future__ import annotations

import os
import pathlib

from . import _arguments, display
from .errors import ConfigError
from .tables import Table, read_table


class Study:
    """Tables of a study, as `vinerow study` wrote them.

    folder: of the study's results
    cells: a row for each run: cell, setting, seed, factors, state, reason, digest, numbers
    settings: a row for each setting: factors, counts, fraction met, statistics of each number
    costs: a row for each cell that ran: times, memory, machine
    """

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = pathlib.Path(_arguments.path("folder", folder))
        if not (self.folder / "cells.csv").is_file():
            if (self.folder / "study.sqlite").is_file():
                raise ConfigError(f"{self.folder}: contains no cells.csv; `vinerow study table` writes it")
            raise ConfigError(f"{self.folder}: contains no cells.csv, so it is not the folder of a study's results")
        self.cells: Table = read_table(self.folder / "cells.csv")
        self.settings: Table = read_table(self.folder / "settings.csv")
        self.costs: Table = read_table(self.folder / "costs.csv")

    def __repr__(self) -> str:
        return f"Study('{self.folder}', {self.cells.row_count} cells, {self.settings.row_count} settings)"

    def _repr_html_(self) -> str:
        return display.study_html(self)


def read_study(folder: str | os.PathLike[str]) -> Study:
    """Reads the tables of a study from the folder of its results, e.g. "runs/my_study". Raises ConfigError."""
    return Study(folder)
