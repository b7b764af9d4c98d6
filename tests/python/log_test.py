#!/usr/bin/env python3
"""vinerow.read_log: the arrays of a log are what the command exports, and what a session had.

    log_test.py VINEROW
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

import vinerow

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIO = ROOT / "assets" / "scenarios" / "riseholme_rover.yaml"
VINEROW = sys.argv[1]


class Logs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        subprocess.run([VINEROW, "run", SCENARIO, "--quiet", "--no-pictures", "--no-report", "--out", cls.out,
                        "--set", "duration_s=4", "--set", "criteria=[]"], check=True, capture_output=True)
        cls.log = vinerow.read_log(cls.out / "log.mcap")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_columns_have_the_values_of_the_session(self):
        truth = self.log["rover/truth"]
        self.assertEqual(truth.type, "Odometry")
        count = len(truth.stamp_s)
        self.assertEqual(truth.pose.position.shape, (count, 3))
        self.assertEqual(truth.pose.orientation.shape, (count, 4))
        self.assertEqual(truth.yaw_std.shape, (count,))
        with vinerow.open(SCENARIO, {"duration_s": 4, "criteria": []}) as session:
            signal = session.signal("rover/truth")
            for k in range(0, count, 10):
                session.step(truth.stamp_s[k])
                numpy.testing.assert_array_equal(signal["pose"].position, truth.pose.position[k])
                numpy.testing.assert_array_equal(signal["pose"].orientation, truth.pose.orientation[k])
                numpy.testing.assert_array_equal(signal["linear_velocity"], truth.linear_velocity[k])

    def test_columns_have_the_values_of_the_exported_arrays(self):
        file = self.out / "truth.npz"
        subprocess.run([VINEROW, "export", self.out / "log.mcap", "--topic", "/rover/truth", "--npz", "--out", file], check=True,
                       capture_output=True)
        exported, truth = numpy.load(file), self.log["rover/truth"]
        numbers = [exported[name] for name in exported.files if exported[name].dtype.kind == "f"]
        ours = numpy.column_stack([truth.pose.position, truth.pose.orientation, truth.linear_velocity])
        found = [any(numpy.array_equal(column, numbers_of) for numbers_of in numbers) for column in ours.T]
        self.assertTrue(all(found), f"{found} of {exported.files}")

    def test_lists_and_texts(self):
        plan = self.log["rover/plan"]
        self.assertEqual(len(plan.points), len(plan.stamp_s))
        points = plan.points[0]
        self.assertEqual(points.position.shape[1], 3)
        self.assertEqual(len(points.kind), len(points.position))
        self.assertIn("LEG", points.kind)
        events = self.log["run/events"]
        self.assertEqual(events.text[0], "started 'riseholme_rover'")
        self.assertEqual(events.level[0], "INFO")

    def test_several_signals_are_read_in_one_pass(self):
        names = ["rover/truth", "run/events", "/rover/plan"]
        together = self.log.read(names)
        self.assertEqual(list(together), names)
        for name in names:
            alone = self.log[name]
            self.assertEqual(together[name].type, alone.type)
            numpy.testing.assert_array_equal(together[name].stamp_s, alone.stamp_s)
        numpy.testing.assert_array_equal(together["rover/truth"].pose.position, self.log["rover/truth"].pose.position)
        self.assertEqual(together["run/events"].text, self.log["run/events"].text)
        self.assertEqual(self.log.read([]), {})
        for wrong, sentence in (("rover/truth", "topics must be a list of names, not str"), (3, "topics must be a list of names, not int"),
                                ([7], "a topic must be a str, not int")):
            with self.assertRaisesRegex(vinerow.ConfigError, f"^{sentence}$"):
                self.log.read(wrong)
        with self.assertRaisesRegex(KeyError, "did you mean 'rover/truth'"):
            self.log.read(["run/events", "rover/truht"])

    def test_topics(self):
        topics = self.log.topics()
        self.assertEqual(topics["rover/truth"], ("Odometry", len(self.log["rover/truth"].stamp_s)))
        self.assertIn("rover/truth", self.log)
        self.assertTrue(self.log.complete)

    def test_mistakes(self):
        with self.assertRaisesRegex(KeyError, "did you mean 'rover/truth'"):
            self.log["rover/truht"]
        with self.assertRaisesRegex(vinerow.ConfigError, "none.mcap"):
            vinerow.read_log("none.mcap")
        other = self.out / "other.mcap"
        other.write_text("text")
        with self.assertRaisesRegex(vinerow.ConfigError, "not an MCAP file"):
            vinerow.read_log(other)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
