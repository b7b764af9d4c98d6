#!/usr/bin/env python3
"""vinerow.run and vinerow.Run: the files of the command, read back; pictures, tables and HTML of results.

    run_test.py VINEROW
"""

import contextlib
import html
import html.parser
import io
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy
from PIL import Image

import vinerow

ROOT = pathlib.Path(__file__).resolve().parents[2]
VINEROW = sys.argv[1]
# A vehicle, pictures, a criterion that fails, and a survey's camera, for which the command draws the coverage.
SCENARIO = ROOT / "assets" / "scenarios" / "riseholme_rover.yaml"
CHANGES = {"duration_s": 3, "criteria": [{"metric": "rover.cross_track_max_m", "max": 0.2}, {"metric": "rover.distance_m", "min": 100}],
           "pictures.width": 320, "pictures.height": 180}
FREE_ROVER = ROOT / "docs" / "examples" / "session" / "free_rover.yaml"
SURVEY = ROOT / "assets" / "scenarios" / "survey_still.yaml"
SURVEY_CHANGES = {"duration_s": 120, "criteria": [], "pictures.width": 160, "pictures.height": 90}


def run_of_the_command(scenario: pathlib.Path, changes: dict, out: pathlib.Path) -> None:
    sets = [word for key, value in changes.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    done = subprocess.run([VINEROW, "run", scenario, "--quiet", "--out", out, *sets], capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr


def without_times(file: pathlib.Path) -> bytes:
    """Contents of a file without what differs between two runs: wall-clock times and the folder's name."""
    text = file.read_bytes()
    if file.name == "summary.json":
        summary = json.loads(text)
        for task in summary["cost"]:
            del task["wall_s"], task["us_per_tick"]
        del summary["wall_s"], summary["real_time_factor"]
        summary["pictures"] = [pathlib.Path(picture).name for picture in summary["pictures"]]
        return json.dumps(summary).encode()
    if file.name == "report.html":
        return re.sub(b"Only this part of the page depends on the machine.*?</section>", b"", text, count=1, flags=re.DOTALL)
    return text


class Strict(html.parser.HTMLParser):
    """Fails on elements that are not closed in order, and collects what is shown."""

    VOID = {"img", "br", "meta"}

    def __init__(self, text: str):
        super().__init__()
        self.open, self.tags, self.words = [], [], []
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        self.words.append(data)


class Runs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.stack = contextlib.ExitStack()
        cls.out = pathlib.Path(cls.stack.enter_context(tempfile.TemporaryDirectory()))
        cls.run_ = vinerow.run(SCENARIO, CHANGES, out=cls.out / "python")
        run_of_the_command(SCENARIO, CHANGES, cls.out / "command")

    @classmethod
    def tearDownClass(cls):
        cls.stack.close()

    def compare_folders(self, ours: pathlib.Path, wanted: pathlib.Path) -> None:
        names = sorted(file.relative_to(wanted) for file in wanted.rglob("*") if file.is_file())
        self.assertEqual(sorted(file.relative_to(ours) for file in ours.rglob("*") if file.is_file()), names)
        for name in names:
            self.assertEqual(without_times(ours / name), without_times(wanted / name), name)

    def test_the_folder_is_that_of_the_command(self):
        self.compare_folders(self.out / "python", self.out / "command")
        self.assertGreater(len(list((self.out / "command" / "frames").iterdir())), 3)

    def test_coverage_of_a_survey_is_drawn_too(self):
        vinerow.run(SURVEY, SURVEY_CHANGES, out=self.out / "survey", report=False)
        run_of_the_command(SURVEY, SURVEY_CHANGES, self.out / "survey_command")
        (self.out / "survey_command" / "report.html").unlink()
        self.compare_folders(self.out / "survey", self.out / "survey_command")
        self.assertIn("coverage", vinerow.read_run(self.out / "survey").pictures)

    def test_results(self):
        run = vinerow.read_run(self.out / "command")
        summary = json.loads((self.out / "command" / "summary.json").read_text())
        self.assertEqual((run.digest, run.seed, run.name), (summary["digest"], 1, "riseholme_rover"))
        self.assertEqual((run.met, run.verdict, run.error, run.missing), (False, "a criterion failed", "", []))
        self.assertEqual([(c.metric, c.kind, c.limit, c.met) for c in run.criteria],
                         [("rover.cross_track_max_m", "max", 0.2, True), ("rover.distance_m", "min", 100.0, False)])
        self.assertEqual(run.metrics["rover"]["distance_m"], summary["metrics"]["rover"]["distance_m"])
        self.assertTrue(math.isnan(run.metrics["rover"]["turn_deviation_max_m"]))
        self.assertEqual(run.scenario, (self.out / "command" / "scenario.resolved.yaml").read_text())
        log_events = run.log["run/events"]
        self.assertEqual([(e.time_s, e.level, e.text) for e in run.events],
                         list(zip(log_events.stamp_s, log_events.level, log_events.text)))
        self.assertEqual(run.report, self.out / "command" / "report.html")
        self.assertIsNone(run.replay)

    def test_pictures_are_the_pixels_of_the_files(self):
        pictures = self.run_.pictures
        self.assertEqual(sorted(pictures), sorted(file.stem for file in (self.out / "python" / "frames").iterdir()))
        for name in pictures:
            picture = pictures[name]
            self.assertEqual((picture.shape, picture.dtype), ((180, 320, 3), numpy.uint8))
            with Image.open(pictures.file(name)) as wanted:
                numpy.testing.assert_array_equal(picture, numpy.asarray(wanted.convert("RGB")))
        with Image.open(io.BytesIO(picture._repr_png_())) as shown:
            numpy.testing.assert_array_equal(picture, numpy.asarray(shown.convert("RGB")))
        self.assertIsNone(picture[0]._repr_png_())
        with self.assertRaisesRegex(KeyError, "no picture 'top'"):
            pictures["top"]

    def test_a_drawn_picture_is_that_of_the_run(self):
        log = self.run_.log
        name = "chase_000003000"
        picture = log.render(3.0, "chase")
        numpy.testing.assert_array_equal(picture, self.run_.pictures[name])
        several = log.render([3.0, 1.0, 3.0], {"kind": "chase", "vehicle": "rover", "distance_m": 4}, width=160, height=96)
        self.assertEqual(several.shape, (3, 96, 160, 3))
        numpy.testing.assert_array_equal(several[0], several[2])
        self.assertGreater(numpy.abs(several[0].astype(int) - several[1]).mean(), 1.0)

    def test_pictures_that_cannot_be_drawn(self):
        render = self.run_.log.render
        for text, *arguments in (("no frame at 9 s: the log covers 0 s to 3 s", 9.0), ("no camera 'chse'.*did you mean 'chase'", 1.0, "chse"),
                                 ("camera must be the name of a camera or a dict of its keys, not int", 1.0, 3),
                                 (r"pictures\.cameras\.view\.kind = 'chas', must be", 1.0, {"kind": "chas"}),
                                 ("time_s must be a number", "soon"), ("time_s must be a finite number", math.nan)):
            with self.assertRaisesRegex(vinerow.ConfigError, text):
                render(*arguments)
        with self.assertRaisesRegex(vinerow.ConfigError, "width = 1, must be from 16 to 8192 pixels"):
            render(1.0, width=1)

    def test_a_machine_without_osmesa(self):
        # A folder of unusable libraries in front of the system's.
        with tempfile.TemporaryDirectory() as folder:
            for name in ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"):
                (pathlib.Path(folder) / name).write_text("")
            code = f"import vinerow; vinerow.read_log({str(self.out / 'python')!r}).render(1.0)"
            done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True,
                                  env={**os.environ, "LD_LIBRARY_PATH": folder})
        self.assertRegex(done.stderr.splitlines()[-1], r"^vinerow\.errors\.UsageError: no picture: .*libOSMesa\.so")

    def test_bad_input_writes_nothing(self):
        with self.assertRaisesRegex(vinerow.ConfigError, "99"):
            vinerow.run(FREE_ROVER, {"rover.spawn": {"alley": 99}}, out=self.out / "bad")
        self.assertFalse((self.out / "bad").exists())

    def test_ctrl_c_ends_a_run_and_keeps_its_log(self):
        out = self.out / "interrupted"
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            vinerow.run(FREE_ROVER, {"duration_s": 10000000}, out=out)
        self.assertLess(time.monotonic() - begin, 30.0)
        run = vinerow.read_run(out)
        self.assertEqual(run.verdict, "broken off")
        self.assertIn("interrupted by the user", run.error)
        self.assertTrue(run.log.complete)
        vinerow.run(FREE_ROVER, {"duration_s": 0.1}, out=out, report=False)

    def test_another_thread_runs_meanwhile(self):
        ticks = []
        thread = threading.Thread(target=lambda: vinerow.run(SCENARIO, {"duration_s": 2, "criteria": []}, out=self.out / "thread",
                                                             pictures=False, report=False))
        thread.start()
        while thread.is_alive():
            ticks.append(time.monotonic())
            time.sleep(0.01)
        thread.join()
        self.assertLess(numpy.diff(ticks).max(), 0.5 * (ticks[-1] - ticks[0]))

    def test_replay_and_report_are_those_of_the_command(self):
        run = vinerow.read_run(self.out / "command")
        wanted = self.out / "wanted.html"
        subprocess.run([VINEROW, "replay", run.folder, "--out", wanted], check=True, capture_output=True)
        try:
            self.assertEqual(run.write_replay().read_bytes(), wanted.read_bytes())
            page = Strict(run.show_replay(300)._repr_html_())
            self.assertEqual(page.tags, ["iframe"])
            self.assertEqual(run.show_report().file, run.report)
        finally:
            (run.folder / "replay.html").unlink()
        report = run.report.read_bytes()
        self.assertEqual(run.write_report().read_bytes(), report)

    def test_bad_folders(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for text, contents in (("contains no summary.json, so it is not the folder of a run", None), ("is not JSON", "{"),
                                   ("is not the summary of a run", "{}"), ("is not the summary of a run", "[]")):
                if contents is not None:
                    (folder / "summary.json").write_text(contents)
                with self.assertRaisesRegex(vinerow.ConfigError, text):
                    vinerow.read_run(folder)

    def test_tables_of_pandas(self):
        import pandas
        log = self.run_.log
        truth, frame = log["rover/truth"], log.frame("rover/truth")
        self.assertIsInstance(frame, pandas.DataFrame)
        self.assertEqual(frame.index.name, "stamp_s")
        numpy.testing.assert_array_equal(frame.index, truth.stamp_s)
        for k, axis in enumerate("xyz"):
            numpy.testing.assert_array_equal(frame[f"pose.position.{axis}"], truth.pose.position[:, k])
            numpy.testing.assert_array_equal(frame[f"linear_velocity.{axis}"], truth.linear_velocity[:, k])
        numpy.testing.assert_array_equal(frame["pose.orientation.w"], truth.pose.orientation[:, 3])
        # The same as the command's table, whose columns have the names of the actuators.
        table = self.out / "actuators.csv"
        subprocess.run([VINEROW, "export", self.out / "python" / "log.mcap", "--topic", "/rover/actuators", "-o", table], check=True,
                       capture_output=True)
        wanted, actuators = pandas.read_csv(table, float_precision="round_trip"), log["rover/actuators"].to_pandas()
        self.assertIn("wheel_fl_speed_radps", actuators)
        for name in actuators:
            numpy.testing.assert_array_equal(actuators[name], wanted[name])
        self.assertEqual(log.frame("rover/plan")["points"].iloc[0].type, "PathPoint")
        with vinerow.open(SCENARIO) as session:
            session.step(0.0)
            with self.assertRaisesRegex(vinerow.UsageError, "only the messages of a log make a table"):
                session.signal("rover/truth").value.to_pandas()

    def test_without_pandas(self):
        code = f"""import sys; sys.modules["pandas"] = None
import vinerow; vinerow.read_log({str(self.out / 'python')!r}).frame("rover/truth")"""
        done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True)
        self.assertRegex(done.stderr.splitlines()[-1], "^ImportError: .*needs the Python package pandas, which cannot be imported")

    def test_html(self):
        run = self.run_
        page = Strict(run._repr_html_())
        words = " ".join(page.words)
        for text in ("riseholme_rover", "a criterion failed", run.digest, "rover.distance_m", "cross_track_rms_m"):
            self.assertIn(text, words)
        self.assertEqual(page.tags.count("img"), 4)
        with vinerow.open(SCENARIO) as session:
            session.step(0.1)
            for thing, text in ((run.log, "rover/truth"), (run.log["rover/truth"], "position (61, 3)"), (run.pictures, "chase_000003000"),
                                (vinerow.load(SCENARIO), "skid-steered"), (session, "Odometry")):
                self.assertIn(text, " ".join(Strict(thing._repr_html_()).words))
        self.assertIn("closed", session._repr_html_())

    def test_html_escapes_what_files_contain(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            bad = "<script>alert('1')</script>\"&"
            summary = json.loads((self.run_.folder / "summary.json").read_text())
            summary |= {"scenario": bad, "status": bad, "error": bad, "digest": bad, "metrics": {bad: {bad: 1.0, "time_s": 1.0}}}
            summary["criteria"] = [{"name": bad, "metric": bad, "kind": "max", "value": 1.0, "limit": 1.0, "met": True}]
            summary["phases"] = [{"name": bad, "state": bad, "begin_s": None, "end_s": None, "reason": bad, "numbers": {}}]
            (folder / "summary.json").write_text(json.dumps(summary))
            (folder / "frames").mkdir()
            (folder / "frames" / "a<b>&.png").write_bytes(self.run_.pictures.file("chase_000003000").read_bytes())
            (folder / "report.html").write_text(f'<p title="a">{bad}</p>')
            (folder / "cells.csv").write_text("cell,state,<b>\n0,<i>met,1\n")
            for table in ("settings.csv", "costs.csv"):
                (folder / table).write_text("<b>\n1\n")
            run = vinerow.read_run(folder)
            pages = [run, run.pictures, run.show_report(), vinerow.read_study(folder), vinerow.Message(bad)]
            for page in pages:
                tags = Strict(page._repr_html_()).tags
                self.assertFalse({"script", "b>", "i"} & set(tags), page)
            # What the frame shows is the page as it is.
            frame = pages[2]._repr_html_()
            self.assertEqual(re.search('srcdoc="([^"]*)"', frame)[1].count("<"), 0)
            self.assertEqual(html.unescape(re.search('srcdoc="([^"]*)"', frame)[1]), f'<p title="a">{bad}</p>')
            self.assertNotIn("allow-same-origin", frame)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
