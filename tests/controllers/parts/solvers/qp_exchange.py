"""Quadratic programmes handed to the program qp_solve_files and its answers read back."""

import dataclasses
import pathlib
import subprocess
import tempfile

import numpy


@dataclasses.dataclass
class Programme:
    """minimise 1/2 x'Hx + f'x subject to lower <= x <= upper, row_lower <= A x <= row_upper."""

    H: numpy.ndarray
    f: numpy.ndarray
    lower: numpy.ndarray
    upper: numpy.ndarray
    A: numpy.ndarray
    row_lower: numpy.ndarray
    row_upper: numpy.ndarray

    def cost(self, x: numpy.ndarray) -> float:
        return float(0.5 * x @ self.H @ x + self.f @ x)

    def violation(self, x: numpy.ndarray) -> float:
        values = numpy.concatenate([x, self.A @ x])
        low = numpy.concatenate([self.lower, self.row_lower])
        up = numpy.concatenate([self.upper, self.row_upper])
        return float(max(0.0, (values - up).max(), (low - values).max()))


@dataclasses.dataclass
class Answer:
    status: str
    iterations: int
    cost: float
    x: numpy.ndarray
    multipliers: numpy.ndarray  # of bounds, then rows


def as_text(programme: Programme) -> str:
    n, m = len(programme.f), len(programme.row_lower)
    parts = [programme.H, programme.f, programme.lower, programme.upper, programme.A, programme.row_lower,
             programme.row_upper]
    numbers = numpy.concatenate([numpy.asarray(part, dtype=float).ravel() for part in parts])
    return f"{n} {m}\n" + " ".join(repr(float(number)) for number in numbers) + "\n"


def run_on(program: str, programmes: list[Programme], *options: str) -> list[str]:
    """A line of output for each programme."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "programmes.txt"
        file.write_text("".join(as_text(programme) for programme in programmes))
        run = subprocess.run([program, *options, str(file)], check=True, capture_output=True, text=True, timeout=60)
    return run.stdout.splitlines()


def times_us(program: str, programmes: list[Programme]) -> list[tuple[float, float]]:
    """Least times of each programme's factorisation and of its cold solution."""
    return [tuple(float(word) for word in line.split()) for line in run_on(program, programmes, "--time")]


def solve_all(program: str, programmes: list[Programme]) -> list[Answer]:
    answers = []
    for programme, line in zip(programmes, run_on(program, programmes), strict=True):
        n = len(programme.f)
        status, iterations, *rest = line.split()
        numbers = numpy.array([float(word) for word in rest])
        assert len(numbers) == 1 + 2 * n + len(programme.row_lower), line
        answers.append(Answer(status, int(iterations), float(numbers[0]), numbers[1:1 + n], numbers[1 + n:]))
    return answers
