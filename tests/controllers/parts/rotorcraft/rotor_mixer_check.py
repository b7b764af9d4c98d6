#!/usr/bin/env python3
"""Judges the rotor mixer by linear programmes.

usage: rotor_mixer_check.py <mix_rotors>
The thrusts of the rotors are f = s r + T t + y c: least-squares shares of the wanted roll and pitch torque (s), of
thrust (T) and of the wanted yaw torque (y). One programme after the other finds the largest s without yaw, the T
nearest to the wanted thrust with that s, the largest y with both. The mixer must make the same wrench.
Exit code 77 (skipped) where numpy or cvxopt are absent.
"""

import subprocess
import sys

try:
    import numpy
    from cvxopt import matrix, solvers
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

SILENT = {"glpk": {"msg_lev": "GLP_MSG_OFF"}}
TOLERANCE = 1e-6  # of the largest thrust


def solve(cost: list, rows: numpy.ndarray, limits: numpy.ndarray) -> numpy.ndarray:
    """minimise cost x subject to rows x <= limits"""
    result = solvers.lp(matrix(cost, tc="d"), matrix(rows), matrix(limits), solver="glpk", options=SILENT)
    assert result["status"] == "optimal", result["status"]
    return numpy.array(result["x"]).ravel()


def best_thrusts(effect: numpy.ndarray, least: float, most: float, wanted: numpy.ndarray) -> numpy.ndarray:
    shares = numpy.linalg.pinv(effect)
    # In units of the largest thrust of a rotor.
    r, t, c = shares[:, 1:3] @ wanted[1:3] / most, shares[:, 0], shares[:, 3] * wanted[3] / most
    wanted, least, most, n = wanted / most, least / most, 1.0, len(t)
    high, low = numpy.full(n, most), numpy.full(n, -least)
    # s, T: f <= most, f >= least, 0 <= s <= 1
    rows = numpy.vstack([numpy.column_stack([r, t]), -numpy.column_stack([r, t]), [[1.0, 0.0]], [[-1.0, 0.0]]])
    s = solve([-1.0, 0.0], rows, numpy.concatenate([high, low, [1.0, 0.0]]))[0]
    # T, d: |T - wanted| <= d. A hair of room: s is at its limit.
    room = 1e-9
    rows = numpy.vstack([numpy.column_stack([t, 0 * t]), numpy.column_stack([-t, 0 * t]), [[1.0, -1.0]], [[-1.0, -1.0]]])
    limits = numpy.concatenate([high - s * r + room, low + s * r + room, [wanted[0], -wanted[0]]])
    thrust = solve([0.0, 1.0], rows, limits)[0]
    base = s * r + thrust * t
    rows = numpy.concatenate([c, -c, [1.0, -1.0]]).reshape(-1, 1)
    y = solve([-1.0], rows, numpy.concatenate([high - base + room, low + base + room, [1.0, 0.0]]))[0]
    return base + y * c


def main() -> int:
    words = iter(subprocess.run([sys.argv[1]], capture_output=True, text=True, check=True).stdout.split())
    worst, cases, cut = 0.0, 0, 0
    for word in words:
        assert word == "vehicle"
        n = int(next(words))
        k_f, k_m, slow, fast = (float(next(words)) for _ in range(4))
        places = numpy.array([[float(next(words)) for _ in range(3)] for _ in range(n)])
        effect = numpy.vstack([numpy.ones(n), places[:, 1], -places[:, 0], places[:, 2] * k_m / k_f])
        least, most = k_f * slow**2, k_f * fast**2
        assert next(words) == "cases"
        for _ in range(int(next(words))):
            wanted = numpy.array([float(next(words)) for _ in range(4)])
            made = k_f * numpy.array([float(next(words)) for _ in range(n)]) ** 2
            expected = most * best_thrusts(effect, least, most, wanted)
            error = numpy.abs(effect @ (made - expected)).max() / most
            worst, cases = max(worst, error), cases + 1
            cut += int(numpy.abs(effect @ made - wanted).max() > 1e-6 * most)
            if error > TOLERANCE:
                print(f"wanted {wanted}: made {effect @ made}, best is {effect @ expected}")
                return 1
    print(f"{cases} wrenches, {cut} of them cut: equal within {worst:.1e} of the largest thrust of a rotor")
    return 0 if cut > cases / 4 else 1


if __name__ == "__main__":
    sys.exit(main())
