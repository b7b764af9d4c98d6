#!/usr/bin/env python3
"""Studies on a real Slurm: a controller and two nodes on this machine.

    slurm_test.py VINEROW
"""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import local_slurm
import study_case

VINEROW = pathlib.Path(sys.argv[1]).resolve()


class SlurmStudy(study_case.StudyCase):
    vinerow = VINEROW
    slurm = None  # set before the tests

    def on_slurm(self, action, file, *more, **how):
        return self.study(action, file, "--runner", "slurm", *more, environment=self.slurm.environment, **how)

    def start(self, file, *more, out="out", **how):
        return subprocess.Popen([VINEROW, "study", "run", file, "--out", self.folder / out, "--runner", "slurm", "--quiet", *map(str, more)],
                                env=self.slurm.environment, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **how)

    def wait_for(self, condition, words):
        until = time.monotonic() + 120
        while not condition():
            self.assertLess(time.monotonic(), until, words)
            time.sleep(0.02)

    def nothing_is_left(self):
        self.wait_for(lambda: not set(self.slurm.queue()) & {"PENDING", "RUNNING", "COMPLETING"}, "tasks are still there")

    def test_a_thousand_cells_though_a_node_and_the_driver_die(self):
        # 50 tasks in two arrays, for Slurm takes 31 in one.
        file = self.write(self.TWO.replace("seeds: 3", "seeds: 250"), duration_s=8)
        driver = self.start(file, "--chunk", 20)
        self.wait_for(lambda: self.stored() > 300, "the study does not come to its 300th cell")
        self.slurm.kill_node("n1")
        driver.send_signal(signal.SIGKILL)
        driver.communicate()
        before = self.stored()
        self.assertLess(before, 900, "killed too late to test anything")
        # Slurm's tasks went on without the driver; the new one waits for them and submits nothing but what is left.
        with self.slurm.no_delay_after_a_failure():
            told = self.on_slurm("resume", file, "--chunk", 20)
        self.assertRegex(told, r"met +1000\n")
        self.assertGreaterEqual(int(told.split(" s, ")[-1].split(" were")[0]), before)
        self.assertEqual(len({row["cell"] for row in self.rows()}), 1000)
        self.assertEqual(list((self.folder / "out" / "slurm").glob("*/chunks")), [])
        self.slurm.start_node("n1")
        # The same table on one core of this machine; where the mathematical library sees no AVX2 and no FMA; and of two at the same time.
        self.study("run", file, "--jobs", 1, out="one")
        hidden = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2_Usable,-AVX2,-FMA_Usable,-FMA,-AVX512F_Usable,-AVX512F"}
        self.study("run", file, out="plain", environment=hidden)
        both = [subprocess.Popen([VINEROW, "study", "run", file, "--out", self.folder / out, "--quiet"], stdout=subprocess.DEVNULL) for out in "ab"]
        self.assertEqual([run.wait() for run in both], [0, 0])
        for table in ("cells.csv", "settings.csv"):
            for out in ("one", "plain", "a", "b"):
                self.assertEqual(self.bytes_of("out", table), self.bytes_of(out, table), (table, out))

    def test_submitted_and_left_alone(self):
        file = self.write(self.TWO)
        told = self.on_slurm("run", file, "--chunk", 5, "--detach")
        self.assertIn("3 tasks submitted as ", told)
        self.wait_for(lambda: self.stored() == 12, "nobody ran the tasks")
        self.assertIn("12 were already finished", self.on_slurm("resume", file))
        self.nothing_is_left()

    def test_tasks_that_wait_are_found_again(self):
        file = self.write(self.TWO)
        self.on_slurm("run", file, "--chunk", 5, "--detach", "--sbatch=--hold")
        before = self.slurm.jobs()
        driver = self.start(file, "--chunk", 5)
        time.sleep(4)
        self.assertEqual((self.slurm.jobs(), self.stored()), (before, 0), "the same cells were submitted again")
        subprocess.run(["scontrol", "release", *before], env=self.slurm.environment, check=True)
        told, error = driver.communicate()
        self.assertEqual(driver.returncode, 0, error)
        self.assertRegex(told, r"run +12 cells")

    def test_ctrl_c_ends_the_tasks(self):
        file = self.write(self.TWO.replace("seeds: 3", "seeds: 100"), duration_s=60)
        driver = self.start(file, "--chunk", 5)
        self.wait_for(lambda: self.stored() > 10, "nobody ran the tasks")
        driver.send_signal(signal.SIGINT)
        _, error = driver.communicate()
        self.assertEqual(driver.returncode, 3)
        self.assertIn("interrupted: finished cells are kept", error)
        self.nothing_is_left()
        self.assertLess(self.stored(), 400)

    def test_a_task_that_ends_too_early(self):
        # Whenever its task comes to the second cell that is killed, as a node without memory does it. The others run.
        file = self.write("set: {criteria: [], stop_when_finished: false}\n"
                          "factors: {long: {key: duration_s, values: [1, 10000000, 2, 3]}}\n")
        driver = self.start(file, "--chunk", 4)
        killed = set()
        while driver.poll() is None:
            for task in self.slurm.processes("n1") + self.slurm.processes("n2"):
                if self.stored() > 0 and b"--chunks" in self.slurm.words_of(task) and self.is_at_work(task):
                    os.kill(task, signal.SIGKILL)
                    killed.add(task)
            time.sleep(0.1)
        _, error = driver.communicate()
        self.assertEqual(driver.returncode, 3, error)
        self.assertEqual(len(killed), 3)
        self.assertEqual([row["state"] for row in self.rows()], ["met", "crashed", "met", "met"])
        self.assertRegex(self.rows()[1]["reason"], r"Slurm task \d+_0 ended as FAILED")

    def is_at_work(self, task):
        """Whether it has run one cell for two seconds: only that which never ends takes so long."""
        try:
            workers = pathlib.Path(f"/proc/{task}/task/{task}/children").read_text().split()
            return any(int(pathlib.Path(f"/proc/{worker}/stat").read_text().split()[13]) > 2 * os.sysconf("SC_CLK_TCK") for worker in workers)
        except FileNotFoundError:
            return False

    def test_stop_rule(self):
        text = ("factors: {accuracy: {key: rover.sensors.gps.accuracy_m, values: [0.001, 0.3]}}\nseeds: 25\n"
                "stop: {metric: rover.average_deviation_m, half_width: 0.2, relative: true, at_least: 4}\n"
                "metrics: [rover.average_deviation_m]\n")
        file = self.write(text, duration_s=5)
        self.on_slurm("run", file)
        self.study("run", file, out="local")
        self.assertEqual(self.bytes_of(), self.bytes_of("local"))
        self.assertIn("not needed", {row["state"] for row in self.rows()})

    def test_bad_input(self):
        file = self.write(self.TWO)
        refused = self.on_slurm("run", file, "--sbatch=--partition=nowhere", "--quiet", status=2)
        self.assertEqual(refused, "vinerow: Slurm refused the job: sbatch: error: Batch job submission failed: Invalid partition name specified\n")
        none = {**os.environ, "PATH": "/nowhere"}
        refused = self.study("run", file, "--runner", "slurm", environment=none, status=2)
        self.assertEqual(refused, "vinerow: this machine has no Slurm ('sbatch' is not in PATH); without '--runner slurm' the study runs locally\n")

    def test_tasks_that_never_work(self):
        # The study is not what it was when the job was submitted.
        file = self.write(self.TWO)
        self.on_slurm("run", file, "--detach", "--sbatch=--hold")
        self.assertEqual(self.slurm.queue().count("PENDING"), 12)
        self.write(self.TWO, duration_s=4)
        self.on_slurm("run", file, "--fresh", "--detach", "--sbatch=--hold")
        self.assertEqual(self.slurm.queue().count("PENDING"), 12, "the outdated tasks are still there")
        self.write(self.TWO, duration_s=5)
        subprocess.run(["scontrol", "release", *self.slurm.jobs()], env=self.slurm.environment, check=True)
        self.wait_for(lambda: "PENDING" not in self.slurm.queue(), "held")
        self.nothing_is_left()
        self.assertEqual(self.stored(), 0)
        logs = [log.read_text() for log in (self.folder / "out" / "slurm").glob("*/0.log")]
        self.assertEqual(len(logs), 1)
        self.assertIn("s.yaml', a file it names or the program has changed since the job was submitted", logs[0])
        # Tasks that cannot even begin: three of them are enough.
        told = self.on_slurm("run", file, "--fresh", "--sbatch=--output=/nowhere/log", "--quiet", status=3)
        self.assertRegex(told, r"^vinerow: no task has a result: Slurm task \d+_\d+ ended as FAILED \(.*\)\n$")
        self.nothing_is_left()

    def test_a_job_that_was_cancelled(self):
        file = self.write(self.TWO.replace("seeds: 3", "seeds: 100"), duration_s=60)
        driver = self.start(file, "--chunk", 5)
        self.wait_for(lambda: self.stored() > 10, "nobody ran the tasks")
        subprocess.run(["scancel", *self.slurm.jobs()], env=self.slurm.environment, check=True)
        _, error = driver.communicate()
        self.assertEqual(driver.returncode, 3)
        self.assertRegex(error, r"Slurm task \d+_\d+ ended as CANCELLED.*; finished cells are kept, 'vinerow study resume' continues\n")
        self.assertGreater(self.stored(), 10)

    def test_a_node_that_never_returns(self):
        self.slurm.kill_node("n2")
        self.addCleanup(self.slurm.start_node, "n2")
        file = self.write(self.TWO)
        told = self.on_slurm("run", file, "--sbatch=--nodelist=n2", "--patience", 3, status=3)
        self.assertRegex(told, r"no task has run for \d+ s \(0 tasks running, 12 waiting.*\); finished cells are kept")
        self.nothing_is_left()


if __name__ == "__main__":
    why = local_slurm.why_not()
    if why:
        print(f"skipped: {why}")
        sys.exit(77)
    place = pathlib.Path(tempfile.mkdtemp(prefix="slurm"))
    try:
        SlurmStudy.slurm = local_slurm.LocalSlurm(place / "cluster", most_tasks=31)
    except RuntimeError as error:
        print(f"skipped: Slurm does not start on this machine: {error}")
        sys.exit(77)
    try:
        unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
    finally:
        SlurmStudy.slurm.stop()
        shutil.rmtree(place)
