"""What tests of the command `vinerow study` share."""

import csv
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCENARIO = ROOT / "assets" / "scenarios" / "orchard_rover.yaml"
NOISY = "rover.sensors: {gps: {type: gps, rate_Hz: 40, error: uniform, accuracy_m: 0.05}}, rover.estimator: {type: gps_pose, heading: truth}"


class StudyCase(unittest.TestCase):
    """Each test has a folder of its own. `vinerow` is set by who uses it."""
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, text, name="s.yaml", duration_s=3, set_more=""):
        scenario = f"vinerow_study: 1\nscenario: {SCENARIO}\n"
        values = f"set: {{duration_s: {duration_s}, criteria: [], {NOISY}{set_more}}}\n"
        (self.folder / name).write_text(scenario + ("" if "set: {" in text else values) + text)
        return self.folder / name

    def study(self, action, file, *more, status=0, out="out", environment=None):
        run = subprocess.run([self.vinerow, "study", action, file, "--out", self.folder / out, *map(str, more)],
                             capture_output=True, text=True, cwd=self.folder, env=environment)
        self.assertEqual(run.returncode, status, run.stdout + run.stderr)
        return run.stderr if status == 2 else run.stdout + run.stderr

    def rows(self, out="out", table="cells.csv"):
        with open(self.folder / out / table, newline="") as file:
            return list(csv.DictReader(file))

    def stored(self, out="out"):
        return sum(1 for _ in (self.folder / out / "cells").glob("*/*.json"))

    def bytes_of(self, out="out", table="cells.csv"):
        return (self.folder / out / table).read_bytes()

    TWO = ("factors:\n  lookahead: {key: rover.controller.lookahead_m, values: [0.5, 1.0]}\n"
           "  pitch: {key: rover.planner.waypoint_pitch_m, values: [0.33, 0.66]}\nseeds: 3\n")
