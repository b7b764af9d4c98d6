#!/usr/bin/env python3
"""vinerow.Session from Python: the same bits as the command, safe views, and one sentence for each mistake.

    session_test.py VINEROW PLUGIN      (PYTHONPATH has the built package)
"""

import copy
import gc
import json
import math
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy

import vinerow

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "assets" / "scenarios"
FREE_ROVER = ROOT / "docs" / "examples" / "session" / "free_rover.yaml"
VINEROW, SINE_CONTROLLER = sys.argv[1:]
WHEELS = [f"wheel_{corner}_speed_radps" for corner in ("fl", "fr", "rl", "rr")]


def free_rover(**options) -> vinerow.Session:
    return vinerow.open(FREE_ROVER, take_over=["rover/actuators"], **options)


def run_of_the_command(scenario: pathlib.Path, changes: dict) -> dict:
    """summary.json of `vinerow run`."""
    with tempfile.TemporaryDirectory() as folder:
        sets = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
        done = subprocess.run([VINEROW, "run", scenario, "--quiet", "--no-pictures", "--no-report", "--out", folder, *sets],
                              capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        return json.loads((pathlib.Path(folder) / "summary.json").read_text())


def drive(session: vinerow.Session, speed_radps: float) -> None:
    session.command("rover/actuators", dict.fromkeys(WHEELS, speed_radps))


class Bits(unittest.TestCase):
    def test_the_digest_is_that_of_the_command(self):
        changes = {"duration_s": 3, "criteria": []}
        summary = run_of_the_command(SCENARIOS / "orchard_rover.yaml", changes)
        with vinerow.open(SCENARIOS / "orchard_rover.yaml", changes) as session:
            session.step(1e6)
            self.assertEqual(session.digest, summary["digest"])
            # JSON has null for NaN.
            metrics = {vehicle: {name: None if math.isnan(value) else value for name, value in values.items()}
                       for vehicle, values in session.metrics().items()}
            self.assertEqual(metrics, summary["metrics"])

    def test_the_command_finds_a_plugin_in_the_current_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "mine.so").symlink_to(SINE_CONTROLLER)
            listed = subprocess.run([VINEROW, "list", "sine", "--plugin", "mine.so"], cwd=folder, capture_output=True, text=True, check=False)
        self.assertEqual(listed.returncode, 0, listed.stderr)
        self.assertIn("controller sine", listed.stdout)

    def test_a_plugin_computes_what_it_computes_for_the_command(self):
        # The interpreter has loaded the C library's sin before the plug-in is loaded.
        changes = {"plugins": f"[{SINE_CONTROLLER}]", "rover.controller": "{type: sine}", "duration_s": "3"}
        summary = run_of_the_command(FREE_ROVER, changes)
        sets = [f"{key}={value}" for key, value in changes.items()]
        with vinerow.open(FREE_ROVER, sets=sets) as session:
            session.step(3.0)
            self.assertGreater(session.metrics()["rover"]["distance_m"], 0.5)
            self.assertEqual(session.digest, summary["digest"])

    def test_division_into_calls_and_threads_change_no_bit(self):
        def run(step_s: float) -> str:
            with vinerow.open(SCENARIOS / "orchard_rover.yaml", {"duration_s": 2}) as session:
                while not session.over:
                    session.step_for(step_s)
                return session.digest

        wanted = run(2.0)
        self.assertEqual(run(0.06), wanted)
        digests = []
        threads = [threading.Thread(target=lambda: digests.append(run(0.05))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(digests, [wanted] * 4)

    def test_reset_and_twin_repeat_the_run(self):
        with free_rover() as session, session.twin() as twin:
            digests = []
            for s in (session, twin, session):
                if s is session and digests:
                    s.reset()
                drive(s, 4.0)
                s.step(1.0)
                digests.append(s.digest)
            self.assertEqual(len(set(digests)), 1)
            session.reset(7)
            self.assertEqual(session.seed, 7)

    def test_a_scenario_from_a_dict(self):
        tree = {
            "vinerow": 1, "name": "free_rover", "duration_s": 10,
            "world": {"type": "vineyard", "row_count": 2, "row_length_m": numpy.float64(20), "relief_m": 0, "waves_m": 0,
                      "leaf_cards_per_m": 10, "plant_variants": 1},
            "vehicles": {"rover": {"type": "diff_drive_rover", "spawn": {"alley": numpy.int64(0)}}},
        }
        with vinerow.open(tree) as from_dict, vinerow.open(FREE_ROVER) as from_file:
            for session in (from_dict, from_file):
                session.step(1.0)
            self.assertEqual(from_dict.digest, from_file.digest)

class Values(unittest.TestCase):
    def test_a_driven_rover_is_where_its_views_are(self):
        with free_rover() as session:
            truth = session.signal("rover/truth")
            self.assertEqual(truth.type, "Odometry")
            session.step(0.0)
            start = truth["pose"].position.copy()
            view = truth["pose"].position
            drive(session, 4.0)
            session.step(3.0)
            driven = numpy.linalg.norm(view - start)
            self.assertGreater(driven, 1.0)
            self.assertAlmostEqual(driven, session.metrics()["rover"]["distance_m"], delta=0.05)
            self.assertAlmostEqual(truth["linear_velocity"][0], truth.value.linear_velocity[0])
            self.assertEqual(truth.fields["linear_velocity"][:2], ("vector", "m/s"))
            self.assertAlmostEqual(truth.stamp_s, 3.0)

    def test_the_pose_has_the_direction_of_the_row(self):
        with free_rover() as session:
            session.step(0.0)
            line = session.world().alleys[0].line
            east, north, _ = line[-1] - line[0]
            pose = session.signal("rover/truth")["pose"]
            self.assertAlmostEqual(float(pose.yaw), math.atan2(north, east), delta=0.02)
            x, y, z, w = pose.orientation  # a turn about the vertical, nearly: w is the last
            self.assertAlmostEqual(2.0 * math.atan2(z, w), math.atan2(north, east), delta=0.02)

    def test_a_plan_is_a_dict_of_fields(self):
        points = [{"position": (float(x), 0.5, 0.0), "yaw": 0.1, "kind": "TURN", "alley": 2} for x in range(3)]
        scenario = vinerow.load(FREE_ROVER, {"rover.controller": {"type": "pure_pursuit"}})
        with vinerow.open(scenario, take_over=["rover/plan"]) as session:
            session.command("rover/plan", {"points": points, "length": 2.0})
            session.step(0.0)
            plan = session.signal("rover/plan").value
            numpy.testing.assert_array_equal(plan.points.position, [point["position"] for point in points])
            self.assertEqual(plan.points.kind, ["TURN"] * 3)
            self.assertEqual(list(plan.points.alley), [2] * 3)
            self.assertEqual(list(plan.points.speed), [0.0] * 3)  # absent: its default
            self.assertEqual(session.signal("rover/plan").writer, "outside")

            def refusal(change):
                return Mistakes.refused(self, vinerow.ConfigError, "rover/plan", session.command, "rover/plan",
                                        {"points": [points[0], {**points[1], **change}]})
            self.assertEqual(str(refusal({"position": (1.0, 2.0)})), "rover/plan.points[1].position must have 3 numbers, not 2")
            self.assertIn("did you mean 'TURN'", str(refusal({"kind": "TURNS"})))
            self.assertIn("has no field 'yw'; did you mean 'yaw'", str(refusal({"yw": 0.0})))
            self.assertIn(".alley must be an int, not float", str(refusal({"alley": 0.5})))

    def test_a_value_is_pickled_and_copied_as_one_for_another_process(self):
        with free_rover() as session:
            session.step(0)
            value = session.signal("rover/truth").value
        for again in (pickle.loads(pickle.dumps(value)), copy.copy(value), copy.deepcopy(value)):
            self.assertEqual(repr(again), repr(value))
            self.assertEqual((again.type, again.pose.position.tobytes()), ("Odometry", value.pose.position.tobytes()))

    def test_events_crashes_and_phases(self):
        with vinerow.open(SCENARIOS / "cooperative_small.yaml", {"duration_s": 10}) as session:
            self.assertEqual(session.phases()[0].state, "waiting")
            session.step(9.5)
            survey = session.phases()[0]
            self.assertEqual((survey.name, survey.state, survey.begin_s, survey.end_s), ("survey", "running", 9.0, None))
            events = session.take_events()
            self.assertEqual((events[0].time_s, events[0].level, events[0].text), (0.0, "INFO", "started 'cooperative_small'"))
            self.assertIn(vinerow.Event(9.0, "INFO", "survey", "phase 'survey' begins"),
                          [event._replace(source="survey") for event in events])
            self.assertEqual(session.take_events(), [])
            self.assertEqual(session.crashes(), [])

    def test_a_run_that_breaks_off(self):
        # Driven off the terrain's edge.
        with free_rover(sets=["duration_s=30", "rover.spawn={alley: 0, offset_m: 9}"]) as session:
            drive(session, -9.0)
            error = Mistakes.refused(self, vinerow.SimulationError, "rover", session.step, 30.0)
            self.assertIn("rover", error.part)
            self.assertAlmostEqual(error.time_s, session.now_s, delta=0.01)
            self.assertEqual(session.take_events()[-1].level, "ERROR")
            session.reset()
            session.step(0.1)

    def test_views_are_read_only_and_share_memory(self):
        with free_rover() as session:
            session.step(0.1)
            truth = session.signal("rover/truth")
            first, second = truth["linear_velocity"], truth["linear_velocity"]
            self.assertTrue(numpy.shares_memory(first, second))
            self.assertFalse(first.flags.writeable)
            with self.assertRaises(ValueError):
                first[0] = 1.0

    def test_views_outlive_reset_and_session(self):
        session = free_rover()
        drive(session, 4.0)
        session.step(1.0)
        view = session.signal("rover/truth")["pose"].position
        wanted = view.copy()
        session.reset()
        session.step(0.5)
        numpy.testing.assert_array_equal(view, wanted)
        session.close()
        del session
        gc.collect()
        numpy.testing.assert_array_equal(view, wanted)


class Mistakes(unittest.TestCase):
    def refused(self, error, text, call, *arguments, **keywords):
        with self.assertRaises(error) as caught:
            call(*arguments, **keywords)
        self.assertIn(text, str(caught.exception))
        return caught.exception

    def test_scenarios(self):
        self.refused(vinerow.ConfigError, "no_such.yaml", vinerow.load, "no_such.yaml")
        error = self.refused(vinerow.ConfigError, "duration_s = 'long', must be", vinerow.load, FREE_ROVER, {"duration_s": "long"})
        self.assertEqual((error.file, error.line, error.key), (None, None, "duration_s"))
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "typo.yaml"
            file.write_text(FREE_ROVER.read_text().replace("spawn: {alley: 0}", "spawn: {alley: zero}"))
            error = self.refused(vinerow.ConfigError, "alley", vinerow.load, file)
            line = next(k for k, text in enumerate(file.read_text().splitlines(), 1) if "zero" in text)
            self.assertEqual((error.file, error.line), (str(file), line))
            self.assertEqual(error.key, "vehicles.rover.spawn.alley")
        self.refused(vinerow.ConfigError, "must be None, bool", vinerow.load, FREE_ROVER, {"duration_s": object()})
        for seed in (-1, 1.5, "one"):
            self.refused(vinerow.ConfigError, f"seed = {seed!r}, must be a whole number", vinerow.load, FREE_ROVER, seed=seed)
        self.assertEqual(vinerow.load(FREE_ROVER, seed=numpy.int64(3)).seed, 3)
        # A dict has no lines: its errors name the key alone.
        error = self.refused(vinerow.ConfigError, "", vinerow.load, {"vinerow": 1, "name": "x", "duration_s": "long"})
        self.assertTrue(str(error).startswith("duration_s = 'long', must be"), error)
        self.assertEqual((error.file, error.line, error.key), (None, None, "duration_s"))
        loop = []
        loop.append(loop)
        self.refused(vinerow.ConfigError, "nested", vinerow.load, FREE_ROVER, {"duration_s": loop})

    def test_commands(self):
        with free_rover() as session:
            command = session.command
            self.refused(vinerow.ConfigError, "rover/actuators", command, "rover/actuator", {})
            self.refused(vinerow.ConfigError, "must be a dict", command, "rover/actuators", [1.0])
            self.refused(vinerow.ConfigError, "must be a number, not str", command, "rover/actuators", {WHEELS[0]: "fast"})
            self.refused(vinerow.ConfigError, "NaN", command, "rover/actuators", {WHEELS[0]: math.nan})
            self.refused(vinerow.ConfigError, "no_wheel", command, "rover/actuators", {"no_wheel": 1.0})
            session.step(1.0)
            self.refused(vinerow.ConfigError, "0.5", command, "rover/actuators", {WHEELS[0]: 1.0}, at_s=0.5)
            self.refused(vinerow.UsageError, "finite", session.step, math.nan)
            self.refused(vinerow.UsageError, "shorter than the physics step of 0.001 s", session.step_for, 0.0001)
            self.refused(KeyError, "linear_velocity", session.signal("rover/truth").__getitem__, "linear_velocty")
        self.refused(vinerow.ConfigError, "AirReference", vinerow.open, FREE_ROVER, take_over=["rover/reference"])

    def test_arguments_of_a_wrong_type(self):
        with free_rover() as session:
            for text, call, argument in (("until_s must be a number, not str", session.step, "soon"),
                                         ("duration_s must be a number, not NoneType", session.step_for, None),
                                         ("seed = -1, must be a whole number from 0 to 18446744073709551615", session.reset, -1),
                                         ("seed = 1.5, must be a whole number from 0 to 18446744073709551615", session.reset, 1.5),
                                         ("name must be a str, not int", session.signal, 1), ("vehicle must be a str, not int", session.map, 1),
                                         ("field must be a str, not int", session.signal("rover/truth").__getitem__, 1),
                                         ("source must be a path, not int", vinerow._core.load_file, 1)):
                with self.assertRaises(vinerow.ConfigError) as caught:
                    call(*((argument, {}, [], None) if call is vinerow._core.load_file else (argument,)))
                self.assertEqual(str(caught.exception), text)

    def test_opening_with_arguments_of_a_wrong_type(self):
        for text, call in (("source must be a file or a dict, not float", lambda: vinerow.load(1.5)),
                           ("source must be a file or a dict, not NoneType", lambda: vinerow.open(None)),
                           ("overrides must be a dict, not list", lambda: vinerow.load(FREE_ROVER, ["duration_s"])),
                           ("sets must be a list of str, not str", lambda: vinerow.load(FREE_ROVER, sets="duration_s=1")),
                           ("an entry of sets must be a str, not bytes", lambda: vinerow.load(FREE_ROVER, sets=[b"x"])),
                           ("folder must be a path, not int", lambda: vinerow.load({"vinerow": 1}, folder=3)),
                           ("take_over must be a list of signals, not float", lambda: vinerow.open(FREE_ROVER, take_over=1.5)),
                           ("scenario must be a Scenario, not NoneType; vinerow.open() takes files and dicts",
                            lambda: vinerow.Session(None, [])),
                           ("out must be a path, not bool", lambda: vinerow.run(FREE_ROVER, out=True)),
                           ("file must be a path, not bytes", lambda: vinerow.read_log(b"x")),
                           ("folder must be a path, not int", lambda: vinerow.read_run(0)),
                           ("folder must be a path, not list", lambda: vinerow.read_study([]))):
            with self.subTest(text), self.assertRaises(vinerow.ConfigError) as caught:
                call()
            self.assertEqual(str(caught.exception), text)

    def test_times_are_those_of_the_decimal(self):
        # 2501 times 1e-3 with one rounding each is 2.5010000000000003.
        with free_rover(sets=["physics.step_s=0.001"]) as session:
            session.step(2.5)
            self.assertEqual(repr(session.now_s), "2.501")

    def test_after_the_end(self):
        with free_rover(sets=["duration_s=0.2"]) as session:
            session.step(5.0)
            self.assertTrue(session.over)
            self.refused(vinerow.ConfigError, "is over at", session.step, 6.0)
        self.refused(vinerow.UsageError, "closed", session.step, 6.0)
        self.refused(vinerow.UsageError, "closed", lambda: session.now_s)

    def test_signals_without_value_or_session(self):
        session = free_rover()
        truth = session.signal("rover/truth")
        self.refused(vinerow.UsageError, "no value yet", truth.__getitem__, "pose")
        session.close()
        self.refused(vinerow.UsageError, "closed", truth.__getitem__, "pose")

    def test_two_threads_on_one_session(self):
        with free_rover(sets=["duration_s=1000"]) as session:
            started, caught = threading.Event(), []

            def step():
                started.set()
                session.step(60.0)

            thread = threading.Thread(target=step)
            thread.start()
            started.wait()
            while thread.is_alive() and not caught:
                try:
                    session.now_s
                except vinerow.UsageError as error:
                    caught.append(str(error))
            thread.join()
            self.assertIn("another thread", caught[0])

    def test_a_fork_cannot_use_the_parents_session(self):
        with free_rover() as session:
            session.step(0.1)
            reader, writer = os.pipe()
            child = os.fork()
            if child == 0:
                try:
                    session.step(0.2)
                    text = "stepped"
                except vinerow.UsageError as error:
                    text = str(error)
                with free_rover() as own:
                    own.step(0.1)
                    text += "; own " + own.digest
                os.write(writer, text.encode())
                os._exit(0)
            os.waitpid(child, 0)
            text = os.read(reader, 4096).decode()
            self.assertIn("belongs to the process", text)
            self.assertIn("own " + session.digest, text)

    def test_ctrl_c_ends_a_long_step_between_two_instants(self):
        with free_rover(sets=["duration_s=10000000"]) as session:
            threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
            begin = time.monotonic()
            with self.assertRaises(KeyboardInterrupt):
                session.step(1.0e7)
            self.assertLess(time.monotonic() - begin, 20.0)
            session.step_for(0.1)  # goes on


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
