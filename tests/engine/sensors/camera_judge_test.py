#!/usr/bin/env python3
"""Pictures of the sensor `camera` against OpenCV: lenses both ways, and a stereo pair whose depth OpenCV finds by matching.

    camera_judge_test.py VINEROW
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import cv2
import numpy
import vinerow
import yaml
from PIL import Image

VINEROW = sys.argv[1]
ROOT = pathlib.Path(__file__).resolve().parents[3]
SCENARIO = ROOT / "assets" / "scenarios" / "vineyard_camera.yaml"
FRONT = "rover.sensors.front."

LENSES = {
    # Strong barrel distortion with decentring, as of a cheap wide lens; a principal point off the middle.
    "brown": {"lens": "brown_conrady", "fx_px": 260.0, "fy_px": 255.0, "cx_px": 168.0, "cy_px": 112.0,
              "distortion": [-0.28, 0.09, 0.0013, -0.0009, -0.013]},
    # 150 degrees.
    "fisheye": {"lens": "fisheye", "fx_px": 122.0, "fy_px": 121.0, "cx_px": 158.0, "cy_px": 121.0,
                "distortion": [-0.021, 0.0062, -0.0031, 0.0004]},
}


def call(*words):
    done = subprocess.run([VINEROW, *map(str, words)], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return done.stdout


def rotation(row):
    w, x, y, z = (float(row[key]) for key in ("qw", "qx", "qy", "qz"))
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def pixels(file):
    with Image.open(file) as picture:
        return numpy.asarray(picture)


class Lenses(unittest.TestCase):
    """Through `vinerow dataset`: its key points come from Lens::project(), its pictures from Lens::direction()."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="vinerow_judge_")
        folder = pathlib.Path(cls.temporary.name)
        study = {"vinerow_study": 1, "scenario": str(SCENARIO),
                 "set": {"duration_s": 1.0, FRONT + "normals": False, FRONT + "readout_s": 0},
                 "factors": {"lens_of_factor": {"alternatives": {name: {FRONT + key: value for key, value in lens.items()}
                                                       for name, lens in LENSES.items()}}},
                 "dataset": {"camera": "rover/front", "every_s": 1, "formats": ["coco"], "classes": ["trunk"],
                             "validation_share": 0}}
        (folder / "study.yaml").write_text(yaml.safe_dump(study, sort_keys=False), encoding="utf-8")
        cls.out = folder / "out"
        call("dataset", folder / "study.yaml", "--out", cls.out, "--quiet")
        with (cls.out / "pictures.csv").open(newline="", encoding="utf-8") as file:
            cls.rows = list(csv.DictReader(file))
        with vinerow.open(SCENARIO) as session:
            world = session.world()
            cls.lines = {row.id: row.line for row in world.rows}
            cls.terrain = world.terrain

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def camera(self, row):
        lens = LENSES[row["lens_of_factor"]]
        K = numpy.array([[lens["fx_px"], 0, lens["cx_px"]], [0, lens["fy_px"], lens["cy_px"]], [0, 0, 1.0]])
        return K, numpy.array(lens["distortion"]), lens["lens"] == "fisheye"

    def test_places_in_pictures_are_those_of_opencv(self):
        notes = json.loads((self.out / "annotations" / "keypoints_train.json").read_text())["annotations"]
        compared = {False: 0, True: 0}
        for row in self.rows:
            K, d, is_fisheye = self.camera(row)
            R, p = rotation(row).T, numpy.array([float(row[key]) for key in ("x_m", "y_m", "z_m")])
            rvec, tvec = cv2.Rodrigues(R)[0], -R @ p
            for note in notes:
                if note["image_id"] != int(row["picture"][:6]) or note["category_id"] != 3:
                    continue
                for k, end in ((0, self.lines[note["row"]][0]), (1, self.lines[note["row"]][-1])):
                    u, v, seen = note["keypoints"][3 * k:3 * k + 3]
                    if not seen:
                        continue
                    project = cv2.fisheye.projectPoints if is_fisheye else cv2.projectPoints
                    expected = project(numpy.array(end, float).reshape(1, 1, 3), rvec, tvec, K, d)[0]
                    numpy.testing.assert_allclose([u, v], expected.ravel(), atol=0.02)
                    compared[is_fisheye] += 1
        self.assertGreaterEqual(min(compared.values()), 3)

    def test_pixels_look_where_opencv_says(self):
        # With the depth each pixel of the ground is a point of the terrain.
        for row in self.rows:
            K, d, is_fisheye = self.camera(row)
            ground = pixels(self.out / "semantic" / "train" / row["picture"]) == 1
            depth_m = pixels(self.out / "depth" / "train" / row["picture"]).astype(float) / 1000
            v, u = numpy.nonzero(ground & (depth_m > 0) & (depth_m < 12))
            chosen = numpy.linspace(0, len(u) - 1, 4000).astype(int)
            u, v = u[chosen], v[chosen]
            at = numpy.stack([u, v], axis=1).astype(float).reshape(-1, 1, 2)
            # Many steps: OpenCV's inverse stops early otherwise.
            criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-12)
            xy = (cv2.fisheye.undistortPoints(at, K, d) if is_fisheye
                  else cv2.undistortPoints(at, K, d, None, None, None, criteria)).reshape(-1, 2)
            z = depth_m[v, u]
            p_C = numpy.stack([xy[:, 0] * z, xy[:, 1] * z, z])
            p_W = rotation(row) @ p_C + numpy.array([[float(row[key])] for key in ("x_m", "y_m", "z_m")])
            height = p_W[2] - numpy.asarray(self.terrain.height_at(p_W[0], p_W[1])).ravel()
            # Depths are whole millimetres along the axis: along a ray to the side that is more.
            r = numpy.hypot(xy[:, 0], xy[:, 1])
            seen = r < 4
            self.assertLess((numpy.abs(height) / numpy.hypot(1, r))[seen].max(), 0.8e-3, row["lens_of_factor"])
            far = numpy.hypot(u - K[0, 2], v - K[1, 2])[seen].max()
            self.assertGreater(far, 120)  # the corners, where lenses bend most


class StereoPair(unittest.TestCase):
    def test_opencv_finds_the_depth(self):
        baseline_m, focal_px = 0.12, 300.0
        eye = {"type": "camera", "rate_Hz": 1, "picture": "mono", "width_px": 480, "height_px": 360,
               "fx_px": focal_px, "samples": 4, "rotation_deg": [0, 8, 0]}
        eyes = {"left": {**eye, "position_m": [0.45, baseline_m / 2, 0.7], "depth": True, "semantic": True},
                "right": {**eye, "position_m": [0.45, -baseline_m / 2, 0.7], "stereo_baseline_m": baseline_m}}
        with tempfile.TemporaryDirectory(prefix="vinerow_stereo_") as temporary:
            folder = pathlib.Path(temporary)
            sets = [f"rover.sensors.{name}={json.dumps(value)}" for name, value in eyes.items()]
            call("run", SCENARIO, "--out", folder / "run", "--no-pictures", "--no-report", "--quiet", "--set", "duration_s=1",
                 "--set", "criteria=[]", *[word for text in sets for word in ("--set", text)])
            for topic in ("left", "right", "left_depth", "left_semantic"):
                call("export", folder / "run", "--topic", f"/rover/{topic}", "-o", folder / "out")
            shown = {topic: pixels(sorted((folder / "out" / f"rover_{topic}").glob("*.png"))[-1])
                     for topic in ("left", "right", "left_depth", "left_semantic")}
        grey = {name: numpy.clip(255 * (shown[name] / 65535.0) ** 0.45, 0, 255).astype(numpy.uint8) for name in ("left", "right")}
        z = shown["left_depth"] / 1000.0
        # The ground within 5 m: between leaves a matcher sees edges of two depths.
        usable = (z > 0.5) & (z < 5) & (shown["left_semantic"] == 1)
        expected_px = baseline_m * focal_px / numpy.where(usable, z, 1.0)

        # Block matching finds the disparity without a hint.
        disparity = cv2.StereoBM_create(96, 15).compute(grey["left"], grey["right"]) / 16.0
        matched = usable & (disparity > 0)
        near = numpy.abs(disparity - expected_px)[matched] < 1

        # Optical flow from the expected place: what is left of it is the error of the pair's geometry.
        v, u = numpy.nonzero(usable)
        chosen = numpy.linspace(0, len(u) - 1, 4000).astype(int)
        at = numpy.stack([u[chosen], v[chosen]], axis=1).astype(numpy.float32).reshape(-1, 1, 2)
        there = at.copy()
        there[:, 0, 0] -= expected_px[v[chosen], u[chosen]].astype(numpy.float32)
        found, status, error = cv2.calcOpticalFlowPyrLK(grey["left"], grey["right"], at, there.copy(), winSize=(15, 15), maxLevel=0,
                                                        flags=cv2.OPTFLOW_USE_INITIAL_FLOW)
        good = (status.ravel() == 1) & (error.ravel() < 8)
        off = numpy.median((found - there).reshape(-1, 2)[good], axis=0)
        print(f"stereo: {100 * matched.sum() / usable.sum():.0f} % of the ground matched, {100 * near.mean():.0f} % of it within 1 px; "
              f"flow {off[0]:.3f}, {off[1]:.3f} px over {good.sum()} points")
        self.assertGreater(matched.sum() / usable.sum(), 0.6)
        self.assertGreater(near.mean(), 0.9)
        self.assertGreater(good.sum(), 1000)
        self.assertLess(numpy.abs(off).max(), 0.02)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
