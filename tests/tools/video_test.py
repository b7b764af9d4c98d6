#!/usr/bin/env python3
"""`vinerow render` and `vinerow video` on a short run, with a program in ffmpeg's place that keeps what it gets; and the
plots of `vinerow report` as files.

    video_test.py VINEROW
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

VINEROW = sys.argv[1]
SVG = "{http://www.w3.org/2000/svg}"
SCENARIO = """
vinerow: 1
name: short
duration_s: 4
world: {type: vineyard, row_count: 2, row_length_m: 10, relief_m: 0}
vehicles:
  rover: {type: diff_drive_rover, spawn: {alley: 0, offset_m: 2}, planner: {type: coverage}, controller: {type: pure_pursuit}}
"""
FAKE = """#!/bin/sh
cat > "$FAKE_KEEPS"
printf '%s\\n' "$@" > "$FAKE_KEEPS.words"
[ -n "$FAKE_FAILS" ] && exit 1
for out; do :; done
echo video > "${out#file:}"
"""
SIZE = ["--width", "64", "--height", "36"]


class Video(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        (cls.folder / "s.yaml").write_text(SCENARIO)
        (cls.folder / "bin").mkdir()
        fake = cls.folder / "bin" / "ffmpeg"
        fake.write_text(FAKE)
        fake.chmod(0o755)
        cls.keeps = cls.folder / "kept"
        run = cls.vinerow("run", "s.yaml", "--out", "run", "--no-pictures", "--no-report", "--quiet")
        assert run.returncode == 0, run.stderr
        if "no pictures" in cls.vinerow("render", "run", "--time", "1", *SIZE).stderr:
            print("skipped: nothing draws here")
            sys.exit(77)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def vinerow(cls, *arguments, path=None, **environment):
        env = {**os.environ, "FAKE_KEEPS": str(cls.keeps), "PATH": path or f"{cls.folder}/bin:{os.environ['PATH']}", **environment}
        return subprocess.run([VINEROW, *arguments], capture_output=True, text=True, cwd=cls.folder, env=env)

    def frames(self, *arguments):
        shutil.rmtree(self.folder / "frames", ignore_errors=True)
        run = self.vinerow("render", "run", "-o", "frames", *arguments, *SIZE)
        self.assertEqual(run.returncode, 0, run.stderr)
        return sorted(f.name for f in (self.folder / "frames").iterdir()), run.stdout

    def test_a_video_is_its_frames_one_after_the_other(self):
        run = self.vinerow("video", "run", "-o", "out/v.mp4", "--from", "1", "--to", "2", "--fps", "10", *SIZE)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual((self.folder / "out" / "v.mp4").read_text(), "video\n")
        self.assertEqual(self.keeps.stat().st_size, 11 * 64 * 36 * 3)
        self.assertIn("11 frames, 1.1 s", run.stdout)
        words = (self.folder / "kept.words").read_text().split("\n")
        self.assertEqual(words[words.index("-video_size") + 1], "64x36")
        self.assertEqual(words[words.index("-framerate") + 1], "10")
        self.assertEqual([f.name for f in (self.folder / "out").iterdir()], ["v.mp4"])

    def test_speed_is_simulated_time_in_a_second_of_video(self):
        run = self.vinerow("video", "run", "-o", "v.mp4", "--fps", "5", "--speed", "5", *SIZE)
        self.assertIn("5 frames, 1 s at 5 frames per second, 5 times as fast", run.stdout)

    def test_a_camera_of_ones_own_is_checked_like_a_scenarios(self):
        own = "kind=fixed,position_m=[0,0,5],look_at_m=[5,0,0],name=tower"
        names, _ = self.frames("--camera", own, "--time", "1")
        self.assertEqual(names, ["tower_000001000.png"])
        for camera, words in {
            "kind=chasse": "did you mean 'chase'",
            "kind=chase,vehicle=rovr": "did you mean 'rover'",
            "kind=chase,height=2": "unknown key",
            "kind=chase,far": "'far' must be key=value",
        }.items():
            run = self.vinerow("render", "run", "--camera", camera, "--time", "1")
            self.assertEqual(run.returncode, 2)
            self.assertIn(words, run.stderr)
            self.assertTrue(run.stderr.startswith("vinerow: --camera"), run.stderr)
            self.assertEqual(run.stderr.count("\n"), 1)

    def test_from_and_to_bound_the_frames(self):
        names, _ = self.frames("--camera", "chase", "--from", "1.5", "--to", "3", "--every", "0.5")
        self.assertEqual(names, [f"chase_00000{t}.png" for t in ["1500", "2000", "2500", "3000"]])
        for span in [["--from", "99"], ["--from", "3", "--to", "2"], ["--time", "99999"]]:
            run = self.vinerow("render", "run", *span)
            self.assertEqual(run.returncode, 2, span)
            self.assertIn("there is no frame", run.stderr)

    def test_digests_are_printed_on_demand(self):
        _, plain = self.frames("--camera", "chase", "--time", "1")
        self.assertTrue(plain.startswith("frames/chase_000001000.png\n"), plain)
        _, told = self.frames("--camera", "chase", "--time", "1", "--digest")
        self.assertRegex(told, r"^[0-9a-f]{32}  frames/chase_000001000\.png\n")

    def test_without_ffmpeg_one_sentence_says_so(self):
        run = self.vinerow("video", "run", "-o", "none.mp4", *SIZE, path="/nowhere")
        self.assertEqual(run.returncode, 2)
        self.assertIn("ffmpeg is not installed", run.stderr)

    def test_where_ffmpeg_fails_nothing_is_left(self):
        run = self.vinerow("video", "run", "-o", "failed/v.mp4", "--to", "0", *SIZE, FAKE_FAILS="1")
        self.assertEqual(run.returncode, 3)
        self.assertIn("ffmpeg failed", run.stderr)
        self.assertEqual(list((self.folder / "failed").iterdir()), [])

    @unittest.skipUnless(shutil.which("ffmpeg") and shutil.which("ffprobe"), "ffmpeg is absent")
    def test_the_real_ffmpeg_makes_a_video_of_that_length(self):
        size = ["--width", "63", "--height", "35"]  # made even
        run = self.vinerow("video", "run", "-o", "real.mp4", "--to", "1", "--fps", "10", *size, path=os.environ["PATH"])
        self.assertEqual(run.returncode, 0, run.stderr)
        probe = ["ffprobe", "-v", "error", "-show_entries", "stream=width,height,nb_frames", "-of", "csv=p=0", "real.mp4"]
        told = subprocess.run(probe, capture_output=True, text=True, cwd=self.folder).stdout
        self.assertEqual(told.strip(), "64,36,11")

    def test_a_folder_of_plots_that_cannot_be_made_is_bad_input(self):
        run = self.vinerow("report", "run", "--out", "page.html", "--plots", "/proc/none")
        self.assertEqual(run.returncode, 2)
        self.assertIn("folder '/proc/none' cannot be created", run.stderr)

    def test_plots_of_a_report_are_files_that_stand_alone(self):
        run = self.vinerow("report", "run", "--out", "page.html", "--plots", "plots")
        self.assertEqual(run.returncode, 0, run.stderr)
        files = list((self.folder / "plots").iterdir())
        page = (self.folder / "page.html").read_text()
        self.assertEqual(len(files), page.count('<svg xmlns="http://www.w3.org/2000/svg" viewBox='))
        self.assertIn("rover_speed.svg", [f.name for f in files])
        for file in files:
            tree = xml.etree.ElementTree.parse(file).getroot()
            self.assertEqual(tree.tag, SVG + "svg")
            self.assertTrue(tree.find(SVG + "title").text, file.name)
            # Inkscape and rsvg know neither variables nor :is().
            style = tree.find(SVG + "style").text
            self.assertNotIn("var(", style)
            self.assertNotIn(":is(", style)
            # What the page hides and enlarges on a telephone is none of a file's.
            self.assertNotIn("@media", style)
            self.assertNotIn("visibility", style)
            self.assertNotIn("18px", style)
            _, _, width, height = map(float, tree.get("viewBox").split())
            self.assertEqual((width, height), (float(tree.get("width")), float(tree.get("height"))))

    def test_every_class_of_a_plot_has_a_rule(self):
        run = self.vinerow("report", "run", "--out", "page.html", "--plots", "plots")
        self.assertEqual(run.returncode, 0, run.stderr)
        # Also curves that this run lacks: only a plane has the speed over ground.
        page = (self.folder / "page.html").read_text()
        coloured = re.findall(r"(?:^|\} )\.(\w+) \{ --c: var\(", page, re.M)
        self.assertIn("ground", coloured)
        curves = 0
        for file in (self.folder / "plots").iterdir():
            tree = xml.etree.ElementTree.parse(file).getroot()
            style = tree.find(SVG + "style").text
            selectors = re.sub(r"\{[^}]*\}", "", style)
            for name in coloured:
                self.assertIn(f"svg .line.{name} {{ fill: none; stroke: #", style, file.name)
            for element in tree.iter():
                classes = (element.get("class") or "").split()
                if element is not tree:
                    for name in classes:
                        self.assertRegex(selectors, rf"\.{name}\b", file.name)
                # Without a rule of its own a curve is filled black.
                if "line" in classes and element.tag == SVG + "polyline":
                    curves += 1
                    self.assertIn(f"svg .{'.'.join(classes)} {{ fill: none; stroke: #", style, file.name)
        self.assertGreater(curves, 10)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
