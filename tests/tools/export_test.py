#!/usr/bin/env python3
"""`vinerow export` against logs written by hand: CSV read by the csv module, arrays by numpy.

    export_test.py VINEROW
"""

import csv
import io
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zipfile
import zlib

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from mcap_file import CLOUD, HEADER, Cdr, Log  # noqa: E402

try:
    import numpy
except ImportError:
    print("skipped: numpy is absent")
    sys.exit(77)

VINEROW = sys.argv[1]

POINT = """
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
"""

KINDS = """std_msgs/Header header
# a comment
int8 LIMIT=-128  # a constant
bool on
byte raw
int8 a
uint8 b
int16 c
uint16 d
int32 e
uint32 f
int64 g
uint64 h
float32 r
float64 s 1.5
string<=80 words
geometry_msgs/Point[2] corners
int32[3] triple
float32[] ranges
string[<=4] labels
""" + HEADER + POINT

NAMED = "std_msgs/Header header\nstring[] name\nfloat64[] value\n" + HEADER
PATH = "std_msgs/Header header\nfloat64 length\nKnot[] knots\nfloat64[] weight\n" + HEADER + """
===
MSG: test_msgs/Knot
Point position
int32[] tags
===
MSG: test_msgs/Point
float64 x
float64 y
"""

# All stand at a limit of their type, or do not fit a shorter one.
VALUES = [
    {"on": True, "raw": 200, "a": -128, "b": 255, "c": -32768, "d": 65535, "e": -(2**31), "f": 2**32 - 1,
     "g": -(2**63), "h": 2**64 - 1, "r": 0.1, "s": 0.1 + 0.2, "words": 'say "hi", ümläut\nnext',
     "corners": [1, 2, 3, 4, 5, 6], "triple": [7, -8, 9], "ranges": [1.5, math.inf, -0.25], "labels": ["x", "y,z"]},
    {"on": False, "raw": 0, "a": 127, "b": 0, "c": 32767, "d": 0, "e": 2**31 - 1, "f": 0,
     "g": 2**63 - 1, "h": 0, "r": math.nan, "s": 5e-324, "words": "", "corners": [0] * 6,
     "triple": [0, 0, 0], "ranges": [-math.inf], "labels": []},
]  # fmt: skip


def kinds_message(stamp_ns: int, v: dict) -> bytes:
    cdr = Cdr().header(stamp_ns, "rover/base_link")
    cdr.add("?", v["on"]).add("B", v["raw"]).add("b", v["a"]).add("B", v["b"]).add("h", v["c"]).add("H", v["d"])
    cdr.add("i", v["e"]).add("I", v["f"]).add("q", v["g"]).add("Q", v["h"]).add("f", v["r"]).add("d", v["s"])
    cdr.text(v["words"]).add("d", *v["corners"]).add("i", *v["triple"])
    cdr.add("I", len(v["ranges"])).add("f", *v["ranges"]).add("I", len(v["labels"]))
    for label in v["labels"]:
        cdr.text(label)
    return cdr.message()


def named_message(stamp_ns: int, pairs: list) -> bytes:
    cdr = Cdr().header(stamp_ns).add("I", len(pairs))
    for name, _ in pairs:
        cdr.text(name)
    return cdr.add("I", len(pairs)).add("d", *[value for _, value in pairs]).message()


def path_message(stamp_ns: int, length: float, knots: list, weights: list) -> bytes:
    cdr = Cdr().header(stamp_ns).add("d", length).add("I", len(knots))
    for x, y, tags in knots:
        cdr.add("d", x, y).add("I", len(tags)).add("i", *tags)
    return cdr.add("I", len(weights)).add("d", *weights).message()


def same(a: float, b: float) -> bool:
    return a == b or (math.isnan(a) and math.isnan(b))


class Export(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.log = self.folder / "log.mcap"

    def run_export(self, *arguments, status=0):
        command = [VINEROW, "export", str(self.log), *map(str, arguments)]
        run = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=self.folder)
        self.assertEqual(run.returncode, status, run.stderr)
        return run

    def table(self, topic: str, *arguments):
        text = self.run_export("--topic", topic, "-o", "-", *arguments).stdout
        return list(csv.DictReader(io.StringIO(text, newline="")))

    def arrays(self, topic: str, *arguments):
        file = self.folder / "x.npz"
        self.run_export("--topic", topic, "-o", file, *arguments)
        with zipfile.ZipFile(file) as packed:
            self.assertIsNone(packed.testzip())
        return numpy.load(file, allow_pickle=False)

    def write_kinds(self):
        log = Log()
        channel = log.channel("/rover/kinds", "test_msgs/msg/Kinds", KINDS)
        # Recorded in another order than stamped: tables are in the order of the stamps.
        log.message(channel, 2_000_000_001, kinds_message(2_000_000_001, VALUES[1]), 2_100_000_000)
        log.message(channel, 1_050_000_000, kinds_message(1_050_000_000, VALUES[0]), 2_200_000_000)
        log.channel("/empty", "test_msgs/msg/Kinds", KINDS)
        log.write(self.log)

    def test_csv_holds_every_kind_of_field(self):
        self.write_kinds()
        rows = self.table("/rover/kinds")
        self.assertEqual([r["time_s"] for r in rows], ["1.05", "2.000000001"])
        self.assertEqual([r["logged_s"] for r in rows], ["2.2", "2.1"])
        for row, v in zip(rows, VALUES):
            self.assertEqual(row["header.frame_id"], "rover/base_link")
            self.assertEqual(row["on"], str(v["on"]))
            for name in ["raw", "a", "b", "c", "d", "e", "f", "g", "h"]:
                self.assertEqual(int(row[name]), v[name], name)
            self.assertTrue(same(float(row["s"]), v["s"]))
            self.assertTrue(same(numpy.float32(row["r"]), numpy.float32(v["r"])))
            self.assertEqual(row["words"], v["words"])
            corners = [float(row[f"corners[{i}].{axis}"]) for i in range(2) for axis in "xyz"]
            self.assertEqual(corners, v["corners"])
            self.assertEqual([int(row[f"triple[{i}]"]) for i in range(3)], v["triple"])
            ranges = [row[f"ranges[{i}]"] for i in range(3)]
            self.assertEqual([float(r) for r in ranges if r != ""], v["ranges"])
            self.assertEqual([row[f"labels[{i}]"] for i in range(2)], (v["labels"] + ["", ""])[:2])
        self.assertNotIn("LIMIT", rows[0])
        self.assertNotIn("header.stamp", rows[0])

    def test_npz_holds_the_same_in_the_types_of_the_definition(self):
        self.write_kinds()
        arrays = self.arrays("/rover/kinds")
        types = {"on": "?", "raw": "u1", "a": "i1", "b": "u1", "c": "i2", "d": "u2", "e": "i4", "f": "u4", "g": "i8", "h": "u8",
                 "r": "f4", "s": "f8", "triple": "i4", "ranges": "f4", "time_s": "f8"}  # fmt: skip
        for name, code in types.items():
            self.assertEqual(arrays[name].dtype, numpy.dtype(code), name)
        self.assertEqual(arrays["time_s"].tolist(), [1.05, 2.000000001])
        for name in ["on", "raw", "a", "b", "c", "d", "e", "f", "g", "h", "words", "triple"]:
            self.assertEqual(arrays[name].tolist(), [v[name] for v in VALUES], name)
        numpy.testing.assert_array_equal(arrays["s"], [v["s"] for v in VALUES])
        numpy.testing.assert_array_equal(arrays["r"], numpy.array([v["r"] for v in VALUES], "f4"))
        ragged = [[1.5, math.inf, -0.25], [-math.inf, math.nan, math.nan]]
        numpy.testing.assert_array_equal(arrays["ranges"], numpy.array(ragged, "f4"))
        self.assertEqual(arrays["labels"].tolist(), [["x", "y,z"], ["", ""]])
        self.assertEqual(arrays["corners[1].z"].tolist(), [6, 0])

    def test_names_and_values_give_a_column_for_each_name(self):
        log = Log()
        channel = log.channel("/rover/wheels", "vinerow_msgs/msg/NamedValues", NAMED)
        log.message(channel, 10**9, named_message(10**9, [("left_radps", 1.0), ("time_s", 9.0)]))
        log.message(channel, 2 * 10**9, named_message(2 * 10**9, [("right_radps", -2.5), ("left_radps", 3.0)]))
        log.write(self.log)
        rows = self.table("/rover/wheels")
        self.assertEqual(list(rows[0]), ["time_s", "logged_s", "header.frame_id", "left_radps", "time_s_", "right_radps"])
        self.assertEqual([r["left_radps"] for r in rows], ["1", "3"])
        self.assertEqual([r["right_radps"] for r in rows], ["", "-2.5"])
        arrays = self.arrays("/rover/wheels")
        numpy.testing.assert_array_equal(arrays["right_radps"], [math.nan, -2.5])
        long = self.table("/rover/wheels", "--long")
        self.assertEqual([(r["time_s"], r["element"], r["name"], r["value"]) for r in long],
                         [("1.0", "0", "left_radps", "1"), ("1.0", "1", "time_s", "9"),
                          ("2.0", "0", "right_radps", "-2.5"), ("2.0", "1", "left_radps", "3")])  # fmt: skip

    def test_a_cloud_gives_a_row_for_each_point_and_a_column_for_each_field(self):
        # As numpy lays out such a point, with a gap; two lines of two points with bytes to spare.
        point = numpy.dtype({"names": ["x", "ring", "t"], "formats": ["<f4", "<u2", "<f8"], "offsets": [0, 4, 8], "itemsize": 20})
        points = numpy.array([[(1.5, 3, 0.25), (2.5, 65535, -1.0)], [(-4.0, 0, 1e300), (0.125, 7, 2.0)]], dtype=point)

        def cloud(stamp_ns, data, width=2, height=2, step=20, row_step=44, big_endian=False):
            message = Cdr().header(stamp_ns).add("I", height, width, 4)
            for name, offset, kind, count in (("x", 0, 7, 1), ("ring", 4, 4, 1), ("t", 8, 8, 1), ("spare", 16, 2, 4)):
                message.text(name).add("I", offset).add("B", kind).add("I", count)
            message.add("?", big_endian).add("I", step, row_step, len(data))
            message.data += data
            return message.add("?", True).message()

        data = b"".join(line.tobytes() + bytes(4) for line in points)
        log = Log()
        channel = log.channel("/lidar", "sensor_msgs/msg/PointCloud2", CLOUD)
        log.message(channel, 10**9, cloud(10**9, data))
        log.message(channel, 2 * 10**9, cloud(2 * 10**9, b"", width=0))
        for wrong in ({"row_step": 39}, {"row_step": 0, "height": 2**32 - 1}, {"step": 12}, {"width": 2**31}, {"big_endian": True}, {"step": 0}):
            log.message(channel, 3 * 10**9, cloud(3 * 10**9, data, **wrong))
        log.write(self.log)
        rows = self.table("/lidar")
        self.assertEqual(list(rows[0]), ["time_s", "logged_s", "element", "header.frame_id", "x", "ring", "t"])
        self.assertEqual([(r["time_s"], r["element"], r["ring"]) for r in rows],
                         [("1.0", "0", "3"), ("1.0", "1", "65535"), ("1.0", "2", "0"), ("1.0", "3", "7"), ("2.0", "0", "")])  # fmt: skip
        arrays = self.arrays("/lidar")
        for name in ("x", "t"):
            numpy.testing.assert_array_equal(arrays[name][:4], points[name].ravel())
        run = self.run_export("--topic", "/lidar", "-o", "-")
        self.assertIn("6 messages of topic '/lidar' are not of type", run.stderr)

    def test_pictures_become_files_with_a_list_of_them(self):
        # A PNG of one grey pixel by hand, by the letter of its specification.
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0))
        png += chunk(b"IDAT", zlib.compress(b"\0\x7f")) + chunk(b"IEND", b"")
        log = Log()
        channel = log.channel("/rover/front", "sensor_msgs/msg/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n" + HEADER)
        for stamp, data in ((10**9, png), (1_500_000_000, b"\xff\xd8\xff\xe0 as a JPEG begins"), (2 * 10**9, b"neither")):
            message = Cdr().header(stamp).text('mono8; "png"').add("I", len(data))
            message.data += data
            log.message(channel, stamp, message.message())
        log.write(self.log)
        folder = self.log.parent / "pictures"
        run = self.run_export("--topic", "/rover/front", "-o", folder)
        self.assertIn("2 pictures", run.stdout)
        self.assertIn("1 messages of topic '/rover/front' are not of type", run.stderr)
        with open(folder / "rover_front.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(r["time_s"], r["format"], r["file"]) for r in rows],
                         [("1", 'mono8; "png"', "rover_front/000001000000000.png"), ("1.5", 'mono8; "png"', "rover_front/000001500000000.jpg")])  # fmt: skip
        self.assertEqual((folder / rows[0]["file"]).read_bytes(), png)
        self.assertEqual(len(list((folder / "rover_front").iterdir())), 2)
        refused = self.run_export("--topic", "/rover/front", "-o", folder / "one.csv", status=2).stderr
        self.assertIn("topic '/rover/front' has pictures, -o must be a folder", refused)
        self.assertEqual(self.arrays("/rover/front")["data"].shape, (3, len(png)))
        both = self.log.parent / "both"
        self.run_export("--topic", "/rover/front", "--csv", "--npz", "-o", both)
        self.assertEqual((both / "rover_front/000001000000000.png").read_bytes(), png)
        self.assertTrue((both / "rover_front.npz").exists())

    def test_pictures_become_arrays_of_their_pixels(self):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        def png(pixels):  # by the letter of its specification: no filter, the higher byte first
            height, width = pixels.shape[:2]
            head = struct.pack(">IIBBBBB", width, height, 8 * pixels.itemsize, 2 if pixels.ndim == 3 else 0, 0, 0, 0)
            rows = b"".join(b"\0" + row.astype(pixels.dtype.newbyteorder(">")).tobytes() for row in pixels)
            return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")

        random = numpy.random.default_rng(1)
        for shape, dtype in (((2, 4, 3), numpy.uint8), ((3, 2), numpy.uint8), ((2, 3), numpy.uint16)):
            pictures = random.integers(0, numpy.iinfo(dtype).max, (2, *shape), dtype)
            for others in (False, True):
                log = Log()
                channel = log.channel("/rover/front", "sensor_msgs/msg/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n" + HEADER)
                files = [png(picture) for picture in pictures] + ([png(pictures[0][:1])] if others else [])
                for k, data in enumerate(files):
                    message = Cdr().header((k + 1) * 10**9).text("png").add("I", len(data))
                    message.data += data
                    log.message(channel, (k + 1) * 10**9, message.message())
                log.write(self.log)
                arrays = self.arrays("/rover/front")
                self.assertEqual("data" in arrays, others)  # of several sizes: the files as they are
                if not others:
                    self.assertEqual(arrays["pixels"].dtype, dtype)
                    numpy.testing.assert_array_equal(arrays["pixels"], pictures)

    def test_a_sequence_of_messages_gives_a_row_for_each_element(self):
        log = Log()
        channel = log.channel("/rover/plan", "test_msgs/msg/Path", PATH)
        log.message(channel, 10**9, path_message(10**9, 8.0, [(1, 2, [5]), (3, 4, [6, 7])], [0.5, 0.25, 0.125]))
        log.message(channel, 2 * 10**9, path_message(2 * 10**9, 0.0, [], []))
        log.write(self.log)
        rows = self.table("/rover/plan")
        # As pandas' explode(): an empty sequence leaves a row, what is shorter leaves cells empty.
        wanted = [
            ("1.0", "0", "8", "1", "2", "5", "", "0.5"),
            ("1.0", "1", "8", "3", "4", "6", "7", "0.25"),
            ("1.0", "2", "8", "", "", "", "", "0.125"),
            ("2.0", "0", "0", "", "", "", "", ""),
        ]
        names = ["time_s", "element", "length", "knots.position.x", "knots.position.y", "knots.tags[0]", "knots.tags[1]", "weight"]
        self.assertEqual([tuple(r[n] for n in names) for r in rows], wanted)
        arrays = self.arrays("/rover/plan")
        nan = math.nan
        numpy.testing.assert_array_equal(arrays["knots.tags"], [[5, nan], [6, 7], [nan, nan], [nan, nan]])
        self.assertEqual(arrays["element"].tolist(), [0, 1, 2, 0])

    def test_a_topic_without_messages_has_its_columns(self):
        self.write_kinds()
        text = self.run_export("--topic", "/empty", "-o", "-").stdout
        columns = text.strip().split(",")
        self.assertEqual(columns[:4], ["time_s", "logged_s", "header.frame_id", "on"])
        self.assertEqual(text.count("\n"), 1)
        self.assertEqual(self.arrays("/empty")["s"].shape, (0,))

    def test_from_and_to_are_inclusive(self):
        self.write_kinds()
        self.assertEqual(len(self.table("/rover/kinds", "--from", "1.05", "--to", "2.000000001")), 2)
        self.assertEqual(len(self.table("/rover/kinds", "--from", "1.06")), 1)
        self.assertEqual(len(self.table("/rover/kinds", "--to", "1.04")), 0)

    def test_a_span_that_no_message_lies_in_is_refused(self):
        self.write_kinds()
        late = self.run_export("--topic", "/rover/kinds", "--from", "500", status=2).stderr
        self.assertIn("export: --from 500 s is after the end of", late)
        turned = self.run_export("--topic", "/rover/kinds", "--from", "2", "--to", "1.5", status=2).stderr
        self.assertIn("export: --from 2 s is after --to 1.5 s", turned)
        none = self.run_export("--topic", "/rover/kinds", "--from", "nan", status=2).stderr
        self.assertIn("export: --from and --to must be times in s", none)

    def test_a_file_of_another_format_is_refused(self):
        self.write_kinds()
        out = self.folder / "cloud.laz"
        refused = self.run_export("--topic", "/rover/kinds", "-o", str(out), status=2).stderr
        self.assertEqual(refused, f"vinerow: export: -o '{out}' must be a file .csv, .npz, .pcd, .ply or .las, - for the terminal, or a folder\n")
        self.assertFalse(out.exists())
        out.mkdir()
        self.run_export("--topic", "/rover/kinds", "-o", str(out))
        self.assertEqual([file.name for file in out.iterdir()], ["rover_kinds.csv"])

    def test_a_log_that_is_cut_off_says_so(self):
        scenario = pathlib.Path(__file__).parents[2] / "assets" / "scenarios" / "vineyard_rover.yaml"
        subprocess.run([VINEROW, "run", scenario, "--out", self.folder, "--quiet", "--no-pictures", "--no-report",
                        "--set", "duration_s=0.2", "--set", "criteria=[]"], check=True)
        self.assertEqual(self.run_export("--topic", "/rover/truth", "-o", "-").stderr, "")
        self.log.write_bytes(self.log.read_bytes()[:-40])
        cut = self.run_export("--topic", "/rover/truth", "-o", "-")
        self.assertEqual(cut.stderr, f"vinerow: '{self.log}' is cut off: what was written before is exported\n")

    def test_patterns_give_a_file_for_each_topic_in_the_folder_alone(self):
        log = Log()
        for topic in ["/a/x", "/a_x", "/../../escape", "/b"]:
            log.message(log.channel(topic, "vinerow_msgs/msg/NamedValues", NAMED), 0, named_message(0, []))
        log.write(self.log)
        self.run_export("--topic", "*", "--csv", "--npz", "-o", "out")
        there = sorted(f.relative_to(self.folder).as_posix() for f in self.folder.rglob("*") if f.is_file())
        stems = ["______escape", "a_x", "a_x_2", "b"]
        self.assertEqual(there, sorted(["log.mcap"] + [f"out/{s}.{e}" for s in stems for e in ["csv", "npz"]]))

    def test_topics_that_do_not_fit_into_memory_together_are_those_of_their_own_export(self):
        # 58 + 58 + 29 MB, of which 128 MB fit. The first messages of the third are not typical.
        log = Log()
        random = numpy.random.default_rng(1)
        channels = [log.channel(f"/scan/{k}", "test_msgs/msg/Scan", "float64[] ranges\n") for k in range(4)]
        for i in range(12):
            for k, channel in enumerate(channels):
                count = 3 if k == 3 else 1_000 if k == 2 and i < 6 else 600_000
                data = bytes(4) + random.random(count).tobytes()
                log.message(channel, i, b"\x00\x01\x00\x00" + struct.pack("<I", count) + data)
        log.write(self.log)
        self.run_export("--topic", "/scan/*", "--npz", "-o", "all")
        for k in range(4):
            self.run_export("--topic", f"/scan/{k}", "-o", f"one_{k}.npz")
            self.assertEqual((self.folder / f"all/scan_{k}.npz").read_bytes(), (self.folder / f"one_{k}.npz").read_bytes())
        self.assertEqual(numpy.load(self.folder / "all/scan_2.npz")["ranges"].shape, (12, 600_000))

    def test_nothing_is_written_if_a_topic_cannot_be_decoded(self):
        log = Log()
        log.message(log.channel("/a", "vinerow_msgs/msg/NamedValues", NAMED), 0, named_message(0, []))
        log.channel("/b", "vinerow_msgs/msg/NamedValues", NAMED, "json")
        log.channel("/c", "test_msgs/msg/Bad", "a/B x\n")
        log.write(self.log)
        self.assertIn("topic '/b' has messages of encoding 'json'", self.run_export("--topic", "*", "-o", "out", status=2).stderr)
        self.assertIn("names the type 'a/B'", self.run_export("--topic", "/a", "--topic", "/c", "-o", "out", status=2).stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_without_such_a_topic_the_nearest_are_named(self):
        self.write_kinds()
        run = self.run_export("--topic", "/rover/kind", status=2)
        self.assertIn("no topic '/rover/kind' (nearest: /rover/kinds, /empty", run.stderr)
        self.assertEqual(run.stderr.count("\n"), 1)
        self.assertEqual(len(self.table("rover/kinds")), 2, "the first / may be left out")

    def test_damaged_messages_are_told_and_left_out(self):
        log = Log()
        channel = log.channel("/x", "test_msgs/msg/Kinds", KINDS)
        whole = kinds_message(0, VALUES[0])
        for size in range(0, len(whole), 7):
            log.message(channel, 0, whole[:size])
        huge = Cdr().header(0).add("I", 0xFFFFFFFF).message()
        named = log.channel("/y", "vinerow_msgs/msg/NamedValues", NAMED)
        log.message(named, 0, huge)
        log.message(named, 0, named_message(0, [("a", 1.0)]))
        log.write(self.log)
        run = self.run_export("--topic", "/x", "-o", "-")
        self.assertIn(f"{len(range(0, len(whole), 7))} messages of topic '/x' are not of type", run.stderr)
        self.assertEqual(len(self.table("/y")), 1)

    def test_text_that_is_no_utf8_is_replaced(self):
        log = Log()
        channel = log.channel("/x", "test_msgs/msg/Text", "string words\n")
        for word in [b"\xff\xc0\xafend", b"\xed\xa0\x80", "€𝄞".encode(), b"cut \xe2\x82"]:
            log.message(channel, 0, Cdr().text(word).message())
        log.write(self.log)
        wanted = [w.decode(errors="replace") for w in [b"\xff\xc0\xafend", b"\xed\xa0\x80", "€𝄞".encode()]]
        # Python makes one mark of a cut sequence, we one of each byte.
        wanted.append("cut \ufffd\ufffd")
        self.assertEqual([r["words"] for r in self.table("/x")], wanted)
        self.assertEqual(self.arrays("/x")["words"].tolist(), wanted)

    def test_definitions_that_cannot_be_read_are_refused_in_one_sentence(self):
        cases = {
            "a/B x\n": "names the type 'a/B', which it does not hold",
            "float64\n": "has the line 'float64', must be a type and a name",
            "a/B x\n===\nMSG: a/B\na/B again\n": "has the type 'a/B', which holds itself",
            "float64[x] y\n": "has the type 'float64[x]'",
            "a/T0 x\n" + "".join(f"===\nMSG: a/T{i}\na/T{i + 1} x\n" for i in range(100)): "is deeper than 64",
        }
        for definition, words in cases.items():
            log = Log()
            log.channel("/x", "test_msgs/msg/Bad", definition)
            log.write(self.log)
            run = self.run_export("--topic", "/x", "-o", "-", status=2)
            self.assertIn(words, run.stderr)
            self.assertEqual(run.stderr.count("\n"), 1)

    def test_a_table_of_too_many_columns_is_refused_and_left_out_of_patterns(self):
        log = Log()
        channel = log.channel("/map", "test_msgs/msg/Map", "int8[] data\n")
        log.message(channel, 0, Cdr().add("I", 70_000).add("b", *([-1] * 70_000)).message())
        log.write(self.log)
        run = self.run_export("--topic", "/map", "-o", "-", status=2)
        self.assertIn("/map: has 70003 columns", run.stderr)
        self.assertIn("left out /map", self.run_export("--topic", "/m*").stderr)
        self.assertEqual(self.arrays("/map")["data"].shape, (1, 70_000))
        self.assertEqual(len(self.table("/map", "--long")), 70_000)

    def test_formats_that_do_not_fit_the_file_are_refused(self):
        self.write_kinds()
        for arguments in [["--npz", "-o", "x.csv"], ["--csv", "-o", "x.npz"], ["--npz", "-o", "-"]]:
            self.assertIn("must be", self.run_export("--topic", "/empty", *arguments, status=2).stderr)
        self.assertIn("one file for 2 topics", self.run_export("--topic", "*", "-o", "x.csv", status=2).stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
