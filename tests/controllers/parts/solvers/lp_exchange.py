"""Linear programmes handed to the program lp_solve_files and its answers read back."""

import dataclasses
import pathlib
import subprocess
import tempfile

import numpy


@dataclasses.dataclass
class Programme:
    """maximise c'x subject to F x <= g."""

    name: str
    F: numpy.ndarray
    g: numpy.ndarray
    c: numpy.ndarray
    optimum: float | None = None  # where it is known from elsewhere


@dataclasses.dataclass
class Answer:
    status: str
    iterations: int
    value: float
    x: numpy.ndarray  # the optimum, or a direction without end
    multipliers: numpy.ndarray

    def fault_of_proof(self, programme: Programme) -> str | None:
        """What the answer itself must prove, by weak duality or by Farkas: to 1e-9 of the sizes that add up, and no
        better than the rounding of a point of this size."""
        F, g, c = programme.F, programme.g, programme.c
        x, y = self.x, self.multipliers
        lengths = numpy.linalg.norm(F, axis=1)
        finite = numpy.isfinite(g)
        if (y < 0.0).any() or (y[~finite] != 0.0).any():
            return f"multipliers {y.min():.1e}"
        gy = float(g[finite] @ y[finite])
        reach = (numpy.abs(g[finite]) / numpy.maximum(lengths[finite], 1e-300)).max(initial=0.0)
        rounding = 1e-15 * max(numpy.linalg.norm(x), reach)
        if self.status == "solved":
            allowed = 1e-9 * (numpy.abs(g) + numpy.abs(F) @ numpy.abs(x)) + rounding * lengths
            excess = (F @ x - g)[finite] - allowed[finite]
            if excess.max(initial=0.0) > 0.0:
                return f"row violated by {excess.max():.1e} too much"
            off = numpy.abs(F.T @ y - c).max() / max(numpy.abs(c).max(), 1e-300)
            allowed = 1e-9 * (numpy.abs(c) @ numpy.abs(x)) + rounding * numpy.linalg.norm(c)
            gap = abs(gy - c @ x)
            return f"F'y - c {off:.1e}, gap {gap:.1e}" if off > 1e-9 or gap > allowed else None
        if self.status == "infeasible":
            off = numpy.abs(F.T @ y).max() / max(lengths @ y, 1e-300)
            return f"F'y {off:.1e}, g'y {gy:.1e}" if off > 1e-9 or not gy < 0.0 else None
        if self.status == "unbounded":
            r = x / numpy.linalg.norm(x)
            climb = ((F @ r)[finite] / numpy.maximum(lengths[finite], 1e-300)).max(initial=0.0)
            return f"F r {climb:.1e}, c'r {c @ r:.1e}" if climb > 1e-9 or not c @ r > 0.0 else None
        return self.status


def as_text(programme: Programme) -> str:
    m, n = programme.F.shape
    numbers = numpy.concatenate([programme.F.ravel(), programme.g, programme.c])
    return f"{n} {m}\n" + " ".join(repr(float(number)) for number in numbers) + "\n"


def solve_all(program: str, programmes: list[Programme]) -> list[Answer]:
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "programmes.txt"
        file.write_text("".join(as_text(programme) for programme in programmes))
        run = subprocess.run([program, str(file)], check=True, capture_output=True, text=True, timeout=120)
    answers = []
    for programme, line in zip(programmes, run.stdout.splitlines(), strict=True):
        m, n = programme.F.shape
        status, iterations, *rest = line.split()
        numbers = numpy.array([float(word) for word in rest])
        assert len(numbers) == 1 + n + m, line
        answers.append(Answer(status, int(iterations), float(numbers[0]), numbers[1:1 + n], numbers[1 + n:]))
    return answers
