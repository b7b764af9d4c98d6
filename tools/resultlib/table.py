"""Reads tools/results.toml: the runs, and the papers' numbers to which they are compared."""

import itertools
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from .expressions import TableError, calls_of

ROOT = Path(__file__).resolve().parents[2]
TABLE = ROOT / "tools" / "results.toml"
VERDICTS = ("reproduced", "in part", "not reproduced", "taken over", "no figure to compare", "drawing")
# {expression|format} in any text of an entry.
NUMBER = re.compile(r"\{([^{}|]+)\|([^{}|]+)\}")


@dataclass(frozen=True)
class Run:
    """One way to make numbers: kind is scenario, study, map, program or benchmark."""

    name: str
    kind: str
    what: str  # scenario, study, program or filter
    sets: tuple[str, ...] = ()
    arguments: tuple[str, ...] = ()
    seeds: int = 1
    quick: bool = False
    group: str = ""  # name of the table's run that axes made this one of
    shown: tuple[str, ...] = ()  # the overrides as shown to readers, with the axes' names
    levels: tuple[tuple[str, str], ...] = ()  # of the axes; of a study its factors

    @property
    def has_cells(self) -> bool:
        """Whether it is a setting of a study, its own or a shipped one."""
        return self.kind in ("scenario", "study")

    @property
    def study(self) -> Path:
        return ROOT / "assets" / "studies" / f"{self.what}.yaml"

    @property
    def scenario(self) -> Path | None:
        """The scenario file, if any."""
        return ROOT / "assets" / "scenarios" / f"{self.what}.yaml" if self.kind in ("scenario", "map") else None


@dataclass
class Entry:
    paper: str
    item: str
    title: str
    verdict: str
    head: list[str] = field(default_factory=list)
    rows: list[list[str]] = field(default_factory=list)
    here: str = ""  # for drawings: the part of it that exists here
    why: str = ""
    pictures: list[str] = field(default_factory=list)

    def texts(self) -> list[str]:
        return [cell for row in self.rows for cell in row] + [self.here, self.why]

    def expressions(self) -> list[str]:
        return [found.group(1) for text in self.texts() for found in NUMBER.finditer(text)]

    def runs(self) -> list[str]:
        """Names of the runs its numbers come from, in order."""
        calls = [call for text in self.expressions() for call in calls_of(text)]
        return list(dict.fromkeys(arguments[0] for name, arguments in calls if name != "asset"))


@dataclass
class Table:
    runs: dict[str, Run]
    entries: list[Entry]
    papers: dict[str, str]  # letter -> what it is

    def asked(self) -> dict[str, list[str]]:
        """Run -> the numbers that are requested from it, in order."""
        paths: dict[str, dict[str, None]] = {}
        for entry in self.entries:
            for text in entry.expressions():
                for name, arguments in calls_of(text):
                    if name != "asset":
                        paths.setdefault(arguments[0], {})[arguments[1]] = None
        return {run: list(names) for run, names in paths.items()}


def runs_of(name: str, given: dict) -> list[Run]:
    """All combinations of the axes, named name/value/value."""
    kinds = [kind for kind in ("scenario", "study", "map", "program", "benchmark") if kind in given]
    beside = {"set", "arguments", "seeds", "quick", "axes"}
    if len(kinds) != 1 or not set(given) <= beside | {*kinds}:
        raise TableError(f"run {name}: wants one of scenario, study, map, program, benchmark, and beside it only "
                         f"{', '.join(sorted(beside))}")
    axes = given.get("axes", {})
    template = tuple(given.get("set", []))
    shown = template
    for axis in axes:
        shown = tuple(text.replace("{" + axis + "}", f"<{axis}>") for text in shown)
    runs = []
    for values in itertools.product(*axes.values()):
        texts = (given[kinds[0]], *template)
        for axis, value in zip(axes, values):
            texts = tuple(text.replace("{" + axis + "}", str(value)) for text in texts)
        runs.append(
            Run("/".join([name, *map(str, values)]), kinds[0], texts[0], texts[1:], tuple(given.get("arguments", [])),
                given.get("seeds", 1), given.get("quick", False), name, shown,
                tuple(zip(axes, map(str, values)))))
    return runs


def rows_of(head: list[str], rows: list) -> list[list[str]]:
    """A row is its cells, or {label, cell}: one cell for all columns, with $row and $column in it."""
    made = []
    for row in rows:
        if isinstance(row, dict):
            label, cell = row["label"], row["cell"]
            row = [label] + [cell.replace("$row", label).replace("$column", column) for column in head[1:]]
        if len(row) != len(head):
            raise TableError(f"the row '{row[0]}' has {len(row)} cells of {len(head)}")
        made.append(row)
    return made


def entry_of(given: dict) -> Entry:
    place = f"paper {given.get('paper')}, {given.get('item')}"
    try:
        fields = dict(given)
        table = fields.pop("table", {"head": [], "rows": []})
        entry = Entry(**fields, head=table["head"], rows=rows_of(table["head"], table["rows"]))
    except (TypeError, KeyError, TableError) as error:
        raise TableError(f"{place}: {error}") from None
    if entry.verdict not in VERDICTS:
        raise TableError(f"{place}: verdict '{entry.verdict}', must be one of {', '.join(VERDICTS)}")
    if entry.verdict == "drawing" and not entry.here:
        raise TableError(f"{place}: a drawing says what of it is here")
    if entry.verdict != "drawing" and not (entry.rows and entry.why):
        raise TableError(f"{place}: must have a table and a reason why the numbers differ")
    return entry


def load_table(file: Path = TABLE) -> Table:
    with file.open("rb") as stream:
        given = tomllib.load(stream)
    runs = [run for name, run_given in given["run"].items() for run in runs_of(name, run_given)]
    table = Table({run.name: run for run in runs}, [entry_of(e) for e in given["entry"]], given["papers"])
    for entry in table.entries:
        for name in entry.runs():
            if name not in table.runs:
                raise TableError(f"paper {entry.paper}, {entry.item}: there is no run '{name}'")
    return table
