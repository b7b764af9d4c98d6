"""Requests handed to the program optimal_control_files and its answers read back."""

import pathlib
import subprocess
import tempfile

import numpy


def request(name: str, *parts) -> str:
    """One line: the name, then all numbers row by row."""
    numbers = [numpy.asarray(part, dtype=float).ravel() for part in parts]
    return name + " " + " ".join(repr(float(number)) for number in numpy.concatenate(numbers)) + "\n"


def answers(program: str, requests: list[str]) -> list[list[str]]:
    """The words of each answer."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "requests.txt"
        file.write_text("".join(requests))
        run = subprocess.run([program, str(file)], check=True, capture_output=True, text=True, timeout=120)
    lines = [line.split() for line in run.stdout.splitlines()]
    assert len(lines) == len(requests), (len(lines), len(requests))
    return lines


def matrices(words: list[str], *shapes: tuple[int, int]) -> list[numpy.ndarray]:
    """The numbers of `words` as matrices of these shapes, one after the other; all words are used."""
    numbers = numpy.array([float(word) for word in words])
    found, at = [], 0
    for rows, columns in shapes:
        found.append(numbers[at:at + rows * columns].reshape(rows, columns))
        at += rows * columns
    assert at == len(numbers), (at, len(numbers))
    return found


def report(faults: list[str], checks: int, judge: str) -> int:
    """Prints what is wrong and how many agree. @returns the exit status"""
    for fault in faults:
        print(fault)
    print(f"{checks - len(faults)} of {checks} answers agree with {judge}")
    return 1 if faults or checks == 0 else 0
