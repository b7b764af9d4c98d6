#!/usr/bin/env python3
"""Solves the 60 programmes of qpsolvers/mpc_qpbenchmark and compares with the reference optima.

usage: qp_benchmark_check.py <qp_solve_files> <folder with outside data, unless VINEROW_DATA names it>
Exit code 77 (skipped) where numpy or the data are absent.
"""

import csv
import os
import pathlib
import sys

try:
    import numpy
    from qp_exchange import Programme, solve_all
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

TOLERANCE = 1e-6


def load(file: pathlib.Path) -> Programme:
    # Without pickle: what is absent (A, b, lb, ub) is a pickled None and stays unread.
    data = numpy.load(file, allow_pickle=False)
    q, G, h = data["q"].ravel(), data["G"], data["h"].ravel()
    free = numpy.full(len(q), numpy.inf)
    return Programme(data["P"], q, -free, free, G, numpy.full(len(h), -numpy.inf), h)


def faults(programme: Programme, answer, optimum: float) -> list[str]:
    if answer.status != "solved":
        return [answer.status]
    cost, n = programme.cost(answer.x), len(programme.f)
    pull = answer.multipliers[:n] + programme.A.T @ answer.multipliers[n:]
    measured = {
        "cost": abs(cost - optimum) / max(1.0, abs(optimum)),
        "violation": programme.violation(answer.x),
        "dual residual": abs(programme.H @ answer.x + programme.f + pull).max(),
        "dual sign": max(0.0, -answer.multipliers.min()),
    }
    return [f"{name} {value:.2e}" for name, value in measured.items() if not value <= TOLERANCE]


def load_all(folder: pathlib.Path) -> tuple[dict[str, float], list[Programme]]:
    """Reference optima by name, and the programmes in the same order."""
    with open(folder / "reference_values.csv", newline="") as file:
        optima = {row["problem"]: float(row["f_star"]) for row in csv.DictReader(file)}
    return optima, [load(folder / "data" / f"{name}.npz") for name in optima]


def main(program: str, folder: pathlib.Path) -> int:
    if not (folder / "reference_values.csv").is_file():
        print(f"skipped: outside data absent: {folder}")
        return 77
    optima, programmes = load_all(folder)
    answers = solve_all(program, programmes)
    wrong = 0
    for name, programme, answer in zip(optima, programmes, answers, strict=True):
        found = faults(programme, answer, optima[name])
        wrong += bool(found)
        if found:
            print(f"{name}: {', '.join(found)}")
    relative = max(abs(p.cost(a.x) - optima[name]) / max(1.0, abs(optima[name]))
                   for name, p, a in zip(optima, programmes, answers, strict=True))
    print(f"{len(optima) - wrong} of {len(optima)} solved; largest difference of the optimum {relative:.1e}, "
          f"most iterations {max(a.iterations for a in answers)}")
    return 1 if wrong or len(optima) != 60 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], pathlib.Path(os.environ.get("VINEROW_DATA", sys.argv[2])) / "mpc_qpbenchmark"))
