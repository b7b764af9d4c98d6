#!/usr/bin/env python3
"""`vinerow compare` on summaries and maps written by hand.

    compare_test.py VINEROW
"""

import copy
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

VINEROW = sys.argv[1]

SUMMARY = {
    "scenario": "s", "status": "all criteria met", "exit_status": 0, "seed": 1, "digest": "abc", "simulated_s": 10.0,
    "criteria": [{"name": "rover.error_m <= 0.5", "metric": "rover.error_m", "kind": "max", "value": 0.25, "limit": 0.5, "met": True}],
    "phases": [{"name": "spray", "state": "succeeded", "criteria": [{"name": "rover.x >= 1", "met": True}]}],
    "metrics": {"rover": {"error_m": 0.25, "distance_m": 100.0, "never_m": None}},
}  # fmt: skip

ORIGIN = {"latitude_deg": 44.6, "longitude_deg": 8.0, "altitude_m": 300.0}
EARTH_RADIUS_M = 6_378_137.0  # of the equator: WGS84
FLATTENING = 1 / 298.257223563


def row(number: int, x0: float, y0: float, x1: float, y1: float, volume: float) -> dict:
    return {"row": number, "first_m": [x0, y0, 0.0], "last_m": [x1, y1, 0.0], "length_m": math.hypot(x1 - x0, y1 - y0),
            "volume_m3": volume, "canopy_top_m": 2.0, "canopy_width_m": 0.6}  # fmt: skip


class Compare(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def compare(self, *arguments, status=0):
        run = subprocess.run([VINEROW, "compare", *map(str, arguments)], capture_output=True, encoding="utf-8", cwd=self.folder)
        self.assertEqual(run.returncode, status, run.stdout + run.stderr)
        return run

    def run_folder(self, name: str, summary: dict) -> str:
        (self.folder / name).mkdir()
        (self.folder / name / "summary.json").write_text(json.dumps(summary))
        return name

    def map_folder(self, name: str, rows: list, origin: dict | None = ORIGIN) -> str:
        (self.folder / name).mkdir()
        (self.folder / name / "report.json").write_text(json.dumps({"rows": rows}))
        (self.folder / name / "map.json").write_text(json.dumps({"origin": origin} if origin else {}))
        return name

    def changed(self, **metrics) -> dict:
        other = copy.deepcopy(SUMMARY)
        other["metrics"]["rover"].update(metrics)
        return other

    def test_metrics_stand_side_by_side_with_their_difference(self):
        a, b = self.run_folder("a", SUMMARY), self.run_folder("b", self.changed(error_m=0.5, new_m=3.0))
        text = self.compare(a, b).stdout
        line = next(line for line in text.splitlines() if line.startswith("rover.error_m"))
        self.assertEqual(line.split(), ["rover.error_m", "0.25", "0.5", "+0.25", "+100.0", "%"])
        self.assertRegex(self.compare(a, self.run_folder("zero", self.changed(error_m=-0.0))).stdout, r"rover\.error_m +0\.25 +0 +-0\.25")
        self.assertIn("2 of 5 metrics differ", text)
        self.assertNotIn("rover.distance_m", text)
        self.assertIn("rover.distance_m", self.compare(a, b, "--all").stdout)
        told = json.loads(self.compare(a, b, "--json").stdout)
        self.assertEqual(told["metrics"]["rover.error_m"], {"values": [0.25, 0.5], "differences": [0.0, 0.25], "differs": True})
        self.assertEqual(told["metrics"]["rover.new_m"]["values"], [None, 3.0])
        self.assertFalse(told["metrics"]["rover.never_m"]["differs"])
        self.assertEqual(told["regressions"], [])

    def test_fail_on_gives_the_exit_status_that_ci_asks_for(self):
        worse = self.changed(error_m=0.75)
        worse["criteria"][0].update(value=0.75, met=False)
        worse.update(exit_status=1, status="criteria failed")
        a, b = self.run_folder("a", SUMMARY), self.run_folder("b", self.changed(error_m=0.26))
        c = self.run_folder("c", worse)
        self.compare(a, c)
        self.compare(a, b, "--fail-on", "regression")
        self.compare(a, b, "--fail-on", "difference", status=1)
        self.compare(a, b, "--fail-on", "difference", "--tolerance", "0.05")
        self.compare(a, b, "--fail-on", "difference", "--tolerance", "0.03", status=1)
        run = self.compare(a, b, c, "--fail-on", "regression", status=1)
        self.assertIn("regression: rover.error_m <= 0.5: FAILED in C, met in A", run.stdout)
        self.assertIn("C ended with exit status 1", run.stdout)
        self.compare(c, a, "--fail-on", "regression")  # it got better

    def test_a_criterion_or_phase_that_is_gone_is_a_regression(self):
        gone = copy.deepcopy(SUMMARY)
        gone["criteria"], gone["phases"][0]["state"] = [], "failed"
        run = self.compare(self.run_folder("a", SUMMARY), self.run_folder("b", gone), "--fail-on", "regression", status=1)
        self.assertIn("rover.error_m <= 0.5: absent in B", run.stdout)
        self.assertIn("phase spray succeeded: FAILED in B", run.stdout)

    def test_wrong_folders_are_refused_in_one_sentence(self):
        a, m = self.run_folder("a", SUMMARY), self.map_folder("m", [])
        (self.folder / "empty").mkdir()
        broken = self.run_folder("broken", SUMMARY)
        (self.folder / "broken" / "summary.json").write_text("{")
        cases = {
            (a, m): "a is the folder of a run, but m is the folder of a map",
            (a, "empty"): "empty: contains neither summary.json nor map.json",
            (a, broken): "broken/summary.json: is not JSON",
            (a, a, "--geojson", "x.geojson"): "need two maps",
            (m, m, m): "3 maps given, must be 2",
            (m, m, "--fail-on", "regression"): "need runs",
        }
        for arguments, words in cases.items():
            run = self.compare(*arguments, status=2)
            self.assertIn(words, run.stderr)
            self.assertEqual(run.stderr.count("\n"), 1)

    def test_rows_of_two_maps_are_matched_by_place_whatever_their_numbers(self):
        # Three rows 2.5 m apart; the second map counts from the other side, turned round, and has lost one.
        a = self.map_folder("a", [row(k, 0, 2.5 * k, 40, 2.5 * k, 10.0 + k) for k in range(3)])
        b = self.map_folder("b", [row(0, 39, 5.1, 1, 5.1, 15.0), row(1, 40, 2.4, 0, 2.4, 5.5), row(2, 0, 12.5, 40, 12.5, 9.0)])
        told = json.loads(self.compare(a, b, "--json").stdout)
        pairs = [(r["row_a"], r["row_b"], r["volume_change_m3"]) for r in told["rows"]]
        self.assertEqual(pairs, [(0, None, None), (1, 1, -5.5), (2, 0, 3.0), (None, 2, None)])
        self.assertAlmostEqual(told["rows"][2]["volume_change_share"], 0.25)
        self.assertAlmostEqual(told["rows"][1]["offset_m"], 0.1)
        self.assertEqual((told["volume_of_rows_in_both_a_m3"], told["volume_of_rows_in_both_b_m3"]), (23.0, 20.5))
        self.assertIn("2 rows in both: A 23.0 m3, B 20.5 m3 (-2.5 m3, -10.9 %); 2 in only one map", self.compare(a, b).stdout)

    def test_maps_of_other_origins_are_brought_together(self):
        # The second origin lies 10 m further north: meridian radius of curvature, WGS84.
        e2 = FLATTENING * (2 - FLATTENING)
        sine = math.sin(math.radians(ORIGIN["latitude_deg"]))
        meridian_m = EARTH_RADIUS_M * (1 - e2) / (1 - e2 * sine**2) ** 1.5
        north = dict(ORIGIN, latitude_deg=ORIGIN["latitude_deg"] + math.degrees(10 / meridian_m))
        a = self.map_folder("a", [row(0, 0, 20, 40, 20, 10.0), row(1, 0, 22.5, 40, 22.5, 20.0)])
        b = self.map_folder("b", [row(0, 0, 10, 40, 10, 11.0), row(1, 0, 12.5, 40, 12.5, 22.0)], north)
        told = json.loads(self.compare(a, b, "--json", "--geojson", "out/d.geojson").stdout)
        self.assertEqual([(r["row_a"], r["row_b"]) for r in told["rows"]], [(0, 0), (1, 1)])
        for r in told["rows"]:
            self.assertLess(r["offset_m"], 1e-3)
        features = json.loads((self.folder / "out/d.geojson").read_text())["features"]
        self.assertEqual(features[0]["properties"], told["rows"][0])
        (lon, lat, _), _ = features[0]["geometry"]["coordinates"]
        self.assertAlmostEqual(lat, ORIGIN["latitude_deg"] + math.degrees(20 / meridian_m), delta=1e-8)
        self.assertAlmostEqual(lon, ORIGIN["longitude_deg"], delta=1e-8)

    def test_maps_without_an_origin_are_compared_in_their_own_metres(self):
        a, b = (self.map_folder(n, [row(0, 0, 0, 40, 0, 10.0)], None) for n in "ab")
        self.assertEqual(json.loads(self.compare(a, b, "--json").stdout)["rows"][0]["row_b"], 0)
        self.assertIn("has no geographic origin", self.compare(a, b, "--geojson", "x.geojson", status=2).stderr)
        c = self.map_folder("c", [])
        self.assertIn("does not, so the relative position", self.compare(a, c, status=2).stderr)

    def test_reach_says_how_far_apart_one_row_may_lie(self):
        a = self.map_folder("a", [row(0, 0, 0, 40, 0, 10.0)])
        b = self.map_folder("b", [row(0, 0, 1.5, 40, 1.5, 10.0)])
        told = json.loads(self.compare(a, b, "--json").stdout)
        self.assertEqual(len(told["rows"]), 2)
        told = json.loads(self.compare(a, b, "--json", "--reach", "1.6").stdout)
        self.assertEqual(len(told["rows"]), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
