#!/usr/bin/env python3
"""`vinerow study` as users call it.

    study_test.py VINEROW
"""

import json
import math
import os
import pathlib
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

import study_case
from study_case import NOISY, ROOT, SCENARIO

VINEROW = pathlib.Path(sys.argv[1]).resolve()


class Study(study_case.StudyCase):
    vinerow = VINEROW

    def test_a_cell_is_what_run_gives(self):
        file = self.write(self.TWO)
        self.study("run", file)
        row = self.rows()[8]  # setting 2 of 3 seeds: lookahead 1.0, pitch 0.33, seed 3
        self.assertEqual((row["setting"], row["seed"], row["lookahead"], row["pitch"]), ("2", "3", "1.0", "0.33"))
        subprocess.run([VINEROW, "run", SCENARIO, "--set", "duration_s=3", "--set", "criteria=[]",
                        *(word for pair in NOISY.split(", rover.est") for word in
                          ("--set", ("rover.est" if pair.startswith("imator") else "") + pair.replace(": ", "=", 1))),
                        "--set", "rover.controller.lookahead_m=1.0", "--set", "rover.planner.waypoint_pitch_m=0.33", "--seed", "3",
                        "--out", self.folder / "run", "--quiet", "--no-pictures", "--no-report", "--no-log"],
                       check=True, capture_output=True)
        summary = json.loads((self.folder / "run" / "summary.json").read_text())
        self.assertEqual(row["digest"], summary["digest"])
        numbers = {f"{v}.{n}": x for v, metrics in summary["metrics"].items() for n, x in metrics.items()}
        self.assertGreater(len(numbers), 20)
        for name, value in numbers.items():
            told = row[name]
            if value is None:
                self.assertIn(told, ("", "inf", "-inf"), name)
            else:
                self.assertEqual(float(told), value, name)

    def test_settings_have_the_statistics_of_their_cells(self):
        self.study("run", self.write(self.TWO + "metrics: [rover.average_deviation_m]\nderived: {twice: 2 * rover.average_deviation_m + lookahead}\n"))
        cells, settings = self.rows(), self.rows(table="settings.csv")
        self.assertEqual(len(settings), 4)
        for setting in settings:
            values = [float(c["rover.average_deviation_m"]) for c in cells if c["setting"] == setting["setting"]]
            mean = sum(values) / 3
            deviation = math.sqrt(sum((v - mean) ** 2 for v in values) / 2)
            half = 4.302652729749464 * deviation / math.sqrt(3)  # Student's t, 2 degrees of freedom, 97.5 %
            for what, want in (("mean", mean), ("deviation", deviation), ("median", sorted(values)[1]), ("mean_low", mean - half),
                               ("mean_high", mean + half)):
                self.assertAlmostEqual(float(setting[f"rover.average_deviation_m:{what}"]), want, delta=1e-12)
            self.assertAlmostEqual(float(setting["twice:mean"]), 2 * mean + float(setting["lookahead"]), delta=1e-12)
            self.assertEqual((setting["met"], setting["finished"]), ("3", "3"))
            self.assertAlmostEqual(float(setting["met_share_low"]), 1 / (1 + 1.959963984540054**2 / 3), delta=1e-12)  # Wilson

    def test_one_core_or_two_in_one_go_or_resumed(self):
        file = self.write(self.TWO.replace("seeds: 3", "seeds: 30"), duration_s=60)
        self.study("run", file, "--jobs", 1, out="one")
        driver = subprocess.Popen([VINEROW, "study", "run", file, "--out", self.folder / "two", "--jobs", "2", "--quiet"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cells = self.folder / "two" / "cells"
        while sum(1 for _ in cells.glob("*/*.json")) < 20 and driver.poll() is None:
            time.sleep(0.01)
        driver.send_signal(signal.SIGKILL)
        driver.wait()
        finished = sum(1 for _ in cells.glob("*/*.json"))
        self.assertLess(finished, 120, "killed too late to test anything")
        told = self.study("resume", file, "--jobs", 2, out="two")
        self.assertIn("were already finished", told)
        before = int(told.split(" s, ")[-1].split(" were")[0])
        self.assertGreaterEqual(before, finished)
        for table in ("cells.csv", "settings.csv"):
            self.assertEqual(self.bytes_of("one", table), self.bytes_of("two", table))
        self.assertEqual(len({row["cell"] for row in self.rows("two")}), 120)
        # Nothing is computed twice.
        self.assertIn("run      0 cells", self.study("run", file, out="two"))

    def test_a_worker_keeps_to_its_core(self):
        # A camera's pictures are cast on all cores, but the other workers of a study have the other ones.
        camera = ROOT / "assets" / "scenarios" / "vineyard_row_camera.yaml"
        file = self.write("seeds: 1\nset: {duration_s: 10, criteria: []}\n")
        file.write_text(file.read_text().replace(str(SCENARIO), str(camera)))
        self.study("run", file, "--jobs", 1)
        (cost,) = self.rows(table="costs.csv")
        self.assertLess(float(cost["cpu_s"]), 1.1 * float(cost["wall_s"]))

    def test_two_drivers(self):
        file = self.write(self.TWO.replace("seeds: 3", "seeds: 40"), duration_s=60)
        first = subprocess.Popen([VINEROW, "study", "run", file, "--out", self.folder / "a", "--cells", self.folder / "shared", "--jobs", "1"],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (self.folder / "a" / "study.sqlite").exists():
            time.sleep(0.01)
        time.sleep(0.2)
        refused = self.study("run", file, "--cells", self.folder / "shared", out="a", status=2)
        self.assertIn("another run", refused)
        self.study("run", file, "--cells", self.folder / "shared", "--jobs", 1, out="b")
        self.assertEqual(first.wait(), 0)
        self.assertEqual(self.bytes_of("a"), self.bytes_of("b"))

    def test_many_write_the_same_cell(self):
        file = self.write("", duration_s=0.1)
        shared = self.folder / "shared"
        for _ in range(4):
            shutil.rmtree(shared, ignore_errors=True)
            writers = [subprocess.Popen([VINEROW, "study", "cell", file, "0", "--out", self.folder / "out", "--cells", shared],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for _ in range(8)]
            for writer in writers:
                _, error = writer.communicate()
                self.assertEqual((writer.returncode, error), (0, ""))
            self.assertEqual([file.suffix for file in shared.glob("*/*")], [".json"])

    def test_cells_by_another_driver(self):
        # Each in a process of its own, whereas a driver's worker keeps its world; worlds, steps and seeds differ.
        file = self.write("factors:\n  lookahead: {key: rover.controller.lookahead_m, values: [0.5, 1.0]}\n"
                          "  rows: {zip: {world.row_length_m: [70, 80, 80], physics.step_s: [0.005, 0.005, 0.0025]}}\nseeds: 2\n")
        numbers = self.study("list", file, "--state", "waiting").split()
        self.assertEqual(numbers, [str(n) for n in range(12)])
        for number in numbers:
            self.assertIn(f"cell {number}: met", self.study("cell", file, number))
        self.assertEqual(self.study("list", file, "--state", "waiting"), "")
        self.study("table", file)
        self.study("run", file, "--jobs", 1, out="driver")
        self.assertEqual(self.bytes_of(), self.bytes_of("driver"))
        self.assertEqual(len({row["digest"] for row in self.rows()}), 12)
        with sqlite3.connect(self.folder / "driver" / "study.sqlite") as index:
            listed = index.execute('SELECT cell, "factor.lookahead", seed, state, digest FROM cells ORDER BY cell').fetchall()
            numbers = dict(index.execute('SELECT cell, "rover.average_deviation_m" FROM numbers').fetchall())
        index.close()
        for row, (cell, lookahead, seed, state, digest) in zip(self.rows(), listed, strict=True):
            self.assertEqual((row["cell"], float(row["lookahead"]), row["seed"], row["state"], row["digest"]),
                             (str(cell), lookahead, str(seed), state, digest))
            self.assertEqual(float(row["rover.average_deviation_m"]), numbers[cell])

    def test_what_does_not_run_to_its_end_is_a_row(self):
        # A step of 12.5 ms does not divide the period of 50 Hz: the combination is refused, its parts alone are not.
        file = self.write("set: {criteria: [{metric: rover.distance_m, min: 1000}], duration_s: 2}\n"
                          "factors:\n  step: {key: physics.step_s, values: [0.005, 0.0125]}\n"
                          "  rate: {key: rover.controller.rate_Hz, values: [40, 50]}\n")
        told = self.study("run", file, status=3)
        states = [row["state"] for row in self.rows()]
        self.assertEqual(states.count("invalid"), 1)
        self.assertEqual(states.count("not met"), 3)
        for row in self.rows():
            self.assertTrue(row["reason"], row)
        bad = next(row for row in self.rows() if row["state"] == "invalid")
        self.assertIn("is not a whole number of physics steps", bad["reason"])
        self.assertEqual(bad["rover.average_deviation_m"], "")
        self.assertIn("invalid", told)
        self.assertIn("invalid", (self.folder / "out" / "study.html").read_text())

    def test_a_budget_ends_a_cell_and_no_other(self):
        file = self.write("factors: {long: {key: duration_s, values: [0.1, 10000000]}}\nbudget: {time_s: 8}\n"
                          "set: {criteria: [], stop_when_finished: false}\n")
        self.study("run", file, status=3)
        self.assertEqual([row["state"] for row in self.rows()], ["met", "out of time"])
        self.assertIn("budget.time_s = 8 s", self.rows()[1]["reason"])
        # Known now, and so not run again, unless asked for.
        self.assertIn("run      0 cells", self.study("resume", file, status=3))
        self.assertIn("run      1 cells", self.study("resume", file, "--retry", status=3))

    def test_a_crash_is_a_row(self):
        # Less than the program needs.
        file = self.write("budget: {memory_MB: 5}\n", duration_s=3000)
        self.study("run", file, status=3)
        self.assertEqual(self.rows()[0]["state"], "out of memory")
        file = self.write("seeds: 2\n", name="killed.yaml", duration_s=10000000, set_more=", stop_when_finished: false")
        driver = subprocess.Popen([VINEROW, "study", "run", file, "--out", self.folder / "killed", "--jobs", "1", "--quiet"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(2):  # both cells
            worker = None
            while worker is None and driver.poll() is None:
                time.sleep(0.2)
                children = pathlib.Path(f"/proc/{driver.pid}/task/{driver.pid}/children").read_text().split()
                worker = int(children[0]) if children else None
            os.kill(worker, signal.SIGKILL)
            while pathlib.Path(f"/proc/{worker}").exists():
                time.sleep(0.01)
        self.assertEqual(driver.wait(), 3)
        self.assertEqual([row["state"] for row in self.rows("killed")], ["crashed"] * 2)
        self.assertIn("signal 9 (Killed)", self.rows("killed")[0]["reason"])

    def test_ctrl_c_keeps_what_is_finished(self):
        file = self.write(self.TWO.replace("seeds: 3", "seeds: 200"), duration_s=60)
        driver = subprocess.Popen([VINEROW, "study", "run", file, "--out", self.folder / "out", "--jobs", "2", "--quiet"],
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while sum(1 for _ in (self.folder / "out" / "cells").glob("*/*.json")) < 10:
            time.sleep(0.01)
        driver.send_signal(signal.SIGINT)
        _, error = driver.communicate()
        self.assertEqual(driver.returncode, 3)
        self.assertIn("interrupted: finished cells are kept", error)
        finished = [row for row in self.rows() if row["state"] == "met"]
        self.assertGreaterEqual(len(finished), 10)
        self.assertEqual(list((self.folder / "out" / "kept").glob("*")) if (self.folder / "out" / "kept").exists() else [], [])

    def test_enough_seeds(self):
        text = ("factors: {accuracy: {key: rover.sensors.gps.accuracy_m, values: [0.001, 0.3]}}\nseeds: 25\n"
                "stop: {metric: rover.average_deviation_m, half_width: 0.2, relative: true, at_least: 4}\n"
                "metrics: [rover.average_deviation_m]\n")
        file = self.write(text, duration_s=5)
        self.study("run", file, "--jobs", 2)
        self.study("run", self.write(text.split("stop")[0] + "metrics: [rover.average_deviation_m]\n", name="all.yaml", duration_s=5), out="all")
        for setting in ("0", "1"):
            values = [float(row["rover.average_deviation_m"]) for row in self.rows("all") if row["setting"] == setting]
            for count in range(4, 26):
                from scipy import stats
                low, high = stats.t.interval(0.95, count - 1, loc=sum(values[:count]) / count, scale=stats.sem(values[:count]))
                if (high - low) / 2 <= 0.2 * sum(values[:count]) / count:
                    break
            states = [row["state"] for row in self.rows() if row["setting"] == setting]
            self.assertEqual(states, ["met"] * count + ["not needed"] * (25 - count))
        self.study("run", file, "--jobs", 1, out="one")
        self.assertEqual(self.bytes_of(), self.bytes_of("one"))

    def test_files_that_are_kept(self):
        limit = "set: {duration_s: 3, criteria: [{metric: rover.distance_m, min: 1}]}\nfactors: {speed: {key: rover.controller.speed_mps, values: [0.1, 1]}}\n"
        for keep, names in (("nothing", []), ("summary", ["summary.json"] * 2), ("log", ["log.mcap"] * 2), ("failed", ["log.mcap"])):
            file = self.write(limit + f"keep: {keep}\n")
            self.study("run", file, out=keep, status=1)
            kept = sorted(p.name for p in (self.folder / keep / "kept").glob("*")) if names else []
            self.assertEqual(len(kept), len(names))
            for folder, name in zip(kept, names, strict=True):
                self.assertTrue((self.folder / keep / "kept" / folder / name).exists())
                self.assertEqual((self.folder / keep / "kept" / folder / "log.mcap").exists(), name == "log.mcap")
        self.assertEqual([row["state"] for row in self.rows("failed")], ["not met", "met"])

    def test_repeat_is_the_same_run(self):
        file = self.write(self.TWO)
        self.study("run", file)
        told = self.study("repeat", file, 7, "--quiet")
        self.assertIn(self.rows()[7]["digest"], told)
        self.assertTrue((self.folder / "out" / "repeat" / "7" / "log.mcap").exists())

    def test_seeds_that_change_nothing_are_reported(self):
        rows = "factors: {lookahead: {key: rover.controller.lookahead_m, values: [0.5, 1.0]}}\nseeds: 2\n"
        told = self.study("run", self.write("set: {duration_s: 3, criteria: []}\n" + rows))
        self.assertIn("note     all runs of a setting have the same digest: the seed changes nothing\n", told)
        self.assertEqual(len({row["digest"] for row in self.rows()}), 2)
        self.assertIn("the seed changes nothing", (self.folder / "out" / "study.html").read_text())
        for text in (rows, rows.replace("seeds: 2", "seeds: 1")):  # with noise, and without a second seed
            self.assertNotIn("the seed changes nothing", self.study("run", self.write(text), out="noisy" + text[-2]))

    def test_plots_and_page(self):
        import xml.etree.ElementTree as xml
        file = self.write(self.TWO + "metrics: [rover.average_deviation_m, rover.distance_m]\ndescription: <b>not bold</b>\n")
        self.study("run", file)
        self.study("plot", file)
        plots = sorted((self.folder / "out" / "plots").glob("*.svg"))
        self.assertGreaterEqual(len(plots), 5)
        for plot in plots:
            xml.parse(plot)
        page = (self.folder / "out" / "study.html").read_text()
        self.assertNotIn("<b>not bold", page)
        xml.fromstring(page.split("\n", 1)[1])
        for word in ("data-cell=\"9\"", "study repeat", "Effects", "Differences", "http://www.w3.org/2000/svg"):
            self.assertIn(word, page)
        self.assertNotIn("src=\"http", page)

    def test_bad_input(self):
        def fault(text, **more):
            return self.study("run", self.write(text, **more), status=2, out="bad").replace(str(self.folder) + "/", "")

        self.assertIn("s.yaml:4: unknown path 'rovr'; did you mean 'rover'?",
                      fault("factors: {a: {key: rovr.controller.lookahead_m, values: [1]}}"))
        self.assertIn("s.yaml:4: vehicles.rover.controller.lookahead_m = -1 m, must be > 0 m",
                      fault("factors: {a: {key: rover.controller.lookahead_m, values: [1, -1]}}"))
        self.assertIn("s.yaml:4: metrics: no cell has a number 'rover.tme_s'; did you mean 'rover.time_s'?", fault("metrics: [rover.tme_s]"))
        self.assertIn("s.yaml:4: derived.x = '1 +' is not an expression", fault("derived: {x: 1 +}"))
        self.assertIn("s.yaml:4: derived.x: no cell has a number 'nothing'", fault("derived: {x: nothing + 1}"))
        self.assertIn("make 1e+09 cells", fault("seeds: 1000\nfactors: {a: {key: gravity_mps2, from: 1, to: 2, count: 1000}, "
                                                "b: {key: rover.controller.lookahead_m, from: 1, to: 2, count: 1000}}"))
        # What a rule across keys refuses, without building a world.
        vines = (f"vinerow_study: 1\nscenario: {ROOT}/assets/scenarios/vineyard_camera.yaml\nset: {{duration_s: 1}}\n"
                 "factors:\n  b:\n    key: world.vines.bbch\n    values: [89, %s]\n"
                 "  arm: {key: world.arm_height_m, values: [0.7, %s]}\n")
        (self.folder / "vines.yaml").write_text(vines % (30, 0.8))
        self.assertIn("vines.yaml:7: world.vines: bbch = 30: grapevines have no stages between 19",
                      self.study("check", self.folder / "vines.yaml", status=2))
        (self.folder / "vines.yaml").write_text(vines % (85, 2.5))
        self.assertIn("vines.yaml:8: world.arm_height_m = 2.5 m, must be < canopy_top_m = 2 m for growing vines",
                      self.study("check", self.folder / "vines.yaml", status=2))
        two = self.write(self.TWO)
        self.assertIn("need '--runner slurm'", self.study("run", two, "--chunk", 3, status=2, out="bad"))
        self.assertIn("--jobs: must be > 0, is '0'", self.study("run", two, "--jobs", 0, status=2, out="bad"))
        self.assertIn("there is nothing to resume", self.study("resume", self.write(""), status=2, out="none"))
        self.assertIn("'mt' is not a state of a cell, must be one of: waiting, not needed, met, not met, broken off, invalid, crashed, out of time, out of "
                      "memory; did you mean 'met'?", self.study("list", self.write(""), "--state", "mt", status=2))
        self.assertIn("there is no cell 1, the study has cells 0 to 0", self.study("cell", self.write(""), 1, status=2))
        (self.folder / "peer.yaml").write_text(f"vinerow_study: 1\nscenario: {ROOT}/docs/examples/live/follow_path.yaml\n")
        self.assertIn("lockstep.topic = 'rover/cmd_vel' waits for the commands of a program outside, and this run has none",
                      self.study("run", self.folder / "peer.yaml", status=2, out="bad"))
        self.assertFalse((self.folder / "bad").exists(), "a refused study writes nothing")

    def test_what_has_changed_is_told(self):
        scenario = self.folder / "mine.yaml"
        scenario.write_text(f"include: {SCENARIO}\n")
        file = self.folder / "s.yaml"
        text = ("vinerow_study: 1\nscenario: mine.yaml\nset: {duration_s: 2, criteria: []}\n"
                "factors: {a: {key: rover.controller.lookahead_m, values: [1, 2]}}\n")
        file.write_text(text)
        self.study("run", file)
        file.write_text(text.replace("[1, 2]", "[1, 2, 3]"))
        self.assertIn("the study's list of cells has changed since; 'vinerow study run --fresh' starts a new index", self.study("run", file, status=2))
        self.assertIn("run      1 cells", self.study("run", file, "--fresh"))
        with scenario.open("a") as more:
            more.write("# edited\n")
        self.assertIn("run      0 cells", self.study("run", file), "a comment changes no run")
        scenario.write_text(scenario.read_text() + "gravity_mps2: 9.7\n")
        self.assertIn("the scenario or a file it names has changed since", self.study("run", file, status=2))
        other = self.write("", name="other.yaml")
        self.assertIn("belongs to another study", self.study("run", other, status=2))
        (self.folder / "out" / "study.sqlite").write_bytes(b"no database at all" * 100)
        self.assertIn("study.sqlite' cannot be read: file is not a database", self.study("run", file, status=2))
        for cell in (self.folder / "out" / "cells").glob("*/*.json"):  # also of the study as it was
            cell.write_text("{}")
        file.write_text(text)
        scenario.write_text(f"include: {SCENARIO}\n")
        self.assertIn("is not the result of a cell", self.study("run", file, "--fresh", status=2))

    def test_a_full_disk_keeps_what_is_finished(self):
        if not os.access("/dev/full", os.W_OK):
            self.skipTest("/dev/full is absent")
        file = self.write(self.TWO)
        # Beyond its limit a file cannot grow: as on a full disk.
        run = subprocess.run(["bash", "-c", f"ulimit -f 20; exec {VINEROW} study run {file} --out {self.folder}/full --quiet"],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)

    def test_the_examples_of_the_page(self):
        rows = re.findall(r"^\| [^|]+ \| `(\{.*\})` \|$", (ROOT / "docs" / "guides" / "studies.md").read_text(), re.MULTILINE)
        self.assertEqual(len(rows), 6)
        for row in rows:
            scenario = "trmpc_stress" if "plane." in row else "orchard_rover" if "world.wind" not in row else "vineyard_rover"
            file = self.folder / "example.yaml"
            file.write_text(f"vinerow_study: 1\nscenario: {SCENARIO.parent / scenario}.yaml\nset: {{criteria: []}}\nfactors: {{f: {row}}}\n")
            # The first cell is never reached: a study is checked before it, and ends at once where nothing can be stored.
            run = subprocess.run([VINEROW, "study", "run", file, "--out", "/proc/nowhere", "--quiet"], capture_output=True, text=True)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn("/proc/nowhere", run.stderr, row)

    def with_commands(self, **scripts):
        """An environment whose first programs are these scripts."""
        folder = self.folder / "commands"
        folder.mkdir(exist_ok=True)
        for name, text in scripts.items():
            (folder / name).write_text(f"#!/bin/sh\n{text}\n")
            (folder / name).chmod(0o755)
        return {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}

    def test_what_slurm_has_forgotten_is_asked_of_its_accounting(self):
        # Answers as those of Slurm 22.05 with slurmdbd; slurm_test.py has a real one, without accounting.
        said = self.folder / "said"
        environment = self.with_commands(sbatch=f'echo "$@" >> {said}; echo 7', squeue="true", scancel="true", scontrol="false",
                                         sacct=f'echo "$@" >> {said}; echo TIMEOUT')
        file = self.write("budget: {time_s: 70}\n")
        self.study("run", file, "--runner", "slurm", "--sbatch=--partition=long", "--quiet", environment=environment, status=3)
        self.assertEqual([row["state"] for row in self.rows()], ["out of time"])
        self.assertEqual(self.rows()[0]["reason"], "Slurm task 7_0 ended as TIMEOUT")
        words = said.read_text().splitlines()
        self.assertEqual(sum("--parsable " in line for line in words), 3, "a cell is tried three times")
        # 70 s for the cell and 300 s for the start of its task, in whole minutes; the user's options come last.
        self.assertRegex(words[0], r"^--parsable --requeue --array=0-0 .* --time=7 --partition=long /.*/job\.sh$")
        self.assertIn("--jobs=7_0 --format=State", words[1])

    def test_what_slurm_takes_later(self):
        # Two tasks to an array; the second array is refused once, while the first is still known to run.
        refused, submitted = self.folder / "refused", self.folder / "submitted"
        environment = self.with_commands(
            sbatch=f"""if [ -e {submitted} ] && [ ! -e {refused} ]; then
    touch {refused}; echo 'sbatch: error: QOSMaxSubmitJobPerUserLimit' >&2; exit 1
fi
touch {submitted}
for script; do :; done
for word; do case $word in --array=0-*) last=${{word#--array=0-}};; esac; done
for k in $(seq 0 $last); do SLURM_ARRAY_TASK_ID=$k sh $script >/dev/null 2>&1; done
echo 8""", squeue="true", scancel="true", sacct="echo COMPLETED", scontrol="echo 'MaxArraySize            = 2'")
        file = self.write("seeds: 4\n")
        told = self.study("run", file, "--runner", "slurm", "--chunk", 1, environment=environment)
        self.assertTrue(refused.exists())
        self.assertRegex(told, r"met +4\n")

    def test_a_study_that_was_killed_while_it_wrote_can_be_read(self):
        file = self.write("seeds: 2\n", name="broken.yaml")
        self.study("run", file, out="broken")
        database = self.folder / "broken" / "study.sqlite"
        before = self.rows("broken")
        # A writer that is killed within a transaction, after pages of it have reached the file.
        writer = textwrap.dedent(f"""
            import os, signal, sqlite3
            base = sqlite3.connect({str(database)!r}, isolation_level=None)
            base.execute("PRAGMA cache_size = 1")
            base.execute("BEGIN")
            base.execute("CREATE TABLE big (x)")
            base.executemany("INSERT INTO big VALUES (?)", [("x" * 900,)] * 500)
            os.kill(os.getpid(), signal.SIGKILL)
        """)
        subprocess.run([sys.executable, "-c", writer])
        self.assertTrue(database.with_name("study.sqlite-journal").exists())
        told = self.study("status", file, out="broken")
        self.assertRegex(told, r"\nmet +2\n")
        self.assertEqual(self.rows("broken"), before)

    def test_what_killed_runs_left_is_removed(self):
        file = self.write("keep: summary\n")
        kept = self.folder / "out" / "kept"
        dead = subprocess.Popen(["true"])
        dead.wait()
        host = os.uname().nodename
        left, working = kept / f".000001-12345678.{host}.{dead.pid}", kept / f".000002-12345678.{host}.{os.getpid()}"
        for folder in (left, working):
            folder.mkdir(parents=True)
        self.study("run", file)
        self.assertEqual((left.exists(), working.exists()), (False, True))

    def test_shipped_studies(self):
        page = (ROOT / "docs" / "guides" / "studies.md").read_text()
        files = sorted((ROOT / "assets" / "studies").glob("*.yaml"))
        self.assertGreaterEqual(len(files), 5)
        for file in files:
            told = self.study("check", file)
            cells = int(told.split("= ")[1].split()[0])
            self.assertRegex(page, rf"\| `{file.stem}` \| .* \| {cells} \|", "the page says how many cells it has")
        # One that a user could type: paper B's, whose tables docs/papers/results.md holds (tools/results --quick recomputes them).
        self.assertLessEqual(len((ROOT / "assets" / "studies" / "orchard_lookahead.yaml").read_text().splitlines()), 30)

    def example(self, begin, end):
        """From one line of the page to another."""
        page = (ROOT / "docs" / "guides" / "studies.md").read_text()
        return page[page.index(begin):page.index(end, page.index(begin))]

    def by_another(self, words, **more):
        """Runs something in the test's folder where `vinerow` is the program that is tested. Its table is that of `study run`."""
        path = f"{VINEROW.parent}:{os.environ['PATH']}"
        run = subprocess.run(words, cwd=self.folder, env={**os.environ, "PATH": path, **more}, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.study("run", self.folder / "my_study.yaml", out="driver")
        self.assertEqual((self.folder / "runs" / "my_study" / "cells.csv").read_bytes(), self.bytes_of("driver"))
        self.assertEqual({row["state"] for row in self.rows("driver")}, {"met"})

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is absent")
    def test_gnu_parallel(self):
        self.write(self.TWO, name="my_study.yaml")
        lines = self.example("vinerow study list my_study.yaml --state", "```")
        self.by_another(["bash", "-e", "-c", lines.replace("-N 10", "-N 5")])

    @unittest.skipUnless(shutil.which("snakemake"), "snakemake is absent")
    def test_snakemake(self):
        self.write(self.TWO, name="my_study.yaml")
        (self.folder / "Snakefile").write_text(self.example("CELLS = [", "```"))
        self.by_another(["snakemake", "--cores", "2"], XDG_CACHE_HOME=str(self.folder / "cache"), HOME=str(self.folder))

    def test_kubernetes_recipe(self):
        # There is no cluster of it here: what a pod runs is run as the Job would, an index after the other.
        import yaml
        job = yaml.safe_load(self.example("apiVersion: batch/v1", "```"))
        self.write(self.TWO, name="my_study.yaml")
        command = job["spec"]["template"]["spec"]["containers"][0]["command"]
        for index in range(12):
            path = f"{VINEROW.parent}:{os.environ['PATH']}"
            subprocess.run(command, cwd=self.folder, env={**os.environ, "PATH": path, "JOB_COMPLETION_INDEX": str(index)}, check=True,
                           capture_output=True)
        self.by_another(["vinerow", "study", "table", "my_study.yaml"])

    def test_schema(self):
        import jsonschema
        schema = json.loads(subprocess.run([VINEROW, "schema", "study"], capture_output=True, text=True, check=True).stdout)
        jsonschema.Draft202012Validator.check_schema(schema)
        validator = jsonschema.Draft202012Validator(schema)
        good = {"vinerow_study": 1, "scenario": "a.yaml"}
        factors = [{"key": "a.b", "values": [1]}, {"key": "a.b", "from": 0, "to": 1, "step": 0.1},
                   {"key": "a.b", "from": 1, "to": 2, "count": 3, "scale": "log"}, {"alternatives": {"x": {}}},
                   {"zip": {"a.b": [1], "c": [2]}}, {"sample": "sobol", "count": 3, "ranges": {"a.b": {"from": 0, "to": 1}}}]
        for factor in factors:
            validator.validate(good | {"factors": {"f": factor}})
        validator.validate(good | {"seeds": 3, "metrics": ["a.b"], "stop": {"metric": "a.b", "half_width": 1}, "budget": {"time_s": 3},
                                   "keep": "failed", "derived": {"x": "a.b * 2"}, "set": {"duration_s": 3}})
        for bad in ({"seeds": 0}, {"keep": "all"}, {"nothing": 1}, {"factors": {"f": {"values": [1]}}}, {"factors": {"f": {"zip": {}}}},
                    {"factors": {"f": {"key": "a", "from": 0, "to": 1}}}, {"vinerow_study": 2}):
            self.assertFalse(validator.is_valid(good | bad), bad)


if __name__ == "__main__":
    if subprocess.run([sys.executable, "-c", "import scipy, jsonschema, yaml"], capture_output=True).returncode != 0:
        print("skipped: scipy, jsonschema or yaml is absent")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
