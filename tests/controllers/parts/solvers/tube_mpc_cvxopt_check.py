#!/usr/bin/env python3
"""Tube MPC of tube_mpc_files against its sparse form in cvxopt, and its sets against scipy's.

usage: tube_mpc_cvxopt_check.py <tube_mpc_files>
Models: the flying wing of the reference of paper A, section 1 (rounded to four decimals), and random plants; states
inside and outside of what is feasible, z_0 free and fixed. cvxopt has z_i, v_i and violations as variables and the
model as equations; P comes from scipy, the tightening from a series summed here, the terminal set is checked against
the limits along simulated ways. Exit code 77 (skipped) where numpy, cvxopt or scipy are absent.
"""

import dataclasses
import sys
import warnings

try:
    import cvxopt
    import cvxopt.solvers
    import numpy
    import scipy
    import scipy.linalg
    from optimal_control_exchange import answers, report, request
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

RANDOM_PLANTS, CALLS = 30, 8
TOLERANCE = 1e-6
warnings.filterwarnings("error", category=scipy.linalg.LinAlgWarning)
PRECISE = {"show_progress": False, "abstol": 1e-13, "reltol": 1e-13, "feastol": 1e-13, "maxiters": 100}
DEG = numpy.pi / 180.0


@dataclasses.dataclass
class Plant:
    A: numpy.ndarray
    B: numpy.ndarray
    E: numpy.ndarray
    K: numpy.ndarray
    state_limit: numpy.ndarray
    input_limit: numpy.ndarray
    Q: numpy.ndarray
    R: numpy.ndarray
    gust: numpy.ndarray
    horizon: int = 20
    soft_weight: float = 1e9
    law: int = 0
    shape: int = 1
    states: numpy.ndarray = None

    def parts(self):
        n, m = self.B.shape
        yield [n, m, self.E.shape[1], self.horizon, self.law, self.shape, self.soft_weight]
        yield from (self.A, self.B, self.E, self.K, self.gust, self.state_limit, self.input_limit, self.Q, self.R)
        yield [len(self.states)]
        yield self.states

    def closed(self):
        return self.A + self.B @ self.K


def longitudinal() -> Plant:
    A = [[.9739, .0496, -.0649, -.4818, 0], [-.0215, .6433, .3848, -.0451, 0], [.0614, -.3532, .6485, -.0027, 0],
         [.0016, -.0100, .0416, 1, 0], [.0073, -.0431, .0023, .5997, 1]]
    B = [[.5764, .2057], [-.0082, -2.0268], [.0183, -5.0291], [.0003, -.1361], [.0021, .0138]]
    E = [[.0261, -.0496], [.0215, .3567], [-.0614, .3532], [-.0016, .0100], [-.0009, -.0065]]
    K = [[-.1192, -.0085, .0047, -.0048, -.0243], [-.0101, -.0418, .0597, .7366, .0246]]
    return Plant(*(numpy.array(M) for M in (A, B, E, K)), numpy.array([2.4, 3, 150 * DEG, 20 * DEG, 15]),
                 numpy.array([.25, 10 * DEG]), numpy.diag([1 / .36, 1, 1 / (60 * DEG) ** 2, 1 / (6 * DEG) ** 2, .25]),
                 numpy.diag([100, 1 / (4 * DEG) ** 2]), numpy.ones(2))


def lateral() -> Plant:
    A = [[.9398, .0756, -.5548, .4745, 0], [-.4098, .5872, .2817, -.1097, 0], [.0564, -.0325, .9531, .0132, 0],
         [-.0111, .0389, .0127, .9981, 0], [.0014, -.0009, .0494, .0002, 1]]
    B, E = [[.2902], [5.2140], [-.2609], [.1413], [-.0057]], [[.0602], [.4098], [-.0564], [.0111], [-.0014]]
    K = [[-.0290, -.0429, -.1258, -.5042, -.4278]]
    return Plant(*(numpy.array(M) for M in (A, B, E, K)), numpy.array([5, 250 * DEG, 120 * DEG, 45 * DEG, 30 * DEG]),
                 numpy.array([12 * DEG]), numpy.diag([1 / 2.25, 1 / (90 * DEG) ** 2, 1 / (60 * DEG) ** 2,
                                                      1 / (12 * DEG) ** 2, 1 / (8 * DEG) ** 2]),
                 numpy.array([[1 / (4 * DEG) ** 2]]), numpy.ones(1))


def random_plant(random: numpy.random.Generator) -> Plant:
    n, m, g = int(random.integers(1, 5)), int(random.integers(1, 3)), int(random.integers(1, 3))
    A = random.normal(size=(n, n))
    A *= random.uniform(0.5, 1.1) / numpy.abs(numpy.linalg.eigvals(A)).max()
    B, E = random.normal(size=(n, m)), random.normal(size=(n, g))
    Q, R = (root @ root.T + 0.1 * numpy.eye(len(root)) for root in (random.normal(size=(k, k)) for k in (n, m)))
    P = scipy.linalg.solve_discrete_are(A, B, numpy.eye(n), numpy.eye(m))  # of another cost than the MPC's
    K = -numpy.linalg.solve(numpy.eye(m) + B.T @ P @ B, B.T @ P @ A)
    plant = Plant(A, B, E, K, random.uniform(1, 3, n), random.uniform(0.5, 2, m), Q, R, numpy.ones(g),
                  int(random.integers(1, 12)), 10.0 ** random.uniform(3, 5))
    state, inputs = reach(plant)
    room = min((plant.state_limit / state).min(), (plant.input_limit / inputs).min())
    plant.gust *= room * random.uniform(0.1, 0.8)
    return plant


def reach(plant: Plant) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Half widths of S along the states and along K: the series, to where nothing changes."""
    rows = numpy.vstack([numpy.eye(len(plant.A)), plant.K])
    total, A_K, W = numpy.zeros(len(rows)), plant.closed(), plant.E @ numpy.diag(plant.gust)
    for _ in range(5000):
        grown = total + numpy.abs(rows @ W).sum(axis=1)
        if (grown == total).all() and numpy.abs(rows).max() < 1e-20:
            break
        total, rows = grown, rows @ A_K
    return total[:len(plant.A)], total[len(plant.A):]


@dataclasses.dataclass
class Sets:
    state_limit: numpy.ndarray
    input_limit: numpy.ndarray
    tube: numpy.ndarray
    terminal: numpy.ndarray


@dataclasses.dataclass
class Solve:
    status: str
    cost: float
    violation: float
    z0: numpy.ndarray
    u: numpy.ndarray
    c: numpy.ndarray  # N x m


def parse(words: list[str], plant: Plant) -> tuple[Sets, list[Solve]]:
    n, m = plant.B.shape
    assert words[0] == "ok", words[:3]
    at = 1

    def take(count: int) -> numpy.ndarray:
        nonlocal at
        at += count
        return numpy.array([float(word) for word in words[at - count:at]])

    limits = take(n), take(m)
    sets = Sets(*limits, *(take(int(take(1)[0]) * n).reshape(-1, n) for _ in range(2)))
    solves = []
    for _ in range(len(plant.states)):
        status = words[at]
        at += 1
        solves.append(Solve(status, *take(2), take(n), take(m), take(plant.horizon * m).reshape(-1, m)))
    assert at == len(words)
    return sets, solves


def fault_of_sets(plant: Plant, sets: Sets, random: numpy.random.Generator) -> str | None:
    state, inputs = reach(plant)
    margin = (plant.state_limit - sets.state_limit) / state - 1.0
    both = numpy.concatenate([margin, (plant.input_limit - sets.input_limit) / inputs - 1.0])
    if both.min() < -1e-9 or both.max() > (0.01 + 1e-8 if plant.shape else 1e-8):
        return f"tightened by {both.min():+.2e} to {both.max():+.2e} more than S"
    # Along random rays to the edge of the terminal set: one limit is met later, none is passed.
    A_K = plant.closed()
    z = random.normal(size=(len(state), 300)) * sets.state_limit[:, None]
    z /= numpy.abs(sets.terminal @ z).max(axis=0)
    largest = numpy.zeros(300)
    for _ in range(2000):
        shares = numpy.vstack([z / sets.state_limit[:, None], plant.K @ z / sets.input_limit[:, None]])
        largest = numpy.maximum(largest, numpy.abs(shares).max(axis=0))
        if numpy.abs(shares).max() < 1e-4:
            break
        z = A_K @ z
    if numpy.abs(largest - 1.0).max() > 1e-6:
        return f"from the terminal set's edge limits are used to {largest.min():.8f} .. {largest.max():.8f}"
    return None


def sparse(M: numpy.ndarray) -> cvxopt.spmatrix:
    """As cvxopt factors it five times as fast as a dense one."""
    rows, columns = M.nonzero()
    return cvxopt.spmatrix(M[rows, columns], rows, columns, M.shape)


class SparseForm:
    """Variables: z_0 .. z_N, v_0 .. v_{N-1}, one violation times the root of its weight for each soft row."""

    def __init__(self, plant: Plant, sets: Sets, x: numpy.ndarray):
        n, m = plant.B.shape
        N = plant.horizon
        self.n, self.m, self.N = n, m, N
        soft_rows = [(i, numpy.eye(n) / sets.state_limit[:, None]) for i in range(N)] + [(N, sets.terminal)]
        soft = sum(len(rows) for _, rows in soft_rows)
        first_v, first_slack = (N + 1) * n, (N + 1) * n + N * m
        size = first_slack + soft
        self.first_v, self.first_slack = first_v, first_slack
        self.root = numpy.sqrt(plant.soft_weight)
        self.H, self.f = numpy.zeros((size, size)), numpy.zeros(size)
        Q_K = plant.Q + plant.K.T @ plant.R @ plant.K
        P = scipy.linalg.solve_discrete_lyapunov(plant.closed().T, Q_K)
        for i in range(N + 1):
            self.H[self.z(i), self.z(i)] = 2.0 * (P if i == N else plant.Q)
        for i in range(N):
            self.H[self.v(i), self.v(i)] = 2.0 * plant.R
        self.H[first_slack:, first_slack:] = numpy.eye(soft)
        model = numpy.zeros((N * n, size))
        for i in range(N):
            rows = slice(i * n, (i + 1) * n)
            model[rows, self.z(i + 1)] = numpy.eye(n)
            model[rows, self.z(i)] = -plant.A
            model[rows, self.v(i)] = -plant.B
        self.E, self.e = model, numpy.zeros(N * n)
        G, h = [], []
        if plant.law == 1:
            fixed = numpy.zeros((n, size))
            fixed[:, self.z(0)] = numpy.eye(n)
            self.E, self.e = numpy.vstack([model, fixed]), numpy.concatenate([self.e, x])
        else:
            tube = numpy.zeros((len(sets.tube), size))
            tube[:, self.z(0)] = sets.tube
            G += [tube, -tube]
            h += [1.0 + sets.tube @ x, 1.0 - sets.tube @ x]
        for i in range(N):
            inputs = numpy.zeros((m, size))
            inputs[:, self.v(i)] = numpy.diag(1.0 / sets.input_limit)
            G += [inputs, -inputs]
            h += [numpy.ones(m)] * 2
        slack = first_slack
        for i, rows in soft_rows:
            block = numpy.zeros((len(rows), size))
            block[:, self.z(i)] = rows
            give = numpy.zeros((len(rows), size))
            give[:, slack:slack + len(rows)] = numpy.eye(len(rows)) / self.root
            slack += len(rows)
            G += [block - give, -block - give]
            h += [numpy.ones(len(rows))] * 2
        self.G, self.h = numpy.vstack(G), numpy.concatenate(h)

    def z(self, i: int) -> slice:
        return slice(i * self.n, (i + 1) * self.n)

    def v(self, i: int) -> slice:
        return slice(self.first_v + i * self.m, self.first_v + (i + 1) * self.m)

    def optimum(self) -> numpy.ndarray | None:
        H, G, E = (sparse(part) for part in (self.H, self.G, self.E))
        f, h, e = (cvxopt.matrix(part) for part in (self.f, self.h, self.e))
        solution = cvxopt.solvers.qp(H, f, G, h, E, e, options=PRECISE)
        y = numpy.array(solution["x"]).ravel()
        multipliers, slacks = numpy.array(solution["z"]).ravel(), self.h - self.G @ y
        for share in (1.0, 1e-2, 1e-4, 1e2, 1e4, 1e-6, 1e6):
            better = self.polished(multipliers > share * slacks)
            if better is not None:
                return better
        return None

    def polished(self, active: numpy.ndarray) -> numpy.ndarray | None:
        """An interior point stops a little inside: the limits it presses on as equations. None unless the point keeps
        all others and presses on these, which makes it the optimum."""
        C = numpy.vstack([self.E, self.G[active]])
        M = numpy.block([[self.H, C.T], [C, numpy.zeros((len(C), len(C)))]])
        rhs = numpy.concatenate([-self.f, self.e, self.h[active]])
        try:
            factors = scipy.linalg.lu_factor(M, check_finite=False)
        except (numpy.linalg.LinAlgError, scipy.linalg.LinAlgWarning):
            return None
        solution = scipy.linalg.lu_solve(factors, rhs)
        for _ in range(2):
            solution += scipy.linalg.lu_solve(factors, rhs - M @ solution)
        if not numpy.isfinite(solution).all():
            return None
        y, pressure = solution[:len(self.f)], solution[len(self.f) + len(self.E):]
        size = 1.0 + numpy.abs(solution).max()
        holds = (self.G @ y - self.h).max() < 1e-9 and pressure.min(initial=0.0) > -1e-11 * size
        solves = numpy.abs(M @ solution - rhs).max() < 1e-11 * size
        return y if holds and solves else None

    def cost(self, y: numpy.ndarray) -> float:
        return float(0.5 * y @ self.H @ y + self.f @ y)


def fault_of(plant: Plant, sets: Sets, x: numpy.ndarray, answer: Solve, counts: dict[str, float]) -> str | None:
    form = SparseForm(plant, sets, x)
    if answer.status != "solved":
        return answer.status
    y = form.optimum()
    if y is None:
        counts["left open by cvxopt"] += 1
        return None
    z0, v0 = y[form.z(0)], y[form.v(0)]
    violation = max(0.0, y[form.first_slack:].max() / form.root)
    counts["judged"] += 1
    counts["at a limit"] += bool((form.h - form.G @ y).min() < 1e-9)
    counts["violated"] += violation > 1e-5
    u = v0 + plant.K @ (x - z0)
    c = numpy.array([y[form.v(i)] - plant.K @ y[form.z(i)] for i in range(plant.horizon)])
    differences = {
        "z_0": (numpy.abs(answer.z0 - z0) / plant.state_limit).max(),
        "u": (numpy.abs(answer.u - u) / plant.input_limit).max(),
        "corrections": (numpy.abs(answer.c - c) / plant.input_limit).max(),
        "violation": abs(answer.violation - violation),
        "cost": abs(answer.cost - form.cost(y)) / max(1.0, abs(form.cost(y))),
    }
    counts["worst"] = max(counts["worst"], *differences.values())
    wrong = [f"{name} differs by {value:.1e}" for name, value in differences.items() if not value <= TOLERANCE]
    return ", ".join(wrong) or None


def main(program: str) -> int:
    random = numpy.random.default_rng(20220708)
    plants = []
    for axis in (longitudinal, lateral):
        for law, shape in ((0, 0), (0, 1), (1, 1)):
            # As flown: states that mostly are feasible; and softer, where violations share the cost.
            plants += [dataclasses.replace(axis(), law=law, shape=shape, soft_weight=weight) for weight in (1e9, 1e4)]
    plants += [dataclasses.replace(random_plant(random), law=i % 2, shape=i // 2 % 2) for i in range(RANDOM_PLANTS)]
    for plant in plants:
        size = 0.5 if plant.soft_weight == 1e9 else 1.5
        plant.states = random.uniform(-size, size, (CALLS, len(plant.A))) * plant.state_limit
    replies = answers(program, [request("tube", *plant.parts()) for plant in plants])
    counts = dict.fromkeys(["judged", "at a limit", "violated", "left open by cvxopt", "worst"], 0)
    faults, checks = [], 0
    for i, (plant, words) in enumerate(zip(plants, replies, strict=True)):
        sets, solves = parse(words, plant)
        found = [fault_of_sets(plant, sets, random)]
        found += [fault_of(plant, sets, x, solve, counts) for x, solve in zip(plant.states, solves, strict=True)]
        checks += len(found)
        faults += [f"plant {i}: {fault}" for fault in found if fault]
    print(", ".join(f"{name}: {count:.3g}" for name, count in counts.items()))
    if min(counts["at a limit"], counts["violated"]) < 50 or counts["left open by cvxopt"] > 0.1 * counts["judged"]:
        faults.append("the problems are too tame or too hard to judge by")
    return report(faults, checks, f"cvxopt {cvxopt.__version__} and scipy {scipy.__version__}")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
