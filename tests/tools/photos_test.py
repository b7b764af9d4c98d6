#!/usr/bin/env python3
"""Photographs of `vinerow survey --pictures`: Exif read by Pillow, XMP by an XML parser, positions by the ellipsoid's own formulas.

    photos_test.py VINEROW
"""

import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import numpy
import vinerow
from PIL import ExifTags, Image

VINEROW = sys.argv[1]
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIO = ROOT / "assets" / "scenarios" / "map_parcel.yaml"
WIDTH, HEIGHT = 320, 213  # of 5472 x 3648
ORIGIN = [-33.4, -70.6, 120.0]  # another quarter of the globe
CAMERA = "{http://pix4d.com/camera/1.0/}"


def call(*words):
    return subprocess.run([VINEROW, *map(str, words)], capture_output=True, text=True, timeout=600)


def ecef(latitude_rad, longitude_rad, altitude_m):
    """WGS84 (NIMA TR8350.2)."""
    a, f = 6378137.0, 1 / 298.257223563
    e2 = f * (2 - f)
    n = a / numpy.sqrt(1 - e2 * numpy.sin(latitude_rad) ** 2)
    return numpy.array([(n + altitude_m) * numpy.cos(latitude_rad) * numpy.cos(longitude_rad),
                        (n + altitude_m) * numpy.cos(latitude_rad) * numpy.sin(longitude_rad),
                        (n * (1 - e2) + altitude_m) * numpy.sin(latitude_rad)])


def local(point_deg, origin_deg):
    """East, north, up."""
    place = [*numpy.radians(point_deg[:2]), point_deg[2]]
    origin = [*numpy.radians(origin_deg[:2]), origin_deg[2]]
    d = ecef(*place) - ecef(*origin)
    s, c = numpy.sin(origin[:2]), numpy.cos(origin[:2])
    east = [-s[1], c[1], 0]
    north = [-s[0] * c[1], -s[0] * s[1], c[0]]
    up = [c[0] * c[1], c[0] * s[1], s[0]]
    return numpy.array([east, north, up]) @ d


def degrees(values):
    d, m, s = (float(value) for value in values)
    return d + m / 60 + s / 3600


def geo_entries(file):
    """Lines of geo.txt by OpenDroneMap's documentation ("Image geolocation files"): file name to its eight numbers."""
    lines = file.read_text().splitlines()
    assert lines[0] == "EPSG:4326"
    entries = {}
    for line in lines[1:]:
        name, *numbers = line.split()
        entries[name] = dict(zip(("x", "y", "z", "yaw", "pitch", "roll", "horizontal", "vertical"), map(float, numbers), strict=True))
    return entries


class Photos(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="vinerow_photos_")
        folder = pathlib.Path(cls.temporary.name)
        # A flight in wind, so that the camera is tilted.
        done = call("run", SCENARIO, "--out", folder / "run", "--no-pictures", "--no-report", "--quiet", "--set",
                    "criteria=[]", "--set", "world.wind={turbulence: 3.0, turbulence_wind_mps: 5.0}", "--set",
                    f"world.origin_latitude_deg={ORIGIN[0]}", "--set", f"world.origin_longitude_deg={ORIGIN[1]}", "--set",
                    f"world.origin_altitude_m={ORIGIN[2]}")
        assert done.returncode <= 1, done.stderr  # it may land hard
        cls.done = call("survey", "--log", folder / "run", "--pictures", "--picture-width", WIDTH, "--out", folder / "out")
        assert cls.done.returncode == 0, cls.done.stderr
        cls.folder = folder / "out" / "pictures"
        with (cls.folder / "truth.csv").open(newline="", encoding="utf-8") as file:
            cls.truth = list(csv.DictReader(file))
        with vinerow.open(SCENARIO) as session:
            world = session.world()
            cls.lines = [row.line for row in world.rows]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def place(self, row):
        return numpy.array([float(row[key]) for key in ("x_m", "y_m", "z_m")])

    def test_there_is_a_photograph_for_each_shot(self):
        self.assertIn(f"{len(self.truth)} of {WIDTH} x {HEIGHT} pixels", self.done.stdout)
        self.assertGreater(len(self.truth), 50)
        self.assertEqual(sorted(path.name for path in self.folder.glob("*.jpg")), [row["photo"] for row in self.truth])
        self.assertEqual(list(self.folder.parent.glob("*.unfinished")), [])

    def test_exif_has_camera_and_position(self):
        geo = (self.folder / "geo.txt").read_text().splitlines()
        self.assertEqual(geo[0], "EPSG:4326")
        errors = []
        for row, line in zip(self.truth, geo[1:]):
            with Image.open(self.folder / row["photo"]) as photo:
                exif = photo.getexif()
                size = photo.size
            self.assertEqual(size, (WIDTH, HEIGHT))
            main = {ExifTags.TAGS[tag]: value for tag, value in exif.items()}
            self.assertEqual((main["Make"], main["Model"]), ("Vinerow", "rx100"))
            self.assertRegex(main["Software"], r"^Vinerow \d")
            own = {ExifTags.TAGS[tag]: value for tag, value in exif.get_ifd(0x8769).items()}
            self.assertAlmostEqual(float(own["FocalLength"]), 8.8)
            self.assertEqual((own["ExifImageWidth"], own["ExifImageHeight"]), size)
            # 8.8 mm on 13.2 mm.
            per_mm = float(own["FocalPlaneXResolution"]) / 10
            self.assertEqual(own["FocalPlaneResolutionUnit"], 3)
            self.assertAlmostEqual(WIDTH / per_mm, 13.2, places=4)
            self.assertAlmostEqual(8.8 * per_mm, WIDTH * 8.8 / 13.2, places=2)
            gps = {ExifTags.GPSTAGS[tag]: value for tag, value in exif.get_ifd(0x8825).items()}
            self.assertEqual((gps["GPSLatitudeRef"], gps["GPSLongitudeRef"], gps["GPSMapDatum"]), ("S", "W", "WGS-84"))
            said = [-degrees(gps["GPSLatitude"]), -degrees(gps["GPSLongitude"]), float(gps["GPSAltitude"])]
            name, longitude, latitude, altitude, *_ = line.split()
            self.assertEqual(name, row["photo"])
            numpy.testing.assert_allclose([float(latitude), float(longitude)], said[:2], atol=4e-9)
            self.assertAlmostEqual(float(altitude), said[2], places=3)
            yaw = float(row["yaw_deg"]) % 360
            self.assertAlmostEqual(float(gps["GPSImgDirection"]), yaw, delta=1e-3)
            # The true place, by formulas of the ellipsoid.
            true = [float(row[key]) for key in ("latitude_deg", "longitude_deg", "altitude_m")]
            numpy.testing.assert_allclose(local(true, ORIGIN), self.place(row), atol=1e-3)
            errors.append(local(said, ORIGIN) - self.place(row))
        # The vehicle's estimate: near the truth, and not the truth.
        rms = numpy.sqrt(numpy.mean(numpy.square(errors), axis=0))
        self.assertLess(rms.max(), 1.0)
        self.assertGreater(rms.max(), 2e-3)

    def test_exposure_does_not_depend_on_the_width(self):
        with tempfile.TemporaryDirectory() as folder:
            means = []
            for width in (32, 96):
                done = call("survey", "--log", self.folder.parents[1] / "run", "--pictures", "--picture-width", width, "--out",
                            pathlib.Path(folder) / str(width))
                self.assertEqual(done.returncode, 0, done.stderr)
                means.append([numpy.asarray(Image.open(path), dtype=float).mean(axis=(0, 1))
                              for path in sorted((pathlib.Path(folder) / str(width) / "pictures").glob("*.jpg"))])
            means.append([numpy.asarray(Image.open(path), dtype=float).mean(axis=(0, 1)) for path in sorted(self.folder.glob("*.jpg"))])
            means = numpy.array(means)  # (widths, photographs, colours)
            # The geometric mean is exposed to 0.18 of the range, 118 of 255 in sRGB; the arithmetic mean of coarser pixels is the same.
            self.assertLess(means.max(), 230)
            self.assertGreater(means.min(), 60)
            self.assertLess(numpy.abs(means - means[2]).max(), 12)

    def test_xmp_has_the_orientation(self):
        tilts = []
        for row in self.truth:
            data = (self.folder / row["photo"]).read_bytes()
            packet = re.search(rb"<x:xmpmeta.*</x:xmpmeta>", data, re.S)[0]
            facts = next(xml.etree.ElementTree.fromstring(packet).iter(
                "{http://www.w3.org/1999/02/22-rdf-syntax-ns#}Description")).attrib
            self.assertEqual(facts[CAMERA + "ModelType"], "perspective")
            self.assertAlmostEqual(float(facts[CAMERA + "PerspectiveFocalLength"]), 8.8)
            x, y = map(float, facts[CAMERA + "PrincipalPoint"].split(","))
            self.assertAlmostEqual(x, 6.6)
            self.assertAlmostEqual(y, 6.6 * HEIGHT / WIDTH, places=4)
            yaw, pitch, roll = numpy.radians([float(facts[CAMERA + key]) for key in ("Yaw", "Pitch", "Roll")])
            # Axes ahead (upper edge), right, down (optical axis) in north, east, down.
            c, s = numpy.cos([yaw, pitch, roll]), numpy.sin([yaw, pitch, roll])
            Rz = numpy.array([[c[0], -s[0], 0], [s[0], c[0], 0], [0, 0, 1]])
            Ry = numpy.array([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]])
            Rx = numpy.array([[1, 0, 0], [0, c[2], -s[2]], [0, s[2], c[2]]])
            axis = (Rz @ Ry @ Rx) @ [0, 0, 1]
            up = (Rz @ Ry @ Rx) @ [1, 0, 0]
            w, qx, qy, qz = (float(row[key]) for key in ("qw", "qx", "qy", "qz"))
            # Of S: x along the axis, z to the upper edge, in east, north, up.
            true_axis = [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + w * qz), 2 * (qx * qz - w * qy)]
            true_up = [2 * (qx * qz + w * qy), 2 * (qy * qz - w * qx), 1 - 2 * (qx * qx + qy * qy)]
            numpy.testing.assert_allclose([axis[1], axis[0], -axis[2]], true_axis, atol=1e-6)
            numpy.testing.assert_allclose([up[1], up[0], -up[2]], true_up, atol=1e-6)
            tilts.append(numpy.degrees(numpy.arccos(-true_axis[2])))
        self.assertGreater(max(tilts), 2.0)  # or the test above compares zeros
        self.assertLess(max(tilts), 40.0)

    def test_vines_are_where_the_pose_says(self):
        # Rows are greener than the meadow 12 m beyond their ends.
        greener = total = 0
        focal = WIDTH * 8.8 / 13.2
        for row in self.truth:
            w, x, y, z = (float(row[key]) for key in ("qw", "qx", "qy", "qz"))
            R = numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                             [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                             [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
            with Image.open(self.folder / row["photo"]) as photo:
                picture = numpy.asarray(photo).astype(float)

            def excess_green(p_W):
                axis, left, up = R.T @ (p_W - self.place(row))
                u = (WIDTH - 1) / 2 - focal * left / axis
                v = (HEIGHT - 1) / 2 - focal * up / axis
                if not (1 <= u < WIDTH - 2 and 1 <= v < HEIGHT - 2):
                    return None
                patch = picture[round(v) - 1:round(v) + 2, round(u) - 1:round(u) + 2].reshape(-1, 3)
                return (2 * patch[:, 1] - patch[:, 0] - patch[:, 2]).max() - 0.5 * patch.mean()

            for line in self.lines[::4]:
                ahead = (line[0] - line[1]) / numpy.linalg.norm(line[0] - line[1])
                on = excess_green(line[0] - 3 * ahead + [0, 0, 1.7])
                off = excess_green(line[0] + 12 * ahead)
                if on is not None and off is not None:
                    total += 1
                    greener += on > off
        self.assertGreater(total, 50)
        self.assertGreater(greener / total, 0.9)

    def test_angles_are_those_of_opendronemap(self):
        # Its conventions (opendm/photo.py): yaw 90: the upper edge points east; pitch 0: straight down, 90: ahead.
        entries = geo_entries(self.folder / "geo.txt")
        self.assertEqual(sorted(entries), [row["photo"] for row in self.truth])
        tilts = []
        for row in self.truth:
            entry = entries[row["photo"]]
            w, x, y, z = (float(row[key]) for key in ("qw", "qx", "qy", "qz"))
            upper = numpy.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
            left = numpy.array([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)])
            yaw = numpy.degrees(numpy.arctan2(upper[0], upper[1]))
            self.assertAlmostEqual((entry["yaw"] - yaw + 180) % 360, 180, delta=1e-3)
            # The optical axis looks ahead as much as the upper edge points up.
            self.assertAlmostEqual(entry["pitch"], numpy.degrees(numpy.arcsin(upper[2])), delta=1e-3)
            # To the right wing down: the picture's left edge is up.
            self.assertAlmostEqual(entry["roll"], numpy.degrees(numpy.arcsin(left[2] / numpy.sqrt(1 - upper[2] ** 2))), delta=1e-3)
            tilts.append([entry["pitch"], entry["roll"]])
        self.assertGreater(numpy.abs(tilts).max(axis=0).min(), 1.0)  # or the test above compares zeros

    def test_bands_are_reflectances(self):
        """TIFF files by Pillow: a grey panel, leaves after PROSPECT-D, and the fields that OpenDroneMap's photo.py asks for."""
        bands = {"red": ("Red", 668, 10), "red_edge": ("Red edge", 717, 10), "nir": ("NIR", 840, 40)}
        line = self.lines[0]
        panel = line[0] + 12 * (line[0] - line[1]) / numpy.linalg.norm(line[0] - line[1])
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            half = 4.0
            (folder / "panel.mtl").write_text("newmtl grey\nKd 0.8 0.8 0.8\n")
            corners = [(x, y, z) for z in (0.0, 0.5) for x, y in ((-half, -half), (half, -half), (half, half), (-half, half))]
            faces = ["5 6 7 8", "4 3 2 1", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"]
            (folder / "panel.obj").write_text("mtllib panel.mtl\nusemtl grey\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in corners) +
                                              "".join(f"f {face}\n" for face in faces))
            result = call("survey", SCENARIO, "--pictures", "--picture-width", WIDTH, "--bands", ",".join(bands), "--out", folder / "out",
                          "--set", f"world.obstacles=[{{file: {folder}/panel.obj, x_m: {panel[0]}, y_m: {panel[1]}}}]")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(f"of {WIDTH} x {HEIGHT} pixels in 3 bands", result.stdout)
            pictures = folder / "out" / "pictures"
            with (pictures / "truth.csv").open(newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(sorted(path.name for path in pictures.glob("*.tif")), sorted(row["photo"] for row in rows))
            self.assertEqual(list(geo_entries(pictures / "geo.txt")), [row["photo"] for row in rows])
            grey, ndvi = [], []
            for first in range(0, len(rows), 3):
                values = {}
                for index, (row, (key, (name, wavelength, width))) in enumerate(zip(rows[first:first + 3], bands.items(), strict=True)):
                    self.assertTrue(row["photo"].endswith(f"_{key}.tif"), row["photo"])
                    with Image.open(pictures / row["photo"]) as photo:
                        self.assertEqual((photo.mode, photo.size), ("I;16", (WIDTH, HEIGHT)))
                        values[key] = numpy.asarray(photo).astype(float) / 32768
                        exif, packet = photo.getexif(), bytes(photo.tag_v2[700])
                    self.assertEqual(exif.get_ifd(0x8825)[1], "N")
                    self.assertGreater(float(exif.get_ifd(0x8769)[0x829A]), 1e-6)  # ExposureTime
                    facts = next(xml.etree.ElementTree.fromstring(re.search(rb"<x:xmpmeta.*</x:xmpmeta>", packet, re.S)[0]).iter(
                        "{http://www.w3.org/1999/02/22-rdf-syntax-ns#}Description")).attrib
                    self.assertEqual([facts[CAMERA + name] for name in ("BandName", "RigCameraIndex", "CaptureUUID")],
                                     [name, str(index), row["photo"].split("_" + key)[0]])
                    self.assertEqual([float(facts[CAMERA + name]) for name in ("CentralWavelength", "WavelengthFWHM")], [wavelength, width])
                # Pictures as planned look straight down, with the upper edge to the yaw.
                p, yaw = self.place(row), numpy.radians(float(row["yaw_deg"]))
                d = panel + [0, 0, 0.5] - p
                focal = WIDTH * 8.8 / 13.2
                u = (WIDTH - 1) / 2 + focal * (d[0] * numpy.cos(yaw) - d[1] * numpy.sin(yaw)) / -d[2]
                v = (HEIGHT - 1) / 2 - focal * (d[0] * numpy.sin(yaw) + d[1] * numpy.cos(yaw)) / -d[2]
                if 3 <= u < WIDTH - 3 and 3 <= v < HEIGHT - 3:
                    grey.append([values[key][round(v) - 1:round(v) + 2, round(u) - 1:round(u) + 2].mean() for key in bands])
                index = (values["nir"] - values["red"]) / (values["nir"] + values["red"])
                ndvi.append([*numpy.percentile(index, [50, 98])])
        self.assertGreater(len(grey), 4)
        numpy.testing.assert_allclose(grey, ((0.8 + 0.055) / 1.055) ** 2.4, atol=0.01)  # linear, from sRGB
        # Dry grass with shadows; dense green leaves in the sun have 0.7 to 0.9.
        middle, high = numpy.array(ndvi).T
        self.assertGreater(middle.min(), 0.05)
        self.assertLess(middle.max(), 0.7)
        self.assertGreater(high.max(), 0.7)
        self.assertLess(high.max(), 0.95)

    def test_accuracies_are_the_errors_of_the_estimate(self):
        entries = geo_entries(self.folder / "geo.txt")
        errors = numpy.array([local([entries[row["photo"]][key] for key in "yxz"], ORIGIN) -
                              [float(row[key]) for key in ("x_m", "y_m", "z_m")] for row in self.truth])
        rms = numpy.sqrt((errors ** 2).mean(axis=0))
        for entry in entries.values():
            self.assertAlmostEqual(entry["horizontal"], max(numpy.hypot(rms[0], rms[1]), 0.01), delta=2e-3)
            self.assertAlmostEqual(entry["vertical"], max(rms[2], 0.01), delta=2e-3)

    def test_planned_places_are_exact_to_a_centimetre(self):
        with tempfile.TemporaryDirectory() as folder:
            result = call("survey", SCENARIO, "--pictures", "--picture-width", 32, "--out", folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            entries = geo_entries(pathlib.Path(folder) / "pictures" / "geo.txt")
            self.assertGreater(len(entries), 50)
            for entry in entries.values():
                self.assertEqual([entry[key] for key in ("pitch", "roll", "horizontal", "vertical")], [0, 0, 0.01, 0.01])


class BadInput(unittest.TestCase):
    def refuse(self, sentence, *words):
        with tempfile.TemporaryDirectory() as folder:
            result = call("survey", *words, "--out", pathlib.Path(folder) / "out")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertRegex(result.stderr, rf"^vinerow: .*{sentence}.*\n$")
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [])

    def test_each_mistake_is_one_sentence(self):
        self.refuse("--log needs --pictures", "--log", "runs/x")
        self.refuse("--pictures needs the world of a scenario, or --log", "--polygon", "x.csv", "--pictures")
        for width, size in (("8", "8 x 5"), ("0", "0 x 0"), ("-5", "-5 x -3"), ("15", "15 x 10"), ("100000", "100000 x 66667")):
            self.refuse(f"photographs of {size} pixels, must be from 16 to 8192 each way; change --picture-width", SCENARIO,
                        "--pictures", f"--picture-width={width}")
        self.refuse("--picture-width has no effect without --pictures", SCENARIO, "--picture-width", "640")
        self.refuse("--bands has no effect without --pictures", SCENARIO, "--bands", "red")
        self.refuse("--bands has 'red' twice", SCENARIO, "--pictures", "--bands", "red,nir,red")
        self.refuse("--bands: uv not in {blue,green,red,red_edge,nir}", SCENARIO, "--pictures", "--bands", "uv")
        self.refuse("--sensor has no effect without --log", SCENARIO, "--pictures", "--sensor", "trigger")
        self.refuse("neither a scenario nor --polygon", SCENARIO, "--log", "runs/x", "--pictures")

    def test_a_folder_with_pictures_is_left_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            kept = pathlib.Path(folder) / "pictures" / "mine.txt"
            kept.parent.mkdir()
            kept.write_text("mine")
            result = call("survey", SCENARIO, "--pictures", "--out", folder)
            self.assertEqual(result.returncode, 2)
            self.assertRegex(result.stderr, r"^vinerow: '.*/pictures' exists and is not empty: remove it, or choose another "
                             r"folder with --out\n$")
            self.assertEqual([path for path in pathlib.Path(folder).rglob("*") if path.is_file()], [kept])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
