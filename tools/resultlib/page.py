"""Writes docs/papers/results.md from the table and the numbers, and compares such a page with other numbers."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

from .expressions import NotRun, TableError, calls_of, evaluate
from .table import NUMBER, ROOT, VERDICTS, Entry, Run, Table

ASSET_NUMBER = r"^\s*{key}:\s*(?:\{{value:\s*)?(\[[^\]]*\]|[-+.\de]+)"
NUMBER_TEXT = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")
NOT_RUN = "not run"


@dataclass
class Piece:
    """Text of the page; for a number also the expression and the allowed difference."""

    text: str
    number: float | None = None
    margin: float = 0.0
    where: str = ""


def asset_number(file: str, key: str, index: int = 0) -> float:
    """A number of a parameter file under assets/."""
    text = (ROOT / "assets" / file).read_text()
    found = re.search(ASSET_NUMBER.format(key=re.escape(key)), text, re.MULTILINE)
    if not found:
        raise TableError(f"assets/{file} has no number {key}")
    numbers = NUMBER_TEXT.findall(found.group(1))
    if index >= len(numbers):
        raise TableError(f"assets/{file}: {key} has {len(numbers)} numbers, none at {index}")
    return float(numbers[index])


class Page:
    """@param values_of  (run, path) -> one value for each seed
    @param tolerance  allowed relative difference in a comparison, besides the last digit
    @param skips      (run) -> whether its numbers are skipped: any number is accepted"""

    def __init__(self, table: Table, values_of: Callable[[Run, str], list], tolerance: float,
                 skips: Callable[[Run], bool] = lambda run: False):
        self.table, self.values_of, self.tolerance, self.skips = table, values_of, tolerance, skips
        self.pieces: list[Piece] = []
        self.faults: list[str] = []

    def text(self) -> str:
        return "".join(piece.text for piece in self.pieces)

    def add(self, text: str, where: str = "") -> None:
        """Adds a text with its numbers inserted."""
        at = 0
        for found in NUMBER.finditer(text):
            self.pieces.append(Piece(text[at:found.start()]))
            self._add_number(found.group(1), found.group(2), where)
            at = found.end()
        self.pieces.append(Piece(text[at:]))

    def add_rough(self, value: float, form: str, where: str) -> None:
        """A number that may differ on another machine or with a part of the runs."""
        self.pieces.append(Piece(format(value, form), value, math.inf, where))

    def compared(self) -> int:
        return sum(piece.number is not None and math.isfinite(piece.margin) for piece in self.pieces)

    def _add_number(self, expression: str, form: str, where: str) -> None:
        rough = form.startswith("~")
        runs = [self.table.runs[arguments[0]] for name, arguments in calls_of(expression) if name != "asset"]
        if any(map(self.skips, runs)):
            self.pieces.append(Piece("?", 0.0, math.inf, where))
            return
        try:
            value = evaluate(expression, lambda run, path: self.values_of(self.table.runs[run], path), asset_number)
        except NotRun:
            self.pieces.append(Piece(NOT_RUN))
            return
        except (TableError, ZeroDivisionError, TypeError, KeyError) as error:
            self.faults.append(f"{where}: {error}")
            self.pieces.append(Piece("?"))
            return
        text = format(value, form.lstrip("~"))
        if isinstance(value, str):
            self.pieces.append(Piece(text))
            return
        decimals = len(text.partition(".")[2])
        margin = 2.0 * abs(value) if rough else self.tolerance * abs(value) + 0.6 * 10.0**-decimals
        self.pieces.append(Piece(text, float(text), margin, f"{where}: {expression}"))

    def differences(self, page: str) -> list[str]:
        """Differences of another page from this one: texts exactly, numbers within their margin."""
        differences, at = [], 0
        for piece in self.pieces:
            line = page.count("\n", 0, at) + 1
            if piece.number is None:
                if not page.startswith(piece.text, at):
                    same = next((i for i, (a, b) in enumerate(zip(piece.text, page[at:])) if a != b), 0)
                    line += piece.text.count("\n", 0, same)
                    wanted, there = piece.text[same:same + 60], page[at + same:at + same + 60]
                    return [*differences, f"line {line}: the text differs: {there!r}, must be {wanted!r}"]
                at += len(piece.text)
                continue
            if math.isinf(piece.margin) and page.startswith(NOT_RUN, at):
                at += len(NOT_RUN)
                continue
            found = NUMBER_TEXT.match(page, at)
            if not found:
                return [*differences, f"line {line}: no number where {piece.text} must be ({piece.where})"]
            if not abs(float(found.group()) - piece.number) <= piece.margin:
                differences.append(f"line {line}: {found.group()}, made anew it is {piece.text} ({piece.where})")
            at = found.end()
        if at != len(page):
            differences.append(f"line {page.count(chr(10), 0, at) + 1}: more text than the table has")
        return differences


def command_of(run: Run) -> str:
    """Command that reproduces a run."""
    sets = "".join(f" --set '{text}'" for text in run.shown)
    seeds = f", seeds 1 to {run.seeds}" if run.seeds > 1 else ""
    if run.kind == "scenario":
        return f"`vinerow run assets/scenarios/{run.what}.yaml{sets}`{seeds}"
    if run.kind == "study":
        return f"`vinerow study run assets/studies/{run.what}.yaml`"
    if run.kind == "map":
        return f"`assets/scenarios/{run.what}.yaml` by `vinerow run`, `cloud`, `map` ([mapping.md](../guides/mapping.md))"
    if run.kind == "program":
        return f"`build/release/bin/{run.what} {' '.join(run.arguments)}`"
    return f"`build/release/bin/vinerow_bench --benchmark_filter='{run.what}'`"


def anchor(entry: Entry) -> str:
    heading = f"{entry.paper}, {entry.item}: {entry.title}".lower()
    return re.sub(r"[^\w\- ]", "", heading).replace(" ", "-")


def write_entry(page: Page, entry: Entry) -> None:
    where = f"paper {entry.paper}, {entry.item}"
    page.add(f"### {entry.paper}, {entry.item}: {entry.title}\n\n*{entry.verdict.capitalize()}.*\n\n")
    page.add("| " + " | ".join(entry.head) + " |\n" + "|---" * len(entry.head) + "|\n")
    for row in entry.rows:
        page.add("| " + " | ".join(row) + " |\n", where)
    page.add(f"\n{entry.why.strip()}\n\n", where)
    commands = dict.fromkeys(command_of(page.table.runs[name]) for name in entry.runs())
    if commands:
        page.add(("Command: " if len(commands) == 1 else "Commands:\n- ") + "\n- ".join(commands) + "\n\n")


def write_page(page: Page, runs: int, cpu_s: float) -> None:
    table = page.table
    page.add("# Reproduction of the three papers' results\n\n"
             "All tables and figures of papers A, B and C, and the numbers in their texts: what is printed, what comes out "
             "here,\nthe command that produces it, and why they differ. One command writes this page; the numbers in its "
             "tables are never\ntyped:\n\n"
             "    tools/results            # builds, runs what is not cached under runs/results, writes this page\n"
             "    tools/results --check    # compares the page with fresh numbers\n"
             "    tools/results --quick    # the same for the runs that take seconds\n\n")
    page.add("`tools/results.toml` defines the runs and how each number is computed. In total: ")
    page.add_rough(runs, ".0f", "runs")
    page.add(" runs, ")
    page.add_rough(cpu_s / 60.0, ".0f", "minutes")
    page.add(" minutes on one core.\n\n"
             "Only the texts of the papers were available, not their figures: a plot is compared with the sentences about "
             "it. If a\npaper misprints an equation, the corrected one is used; the pages linked below list the "
             "corrections.\n\n"
             "- *Reproduced*: could have failed, and agrees with the printed numbers or, without any, with the text.\n"
             "- *In part*: agrees in some of its numbers or sentences only.\n"
             "- *Taken over*: an input here, or chosen such that it agrees.\n\n")
    verdicts = [verdict for verdict in VERDICTS if any(e.verdict == verdict for e in table.entries)]
    page.add("| entries | " + " | ".join(verdicts) + " |\n" + "|---" * (len(verdicts) + 1) + "|\n")
    for letter in table.papers:
        counts = [sum(e.paper == letter and e.verdict == verdict for e in table.entries) for verdict in verdicts]
        page.add(f"| paper {letter} | " + " | ".join(map(str, counts)) + " |\n")
    page.add("\n| paper | |\n|---|---|\n")
    for letter, name in table.papers.items():
        page.add(f"| {letter} | {name} |\n")
    page.add("\n")
    for letter in table.papers:
        entries = [e for e in table.entries if e.paper == letter]
        page.add(f"## Paper {letter}\n\n| | | |\n|---|---|---|\n")
        for e in entries:
            if e.verdict != "drawing":
                page.add(f"| [{e.item}](#{anchor(e)}) | {e.title} | {e.verdict} |\n")
        page.add("\n")
        for e in entries:
            if e.verdict != "drawing":
                write_entry(page, e)
        drawings = [e for e in entries if e.verdict == "drawing"]
        page.add(f"### Paper {letter}: drawings and photographs\n\n| | shows | here |\n|---|---|---|\n")
        for e in drawings:
            page.add(f"| {e.item} | {e.title} | {e.here} |\n", f"paper {letter}, {e.item}")
        page.add("\n")
    while page.pieces and not page.pieces[-1].text.strip():
        page.pieces.pop()
    page.pieces[-1].text = page.pieces[-1].text.rstrip("\n") + "\n"
