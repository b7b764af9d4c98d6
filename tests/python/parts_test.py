#!/usr/bin/env python3
"""Parts written in Python: the same runs as C++ parts, in the command and here, and one sentence for each mistake.

    parts_test.py VINEROW SINE_CONTROLLER ALLEY_CENTRING      (PYTHONPATH has the built package)
"""

import gc
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import vinerow

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent / "parts"
EXAMPLE = ROOT / "docs" / "examples" / "python" / "alley_centring.yaml"
VINEROW, SINE_CONTROLLER, ALLEY_CENTRING = (os.path.abspath(word) for word in sys.argv[1:])
SESSION = None
WORLD = {"type": "vineyard", "row_count": 2, "row_length_m": 20, "relief_m": 0, "waves_m": 0, "leaf_cards_per_m": 10, "plant_variants": 1}


def rover(plugin, duration_s=3, **parts):
    return {"vinerow": 1, "name": "parts", "duration_s": duration_s, "plugins": [str(plugin)], "world": WORLD,
            "vehicles": {"rover": {"type": "diff_drive_rover", "spawn": {"alley": 0}, **{"estimator": {"type": "truth"}, **parts}}}}


def digest(tree):
    with vinerow.open(tree) as session:
        session.step(1e6)
        return session.digest


def command(*words, **options):
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    return subprocess.run([VINEROW, *map(str, words)], capture_output=True, text=True, env=environment, **options)


def run_of_the_command(tree):
    """Process and summary of `vinerow run`, which finds the Python package itself."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "parts.yaml"
        file.write_text(json.dumps(tree))
        done = command("run", file, "--quiet", "--no-pictures", "--no-report", "--out", folder + "/run")
        summary = pathlib.Path(folder) / "run" / "summary.json"
        return done, json.loads(summary.read_text()) if summary.exists() else {}


class Runs(unittest.TestCase):
    def test_the_example_has_the_digest_of_the_same_law_in_cpp(self):
        with vinerow.open(EXAMPLE) as session:
            session.step(1e6)
            python = session.digest
            self.assertEqual(session.metrics()["rover"]["contact_count"], 0)
            self.assertGreater(session.metrics()["rover"]["distance_m"], 10.0)
        with vinerow.open(EXAMPLE, {"plugins": [ALLEY_CENTRING], "rover.controller": {"type": "alley_centring"}}) as session:
            session.step(1e6)
            self.assertEqual(session.digest, python)

    def test_the_example_of_the_guide(self):
        text = (ROOT / "docs" / "guides" / "python_parts.md").read_text()
        example = re.search(r"```python\n(.*?)```", text, re.DOTALL).group(1)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "circle.py"
            file.write_text(example)
            with vinerow.open(rover(file, 3, controller={"type": "circle", "speed_mps": 0.5})) as session:
                session.step(1e6)
                self.assertGreater(session.metrics()["rover"]["distance_m"], 0.5)
                self.assertGreater(session.signal("rover/truth")["pose"].yaw, 0.1)  # to the left, where the wheels are slower

    def test_elementary_functions_are_those_of_the_simulator(self):
        self.assertEqual(digest(rover(HERE / "good_parts.py", controller={"type": "sine_py"})),
                         digest(rover(SINE_CONTROLLER, controller={"type": "sine"})))

    def test_the_command_computes_the_same(self):
        for tree in (rover(HERE / "good_parts.py", controller={"type": "machine_sine"}),
                     rover(HERE / "good_parts.py", controller={"type": "random_walk"})):
            done, summary = run_of_the_command(tree)
            self.assertIn(done.returncode, (0, 1), done.stderr)
            self.assertEqual(summary["digest"], digest(tree))

    def test_random_numbers_follow_the_seed(self):
        tree = rover(HERE / "good_parts.py", controller={"type": "random_walk"})
        self.assertEqual(digest(tree), digest(tree))
        self.assertNotEqual(digest(tree), digest({**tree, "seed": 2}))

    def test_planner_and_estimator(self):
        tree = rover(HERE / "good_parts.py", 40, planner={"type": "line"}, controller={"type": "pure_pursuit"}, estimator={"type": "copy"})
        with vinerow.open(tree) as session:
            session.step(5.0)
            truth, estimate = (session.signal(f"rover/{name}")["pose"].position for name in ("truth", "estimate"))
            self.assertGreater(session.metrics()["rover"]["distance_m"], 1.0)
            self.assertEqual(truth.tolist(), estimate.tolist())
            session.step(1e6)
            numbers = session.metrics()["rover"]
            ends = session.map("rover").alleys[0].line[[0, -1]]
            self.assertAlmostEqual(numbers["planned_length_m"], float(sum((ends[1] - ends[0]) ** 2) ** 0.5), places=9)
            self.assertTrue(session.finished)
            self.assertLess(numbers["cross_track_max_m"], 0.1)

    def test_guidance(self):
        tree = rover(HERE / "good_parts.py", 6, guidance={"type": "forward_py"}, controller={"type": "four_wheel_steering"},
                     planner={"type": "line"})
        tree["vehicles"]["rover"]["type"] = "four_wheel_steering_rover"
        with vinerow.open(tree) as session:
            session.step(1e6)
            # The controller alone would drive at its own speed.
            self.assertAlmostEqual(session.signal("rover/local_command")["speed"], 0.5)
            self.assertAlmostEqual(session.metrics()["rover"]["max_speed_mps"], 0.5, delta=0.1)

    def test_a_planner_without_a_path(self):
        tree = rover(HERE / "good_parts.py", planner={"type": "line"}, controller={"type": "pure_pursuit"})
        tree["world"] = {**WORLD, "row_count": 3}
        with vinerow.open(tree) as session, self.assertRaisesRegex(vinerow.ConfigError, r"rover.planner \(line\): only for two rows"):
            session.step(1.0)

    def test_finished_and_failure(self):
        base = {"type": "until", "end_s": 1.0, "must_mps": 1}
        with vinerow.open(rover(HERE / "good_parts.py", controller=base)) as session:
            session.step(1e6)
            self.assertTrue(session.finished)
            self.assertAlmostEqual(session.metrics()["rover"]["time_s"], 1.0, delta=0.06)
        with vinerow.open(rover(HERE / "good_parts.py", controller={**base, "gives_up": True})) as session:
            session.step(1e6)
            self.assertFalse(session.finished)
            self.assertIn("ran out of patience", str([event.text for event in session.take_events()]))

    def test_sessions_on_threads(self):
        tree = rover(HERE / "good_parts.py", controller={"type": "sine_py"})
        wanted, digests = digest(tree), []
        threads = [threading.Thread(target=lambda: digests.append(digest(tree))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60)
        self.assertEqual(digests, [wanted] * 4)

    def test_reset_and_twin(self):
        with vinerow.open(EXAMPLE, {"duration_s": 2}) as session, session.twin() as twin:
            digests = []
            for one in (session, twin):
                one.step(1e6)
                digests.append(one.digest)
            session.reset()
            session.step(1e6)
            self.assertEqual({*digests, session.digest}, {digests[0]})

    def test_a_study(self):
        with tempfile.TemporaryDirectory() as folder:
            study = pathlib.Path(folder) / "study.yaml"
            study.write_text(f"vinerow_study: 1\nscenario: {EXAMPLE}\nset: {{duration_s: 1}}\n"
                             "factors: {speed_mps: {key: rover.controller.speed_mps, values: [0.5, 0.8]}}\n")
            done = command("study", "run", study, "--jobs", "2", cwd=folder)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            tables = list(pathlib.Path(folder).rglob("cells.csv"))
            self.assertEqual(len(tables), 1, done.stdout)
            text = tables[0].read_text()
            for speed in (0.5, 0.8):
                with vinerow.open(EXAMPLE, {"duration_s": 1, "rover.controller.speed_mps": speed}) as session:
                    session.step(1e6)
                    self.assertIn(session.digest, text)

    def test_later_commands_load_the_plug_ins_of_the_run(self):
        with tempfile.TemporaryDirectory() as folder:
            plugin, scenario, run = (pathlib.Path(folder) / name for name in ("until.py", "parts.yaml", "run"))
            plugin.write_text((HERE / "good_parts.py").read_text())
            tree = rover(plugin, controller={"type": "until", "must_mps": 0.5})
            for given in ([], ["--plugin", plugin]):
                scenario.write_text(json.dumps({**tree, "plugins": []} if given else tree))
                done = command("run", scenario, *given, "--quiet", "--no-pictures", "--no-report", "--out", run)
                self.assertIn(done.returncode, (0, 1), done.stderr)
                summary = json.loads((run / "summary.json").read_text())
                repeated = command("run", run / "scenario.resolved.yaml", "--quiet", "--no-pictures", "--out", run / "again")
                self.assertIn(f"digest   {summary['digest']}\n", repeated.stdout, repeated.stderr)
                for words in (["report", run, "--plugin", plugin], ["replay", run], ["replay", run / "log.mcap"], ["replay", run, "--plugin", plugin],
                              ["video", run, "-o", run / "a.mp4", "--to", 0.1], ["render", run, "--time", 1]):
                    self.assertNotIn("unknown controller", command(*words).stderr)
            plugin.unlink()
            self.assertIn("until.py': no such file", command("replay", run).stderr)

    def test_list_and_schema_have_the_parameters(self):
        done = command("list", "until", "--plugin", HERE / "good_parts.py")
        self.assertEqual(done.returncode, 0, done.stderr)
        for words in (r"controller until .*good_parts\.py", r"rate_Hz: default 20", r"end_s +s +default 1 +>= 0 +end of the task",
                      r"side +default left +left \| right", r"must_mps +m/s +default required", r"count +default 3"):
            self.assertRegex(done.stdout, words)
        schema = command("schema", "--plugin", HERE / "good_parts.py")
        self.assertIn("wheels_radps", schema.stdout)


class Mistakes(unittest.TestCase):
    def fails(self, kind, **parts):
        with vinerow.open(rover(HERE / "bad_parts.py", **parts)) as session, self.assertRaises(kind) as caught:
            session.step(2.0)
        return caught.exception

    def test_in_a_step(self):
        text = (HERE / "bad_parts.py").read_text().split("\n")
        line = 1 + next(i for i, words in enumerate(text) if "LINE raises" in words)
        for name, words in {
            "raises": rf"ZeroDivisionError: division by zero \(bad_parts\.py:{line}\)",
            "exits": r"SystemExit: 3 \(bad_parts\.py:\d+\)",
            "writes_nan": r"actuators contains NaN \(bad_parts\.py:\d+\)",
            "wrong_actuator": r"rover\.controller drives actuator 'wheel_front', which vehicle type 'diff_drive_rover' does not have.*:\d+\)",
            "wrong_type": r"actuators\['wheel_fl_speed_radps'\] must be a number, not str \(bad_parts\.py:\d+\)",
            "no_dict": r"actuators must be a dict of names and numbers, not list \(bad_parts\.py:\d+\)",
            "returns": r"step\(\) must return None, not dict; values go to a writer \(bad_parts\.py\)",
            "wrong_field": r"KeyError: .*signal 'estimate' has no field 'pos'; did you mean 'pose'\?.*\(bad_parts\.py:\d+\)",
            "no_field": r"field must be a str, not int \(bad_parts\.py:\d+\)",
            "odd_finish": r"finished\(\) must return a bool, not str \(bad_parts\.py\)",
        }.items():
            with self.subTest(name):
                error = self.fails(vinerow.SimulationError, controller={"type": name})
                self.assertRegex(str(error), words)
                self.assertEqual(error.part, f"rover.controller ({name})")
                self.assertAlmostEqual(error.time_s, 0.0 if name == "odd_finish" else 0.5)

    def test_plans(self):
        for name, words in {"bad_path": r"the result of plan\(\) must have at least 2 points, not 1",
                            "bad_shape": r"the result of plan\(\)\.points\[0\]\.position must have 3 numbers, not 2"}.items():
            error = self.fails(vinerow.SimulationError, planner={"type": name}, controller={"type": "pure_pursuit"})
            self.assertRegex(str(error), words)

    def test_while_it_is_built(self):
        for name, words in {
            "raises_in_init": r"rover\.controller \(raises_in_init\): ValueError: no \(bad_parts\.py:\d+\)",
            "no_signal": r"the name 'sonar_left' does not determine a message type",
            "no_name": r"rover\.controller \(no_name\): name must be a str, not int",
            "nobody_writes": r"reads signal 'rover/estimat', which nobody writes; did you mean 'estimate'",
        }.items():
            with self.subTest(name), self.assertRaisesRegex(vinerow.ConfigError, words):
                vinerow.open(rover(HERE / "bad_parts.py", controller={"type": name})).close()

    def test_parameters(self):
        for changes, words in (({"end_s": -1}, r"end_s = -1 s, must be >= 0 s"), ({"sid": "left"}, r"did you mean 'side'"),
                               ({"side": "up"}, r"side"), ({"must_mps": None}, r"must_mps")):
            part = {"type": "until", "must_mps": 1, **changes}
            part = {key: value for key, value in part.items() if value is not None}
            with self.assertRaisesRegex(vinerow.ConfigError, words):
                vinerow.load(rover(HERE / "good_parts.py", controller=part))

    def test_files(self):
        head = "from vinerow import parts\n"
        whole = "    def connect(self, ports): pass\n    def step(self, now_s): pass\n"
        for text, words, line in (
            ("x = 1\ndef f(:\n", r"bad\.py:2: SyntaxError: invalid syntax", 2),
            ("x = 1\ny = z\n", r"bad\.py:2: NameError: name 'z' is not defined", 2),
            ("import sys\nsys.exit()\n", r"bad\.py:2: SystemExit", 2),
            ("x = 1\n", r"bad\.py: has no part: no class with a decorator of vinerow\.parts", None),
            (head + "@parts.controller('a', rate_Hz=1)\nclass A(parts.Controller):\n    'w'\n    def connect(self, ports): pass\n",
             r"bad\.py:2: controller 'a': class A has no method step\(\)", 2),
            (head + "@parts.controller('a', rate_Hz=0)\nclass A(parts.Controller):\n    'w'\n" + whole,
             r"controller 'a': rate_Hz = 0, must be a number > 0", 2),
            (head + "@parts.planner('a')\nclass A(parts.Controller):\n    'w'\n" + whole, r"must be a class derived from .*Planner", 2),
            (head + "@parts.controller('a', rate_Hz=1)\nclass A(parts.Controller):\n    'w'\n    x_m = parts.Number(-1, 'm', at_least=0)\n" + whole,
             r"bad\.py:2: the default x_m = -1 m, must be >= 0 m", 2),
            (head + "@parts.controller('a', rate_Hz=1)\nclass A(parts.Controller):\n    'w'\n    x_m = parts.Number('b', 'm')\n" + whole,
             r"bad\.py:2: the default of 'x_m' must be a number, not str", 2),
            (head + "@parts.controller('pure_pursuit', rate_Hz=1)\nclass A(parts.Controller):\n    'w'\n" + whole,
             r"bad\.py:2: controller 'pure_pursuit' is registered twice \(built-in, .*bad\.py\)", 2),
        ):
            with self.subTest(words), tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder) / "bad.py"
                file.write_text(text)
                with self.assertRaisesRegex(vinerow.ConfigError, words) as caught:
                    vinerow.load(rover(file))
                self.assertEqual((caught.exception.file, caught.exception.line), (str(file), line))
        done = command("list", "--plugin", HERE / "none.py")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"plug-in '.*none\.py' does not exist")

    def test_the_command_says_the_same(self):
        done, _ = run_of_the_command(rover(HERE / "bad_parts.py", controller={"type": "raises"}))
        self.assertEqual(done.returncode, 3)
        self.assertRegex(done.stdout + done.stderr, r"ZeroDivisionError: division by zero \(bad_parts\.py:\d+\)")

    def test_ctrl_c_ends_a_part_that_blocks(self):
        for name in ("loops", "loops_in_init"):
            threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
            with self.assertRaises(KeyboardInterrupt):
                with vinerow.open(rover(HERE / "bad_parts.py", controller={"type": name})) as session:
                    session.step(1.0)

    def test_ctrl_c_ends_a_part_that_blocks_in_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "parts.yaml"
            file.write_text(json.dumps(rover(HERE / "bad_parts.py", controller={"type": "loops"})))
            process = subprocess.Popen([VINEROW, "run", file, "--quiet", "--no-pictures", "--no-report", "--out", folder + "/run"],
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            self.assertEqual(process.stdout.readline(), "looping\n")
            process.send_signal(signal.SIGINT)
            text, _ = process.communicate(timeout=30)
            self.assertEqual(process.returncode, 3, text)
            self.assertIn("interrupted by Ctrl-C", text)

    def test_a_part_that_holds_on_to_its_run(self):
        global SESSION
        SESSION = vinerow.open(rover(HERE / "bad_parts.py", controller={"type": "uses_the_session"}))
        with self.assertRaisesRegex(vinerow.SimulationError, "the session is in use by another thread"):
            SESSION.step(1.0)
        SESSION.close()
        with vinerow.open(rover(HERE / "bad_parts.py", controller={"type": "keeps"})) as session:
            session.step(1.0)
            kept = sys.modules["bad_parts"].KEPT
        gc.collect()
        part, reader, pose, context, writer = kept[0]
        self.assertEqual(pose.position.shape, (3,))
        for use in (lambda: reader["pose"], lambda: reader.count, lambda: context.map, lambda: writer.write({})):
            with self.assertRaisesRegex(vinerow.UsageError, "may be used only in"):
                use()
        with vinerow.open(rover(HERE / "bad_parts.py", controller={"type": "starts_threads"})) as session:
            session.step(0.5)
            self.assertRegex(sys.modules["bad_parts"].KEPT[1], r"reader 'estimate' may be used only in step\(\), in the thread that runs")

    def test_the_process_ends_well(self):
        for words in ("session.step(1.0)", "session.step(1.0); session.close()", "import sys; sys.modules['x'] = session"):
            script = f"import vinerow\nsession = vinerow.open({str(EXAMPLE)!r})\n{words}\n"
            done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
