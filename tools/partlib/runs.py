"""Runs of the command for the pictures, and what they leave: arrays of a log, rows of a world, frames."""

import hashlib
import io
import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
ASSETS = ROOT / "assets"


class RunError(Exception):
    """A command that failed, with its last words."""


class Runs:
    def __init__(self, vinerow: Path, work: Path, out: Path):
        self.vinerow, self.work, self.out = vinerow.resolve(), work.resolve(), out.resolve()
        self.work.mkdir(parents=True, exist_ok=True)
        self.out.mkdir(parents=True, exist_ok=True)
        if not self.vinerow.exists():
            raise SystemExit(f"part_pictures: --vinerow {vinerow}: no such program")
        self.program = hashlib.md5(self.vinerow.read_bytes()
                                   + b"".join(p.read_bytes() for p in sorted(self.vinerow.parent.parent.glob("lib/libvinerow.so.*")))).hexdigest()

    def call(self, *words, allowed=(0,)) -> str:
        """Standard output of the command. @throws RunError"""
        done = subprocess.run([str(self.vinerow), *map(str, words)], capture_output=True, text=True)
        if done.returncode not in allowed:
            last = (done.stderr.strip() or done.stdout.strip()).splitlines()[-1:]
            raise RunError(f"vinerow {' '.join(map(str, words))}: status {done.returncode}: {' '.join(last)}")
        return done.stdout

    def once(self, name: str, key: str, make) -> Path:
        """Folder `name`, filled by make(folder) unless it was made with the same key by the same program."""
        folder, stamp = self.work / name, hashlib.md5((key + self.program).encode()).hexdigest()
        if not (folder / "stamp").exists() or (folder / "stamp").read_text() != stamp:
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            print(f"  {name}", flush=True)
            make(folder)
            (folder / "stamp").write_text(stamp)
        return folder

    def run(self, name: str, scenario, *sets: str, files: dict | None = None, pictures=False, seed=1, allowed=(0, 1)) -> Path:
        """Folder of a run. @param scenario  text of a file, or the name of a shipped scenario  @param files  beside it, name to text"""
        shipped = "\n" not in scenario
        text = (ASSETS / "scenarios" / f"{scenario}.yaml").read_text() if shipped else scenario
        key = repr((text, sets, files, pictures, seed))

        def make(folder: Path) -> None:
            path = ASSETS / "scenarios" / f"{scenario}.yaml" if shipped else folder / "scenario.yaml"
            if not shipped:
                path.write_text(text)
            for file, content in (files or {}).items():
                (folder / file).write_text(content)
            options = [word for value in sets for word in ("--set", value)]
            self.call("run", path, "--out", folder / "run", "--quiet", "--no-report", "--seed", seed, *options,
                      *([] if pictures else ["--no-pictures"]), allowed=allowed)

        return self.once(name, key, make) / "run"

    def arrays(self, run: Path, topic: str) -> dict:
        """A topic as arrays, `time_s` among them."""
        file = run.parent / (topic.strip("/").replace("/", "_") + ".npz")
        if not file.exists():
            self.call("export", run, "--topic", topic, "-o", file)
        with np.load(file) as table:
            return {name: table[name] for name in table.files}

    def positions(self, run: Path, topic: str) -> tuple[np.ndarray, np.ndarray]:
        """Times and positions (n x 3, world) of an Odometry."""
        table = self.arrays(run, topic)
        return table["time_s"], np.stack([table[f"pose.pose.position.{axis}"] for axis in "xyz"], axis=1)

    def plan(self, run: Path, vehicle: str) -> np.ndarray:
        """Points of a plan, n x 3."""
        table = self.arrays(run, f"/{vehicle}/plan")
        return np.stack([table[f"poses.pose.position.{axis}"] for axis in "xyz"], axis=1)

    def metrics(self, run: Path, vehicle: str) -> dict:
        return json.loads((run / "summary.json").read_text())["metrics"][vehicle]

    def grid(self, run: Path) -> tuple[np.ndarray, tuple[float, float, float, float]]:
        """Occupied cells of the world's grid, and their extent for imshow."""
        table = self.arrays(run, "/run/map")
        rows, columns = int(table["info.height"][0]), int(table["info.width"][0])
        cell = float(table["info.resolution"][0])
        x, y = float(table["info.origin.position.x"][0]), float(table["info.origin.position.y"][0])
        return table["data"][0].reshape(rows, columns) > 50, (x, x + columns * cell, y, y + rows * cell)

    def frame(self, run: Path, camera: str, width: int | None = None) -> np.ndarray:
        """The last frame of a camera."""
        picture = Image.open(sorted((run / "frames").glob(f"{camera}_*.png"))[-1]).convert("RGB")
        if width:
            picture = picture.resize((width, round(picture.height * width / picture.width)), Image.LANCZOS)
        return np.asarray(picture)

    def save(self, figure, name: str, colours: int = 96, dpi: int = 130) -> None:
        """A PNG with a palette: a quarter of the size, and nothing to see of it."""
        import matplotlib.pyplot as plt

        buffer = io.BytesIO()
        figure.savefig(buffer, format="png", dpi=dpi)
        plt.close(figure)
        picture = Image.open(buffer).convert("RGB")
        photo = colours > 200
        picture = picture.quantize(colours, method=Image.Quantize.MEDIANCUT if not photo else Image.Quantize.MAXCOVERAGE, kmeans=1,
                                   dither=Image.Dither.FLOYDSTEINBERG if photo else Image.Dither.NONE)
        path = self.out / f"parts_{name}.png"
        picture.save(path, optimize=True)
        print(f"{path.name}  {picture.width} x {picture.height}  {path.stat().st_size / 1000:.0f} kB", flush=True)


def resolved_number(run: Path, key: str) -> float:
    """The first value of a key in the resolved scenario."""
    found = re.search(rf"\b{key}: (?:{{value: )?([-+.\deE]+)", (run / "scenario.resolved.yaml").read_text())
    if not found:
        raise RunError(f"{run}/scenario.resolved.yaml has no {key}")
    return float(found.group(1))
