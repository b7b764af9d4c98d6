#!/usr/bin/env python3
"""`vinerow dataset`, read back by others: COCO by pycocotools, PNG by Pillow, poses and rows by numpy.

    dataset_test.py VINEROW
"""

import csv
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import cv2
import numpy
import vinerow
import yaml
from PIL import Image
from pycocotools import mask as coco_mask
from pycocotools.coco import COCO

VINEROW = sys.argv[1]
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIO = ROOT / "assets" / "scenarios" / "vineyard_camera.yaml"
CLASSES = ["bunch", "trunk", "post", "vehicle", "leaf"]
BUNCH_LABEL, VEHICLE_LABEL = 4, 9

STUDY = {
    "vinerow_study": 1,
    "description": "a test",
    "scenario": str(SCENARIO),
    # All rows at once: the poses of pictures.csv are then those of each pixel.
    "set": {"duration_s": 2.5, "rover.sensors.front.readout_s": 0},
    "factors": {
        "look": {"alternatives": {"ahead": {}, "side": {"rover.sensors.front.rotation_deg": [0, 3, 40]},
                                  # Its own front is in the picture.
                                  "down": {"rover.sensors.front.rotation_deg": [0, 70, 0],
                                           "world.vines.bbch": 65}}},
    },
    "seeds": [1, 2],
    "dataset": {"camera": "rover/front", "every_s": 1, "formats": ["coco", "coco_panoptic", "yolo", "yolo_segment", "yolo_pose", "kitti"], "classes": CLASSES,
                "validation_share": 0.3, "split_by": "seed", "licence": "CC0-1.0"},
}


def run(study, folder, before=""):
    """Runs `vinerow dataset`; returns its result and the data set's folder."""
    file = folder / "study.yaml"
    file.write_text(yaml.safe_dump(study, sort_keys=False), encoding="utf-8")
    out = folder / "out"
    command = f"{before} '{VINEROW}' dataset '{file}' --out '{out}' --quiet"
    return subprocess.run(["sh", "-c", command], capture_output=True, text=True, timeout=600), out


def even_odd(corners, shape):
    """Pixels whose middle has an odd number of the polygon's edges to its right. Corners count from the first pixel's edge."""
    y, x = numpy.mgrid[:shape[0], :shape[1]] + 0.5
    inside = numpy.zeros(shape, bool)
    for (x0, y0), (x1, y1) in zip(corners, numpy.roll(corners, -1, axis=0), strict=True):
        if y0 != y1:
            crosses = (y0 > y) != (y1 > y)
            inside ^= crosses & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return inside


def pixels(file):
    with Image.open(file) as picture:
        return numpy.asarray(picture).astype(numpy.int64)


def changed(**changes):
    return {**STUDY, "dataset": {**STUDY["dataset"], **changes}}


def rotation(q):
    w, x, y, z = q
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def distance_to(line, p):
    """Of a point from a polyline."""
    a, b = line[:-1], line[1:]
    share = numpy.clip(((p - a) * (b - a)).sum(1) / ((b - a) ** 2).sum(1), 0, 1)
    return numpy.linalg.norm(a + share[:, None] * (b - a) - p, axis=1).min()


class Poses:
    """Pictures of pictures.csv as ideal cameras."""

    def __init__(self, row):
        number = {key: float(row[key]) for key in
                  ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "fx", "fy", "cx", "cy")}
        self.p = numpy.array([number[key] for key in ("x_m", "y_m", "z_m")])
        self.R = rotation([number[key] for key in ("qw", "qx", "qy", "qz")])
        self.K = numpy.array([[number["fx"], 0, number["cx"]], [0, number["fy"], number["cy"]], [0, 0, 1]])

    def project(self, p_W):
        p_C = self.R.T @ (numpy.asarray(p_W) - self.p)
        uvw = self.K @ p_C
        return uvw[:2] / uvw[2], p_C[2]

    def point(self, u, v, z):
        return self.p + self.R @ (z * numpy.linalg.solve(self.K, [u, v, 1.0]))


def world_of(row):
    """The vineyard of a picture: its plants and ground are those of the seed."""
    with vinerow.open(SCENARIO, {"world.plant_seed": int(row["seed"])}) as session:
        return session.world()


class Dataset(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="vinerow_dataset_"))
        cls.result, cls.out = run(STUDY, cls.folder)
        assert cls.result.returncode == 0, cls.result.stderr
        with open(cls.out / "pictures.csv", newline="", encoding="utf-8") as file:
            cls.rows = list(csv.DictReader(file))
        cls.worlds = {row["seed"]: world_of(row) for row in cls.rows}
        cls.instances = {part: COCO(cls.out / "annotations" / f"instances_{part}.json") for part in ("train", "val")}
        cls.keypoints = {part: COCO(cls.out / "annotations" / f"keypoints_{part}.json") for part in ("train", "val")}

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def layer(self, kind, row):
        return pixels(self.out / kind / row["part"] / row["picture"])

    def things(self, row):
        rgb = self.layer("instances", row)
        return rgb[..., 0] + 256 * rgb[..., 1] + 65536 * rgb[..., 2]

    def annotations(self, files, row):
        coco = files[row["part"]]
        return coco.loadAnns(coco.getAnnIds(imgIds=[int(row["picture"][:6])]))

    def test_pictures_are_those_of_the_runs(self):
        # 6 cells, pictures at 0, 1 and 2 s.
        self.assertEqual(len(self.rows), 18)
        self.assertEqual(sorted({row["part"] for row in self.rows}), ["train", "val"])
        for seed in ("1", "2"):
            self.assertEqual(len({row["part"] for row in self.rows if row["seed"] == seed}), 1)
        self.assertEqual([float(row["time_s"]) for row in self.rows[:3]], [0.0, 1.0, 2.0])
        self.assertEqual({row["look"] for row in self.rows}, {"ahead", "side", "down"})
        for row in self.rows:
            self.assertEqual(self.layer("images", row).shape, (240, 320, 3))

    def test_poses_are_those_of_the_run(self):
        # Mounting of the scenario: 0.45 m ahead, 0.7 m up, 8 deg down.
        row = self.rows[2]
        with vinerow.open(SCENARIO, {"rover.sensors.front.rate_Hz": 1.0}) as session:
            session.step(2.001)
            place = numpy.array([float(row[key]) for key in ("x_m", "y_m", "z_m")])
            body = session.signal("rover/truth")["pose"]
            self.assertAlmostEqual(numpy.linalg.norm(place - body.position), numpy.hypot(0.45, 0.7), delta=5e-3)
        axis = Poses(row).R @ [0, 0, 1]
        self.assertAlmostEqual(numpy.degrees(numpy.arcsin(axis[2])), -8.0, delta=3.0)

    def test_coco_masks_are_the_instance_pictures(self):
        kinds = set()
        for row in self.rows:
            things, semantic = self.things(row), self.layer("semantic", row)
            listed = numpy.zeros(things.shape, bool)
            for a in self.annotations(self.instances, row):
                mask = self.instances[row["part"]].annToMask(a).astype(bool)
                numpy.testing.assert_array_equal(mask, things == a["thing"])
                self.assertEqual(a["area"], mask.sum())
                numpy.testing.assert_array_equal(a["bbox"], coco_mask.toBbox(a["segmentation"]))
                self.assertGreaterEqual(a["area"], 16)
                self.assertTrue(0 <= a["visible_share"] <= 1)
                self.assertFalse((listed & mask).any())
                listed |= mask
                name = CLASSES[a["category_id"] - 1]
                kinds.add(name)
                label = {"bunch": BUNCH_LABEL, "vehicle": VEHICLE_LABEL, "leaf": 2, "trunk": 3, "post": 6}[name]
                self.assertEqual(set(semantic[mask]), {label})
            # What is not listed is small.
            for label in (BUNCH_LABEL, 2, 6, VEHICLE_LABEL):
                left_out = things[(semantic == label) & ~listed]
                self.assertLess(max(numpy.unique(left_out, return_counts=True)[1], default=0), 16)
        self.assertEqual(kinds, set(CLASSES))

    def test_panoptic_pictures_divide_every_pixel(self):
        # As the format's page reads them (cocodataset.org, "Data format", 4): id = R + 256 G + 65536 B, 0 is unlabelled.
        names = ["sky", "ground", "leaf", "wood", "bunch", "fruit", "post", "wire", "obstacle", "vehicle", "person", "weed"]
        unlabelled = 0
        kinds = set()
        for part in ("train", "val"):
            with open(self.out / "annotations" / f"panoptic_{part}.json", encoding="utf-8") as file:
                panoptic = json.load(file)
            instances = self.instances[part]
            self.assertEqual(panoptic["images"], instances.dataset["images"])
            self.assertEqual([a["image_id"] for a in panoptic["annotations"]], [image["id"] for image in panoptic["images"]])
            categories = {c["id"]: c for c in panoptic["categories"]}
            self.assertEqual(len(categories), len(panoptic["categories"]))
            self.assertEqual(len({tuple(c["color"]) for c in categories.values()}), len(categories))
            self.assertTrue(all(0 <= value <= 255 for c in categories.values() for value in c["color"]))
            self.assertEqual([c["name"] for c in categories.values() if c["isthing"]], CLASSES)
            self.assertEqual({c["name"] for c in categories.values() if not c["isthing"]}, set(names) - set(CLASSES))
            for c in instances.dataset["categories"]:
                self.assertEqual(categories[c["id"]]["name"], c["name"])
            for a in panoptic["annotations"]:
                row = next(row for row in self.rows if int(row["picture"][:6]) == a["image_id"])
                rgb = pixels(self.out / "annotations" / f"panoptic_{part}" / a["file_name"])
                ids = rgb[..., 0] + 256 * rgb[..., 1] + 65536 * rgb[..., 2]
                things, semantic = self.things(row), self.layer("semantic", row)
                found = {}
                self.assertEqual(set(numpy.unique(ids)) - {0}, {s["id"] for s in a["segments_info"]})
                for segment in a["segments_info"]:
                    mask = ids == segment["id"]
                    y, x = numpy.nonzero(mask)
                    self.assertEqual(segment["area"], mask.sum())
                    self.assertEqual(segment["bbox"], [x.min(), y.min(), x.max() - x.min() + 1, y.max() - y.min() + 1])
                    self.assertEqual(segment["iscrowd"], 0)
                    category = categories[segment["category_id"]]
                    kinds.add(category["name"])
                    if category["isthing"]:
                        found[segment["thing"]] = segment["category_id"]
                        numpy.testing.assert_array_equal(mask, things == segment["thing"])
                    else:
                        self.assertNotIn("thing", segment)
                        self.assertEqual(set(semantic[mask]), {names.index(category["name"])})
                # Each category of stuff is one segment, and the things are those of the instances.
                stuff = [s["category_id"] for s in a["segments_info"] if not categories[s["category_id"]]["isthing"]]
                self.assertEqual(len(stuff), len(set(stuff)))
                self.assertEqual(found, {b["thing"]: b["category_id"] for b in self.annotations(self.instances, row)})
                # No other pixel is left out than those of things that are too small.
                numbers, counts = numpy.unique(things[ids == 0], return_counts=True)
                self.assertLess(counts.max(initial=0), 16)
                self.assertFalse(set(numbers) & {0, 1})
                unlabelled += counts.sum()
        self.assertGreater(unlabelled, 100)
        self.assertGreaterEqual(kinds, {"sky", "ground", "wire", "wood", *CLASSES})

    def test_yolo_boxes_are_those_of_coco(self):
        data = yaml.safe_load((self.out / "data.yaml").read_text())
        self.assertEqual([data["names"][i] for i in range(len(CLASSES))], CLASSES)
        for row in self.rows:
            self.assertTrue((self.out / data[row["part"]] / row["picture"]).is_file())
            label = self.out / "labels" / row["part"] / (row["picture"][:6] + ".txt")
            boxes = [line.split() for line in label.read_text().splitlines()]
            expected = self.annotations(self.instances, row)
            self.assertEqual(len(boxes), len(expected))
            for (name, *box), a in zip(boxes, expected):
                x, y, w, h = (float(value) for value in box)
                self.assertEqual(int(name) + 1, a["category_id"])
                numpy.testing.assert_allclose([(x - w / 2) * 320, (y - h / 2) * 240, w * 320, h * 240], a["bbox"],
                                              atol=2e-3)

    def test_yolo_polygons_hold_the_pixels_of_coco_masks(self):
        data = yaml.safe_load((self.out / "yolo_segment" / "data.yaml").read_text())
        self.assertEqual([data["names"][i] for i in range(len(CLASSES))], CLASSES)
        pieces = 0
        for row in self.rows:
            picture = self.out / "yolo_segment" / data[row["part"]] / row["picture"]
            self.assertEqual(picture.read_bytes(), (self.out / "images" / row["part"] / row["picture"]).read_bytes())
            # Where YOLO looks for labels.
            label = pathlib.Path(str(picture).replace("/images/", "/labels/")).with_suffix(".txt")
            lines = [line.split() for line in label.read_text().splitlines()]
            expected = self.annotations(self.instances, row)
            self.assertEqual(len(lines), len(expected))
            for (name, *numbers), a in zip(lines, expected, strict=True):
                self.assertEqual(int(name) + 1, a["category_id"])
                corners = numpy.array(numbers, float).reshape(-1, 2) * [320, 240]
                left, top, width, height = (int(value) for value in a["bbox"])
                numpy.testing.assert_allclose([corners.min(axis=0), corners.max(axis=0)], [[left, top], [left + width, top + height]], atol=1e-3)
                mask = self.instances[row["part"]].annToMask(a).astype(bool)
                box = mask[top:top + height, left:left + width]
                numpy.testing.assert_array_equal(even_odd(corners - [left, top], box.shape), box)
                # As pycocotools draws polygons; lines from piece to piece may add their pixels.
                drawn = coco_mask.decode(coco_mask.merge(coco_mask.frPyObjects([corners.ravel().tolist()], *mask.shape))).astype(bool)
                count = cv2.connectedComponents(mask.astype(numpy.uint8), connectivity=4)[0] - 1
                if count == 1 and len(cv2.findContours(mask.astype(numpy.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)[0]) == 1:
                    numpy.testing.assert_array_equal(drawn, mask)
                pieces = max(pieces, count)
        self.assertGreater(pieces, 3)

    def test_yolo_key_points_are_those_of_coco(self):
        data = yaml.safe_load((self.out / "yolo_pose" / "data.yaml").read_text())
        self.assertEqual(data["kpt_shape"], [2, 3])
        count = 0
        for row in self.rows:
            picture = self.out / "yolo_pose" / data[row["part"]] / row["picture"]
            self.assertTrue(picture.is_file())
            label = pathlib.Path(str(picture).replace("/images/", "/labels/")).with_suffix(".txt")
            lines = [line.split() for line in label.read_text().splitlines()]
            expected = self.annotations(self.keypoints, row)
            self.assertEqual(len(lines), len(expected))
            for (name, *numbers), a in zip(lines, expected, strict=True):
                category = self.keypoints[row["part"]].loadCats(a["category_id"])[0]
                self.assertEqual(data["names"][int(name)], category["name"])
                x, y, w, h = (float(number) for number in numbers[:4])
                numpy.testing.assert_allclose([(x - w / 2) * 320, (y - h / 2) * 240, w * 320, h * 240], a["bbox"], atol=8e-3)
                for (u, v, seen), (px, py, flag) in zip(numpy.reshape(a["keypoints"], (2, 3)), numpy.reshape(numbers[4:], (2, 3)).astype(float), strict=True):
                    self.assertEqual(flag, seen)
                    # COCO counts pixels from their middle, YOLO shares from the picture's edge.
                    wanted = [u + 0.5, v + 0.5] if seen else [0, 0]
                    numpy.testing.assert_allclose([px * 320, py * 240], wanted, atol=6e-3)
                    count += bool(seen)
        self.assertGreater(count, 20)

    def test_key_points_of_rows_are_their_ends(self):
        found = 0
        for row in self.rows:
            camera = Poses(row)
            lines = {line.id: line.line for line in self.worlds[row["seed"]].rows}
            for a in self.annotations(self.keypoints, row):
                if a["category_id"] != 3:
                    continue
                for k, end in ((0, lines[a["row"]][0]), (1, lines[a["row"]][-1])):
                    u, v, seen = a["keypoints"][3 * k:3 * k + 3]
                    uv, z = camera.project(end)
                    inside = z > 0 and -0.5 <= uv[0] < 319.5 and -0.5 <= uv[1] < 239.5
                    self.assertEqual(seen > 0, inside)
                    if seen:
                        numpy.testing.assert_allclose([u, v], uv, atol=0.02)
                        found += 1
        self.assertGreater(found, 5)

    def test_feet_are_on_the_ground_below_rows(self):
        errors = []
        for row in self.rows:
            world = self.worlds[row["seed"]]
            lines, terrain = [line.line for line in world.rows], world.terrain
            camera, depth, things = Poses(row), self.layer("depth", row), self.things(row)
            for a in self.annotations(self.keypoints, row):
                u, v, seen = a["keypoints"][:3]
                if a["category_id"] != 1 or seen != 2 or a["area"] < 200:
                    continue
                # The picture's own depth at the trunk, beside the foot.
                x, y = round(u), round(v)
                near = [depth[j, i] for j in range(max(y - 1, 0), min(y + 2, 240))
                        for i in range(max(x - 1, 0), min(x + 2, 320)) if things[j, i] == a["thing"]]
                p = camera.point(u, v, min(near) / 1000)
                height = p[2] - float(terrain.height_at(p[0], p[1]))
                off = min(distance_to(line[:, :2], p[:2]) for line in lines)
                errors.append((off, height))
        self.assertGreater(len(errors), 10)
        # The depth is that of the trunk's front, and trunks are bent.
        self.assertLess(max(off for off, _ in errors), 0.15)
        self.assertLess(max(abs(height) for _, height in errors), 0.08)

    def test_kitti_boxes_hold_what_is_seen(self):
        compared = 0
        for row in self.rows:
            stem = row["picture"][:6]
            training = self.out / "kitti" / "training"
            self.assertEqual((training / "image_2" / row["picture"]).read_bytes(),
                             (self.out / "images" / row["part"] / row["picture"]).read_bytes())
            calib = dict(line.split(": ") for line in (training / "calib" / f"{stem}.txt").read_text().splitlines())
            P = numpy.array([float(v) for v in calib["P2"].split()]).reshape(3, 4)
            metres = pixels(training / "depth_2" / row["picture"]) / 256.0
            numpy.testing.assert_allclose(metres, self.layer("depth", row) / 1000.0, atol=1 / 512 + 1e-9)
            listed = self.annotations(self.instances, row)
            lines = (training / "label_2" / f"{stem}.txt").read_text().splitlines()
            self.assertEqual(len(lines), len(listed))
            for line, a in zip(lines, listed):
                name, truncated, occluded, alpha, *numbers = line.split()
                left, top, right, bottom, h, w, l, x, y, z, turn = (float(value) for value in numbers)
                self.assertEqual(name.lower(), CLASSES[a["category_id"] - 1])
                numpy.testing.assert_allclose([left, top, right - left + 1, bottom - top + 1], a["bbox"])
                self.assertIn(occluded, "012")
                wrapped = (turn - numpy.arctan2(x, z) - float(alpha) + numpy.pi) % (2 * numpy.pi) - numpy.pi
                self.assertLess(abs(wrapped), 2e-3)
                # Corners as in the devkit's computeBox3D.
                c, s = numpy.cos(turn), numpy.sin(turn)
                corners = numpy.array([[c * i + s * k + x, y - j, -s * i + c * k + z]
                                       for i in (-l / 2, l / 2) for j in (0, h) for k in (-w / 2, w / 2)])
                if float(truncated) > 0 or corners[:, 2].min() < 0.3:
                    continue
                uvw = P @ numpy.vstack([corners.T, numpy.ones(8)])
                u, v = uvw[0] / uvw[2], uvw[1] / uvw[2]
                self.assertLess(u.min(), left + 1)
                self.assertGreater(u.max(), right - 1)
                self.assertLess(v.min(), top + 1)
                self.assertGreater(v.max(), bottom - 1)
                # Depths of the thing's pixels are inside the box.
                z_mm = self.layer("depth", row)[self.things(row) == a["thing"]]
                self.assertGreater(z_mm.min() / 1000, corners[:, 2].min() - 0.02)
                self.assertLess(z_mm.max() / 1000, corners[:, 2].max() + 0.02)
                compared += 1
        self.assertGreater(compared, 200)

    def test_kitti_poses_start_at_the_first_picture(self):
        first = [row for row in self.rows if row["cell"] == "0"]
        poses = numpy.loadtxt(self.out / "kitti" / "poses" / "0000.txt").reshape(-1, 3, 4)
        self.assertEqual(len(poses), len(first))
        numpy.testing.assert_allclose(poses[0], numpy.eye(4)[:3], atol=1e-9)
        a, b = Poses(first[0]), Poses(first[-1])
        numpy.testing.assert_allclose(poses[-1][:, 3], a.R.T @ (b.p - a.p), atol=1e-4)
        numpy.testing.assert_allclose(poses[-1][:, :3], a.R.T @ b.R, atol=1e-6)

    def test_card_counts_what_is_there(self):
        card = (self.out / "README.md").read_text(encoding="utf-8")
        head = yaml.safe_load(card.split("---")[1])
        self.assertIn("object-detection", head["task_categories"])
        for k, name in enumerate(CLASSES):
            counts = [len(self.instances[part].getAnnIds(catIds=[k + 1])) for part in ("train", "val")]
            self.assertIn(f"| `{name}` | {counts[0]} | {counts[1]} | 0 |", card)
        self.assertIn("CC0-1.0", card)
        self.assertIn("- seeds: 1, 2", card)
        self.assertIn("- seeds of the plants: 1, 2", card)
        self.assertIn("| look | ahead | nothing |", card)
        self.assertIn("| look | side | `{rover.sensors.front.rotation_deg: [0, 3, 40]}` |", card)
        self.assertIn("val has 50 % of the pictures, not the 30 % of validation_share: the pictures of a seed stay together.",
                      card)
        self.assertIn("note     val has 50 % of the pictures", self.result.stdout)

    def test_parts_share_neither_plants_nor_pictures(self):
        # All runs begin at the same place.
        begun = {(row["look"], row["part"]): row for row in self.rows if float(row["time_s"]) == 0}
        for look in ("ahead", "side", "down"):
            one, other = begun[look, "train"], begun[look, "val"]
            self.assertLess(numpy.mean(self.things(one) == self.things(other)), 0.9)
        digests = [hashlib.sha256((self.out / kind / row["part"] / row["picture"]).read_bytes()).digest()
                   for kind in ("images", "instances", "depth") for row in self.rows]
        self.assertEqual(len(set(digests)), len(digests))
        self.assertIn("No two parts show the same plants.", (self.out / "README.md").read_text(encoding="utf-8"))

    def test_one_core_gives_the_same_bytes(self):
        study = {**changed(split_by="cell"), "seeds": [1], "factors": {"look": {"alternatives": {
            "ahead": {}, "side": STUDY["factors"]["look"]["alternatives"]["side"]}}}}
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
            first, a = run(study, pathlib.Path(one), "taskset -c 0")
            second, b = run(study, pathlib.Path(two))
            self.assertEqual((first.returncode, second.returncode), (0, 0))
            files = sorted(path.relative_to(a) for path in a.rglob("*") if path.is_file())
            self.assertEqual(files, sorted(path.relative_to(b) for path in b.rglob("*") if path.is_file()))
            for file in files:
                if file.name != "README.md":  # names the study's file
                    self.assertEqual((a / file).read_bytes(), (b / file).read_bytes(), file)


class InAFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vinerow_dataset_"))

    def tearDown(self):
        shutil.rmtree(self.folder)


class OtherSets(InAFolder):
    def make(self, study):
        result, out = run(study, self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(out / "pictures.csv", newline="", encoding="utf-8") as file:
            return out, list(csv.DictReader(file)), (out / "README.md").read_text(encoding="utf-8")

    def test_a_given_plant_seed_is_kept_and_the_card_says_what_parts_share(self):
        study = {**STUDY, "set": {"duration_s": 0.1, "world.plant_seed": 7}, "factors": {}}
        out, rows, card = self.make(study)
        self.assertEqual({row["part"] for row in rows}, {"train", "val"})
        a, b = (pixels(out / "instances" / row["part"] / row["picture"]) for row in rows)
        numpy.testing.assert_array_equal(a, b)
        self.assertIn("train and val show the same plants (`world.plant_seed` 7): scores of val say nothing about others.", card)

    def test_key_points_lean_as_the_posts_of_a_rolling_shutter(self):
        front = "rover.sensors.front."
        study = {**changed(every_s=0.5, classes=["post"], formats=["coco"], validation_share=0, split_by="cell"),
                 "factors": {}, "seeds": [1, 2],
                 "set": {"duration_s": 6, "rover.controller.speed_mps": 1.5, "world.vines.bbch": 3, front + "readout_s": 0.09,
                         front + "exposure_s": 0.005, front + "rotation_deg": [0, 3, 75], "criteria": []}}
        out, rows, _ = self.make(study)
        points = COCO(out / "annotations" / "keypoints_train.json")
        things = COCO(out / "annotations" / "instances_train.json")
        largest, compared = 0.0, 0
        for image, row in zip(sorted(points.imgs), rows, strict=True):
            masks = {a["thing"]: things.annToMask(a) for a in things.loadAnns(things.getAnnIds(imgIds=[image]))}
            for a in points.loadAnns(points.getAnnIds(imgIds=[image])):
                (u0, v0, foot), (u1, v1, head) = numpy.reshape(a["keypoints"], (2, 3))
                if a["category_id"] != 2 or foot != 2 or head != 2 or v0 - v1 < 60:
                    continue
                # Where rows of the picture itself cross the post, above the grass and below the top.
                y, x = numpy.nonzero(masks[a["thing"]])
                rows_of = [r for r in range(int(v1) + 4, int(v0) - 10) if (y == r).sum() >= 2]
                if len(rows_of) < 40:
                    continue
                middle = [x[y == r].mean() for r in rows_of]
                on_line = [u1 + (u0 - u1) * (r - v1) / (v0 - v1) for r in rows_of]
                self.assertLess(numpy.abs(numpy.subtract(middle, on_line)).mean(), 1.0, row["picture"])
                largest, compared = max(largest, abs(u1 - u0)), compared + 1
        self.assertGreater(compared, 3)
        self.assertGreater(largest, 5.0)  # px; upright posts of a camera at rest do not lean

    def test_shipped_studies_do_not_leak(self):
        folder = ROOT / "assets" / "studies"
        for file in sorted(folder.glob("*_dataset.yaml")):
            study = yaml.safe_load(file.read_text(encoding="utf-8"))
            self.assertEqual(study["dataset"]["split_by"], "seed")
            if file.stem == "row_net_dataset":
                # A record of how a net was trained; its guide says that the plants are the same.
                self.assertEqual(study["set"]["world.plant_seed"], 1)
                continue
            if file.stem == "weed_dataset":
                study["set"]["world.weeds.per_m2"] = 8
            study = {**study, "scenario": str(folder / study["scenario"]), "factors": {},
                     "dataset": {**study["dataset"], "pictures": 1}}
            out, rows, card = self.make(study)
            pictures = [pixels(out / "instances" / row["part"] / row["picture"]) for row in rows]
            for i, one in enumerate(rows):
                for j in range(i):
                    if one["part"] != rows[j]["part"]:
                        a, b = pictures[i], pictures[j]
                        is_thing = (a > 1).any(axis=-1) | (b > 1).any(axis=-1)  # neither sky nor ground
                        self.assertGreater(is_thing.mean(), 0.02)
                        self.assertLess(numpy.mean((a == b).all(axis=-1)[is_thing]), 0.5)
            self.assertIn("No two parts show the same plants.", card)
            listed = COCO(out / "annotations" / "instances_train.json")
            for category in listed.getCatIds():
                self.assertGreater(len(listed.getAnnIds(catIds=[category])), 2, file.name)
            shutil.rmtree(out)

    def test_labels_do_not_see_the_errors_of_depth(self):
        key = "rover.sensors.front.depth_"
        noisy = {key + "dropout_share": 0.5, key + "disparity_std_px": 2.0, key + "baseline_m": 0.05, key + "min_m": 3.0,
                 key + "max_m": 9.0}
        study = {**changed(validation_share=0, split_by="cell"), "set": {"duration_s": 0.1}, "seeds": [1],
                 "factors": {"depth": {"alternatives": {"exact": {}, "noisy": noisy}}}}
        out, rows, _ = self.make(study)
        exact, other = (pixels(out / "depth" / row["part"] / row["picture"]) for row in rows)
        numpy.testing.assert_array_equal(exact, other)
        points = json.loads((out / "annotations" / "keypoints_train.json").read_text())["annotations"]
        by_picture = [[a["keypoints"] for a in points if a["image_id"] == int(row["picture"][:6])] for row in rows]
        self.assertGreater(len(by_picture[0]), 5)
        self.assertEqual(*by_picture)

    def test_long_runs_keep_their_pictures_apart(self):
        # 9e6 s in steps of 1 ms are more pictures than 32 bits count.
        study = {**changed(every_s=0.001, pictures=2), "factors": {}, "set": {
            "duration_s": 9_000_000, "rover.sensors.front.exposure_s": 0.0005, "rover.sensors.front.readout_s": 0}}
        out, rows, _ = self.make(study)
        self.assertEqual([row["picture"] for row in rows], [f"{k:06}.png" for k in range(4)])
        self.assertEqual(len(list((out / "images").rglob("*.png"))), 4)

    def test_the_card_has_all_sizes_and_keys(self):
        width = {"rover.sensors.front.width_px": 160, "rover.sensors.front.cx_px": 80}
        study = {**changed(validation_share=0), "seeds": [1], "set": {"duration_s": 0.1, "world.cloud_cover": 1}, "factors": {
            "size": {"alternatives": {"small": width, "big": {}}},
            "rays": {"key": "rover.sensors.front.samples", "values": [1, 2]}}}
        _, _, card = self.make(study)
        self.assertIn("camera `rover/front`, 160 x 240, 320 x 240 pixels", card)
        self.assertIn("| rays | `rover.sensors.front.samples` | 1, 2 |", card)
        self.assertNotIn("sky is clear", card)


class BadInput(InAFolder):

    def refuse(self, study, sentence, status=2, before=""):
        result, out = run(study, self.folder, before)
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertRegex(result.stderr, sentence)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name != "study.yaml"], [])

    def test_each_mistake_is_one_sentence(self):
        without = {key: value for key, value in STUDY.items() if key != "dataset"}
        self.refuse(without, r"has no 'dataset'; add dataset: \{camera: <vehicle>/<camera>\}")
        self.refuse(changed(classes=["bunches"]), r"study.yaml:\d+: dataset.classes has 'bunches', each must be one of: "
                    r"leaf, wood, .*; did you mean 'bunch'\?")
        self.refuse(changed(classes=["bunch", "bunch"]), r"study.yaml:\d+: dataset.classes has 'bunch' twice")
        self.refuse(changed(classes=[]), r"study.yaml:\d+: dataset.classes = \[\], must name at least one")
        self.refuse(changed(formats=["voc"]),
                    r"study.yaml:\d+: dataset.formats has 'voc', each must be one of: coco, coco_panoptic, yolo, yolo_segment, yolo_pose, kitti")
        self.refuse(changed(every_s=0.0105),
                    r"dataset.every_s = 0.0105 s, must be a multiple of the physics step of 0.001 s")
        self.refuse(changed(camera="rover/frnt"), r"dataset.camera = 'rover/frnt', must be a sensor of type camera: "
                    r"rover/front; did you mean 'rover/front'\?")
        self.refuse(changed(camera="rover"), r"dataset.camera = 'rover', must be a sensor of type camera")
        self.refuse(changed(every_s=0.0010000005),
                    r"study.yaml:\d+: dataset.every_s = 0.0010000005 s, must be a multiple of the physics step of 0.001 s")
        self.refuse({**changed(every_s=0.001), "set": {"duration_s": 2.5}},
                    r"study.yaml:\d+: dataset.every_s = 0.001 s, must be at least the 0.0162 s of an exposure "
                    r"and a readout of 'rover/front'")
        limits = {"rover.sensors.front.depth_min_m": 9, "rover.sensors.front.depth_max_m": 3}
        self.refuse({**STUDY, "set": limits}, r"study.yaml:\d+: vehicles.rover.sensors.front.depth_min_m = 9, must be < "
                    r"depth_max_m = 3")
        self.refuse({**STUDY, "seeds": [1, 10**16]}, r"study.yaml:\d+: seed 10000000000000000 is too large to be also the "
                    r"world's plant_seed; choose smaller seeds, or set world.plant_seed")
        self.refuse(changed(validation_share=0.7, test_share=0.3),
                    r"study.yaml:\d+: dataset.validation_share \+ dataset.test_share = 1, must be < 1")
        self.refuse(changed(test_share=0.1), r"study.yaml:\d+: dataset.validation_share = 0.3 and test_share = 0.1 need at "
                    r"least 3 seeds, but the study has 2; add some, choose another split_by, or set a share to 0")
        quick = {"rover.sensors.front.exposure_s": 0.0005, "rover.sensors.front.readout_s": 0}
        self.refuse({**changed(every_s=0.001), "set": {**quick, "duration_s": 9_000_000}},
                    r"study.yaml:\d+: dataset.every_s makes 9e\+09 pictures in the 9e\+06 s of a run, must make at most "
                    r"1000000000; set dataset.pictures or a longer dataset.every_s")
        self.refuse({**changed(every_s=0.001), "set": {**quick, "duration_s": 900_000}},
                    r"study.yaml:\d+: dataset.pictures: 6 runs of up to 900000001 pictures, must make at most 1000000000 "
                    r"together; set dataset.pictures or a longer dataset.every_s")
        self.refuse(changed(pictures=0), r"dataset.pictures = 0")
        distorted = {**STUDY, "set": {**STUDY["set"], "rover.sensors.front.distortion": [0.1, 0, 0, 0, 0]}}
        self.refuse(distorted, r"dataset.formats has kitti, which knows no distortion")
        depth = {**STUDY, "set": {**STUDY["set"], "rover.sensors.front.picture": "depth"}}
        self.refuse(depth, r"dataset.camera = 'rover/front' takes pictures of depth alone")
        below = {**STUDY, "set": {**STUDY["set"], "rover.sensors.front.position_m": [0, 0, -3]}}
        self.refuse(below, r"no cell gave a picture; cell 0: .*is below the ground")

    def test_a_folder_with_files_is_left_alone(self):
        out = self.folder / "out"
        out.mkdir()
        (out / "mine.txt").write_text("mine")
        result, _ = run(STUDY, self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"'.*/out' exists and is not empty: remove it, or choose another folder with")
        self.assertEqual((out / "mine.txt").read_text(), "mine")

    def test_a_file_in_the_folders_place_is_left_alone(self):
        out = self.folder / "out"
        for content in ("", "mine"):
            out.write_text(content)
            result, _ = run(STUDY, self.folder)
            self.assertEqual(result.returncode, 2)
            self.assertRegex(result.stderr, r"'.*/out' is not a folder: remove it, or choose another folder with --out")
            self.assertEqual(out.read_text(), content)

    def test_a_full_disk_leaves_nothing(self):
        # Beyond this size no file can be written.
        self.refuse(STUDY, r"cannot be written", status=3, before="ulimit -f 60;")

    def test_a_run_that_breaks_off_is_in_the_card(self):
        study = {**changed(validation_share=0), "seeds": 1, "factors": {"place": {"alternatives": {
            "good": {}, "below": {"rover.sensors.front.position_m": [0, 0, -3]}}}}}
        result, out = run(study, self.folder)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("broke off 1 of 2 runs", result.stdout)
        self.assertRegex((out / "README.md").read_text(), r"- run 1: 0 pictures, then: .*below the ground")
        pictures = json.loads((out / "annotations" / "instances_train.json").read_text())["images"]
        self.assertEqual(len(pictures), 3)

    def test_ctrl_c_leaves_nothing(self):
        import signal
        import time
        (self.folder / "study.yaml").write_text(yaml.safe_dump({**STUDY, "seeds": 50}), encoding="utf-8")
        process = subprocess.Popen([VINEROW, "dataset", str(self.folder / "study.yaml"), "--out",
                                    str(self.folder / "out"), "--quiet"], stderr=subprocess.PIPE, text=True)
        for _ in range(600):
            if list(self.folder.rglob("*.png")):
                break
            time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3)
        self.assertRegex(errors, r"interrupted: no data set is kept")
        self.assertEqual([path.name for path in self.folder.iterdir()], ["study.yaml"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
