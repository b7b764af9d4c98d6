#!/usr/bin/env python3
"""Are numbers typed in the pages those of golden.json?

    page_numbers_test.py

`781 s<!-- golden: vineyard_quadrotor_parcel simulated_s -->` holds the last number before the mark, to the digits that are printed, to that value of
that scenario; `31 mm<!-- golden: riseholme_rover rover.cross_track_max_m 1000 -->` to a thousand times a metric.
"""

import json
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = json.loads((ROOT / "tests" / "scenarios" / "golden.json").read_text())
MARK = re.compile(r"<!-- golden: *([^>]*?) *-->")
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)")


def golden_value(words: list[str]) -> float:
    scenario, path, *factor = words
    node = GOLDEN[scenario] if path == "simulated_s" else GOLDEN[scenario]["metrics"]
    for key in path.split("."):
        node = node[key]
    return float(node) * float(factor[0] if factor else 1.0)


def faults_of(text: str) -> list[str]:
    """What is wrong in a page, a sentence each."""
    faults, last = [], 0
    for mark in MARK.finditer(text):
        numbers = NUMBER.findall(text[max(last, text.rfind("\n", 0, mark.start())):mark.start()])
        last = mark.end()
        try:
            value = golden_value(mark.group(1).split())
        except (KeyError, TypeError, ValueError) as error:
            faults.append(f"golden.json has no '{mark.group(1)}' ({error!r})")
            continue
        if not numbers:
            faults.append(f"no number before '{mark.group(1)}'")
            continue
        wanted = format(value, f".{len(numbers[-1].partition('.')[2])}f")
        if float(numbers[-1]) != float(wanted):
            faults.append(f"{numbers[-1]} is printed of '{mark.group(1)}', golden.json has {wanted}")
    return faults


class Pages(unittest.TestCase):
    def test_pages_print_what_is_golden(self):
        marks = 0
        for page in sorted((ROOT / "docs").rglob("*.md")):
            text = page.read_text()
            marks += len(MARK.findall(text))
            self.assertEqual(faults_of(text), [], page.name)
        self.assertGreater(marks, 20)

    def test_pages_count_the_shipped_scenarios(self):
        count = len(list((ROOT / "assets" / "scenarios").glob("*.yaml")))
        for page in ("README.md", "docs/tutorial/1_first_run.md"):
            self.assertEqual(re.findall(r"(\d+) (?:shipped )?scenarios", (ROOT / page).read_text()), [str(count)], page)


class Judge(unittest.TestCase):
    TIME = GOLDEN["vineyard_quadrotor_parcel"]["simulated_s"]

    def test_takes_the_digits_that_are_printed(self):
        for decimals in (0, 1, 2):
            self.assertEqual(faults_of(f"{self.TIME:.{decimals}f} s<!-- golden: vineyard_quadrotor_parcel simulated_s -->"), [])

    def test_refuses_a_wrong_number(self):
        self.assertEqual(len(faults_of(f"{self.TIME + 1.0:.0f} s<!-- golden: vineyard_quadrotor_parcel simulated_s -->")), 1)
        self.assertEqual(len(faults_of(f"{self.TIME + 0.01:.2f} s<!-- golden: vineyard_quadrotor_parcel simulated_s -->")), 1)

    def test_refuses_marks_of_nothing(self):
        for mark in ("no_scenario simulated_s", "riseholme_rover rover.no_metric", "riseholme_rover"):
            self.assertEqual(len(faults_of(f"1 m<!-- golden: {mark} -->")), 1)
        self.assertEqual(len(faults_of("7\n<!-- golden: riseholme_rover simulated_s -->")), 1)


if __name__ == "__main__":
    unittest.main()
