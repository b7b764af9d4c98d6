#!/usr/bin/env python3
"""`vinerow export` of clouds, from logs written by hand: PLY read by OpenCV, LAS by laspy, PCD by the letter of its specification, poses
by SciPy.

    export_clouds_test.py VINEROW
"""

import csv
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import cv2
import laspy
import numpy
from scipy.spatial.transform import Rotation, Slerp

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from mcap_file import CLOUD, HEADER, Cdr, Log  # noqa: E402

VINEROW = sys.argv[1]
# As the log has points, with an unused byte at the end.
POINT = numpy.dtype({"names": ["x", "y", "z", "time", "intensity", "ring", "return_number"],
                     "formats": ["<f4", "<f4", "<f4", "<f4", "<f4", "<u2", "|u1"],
                     "offsets": [0, 4, 8, 12, 16, 20, 22], "itemsize": 24})  # fmt: skip
DATATYPES = {"<f4": 7, "<u2": 4, "|u1": 2}
PERIOD_S, ORIGIN_S = 0.1, 10.0


def pcd(file: pathlib.Path) -> numpy.ndarray:
    """https://pointclouds.org/documentation/tutorials/pcd_file_format.html"""
    head, data = file.read_bytes().split(b"DATA binary\n", 1)
    lines = dict(line.split(" ", 1) for line in head.decode().splitlines() if not line.startswith("#"))
    kinds = {"F": "f", "U": "u", "I": "i"}
    formats = [f"<{kinds[kind]}{size}" for kind, size in zip(lines["TYPE"].split(), lines["SIZE"].split(), strict=True)]
    points = numpy.frombuffer(data, dtype=list(zip(lines["FIELDS"].split(), formats, strict=True)))
    assert int(lines["POINTS"]) == int(lines["WIDTH"]) * int(lines["HEIGHT"]) == len(points)
    assert lines["VERSION"] == "0.7" and set(lines["COUNT"].split()) == {"1"}
    return points


def ply_positions(file: pathlib.Path) -> numpy.ndarray:
    return numpy.asarray(cv2.loadPointCloud(str(file))[0]).reshape(-1, 3)


def positions(points: numpy.ndarray) -> numpy.ndarray:
    return numpy.stack([points["x"], points["y"], points["z"]], axis=1)


def cloud_message(stamp_ns: int, points: numpy.ndarray, frame: str = "rover/lidar") -> bytes:
    message = Cdr().header(stamp_ns, frame).add("I", 1, len(points), len(POINT.names))
    for name in POINT.names:
        kind, offset = POINT.fields[name][:2]
        message.text(name).add("I", offset).add("B", DATATYPES[kind.str]).add("I", 1)
    message.add("?", False).add("I", POINT.itemsize, POINT.itemsize * len(points), points.nbytes)
    message.data += points.tobytes()
    return message.add("?", True).message()


def odometry_message(stamp_ns: int, p, q) -> bytes:
    message = Cdr().header(stamp_ns).text("rover/base_link").add("d", *p, *q, *[0.0] * 36)
    return message.add("d", *[0.0] * (6 + 36)).message()


def mounting_message(p, q, sensor: str = "rover/lidar") -> bytes:
    return Cdr().add("I", 1).header(0, "rover/base_link").text(sensor).add("d", *p, *q).message()


def krueger(latitude, longitude, meridian):
    """UTM easting and northing, m, on the ellipsoid of WGS 84: Krueger 1912, in the form of Karney, J. Geodesy 85 (2011), eq. 7 to 11, 35."""
    a, f = 6378137.0, 1 / 298.257223563
    n = f / (2 - f)
    e = math.sqrt(f * (2 - f))
    radius = a / (1 + n) * (1 + n**2 / 4 + n**4 / 64)
    alpha = (n / 2 - 2 / 3 * n**2 + 5 / 16 * n**3, 13 / 48 * n**2 - 3 / 5 * n**3, 61 / 240 * n**3)
    tau = numpy.tan(latitude)
    sigma = numpy.sinh(e * numpy.arctanh(e * tau / numpy.hypot(1, tau)))
    conformal = tau * numpy.hypot(1, sigma) - sigma * numpy.hypot(1, tau)
    xi = numpy.arctan2(conformal, numpy.cos(longitude - meridian))
    eta = numpy.arcsinh(numpy.sin(longitude - meridian) / numpy.hypot(conformal, numpy.cos(longitude - meridian)))
    east, north = eta.copy(), xi.copy()
    for k, factor in enumerate(alpha, 1):
        east += factor * numpy.cos(2 * k * xi) * numpy.sinh(2 * k * eta)
        north += factor * numpy.sin(2 * k * xi) * numpy.cosh(2 * k * eta)
    return 500_000 + 0.9996 * radius * east, 0.9996 * radius * north


class ExportOfClouds(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.log = self.folder / "log.mcap"
        # A drive along a bend, uphill; poses every tenth of a second.
        self.times = ORIGIN_S + PERIOD_S * numpy.arange(11)
        self.way = numpy.array([[0.1 * i * i, 2.0 * i, 0.3 * i] for i in range(11)])
        self.turns = Rotation.from_euler("zyx", [[8 * i, -3 * i, i] for i in range(11)], degrees=True)
        self.p_BS, self.R_BS = numpy.array([0.4, -0.1, 0.7]), Rotation.from_euler("zyx", [20, 10, -5], degrees=True)
        # What stands in the world, seen at a time of its own each.
        random = numpy.random.default_rng(7)
        self.count = 600
        self.p_W = random.uniform([-5, 0, 0], [15, 25, 6], (self.count, 3))
        self.seen_s = numpy.linspace(self.times[0], self.times[-1], self.count)
        self.rings = random.integers(0, 16, self.count)
        self.intensities = random.uniform(0, 120, self.count)
        self.intensities[0] = 700  # of a reflector
        self.returns = random.integers(1, 3, self.count)

    def write_log(self, frame="rover/lidar", mounted="rover/lidar"):
        log = Log()
        truth = log.channel("/rover/truth", "nav_msgs/msg/Odometry", "")
        for t, p, q in zip(self.times, self.way, self.turns.as_quat(), strict=True):
            log.message(truth, round(t * 1e9), odometry_message(round(t * 1e9), p, q))
        static = log.channel("/tf_static", "tf2_msgs/msg/TFMessage", "")
        log.message(static, 0, mounting_message(self.p_BS, self.R_BS.as_quat(), mounted))
        lidar = log.channel("/rover/lidar", "sensor_msgs/msg/PointCloud2", CLOUD)
        p_WB = numpy.stack([numpy.interp(self.seen_s, self.times, self.way[:, k]) for k in range(3)], axis=1)
        R_WB = Slerp(self.times, self.turns)(numpy.clip(self.seen_s, self.times[0], self.times[-1]))
        p_WS, R_WS = p_WB + R_WB.apply(self.p_BS), R_WB * self.R_BS
        p_S = R_WS.inv().apply(self.p_W - p_WS)
        for part in numpy.array_split(numpy.arange(self.count), 4):
            stamp_ns = round(self.seen_s[part[-1]] * 1e9)
            points = numpy.zeros(len(part), dtype=POINT)
            for k, name in enumerate("xyz"):
                points[name] = p_S[part, k]
            points["time"], points["ring"] = self.seen_s[part] - stamp_ns / 1e9, self.rings[part]
            points["intensity"], points["return_number"] = self.intensities[part], self.returns[part]
            log.message(lidar, stamp_ns, cloud_message(stamp_ns, points, frame))
            self.last = points
        other = log.channel("/rover/note", "std_msgs/msg/Header", "std_msgs/Header header\n" + HEADER)
        log.message(other, 0, Cdr().header(0).message())
        log.write(self.log)

    def run_export(self, *arguments, status=0):
        command = [VINEROW, "export", str(self.log), *map(str, arguments)]
        run = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=self.folder)
        self.assertEqual(run.returncode, status, run.stderr)
        return run

    def refused(self, *arguments) -> str:
        before = sorted(self.folder.rglob("*"))
        text = self.run_export(*arguments, status=2).stderr
        self.assertEqual(text.count("\n"), 1, text)
        self.assertEqual(sorted(self.folder.rglob("*")), before)
        return text

    def test_each_cloud_is_a_file_of_all_its_fields(self):
        self.write_log()
        run = self.run_export("--topic", "/rover/*", "--pcd", "-o", "scans")
        self.assertEqual(run.stdout, "scans/rover_lidar  4 clouds\n")
        with open(self.folder / "scans" / "rover_lidar.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["frame_id"], row["points"]) for row in rows], [("rover/lidar", "150")] * 4)
        self.assertEqual(rows[-1]["file"], "rover_lidar/000011000000000.pcd")
        points = pcd(self.folder / "scans" / rows[-1]["file"])
        self.assertEqual(points.dtype.names, POINT.names)
        for name in POINT.names:
            numpy.testing.assert_array_equal(points[name], self.last[name])
        self.run_export("--topic", "/rover/lidar", "--ply", "-o", "scans")
        seen = ply_positions(self.folder / "scans" / "rover_lidar" / "000011000000000.ply")
        numpy.testing.assert_array_equal(seen, positions(self.last))

    def test_all_clouds_become_one_in_the_map_by_the_pose_at_each_points_time(self):
        self.write_log()
        run = self.run_export("--topic", "/rover/lidar", "-o", "all.pcd")
        self.assertEqual(run.stdout, "all.pcd  600 points in the frame of the map, by /rover/truth\n")
        self.assertNotIn("left out", run.stderr)
        points = pcd(self.folder / "all.pcd")
        error_m = numpy.abs(positions(points) - self.p_W).max()
        print(f"points in the map: largest error {error_m:.1e} m")
        self.assertLess(error_m, 2e-5)  # of single precision, at 20 m and at turns of 2 rad/s
        numpy.testing.assert_allclose(points["time"], self.seen_s, atol=2e-8)
        numpy.testing.assert_array_equal(points["ring"], self.rings)
        self.run_export("--topic", "rover/lidar", "-o", "all.ply", "--poses", "rover/truth")
        numpy.testing.assert_array_equal(ply_positions(self.folder / "all.ply"), positions(points))

    def test_a_las_file_keeps_time_intensity_and_ring(self):
        self.write_log()
        run = self.run_export("--topic", "/rover/lidar", "-o", "new/all.las")
        self.assertEqual(run.stdout, "new/all.las  600 points in the frame of the map, by /rover/truth\n")
        las = laspy.read(self.folder / "new" / "all.las")
        self.assertEqual((str(las.header.version), las.header.point_format.id, las.header.point_count), ("1.2", 1, 600))
        self.assertLess(numpy.abs(las.xyz - self.p_W).max(), 1.2e-4)  # steps of 0.1 mm, and single precision in the log
        numpy.testing.assert_allclose(las.header.mins, las.xyz.min(axis=0), atol=1e-9)
        numpy.testing.assert_allclose(las.gps_time, self.seen_s, atol=2e-8)
        numpy.testing.assert_array_equal(las.user_data, self.rings)
        numpy.testing.assert_array_equal(numpy.array(las.return_number), self.returns)
        self.assertTrue((numpy.array(las.number_of_returns) >= self.returns).all())
        numpy.testing.assert_array_equal(las.header.number_of_points_by_return[:2], numpy.bincount(self.returns)[1:])
        expected = numpy.minimum(numpy.round(100 * self.intensities.astype(numpy.float32).astype(float)), 65535)
        numpy.testing.assert_array_equal(las.intensity, expected)

    def test_a_las_file_in_a_reference_system(self):
        """Against Krueger's series for the transverse Mercator projection, which is exact to nanometres."""
        out = self.folder / "run"
        scenario = pathlib.Path(__file__).resolve().parents[2] / "assets" / "scenarios" / "vineyard_scan.yaml"
        subprocess.run([VINEROW, "run", scenario, "--quiet", "--no-pictures", "--no-report", "--set", "duration_s=0.3", "--set", "criteria=[]",
                        "--out", out], check=True, capture_output=True)  # fmt: skip
        self.log = out / "log.mcap"
        self.run_export("--topic", "/rover/lidar", "-o", "map.las")
        self.run_export("--topic", "/rover/lidar", "-o", "utm.las", "--crs", "EPSG:32632")
        self.run_export("--topic", "/rover/lidar", "-o", "geographic.las", "--crs", "EPSG:4326")
        p_W, utm, lonlat = (laspy.read(self.folder / name).xyz for name in ("map.las", "utm.las", "geographic.las"))
        easting, northing = krueger(numpy.radians(lonlat[:, 1]), numpy.radians(lonlat[:, 0]), math.radians(9))
        self.assertLess(numpy.abs(utm[:, 0] - easting).max(), 2e-4)
        self.assertLess(numpy.abs(utm[:, 1] - northing).max(), 2e-4)
        # Lengths are those of the map, but for the projection's scale 2 degrees beside its meridian and 300 m up.
        pairs = numpy.random.default_rng(1).integers(0, len(p_W), (200, 2))
        lengths = [numpy.linalg.norm((points[pairs[:, 0]] - points[pairs[:, 1]])[:, :2], axis=1) for points in (p_W, utm)]
        ratios = (lengths[1] / lengths[0])[lengths[0] > 5]
        self.assertGreater(len(ratios), 20)
        self.assertLess(numpy.abs(ratios - 0.9996).max(), 2e-4)
        keys = [bytes(record.record_data_bytes()) for record in laspy.read(self.folder / "utm.las").header.vlrs]
        self.assertTrue(any((32632).to_bytes(2, "little") in key for key in keys))
        self.assertIn("crs = 'EPSG:99' is not a coordinate reference system", self.refused("--topic", "/rover/lidar", "-o", "n/x.las", "--crs", "EPSG:99"))

    def test_points_without_a_pose_are_left_out_and_counted(self):
        self.seen_s = self.seen_s + 0.5  # the last poses are half a second before the last points
        self.write_log()
        run = self.run_export("--topic", "/rover/lidar", "-o", "all.pcd")
        inside = self.seen_s <= self.times[-1]
        self.assertIn(f"{self.count - inside.sum()} points before the first or after the last pose of /rover/truth were left out", run.stderr)
        points = pcd(self.folder / "all.pcd")
        self.assertEqual(len(points), inside.sum())
        self.assertLess(numpy.abs(positions(points) - self.p_W[inside]).max(), 2e-5)

    def test_a_span_selects_clouds(self):
        self.write_log()
        run = self.run_export("--topic", "/rover/lidar", "--from", "10.4", "--to", "10.8", "-o", "all.ply")
        self.assertIn("300 points", run.stdout)

    def test_what_is_missing_is_said_and_nothing_is_written(self):
        self.write_log()
        self.assertIn("topic '/rover/note' has no clouds, it is of type std_msgs/msg/Header", self.refused("--topic", "/rover/note", "--pcd"))
        self.assertIn("none of the topics has clouds", self.refused("--topic", "/rover/n*", "--ply"))
        self.assertIn("topic '/rover/note' has no clouds", self.refused("--topic", "/rover/note", "-o", "x.ply"))
        self.assertIn("no topic '/rover/gone'", self.refused("--topic", "/rover/lidar", "-o", "x.ply", "--poses", "/rover/gone"))
        self.assertIn("has clouds of 'rover', whose poses '/drone/truth' does not hold", self.refused("--topic", "/rover/lidar", "-o", "x.ply", "--poses", "/drone/truth"))
        self.assertIn("-o must be a .pcd, .ply or .las file", self.refused("--topic", "/rover/lidar", "--ply", "--poses", "/rover/truth"))
        self.assertIn("--crs is that of a LAS file, -o must be a .las file", self.refused("--topic", "/rover/lidar", "-o", "x.ply", "--crs", "EPSG:32632"))
        self.assertIn("-o is a .las file, with --pcd it must be a folder or a .pcd file", self.refused("--topic", "/rover/lidar", "--pcd", "-o", "x.las"))
        self.assertIn("--pcd excludes --ply", self.refused("--topic", "/rover/lidar", "--ply", "--pcd"))
        self.assertIn("-o is a .ply file, with --pcd it must be a folder or a .pcd file", self.refused("--topic", "/rover/lidar", "--pcd", "-o", "x.ply"))
        self.assertIn("--ply cannot be printed to the terminal", self.refused("--topic", "/rover/lidar", "--ply", "-o", "-"))
        self.assertIn("has no clouds between --from and --to", self.refused("--topic", "/rover/lidar", "--from", "10.3", "--to", "10.4", "-o", "x.ply"))
        self.write_log(frame="rover/nose")
        self.assertIn("has clouds in the frame 'rover/nose', which /tf_static does not place on a vehicle", self.refused("--topic", "/rover/lidar", "-o", "x.pcd"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
