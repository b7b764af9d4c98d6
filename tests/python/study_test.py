#!/usr/bin/env python3
"""vinerow.read_study: the tables that `vinerow study` writes.

    study_test.py VINEROW
"""

import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

import vinerow

ROOT = pathlib.Path(__file__).resolve().parents[2]
VINEROW = sys.argv[1]
STUDY = f"""vinerow_study: 1
name: two
scenario: {ROOT}/assets/scenarios/orchard_rover.yaml
set: {{duration_s: 1, criteria: []}}
factors:
  step_s: {{key: physics.step_s, values: [0.005, 0.0125]}}
  rate_Hz: {{key: rover.controller.rate_Hz, values: [40, 50]}}
  law: {{alternatives: {{slow: {{rover.controller.speed_mps: 0.5}}, fast: {{}}}}}}
seeds: 2
derived: {{doubled_m: rover.distance_m * 2}}
"""


class Studies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name) / "out"
        file = pathlib.Path(cls.folder.name) / "two.yaml"
        file.write_text(STUDY)
        done = subprocess.run([VINEROW, "study", "run", file, "--out", cls.out], capture_output=True, text=True)
        assert done.returncode == 3, done.stderr  # a step of 12.5 ms does not divide the period of 50 Hz
        cls.study = vinerow.read_study(cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_columns_are_those_of_the_files(self):
        for name in ("cells", "settings", "costs"):
            table = getattr(self.study, name)
            with open(self.out / f"{name}.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(list(table), list(rows[0]))
            self.assertEqual(table.row_count, len(rows))
            for column, values in table.items():
                for value, row in zip(values, rows):
                    if isinstance(value, str):
                        self.assertEqual(value, row[column])
                    elif row[column] == "":
                        self.assertTrue(numpy.isnan(value))
                    else:
                        self.assertEqual(value, float(row[column]))

    def test_types(self):
        cells = self.study.cells
        self.assertEqual((cells["cell"].dtype, cells["rate_Hz"].dtype, cells["step_s"].dtype, cells["law"].dtype),
                         (numpy.dtype("int64"), numpy.dtype("int64"), numpy.dtype("float64"), numpy.dtype("object")))
        self.assertEqual(list(cells["cell"]), list(range(16)))
        self.assertEqual(list(cells["step_s"]), [0.005] * 8 + [0.0125] * 8)
        self.assertEqual(list(cells["law"]), ["slow", "slow", "fast", "fast"] * 4)
        self.assertEqual(list(cells["state"]), ["met"] * 12 + ["invalid"] * 4)
        ran = cells["state"] == "met"
        numpy.testing.assert_array_equal(cells["doubled_m"][ran], 2.0 * cells["rover.distance_m"][ran])
        self.assertTrue(numpy.isnan(cells["rover.distance_m"][~ran]).all())
        self.assertEqual(len(cells["digest"][0]), 32)

    def test_a_cell_is_the_run_of_a_session(self):
        cells = self.study.cells
        with vinerow.open(ROOT / "assets/scenarios/orchard_rover.yaml",
                          {"duration_s": 1, "criteria": [], "physics.step_s": 0.005, "rover.controller.rate_Hz": 50,
                           "rover.controller.speed_mps": 0.5}, seed=2) as session:
            session.step(10.0)
            self.assertEqual(cells["digest"][5], session.digest)
            self.assertEqual(cells["rover.distance_m"][5], session.metrics()["rover"]["distance_m"])

    def test_pandas_and_html(self):
        frame = self.study.cells.to_pandas()
        self.assertEqual(frame.groupby("rate_Hz")["rover.distance_m"].count().to_dict(), {40: 8, 50: 4})
        text = self.study._repr_html_()
        self.assertIn("4 invalid", text)
        self.assertIn("rate_Hz", text)
        long = vinerow.Table(a=numpy.arange(100), b=numpy.array(["x"] * 100, object))._repr_html_()
        self.assertIn("100 rows, 2 columns", long)
        self.assertEqual(long.count("<tr"), 1 + 12 + 1)

    def test_mistakes(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)

            def refused(text):
                with self.assertRaisesRegex(vinerow.ConfigError, text):
                    vinerow.read_study(folder)
            refused("contains no cells.csv, so it is not the folder of a study's results")
            (folder / "study.sqlite").write_text("")
            refused("contains no cells.csv; `vinerow study table` writes it")
            (folder / "cells.csv").write_text("a,b\n1,2\n3\n")
            refused("cells.csv:3: has 1 values, must have 2")
            (folder / "cells.csv").write_text("")
            refused("cells.csv: is empty")
            (folder / "cells.csv").write_bytes(b"a\n\xff\n")
            refused("cells.csv: cannot be read: .*utf-8")
            (folder / "cells.csv").write_text("a\n1\n")
            refused("settings.csv: cannot be read: .*No such file")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
