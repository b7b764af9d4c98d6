#!/usr/bin/env python3
"""The examples of docs/examples/live: a teleoperated rover drives as its commands ask, a path follower in lock-step repeats, and a layout
of Foxglove names services that exist.

    live_test.py VINEROW     (in the environment of tools/python_environment)
"""

import json
import math
import os
import pathlib
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest

import numpy
from websockets.sync.client import ClientConnection, connect

import vinerow

ROOT = pathlib.Path(__file__).resolve().parents[2]
VINEROW = sys.argv[1]
EXAMPLES = ROOT / "docs" / "examples" / "live"
TELEOP = ROOT / "assets" / "scenarios" / "vineyard_teleop.yaml"
FREE_ROVER = ROOT / "docs" / "examples" / "session" / "free_rover.yaml"
LAYOUT = ROOT / "assets" / "foxglove" / "live.json"
# A level vineyard has a closed form. Commands hold longer, should this machine be busy.
LEVEL = ["world.relief_m=0", "world.waves_m=0", "rover.controller.timeout_s=5"]
SPEED_mps, ACCELERATION_mps2 = 0.8, 1.5  # of teleop.py and of the scenario
# Below the domains of other tests, which are 20 to 99.
DOMAIN = 1 + os.getpid() % 19
PATIENCE_s = 60


def command_of(scenario: pathlib.Path, out: pathlib.Path, options: list, changes: list[str] = []) -> list:
    sets = [word for change in changes for word in ("--set", change)]
    return [VINEROW, "run", scenario, "--out", out, "--no-pictures", "--no-report", "--quiet", *options, *sets]


def digest_of(output: str) -> str:
    return re.search(r"digest +(\w+)", output).group(1)


class Run:
    """A live run in the background. Ends with the context."""

    def __init__(self, scenario: pathlib.Path, out: pathlib.Path, *changes: str, options: tuple = ()):
        self.out = out
        self.process = subprocess.Popen(command_of(scenario, out, ["--live", "--live-port", "0", *options], list(changes)),
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        for line in self.process.stdout:
            if address := re.match(r"live +http://localhost:(\d+)/", line):
                self.address = f"ws://localhost:{address.group(1)}"
                break

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def end(self) -> None:
        """Interrupts the run, so that its log is complete."""
        if not self.process.stdout.closed:
            self.process.send_signal(signal.SIGINT)
            self.process.communicate(timeout=PATIENCE_s)


def teleop(*arguments: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-B", EXAMPLES / "teleop.py", *arguments], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=PATIENCE_s)


class Keyboard:
    """teleop.py in a terminal."""

    def __init__(self, address: str):
        self.here, self.terminal = pty.openpty()
        self.settings = termios.tcgetattr(self.terminal)
        self.process = subprocess.Popen([sys.executable, "-B", EXAMPLES / "teleop.py", address], stdin=self.terminal,
                                        stdout=self.terminal, stderr=self.terminal)
        self.expect(r"stop +x ")

    def press(self, key: str, expected: str) -> None:
        """Presses a key and waits for what it shows."""
        os.write(self.here, key.encode())
        self.expect(expected)

    def expect(self, expected: str) -> None:
        text, end = "", time.monotonic() + PATIENCE_s
        while not re.search(expected, text):
            if time.monotonic() > end:
                raise AssertionError(f"no '{expected}' in '{text[-200:]}'")
            if select.select([self.here], [], [], 0.1)[0]:
                text += os.read(self.here, 4096).decode()

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        os.close(self.here)
        os.close(self.terminal)


class Live(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class Teleop(Live):
    def test_a_script_drives_as_the_closed_form_of_its_commands(self):
        motions = [("forward", 3.0), ("stop", 1.0), ("back", 2.0), ("stop", 1.0), ("left", 2.0)]
        with Run(TELEOP, self.folder / "run", *LEVEL) as run:
            done = teleop(run.address, "--script", "; ".join(f"{name} {seconds}" for name, seconds in motions))
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            run.end()
        log = vinerow.read_log(run.out)
        commands, truth = log["rover/cmd_vel"], log["rover/truth"]

        # The commands of the script, each at its time.
        twists = numpy.stack([commands.speed, commands.yaw_rate], axis=1)
        begins = [0, *(1 + numpy.flatnonzero((numpy.diff(twists, axis=0) != 0.0).any(axis=1)))]
        self.assertEqual(twists[begins].tolist(), [[SPEED_mps, 0.0], [0.0, 0.0], [-SPEED_mps, 0.0], [0.0, 0.0], [0.0, 0.6], [0.0, 0.0]])
        at_s = commands.stamp_s[begins]
        for (name, seconds), real_s in zip(motions, numpy.diff(at_s)):
            self.assertTrue(seconds - 0.2 < real_s < seconds + 0.5, f"{name}: {real_s} s for {seconds} s")
        self.assertGreater(len(twists), 100, "commands repeat while a motion lasts")

        # The limit of the acceleration lengthens start and stop equally: the distance is speed times duration.
        at = numpy.searchsorted(truth.stamp_s, at_s)
        position, yaw = truth.pose.position[:, :2], truth.pose.yaw
        heading = numpy.array([math.cos(yaw[at[0]]), math.sin(yaw[at[0]])])
        for begin, end, speed_mps in ((0, 2, SPEED_mps), (2, 4, -SPEED_mps)):
            moved_m = (position[at[end]] - position[at[begin]]) @ heading
            wanted_m = speed_mps * (at_s[begin + 1] - at_s[begin])
            print(f"{moved_m:.3f} m, closed form {wanted_m:.3f} m")
            self.assertAlmostEqual(moved_m, wanted_m, delta=0.03 * abs(wanted_m))
        limited_mps = log["rover/command"].speed
        self.assertEqual((limited_mps.max(), limited_mps.min()), (SPEED_mps, -SPEED_mps))
        self.assertLessEqual(abs(numpy.diff(limited_mps)).max(), ACCELERATION_mps2 / 50.0 + 1e-9)
        self.assertGreater(numpy.unwrap(yaw)[-1] - yaw[at[4]], 0.3, "left")

        # What the client shows is what the log has.
        last = done.stdout.splitlines()[-1]
        x, y = map(float, re.fullmatch(r"stop +x (\S+) m, y (\S+) m, -?0.00 m/s, -?0.00 rad/s", last).groups())
        self.assertLess(math.dist((x, y), position[-1]), 0.02)

    def test_keys_drive(self):
        with Run(TELEOP, self.folder / "run", *LEVEL) as run:
            keyboard = Keyboard(run.address)
            self.addCleanup(keyboard.close)
            keyboard.press("w", r"forward +x .* 0\.(7[5-9]|8\d) m/s")
            second = teleop(run.address, "--script", "back 1")
            self.assertEqual(second.returncode, 1)
            self.assertRegex(second.stderr, r"^teleop: 'rover/cmd_vel' is commanded by [^\n]*\n$")
            keyboard.press("\x1b[D", r"left +x ")
            keyboard.press(" ", r"stop +x .* -?0\.00 m/s, -?0\.00 rad/s")
            os.write(keyboard.here, b"q")
            self.assertEqual(keyboard.process.wait(PATIENCE_s), 0)
            self.assertEqual(termios.tcgetattr(keyboard.terminal), keyboard.settings)

    def test_the_end_of_the_run_ends_the_client(self):
        with Run(TELEOP, self.folder / "run", "duration_s=1") as run:
            done = teleop(run.address, "--script", "forward 100")
        self.assertEqual((done.returncode, done.stderr), (1, "teleop: the run is over\n"))

    def test_errors_are_sentences(self):
        done = teleop("ws://localhost:1", "--script", "forward 1")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^teleop: no live run at ws://localhost:1: [^\n]*refused\n$")
        for arguments, words in ((["--script", "fly 1"], "invalid script value: 'fly 1'"), ([], "standard input is no terminal")):
            done = teleop(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)
        with Run(TELEOP, self.folder / "token", options=("--live-token", "secret")) as run:
            done = teleop(run.address, "--script", "forward 1")
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stderr, r"^teleop: no live run at ws://localhost:\d+: The token is missing or wrong[^\n]*\n$")
            self.assertEqual(teleop(f"{run.address}/?token=secret", "--script", "stop 0.1").returncode, 0)
        with Run(FREE_ROVER, self.folder / "free", options=("--paused",)) as run:
            done = teleop(run.address, "--script", "forward 1")
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stderr, r"^teleop: [^\n]*no part of this run takes commands from outside\n$")


class Layout(Live):
    def test_it_calls_services_and_commands_topics_that_exist(self):
        panels = json.loads(LAYOUT.read_text())["configById"]
        calls = [(name.split("!")[1], panel["serviceName"], panel["requestPayload"])
                 for name, panel in panels.items() if name.startswith("CallService!")]
        topics = [panel["topic"] for name, panel in panels.items() if name.startswith("Teleop!")]
        self.assertEqual((len(calls), len(topics)), (3, 1))
        # A step needs a paused run.
        calls.sort(key=lambda call: ["pause", "step", "play"].index(call[0]))
        with Run(TELEOP, self.folder / "run") as run, connect(
                run.address, subprotocols=["foxglove.websocket.v1"], max_size=None, proxy=None) as socket:
            while not self.message(socket, "advertise")["channels"]:  # the run has not begun
                pass
            services = {service["name"]: service["id"] for service in self.message(socket, "advertiseServices")["services"]}
            socket.send(json.dumps({"op": "getParameters", "parameterNames": ["command_topics"]}))
            allowed = self.message(socket, "parameterValues")["parameters"][0]["value"]
            self.assertIn(topics[0], [each["topic"] for each in allowed])
            for _, name, payload in calls:
                socket.send(struct.pack("<BIII", 2, services[name], 7, 4) + b"json" + payload.encode())
                while not isinstance(frame := socket.recv(timeout=PATIENCE_s), bytes) or frame[0] != 3:
                    self.assertNotIn("serviceCallFailure", str(frame))
                self.assertEqual(json.loads(frame[17:])["result"]["result"], 1, f"{name}: {frame[17:]}")

    def message(self, socket: ClientConnection, op: str) -> dict:
        """The next text message with this operation."""
        while not isinstance(frame := socket.recv(timeout=PATIENCE_s), str) or json.loads(frame)["op"] != op:
            pass
        return json.loads(frame)


class FollowPath(Live):
    scenario = EXAMPLES / "follow_path.yaml"

    def drive(self, name: str, *options: str) -> str:
        """Output of a run that follow_path.py drives."""
        follower = subprocess.Popen([sys.executable, "-B", EXAMPLES / "follow_path.py", "--domain", str(DOMAIN)],
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            run = subprocess.run(command_of(self.scenario, self.folder / name, ["--ros2", "--ros2-domain", str(DOMAIN), *options]),
                                 capture_output=True, text=True, timeout=4 * PATIENCE_s)
            if "built without Cyclone DDS" in run.stderr:
                self.skipTest("this build has no ROS 2")
            said, _ = follower.communicate(timeout=PATIENCE_s)
        finally:
            follower.kill()
            follower.communicate()
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout + said)  # 0: all criteria met
        driven, planned = map(float, re.search(r"the run is over: (\S+) m of (\S+) m driven", said).groups())
        self.assertLess(planned - driven, 0.1)
        return run.stdout

    def test_it_follows_the_plan_and_repeats(self):
        quick = self.drive("quick")
        paced = self.drive("paced", "--speed", "30")
        self.assertEqual(digest_of(paced), digest_of(quick))
        metrics = json.loads((self.folder / "quick" / "summary.json").read_text())["metrics"]["rover"]
        print(f"follow_path: {metrics['alleys_driven']:.0f} alleys, {1000 * metrics['cross_track_rms_m']:.0f} mm in the rows, "
              f"{1000 * metrics['turn_deviation_rms_m']:.0f} mm in the turns")

        replay = subprocess.run(command_of(self.scenario, self.folder / "replay", ["--replay-commands", self.folder / "quick"]),
                                capture_output=True, text=True)
        self.assertEqual(replay.returncode, 0, replay.stdout + replay.stderr)
        self.assertRegex(replay.stdout, r"replay +of 2400 commands: the same digest as the log")
        self.assertEqual(digest_of(replay.stdout), digest_of(quick))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
