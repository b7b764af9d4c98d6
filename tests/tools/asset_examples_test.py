#!/usr/bin/env python3
"""Are the examples in the comments of assets/ valid? Each `sensors: {...}`, `vehicles: {...}`, `controller: {...}` of a part's file is put into
a scenario, and each `--set` of a scenario or a vehicle onto one; then the command checks what a run checks.

    asset_examples_test.py VINEROW
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

VINEROW = sys.argv[1]
ROOT = pathlib.Path(__file__).resolve().parents[2]
ASSETS = ROOT / "assets"
ROVER_URDF = ROOT / "tests/vehicles/data/plain_rover.urdf"

HEAD = "vinerow: 1\nworld: {type: vineyard, row_count: 3, row_length_m: 20, surroundings_m: 300}\n"
ROVER = """vehicles:
  rover:
    type: diff_drive_rover
    spawn: {alley: 0, offset_m: 2}
    """
PLANE = """vehicles:
  plane:
    include: ../vehicles/mh900_like.yaml
    spawn: {x_m: 0, y_m: -200, yaw_deg: 90}
    launch: air
    start_height_m: 120
    planner: {type: waypoints, x_m: [0, 0], y_m: [-200, 200], z_m: [120, 120]}
    guidance: {type: waypoint_guidance, rate_Hz: 20, end: stop}
    """


def comments(file: pathlib.Path) -> str:
    """Of the file's head."""
    lines = file.read_text().splitlines()
    head = [line[1:].strip() for line in lines if line.startswith("#")]
    return "\n".join(head)


def braces(text: str, key: str) -> str | None:
    """`key: {...}` with its closing brace."""
    begin = re.search(rf"\b{key}: (?={{)", text)
    if begin is None:
        return None
    depth = 0
    for at in range(begin.end(), len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return text[begin.start() : at + 1]
    raise AssertionError(f"no closing brace: {text[begin.start():]}")


class Examples(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        place = pathlib.Path(self.folder.name)
        for kind in ("sensors", "vehicles", "controllers"):
            (place / kind).symlink_to(ASSETS / kind)
        (place / "scenarios").mkdir()
        self.scenario = place / "scenarios/example.yaml"

    def check(self, text: str, *more: str):
        self.scenario.write_text(text)
        self.validate(self.scenario, *more)

    def validate(self, file: pathlib.Path, *more: str):
        run = subprocess.run([VINEROW, "validate", str(file), *more], capture_output=True, encoding="utf-8")
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_sensors(self):
        for file in sorted((ASSETS / "sensors").glob("*.yaml")):
            with self.subTest(file.name):
                example = braces(comments(file), "sensors")
                self.assertIsNotNone(example, "shows how it is included")
                self.assertIn(f"../sensors/{file.name}", example)
                self.check(HEAD + ROVER + example + "\n")

    def test_vehicles(self):
        for file in sorted((ASSETS / "vehicles").glob("*.yaml")):
            with self.subTest(file.name):
                example = braces(comments(file), "vehicles")
                if example is None:
                    continue  # the one whose URDF is not part of the project: below
                self.assertIn(f"../vehicles/{file.name}", example)
                start = "spawn: {x_m: -10, y_m: -10}"
                self.check(HEAD + example.replace(".yaml}", ".yaml, " + start + "}") + "\n")

    def test_controllers(self):
        for file in sorted((ASSETS / "controllers").glob("*.yaml")):
            with self.subTest(file.name):
                example = braces(comments(file), "controller")
                self.assertIn(f"../controllers/{file.name}", example)
                self.check(HEAD + PLANE + example + "\n")

    def test_overrides(self):
        found = 0
        for file in sorted((ASSETS / "scenarios").glob("*.yaml")):
            text = " ".join(comments(file).split())
            for at in [m.end() for m in re.finditer(r"--set (?=[\w.]+=)", text)]:
                value = re.match(r"[\w.]+=(?:{[^}]*}|[^\s;,()]+)", text[at:]).group()
                others = re.findall(r"^ --set (\S+)", text[at + len(value) :])
                with self.subTest(file.name, override=value):
                    self.validate(file, *(part for one in [value, *others] for part in ("--set", one)))
                    found += 1
        self.assertGreater(found, 1)

    def test_the_husky_takes_a_urdf_in_both_ways(self):
        text = comments(ASSETS / "vehicles/husky.yaml")
        self.assertIn("urdf: <path>/husky.urdf", text)
        override = re.search(r"--set ([\w.]+)=\.\.\.", text).group(1)
        body = "vehicles:\n  rover:\n    include: ../vehicles/husky.yaml\n    spawn: {x_m: -10, y_m: -10}\n"
        self.check(HEAD + body + f"    urdf: {ROVER_URDF}\n")
        self.check(HEAD + body, "--set", f"{override}={ROVER_URDF}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
