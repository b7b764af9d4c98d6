#!/usr/bin/env python3
"""Designs feedback gains for `trmpc` for a fixed-wing vehicle with uncertain derivatives.

usage: lmi_gain.py <vinerow> <vehicle.yaml> > gains.yaml

One gain K (u = K x) for all 8 vertices of each axis: longitudinal pitch_alpha and pitch_elevator +-20 %, lift_alpha
+-10 %; lateral roll_beta, roll_aileron and yaw_beta +-20 %. The sampled models of the vertices are those of
`vinerow trim --json`. Guaranteed cost, after Boyd et al., "Linear Matrix Inequalities in System and Control Theory",
1994, section 10.2: with X = P^-1 and Y = K X,

    [ X            *    *   * ]
    [ A X + B Y    X    *   * ]  >= 0  for every vertex (A, B):  x+' P x+ - x' P x <= -(x'Q x + u'R u),
    [ Q^1/2 X      0    I   * ]
    [ R^1/2 Y      0    0   I ]

with minimum trace of P, a bound on the cost of random states. States and inputs are scaled by the values that cost 1
each (the defaults of the controllers' group `weights`); without scaling the solver finds no solution. Needs numpy and
cvxopt (GPL), to which nothing of vinerow links: the gains are data.
"""

import itertools
import json
import subprocess
import sys

import cvxopt
import cvxopt.solvers
import numpy

DEG = numpy.pi / 180.0
PERIOD_S = 0.05
AXES = {
    "longitudinal": {
        "spread": {"pitch_alpha": 0.2, "pitch_elevator": 0.2, "lift_alpha": 0.1},
        "states": [0.6, 1.0, 60 * DEG, 6 * DEG, 2.0],  # u m/s, w m/s, q rad/s, theta rad, h m
        "inputs": [0.1, 4 * DEG],  # throttle, elevator rad
    },
    "lateral": {
        "spread": {"roll_beta": 0.2, "roll_aileron": 0.2, "yaw_beta": 0.2},
        "states": [1.5, 90 * DEG, 60 * DEG, 12 * DEG, 8 * DEG],  # v m/s, p, r rad/s, phi, psi rad
        "inputs": [4 * DEG],  # aileron rad
    },
}


def trimmed(vinerow: str, vehicle: str, changes: dict[str, float]) -> dict:
    sets = [word for name, value in changes.items() for word in ("--set", f"{name}={value!r}")]
    run = subprocess.run([vinerow, "trim", vehicle, "--json", "--period", str(PERIOD_S), *sets], check=False,
                         capture_output=True, text=True, timeout=60)
    if run.returncode != 0:
        sys.exit(f"lmi_gain: {run.stderr.strip()}")
    return json.loads(run.stdout)


def nominal_values(vehicle: str, names: list[str]) -> dict[str, float]:
    """Numbers of the vehicle file, plain or with their source: `name: 1.0` or `name: {value: 1.0, source: ...}`."""
    found = {}
    with open(vehicle, encoding="utf-8") as file:
        for line in file:
            name, _, rest = line.partition(":")
            if name in names:
                rest = rest.split("value:")[-1]
                found[name] = float(rest.replace("{", "").replace("}", "").split(",")[0].split("#")[0])
    missing = [name for name in names if name not in found]
    if missing:
        sys.exit(f"lmi_gain: {vehicle} does not give {', '.join(missing)}")
    return found


def vertices(vinerow: str, vehicle: str, axis: str) -> list[tuple[numpy.ndarray, numpy.ndarray]]:
    """(A, B) of the 8 corners of the spread."""
    spread = AXES[axis]["spread"]
    nominal = nominal_values(vehicle, list(spread))
    models = []
    for signs in itertools.product((-1.0, 1.0), repeat=len(spread)):
        changes = {name: nominal[name] * (1.0 + sign * spread[name]) for name, sign in zip(spread, signs, strict=True)}
        model = trimmed(vinerow, vehicle, changes)[axis]
        models.append((numpy.array(model["A"]), numpy.array(model["B"])))
    return models


class Affine:
    """Matrices that depend linearly on the entries of symmetric X, Z (n x n) and of Y (m x n)."""

    def __init__(self, n: int, m: int):
        self.n, self.m = n, m
        pairs = [(i, j) for i in range(n) for j in range(i + 1)]
        self.basis = []
        for kind in "XZ":
            for i, j in pairs:
                S = numpy.zeros((n, n))
                S[i, j] = S[j, i] = 1.0
                self.basis.append((kind, S))
        for i in range(m):
            for j in range(n):
                Y = numpy.zeros((m, n))
                Y[i, j] = 1.0
                self.basis.append(("Y", Y))

    def parts(self, values: numpy.ndarray) -> dict[str, numpy.ndarray]:
        total = {"X": numpy.zeros((self.n, self.n)), "Z": numpy.zeros((self.n, self.n)),
                 "Y": numpy.zeros((self.m, self.n))}
        for value, (kind, matrix) in zip(values, self.basis, strict=True):
            total[kind] = total[kind] + value * matrix
        return total


def design(models: list[tuple[numpy.ndarray, numpy.ndarray]]) -> numpy.ndarray:
    """K for models in scaled states and inputs, where Q and R are unit matrices."""
    n, m = models[0][1].shape
    affine = Affine(n, m)
    I_n, I_m, zero = numpy.eye(n), numpy.eye(m), numpy.zeros

    def decrease(A, B, X, Y, constant):
        one_n, one_m = constant * I_n, constant * I_m
        next_state = A @ X + B @ Y
        return numpy.block([[X, next_state.T, X, Y.T], [next_state, X, zero((n, n)), zero((n, m))],
                            [X, zero((n, n)), one_n, zero((n, m))],
                            [Y, zero((m, n)), zero((m, n)), one_m]])

    def bound(X, Z, constant):
        return numpy.block([[Z, constant * I_n], [constant * I_n, X]])

    blocks = [lambda p, c, A=A, B=B: decrease(A, B, p["X"], p["Y"], c) for A, B in models]
    blocks.append(lambda p, c: bound(p["X"], p["Z"], c))
    cost = numpy.array([numpy.trace(S) if kind == "Z" else 0.0 for kind, S in affine.basis])
    unit = numpy.eye(len(affine.basis))
    G, h = [], []
    for block in blocks:  # cvxopt: G y + s = h, s >= 0, so s is the block
        columns = [-block(affine.parts(direction), 0.0).ravel() for direction in unit]
        G.append(cvxopt.matrix(numpy.array(columns).T))
        h.append(cvxopt.matrix(block(affine.parts(0.0 * cost), 1.0)))
    solution = cvxopt.solvers.sdp(cvxopt.matrix(cost), Gs=G, hs=h,
                                  options={"show_progress": False, "abstol": 1e-7, "reltol": 1e-6, "feastol": 1e-7})
    if solution["status"] != "optimal":
        sys.exit(f"lmi_gain: cvxopt ends with '{solution['status']}'")
    parts = affine.parts(numpy.array(solution["x"]).ravel())
    return parts["Y"] @ numpy.linalg.inv(parts["X"])


def radius(matrix: numpy.ndarray) -> float:
    return float(numpy.abs(numpy.linalg.eigvals(matrix)).max())


def main(vinerow: str, vehicle: str) -> int:
    print("# Feedback gains for the controller `trmpc`, designed by tools/design/lmi_gain.py for sampling at "
          f"{1.0 / PERIOD_S:g} Hz")
    print("# about level flight at cruise speed: one guaranteed-cost gain for the 8 vertices of each axis. Include it as")
    print("#   controller: {type: trmpc, include: ../controllers/<this file>}")
    print("gain: given")
    for axis, about in AXES.items():
        models = vertices(vinerow, vehicle, axis)
        states, inputs = (numpy.diag(about[name]) for name in ("states", "inputs"))
        scaled = [(numpy.linalg.inv(states) @ A @ states, numpy.linalg.inv(states) @ B @ inputs) for A, B in models]
        K = inputs @ design(scaled) @ numpy.linalg.inv(states)
        worst = max(radius(A + B @ K) for A, B in models)
        spread = ", ".join(f"{name} +-{100 * share:g} %" for name, share in about["spread"].items())
        print(f"# {spread}: worst spectral radius {worst:.4f}")
        print(f"{axis}_gain: [{', '.join(f'{value:.5f}' for value in K.ravel())}]")
        if worst >= 1.0:
            sys.exit("lmi_gain: a vertex is not held")
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.split("\n\n")[1])
    sys.exit(main(*sys.argv[1:]))
