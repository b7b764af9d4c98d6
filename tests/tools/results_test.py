#!/usr/bin/env python3
"""Is docs/papers/results.md complete, and does its table name only what exists?

    results_test.py VINEROW [LOCALISATION_STUDY]
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))

from resultlib.expressions import NotRun, TableError, calls_of, evaluate  # noqa: E402
from resultlib.page import Page, asset_number, write_page  # noqa: E402
from resultlib.programs import comparison_numbers, rows_of_study  # noqa: E402
from resultlib.studies import Studies  # noqa: E402
from resultlib.table import entry_of, load_table, runs_of  # noqa: E402

VINEROW, *STUDY = sys.argv[1:]

# What the papers number: counted in their texts. Paper A has no table.
ITEMS = {"A": {"figure": 21}, "B": {"figure": 22, "table": 3}, "C": {"figure": 11, "table": 3}}
TABLE = load_table()


def call(*command: str) -> str:
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=True).stdout


class Completeness(unittest.TestCase):
    def test_every_table_and_figure_has_one_entry(self):
        for paper, kinds in ITEMS.items():
            wanted = sorted(f"{kind} {n}" for kind, count in kinds.items() for n in range(1, count + 1))
            there = sorted(e.item for e in TABLE.entries if e.paper == paper and not e.item.startswith("text"))
            self.assertEqual(there, wanted, f"paper {paper}")

    def test_every_entry_with_numbers_has_ours(self):
        for entry in TABLE.entries:
            if entry.verdict != "drawing":
                self.assertTrue(entry.expressions(), f"{entry.paper}, {entry.item} has no number of ours")

    def test_every_run_is_used(self):
        used = {TABLE.runs[name].group for entry in TABLE.entries for name in entry.runs()}
        self.assertEqual(used, {run.group for run in TABLE.runs.values()})

    def test_the_page_has_the_tables_text(self):
        page = Page(TABLE, lambda run, path: [], 0.0, skips=lambda run: True)
        write_page(page, 0, 0.0)
        there = (ROOT / "docs" / "papers" / "results.md").read_text()
        self.assertEqual(page.differences(there), [], "tools/results makes it anew")


class Names(unittest.TestCase):
    def test_studies_take_their_values_and_have_their_numbers(self):
        with tempfile.TemporaryDirectory() as folder:
            studies = Studies(VINEROW, 1, TABLE.asked())
            files = studies.files([run for run in TABLE.runs.values() if run.has_cells], pathlib.Path(folder))
            self.assertGreater(len(files), 30)
            for file, runs in files.items():
                told = subprocess.run([VINEROW, "study", "check", file], capture_output=True, text=True)
                self.assertEqual(told.returncode, 0, f"{runs[0].name}: {told.stdout}{told.stderr}")
                kept = re.findall(r"[\w.]+", file.read_text().partition("metrics:")[2])
                for run in runs:
                    self.assertLessEqual(set(TABLE.asked()[run.name]), set(kept), run.name)

    def test_planners_tell_their_numbers(self):
        # What planners count is known when they have planned: the study's check lets it pass.
        for name, paths in TABLE.asked().items():
            run, paths = TABLE.runs[name], {p for p in paths if p.startswith("planning.")}
            if not paths or run.kind != "scenario":
                continue
            with tempfile.TemporaryDirectory() as folder:
                sets = [word for text in (*run.sets, "duration_s=0.1", "criteria=[]") for word in ("--set", text)]
                call(VINEROW, "run", run.scenario, "--quiet", "--no-log", "--no-pictures", "--out", folder, *sets)
                planning = json.loads((pathlib.Path(folder) / "summary.json").read_text())["planning"]
            for path in paths:
                _, vehicle, number = path.split(".")
                self.assertIn(number, planning[vehicle], f"{name}: {path}")

    def test_maps_tell_their_figures(self):
        schema = json.loads(call(VINEROW, "schema", "report.json"))
        errors = comparison_numbers(
            "against the truth\n  rows found     3 of 4\n  direction      +0.1 deg of 2 deg\n"
            "  spacing        -0.2 m of 2.5 m\n  row ends       0.1 m mean error, 0.3 m maximum\n"
            "  volume         -2.5 % of 9 m3; canopy seen -9.5 %\n")
        self.assertEqual((errors["rows_found"], errors["rows"], errors["seen_volume_percent"]), (3.0, 4.0, -9.5))
        for name, paths in TABLE.asked().items():
            if TABLE.runs[name].kind != "map":
                continue
            for path in paths:
                first, *keys = path.split(".")
                if first in ("errors", "rows"):
                    self.assertIn(keys[0], {"errors": errors, "rows": ["mean_length_m"]}[first], path)
                    continue
                self.assertEqual(first, "report", path)
                node = schema
                for key in keys:
                    node = node["properties"][key]

    @unittest.skipUnless(STUDY, "localisation_study is not built")
    def test_programs_print_their_rows(self):
        for name, paths in TABLE.asked().items():
            run = TABLE.runs[name]
            if run.kind == "program":
                rows = rows_of_study(call(STUDY[0], "1", *run.arguments[1:]))
                for path in paths:
                    row, number = path.rsplit("/", 1)
                    self.assertIn(row, rows, f"{name}: {path}")
                    self.assertIn(number, rows[row], f"{name}: {path}")

    def test_benchmarks_exist(self):
        source = (ROOT / "tests/benchmarks/localisation_phases_bench.cpp").read_text()
        for name, paths in TABLE.asked().items():
            if TABLE.runs[name].kind == "benchmark":
                for path in paths:
                    benchmark, counter = path.split(".")
                    self.assertIn(f"BENCHMARK({benchmark})", source)
                    self.assertIn(f'"{counter}"', source)

    def test_pictures_pages_and_files_exist(self):
        for entry in TABLE.entries:
            for picture in entry.pictures:
                self.assertTrue((ROOT / "docs/pictures" / picture).exists(), picture)
            for text in entry.texts():
                for link in re.findall(r"\]\(([\w/.]+)(?:#[\w-]+)?\)", text):
                    self.assertTrue((ROOT / "docs" / "papers" / link).exists(), f"{entry.paper}, {entry.item}: {link}")
                for file in re.findall(r"`((?:assets|tests|engine|controllers)/[\w/.]+)`", text):
                    self.assertTrue((ROOT / file).exists(), f"{entry.paper}, {entry.item}: {file}")


class Arithmetics(unittest.TestCase):
    VALUES = {("run", "a.b"): [3.0, -4.0, 12.0], ("run", "none"): [None], ("run", "name"): ["met"]}

    def value(self, text: str):
        return evaluate(text, lambda run, path: self.VALUES[run, path], lambda file, key: 2.5)

    def test_over_seeds(self):
        self.assertEqual(self.value("one('run', 'a.b')"), 3.0)
        self.assertEqual(self.value("largest('run', 'a.b') + least('run', 'a.b')"), 8.0)
        self.assertEqual(self.value("total('run', 'a.b') / seeds('run', 'a.b')"), self.value("mean('run', 'a.b')"))
        self.assertAlmostEqual(self.value("rms('run', 'a.b')"), 13.0 / math.sqrt(3.0))
        self.assertAlmostEqual(self.value("deviation('run', 'a.b')"), math.sqrt((4 / 9 + 529 / 9 + 625 / 9) / 2))
        self.assertEqual(self.value("-2 ** 2 + max(1, asset('file', 'key')) * abs(-2)"), 1.0)

    def test_bad_expressions_are_refused(self):
        for text, reason in {
            "one('run'": "is no expression",
            "median('run', 'a.b')": "no function median",
            "__import__('os')": "no function __import__",
            "one('run', 'none')": "run: none was not measured",
            "(lambda: 1)()": "is not known",
        }.items():
            with self.assertRaisesRegex(TableError, reason):
                self.value(text)

    def test_numbers_of_parameter_files(self):
        self.assertEqual(asset_number("vehicles/quadrotor_m100.yaml", "inertia_kgm2", 2), 0.1231)
        with self.assertRaisesRegex(TableError, "has no number wing_m"):
            asset_number("vehicles/quadrotor_m100.yaml", "wing_m")


class Entries(unittest.TestCase):
    def test_bad_entries_are_refused(self):
        good = {"paper": "A", "item": "figure 1", "title": "t", "verdict": "reproduced", "why": "w",
                "table": {"head": ["", "x"], "rows": [["a", "1"]]}}
        self.assertEqual(entry_of(good).rows, [["a", "1"]])
        for change, reason in [
            ({"verdict": "fine"}, "paper A, figure 1: verdict 'fine', must be one of reproduced"),
            ({"why": ""}, "reason why the numbers differ"),
            ({"verdict": "drawing"}, "says what of it is here"),
            ({"table": {"head": ["", "x"], "rows": [["a"]]}}, "the row 'a' has 1 cells of 2"),
            ({"colour": "red"}, "colour"),
        ]:
            with self.assertRaisesRegex(TableError, reason):
                entry_of(good | change)
        with self.assertRaisesRegex(TableError, "run r: wants one of scenario"):
            runs_of("r", {"scenario": "a", "map": "b"})

    def test_axes_and_columns_are_filled_in(self):
        runs = runs_of("r", {"scenario": "s_{n}", "set": ["v.c={x: {n}}"], "axes": {"n": [1, 2]}})
        self.assertEqual([(r.name, r.what, r.sets) for r in runs],
                         [("r/1", "s_1", ("v.c={x: 1}",)), ("r/2", "s_2", ("v.c={x: 2}",))])
        row = entry_of({"paper": "A", "item": "i", "title": "t", "verdict": "reproduced", "why": "w", "table": {
            "head": ["h", "1", "2"], "rows": [{"label": "L", "cell": "$row/$column"}]}}).rows[0]
        self.assertEqual(row, ["L", "L/1", "L/2"])


class Comparison(unittest.TestCase):
    """A page of one number: 1.50 of a run, with 2 % of tolerance."""

    def page(self, value: float = 1.5, **options) -> Page:
        page = Page(TABLE, lambda run, path: [value], 0.02, **options)
        page.add("x is {one('survey_still', 'a.b')|.2f} m\n", "here")
        return page

    def test_numbers_within_tolerance_are_the_same(self):
        self.assertEqual(self.page().text(), "x is 1.50 m\n")
        for text in ("x is 1.50 m\n", "x is 1.53 m\n", "x is 1.47 m\n"):
            self.assertEqual(self.page().differences(text), [])

    def test_other_numbers_and_texts_are_told(self):
        told = self.page().differences("x is 1.60 m\n")
        self.assertEqual(told, ["line 1: 1.60, made anew it is 1.50 (here: one('survey_still', 'a.b'))"])
        self.assertIn("the text differs", self.page().differences("x is 1.50 mm\n")[0])
        self.assertIn("more text", self.page().differences("x is 1.50 m\nand more\n")[0])
        self.assertIn("no number", self.page().differences("x is not run m\n")[0])

    def test_numbers_that_are_left_out(self):
        quick = self.page(skips=lambda run: True)
        self.assertEqual(quick.differences("x is 99 m\n") + quick.differences("x is not run m\n"), [])
        self.assertEqual(quick.compared(), 0)

        def none(run, path):
            raise NotRun("there is no such scenario")

        page = Page(TABLE, none, 0.02)
        page.add("{one('survey_still', 'a.b')|.2f}")
        self.assertEqual(page.text(), "not run")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
