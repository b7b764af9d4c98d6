#!/usr/bin/env python3
"""Random MPC problems of optimal_control_files against their sparse form in cvxopt.

usage: linear_mpc_cvxopt_check.py <optimal_control_files>
Inputs, input rates, states (absolute, relative, soft and hard) and the last state are limited, references and input
references change along the horizon, a constant disturbance acts. cvxopt has states, inputs and violations as
variables and the model as equations: nothing is condensed there. Problems without solution are judged by scipy's
linear programme (HiGHS). Exit code 77 (skipped) where numpy, cvxopt or scipy are absent.
"""

import dataclasses
import sys

try:
    import cvxopt
    import cvxopt.solvers
    import numpy
    import scipy
    import scipy.optimize
    from optimal_control_exchange import answers, report, request
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

PLANTS, CALLS = 250, 3
TOLERANCE = 1e-6
PRECISE = {"show_progress": False, "abstol": 1e-12, "reltol": 1e-12, "feastol": 1e-12, "maxiters": 200}


@dataclasses.dataclass
class Rows:
    relative: bool
    F: numpy.ndarray
    lower: numpy.ndarray
    upper: numpy.ndarray
    weight: numpy.ndarray

    def parts(self):
        return [[len(self.F), self.relative], self.F, self.lower, self.upper, self.weight]


@dataclasses.dataclass
class Plant:
    A: numpy.ndarray
    B: numpy.ndarray
    Q: numpy.ndarray
    R: numpy.ndarray
    P: numpy.ndarray
    horizon: int
    inputs: tuple[numpy.ndarray, numpy.ndarray] | None
    rates: tuple[numpy.ndarray, numpy.ndarray] | None
    blocks: list[Rows]
    terminal_blocks: list[Rows]

    def parts(self):
        n, m = self.B.shape
        yield from ([n, m, self.horizon], self.A, self.B, self.Q, self.R, self.P)
        for limits in (self.inputs, self.rates):
            yield [limits is not None]
            yield from limits or ()
        for blocks in (self.blocks, self.terminal_blocks):
            yield [len(blocks)]
            for block in blocks:
                yield from block.parts()


@dataclasses.dataclass
class Call:
    x: numpy.ndarray
    reference: numpy.ndarray  # (N + 1) x n
    input_reference: numpy.ndarray  # N x m
    disturbance: numpy.ndarray
    input_before: numpy.ndarray

    def parts(self):
        return [self.x, self.reference, self.input_reference, self.disturbance, self.input_before]


@dataclasses.dataclass
class Answer:
    status: str
    cost: float
    violation: float
    inputs: numpy.ndarray  # N x m
    states: numpy.ndarray  # (N + 1) x n


def random_rows(random: numpy.random.Generator, n: int, most: int) -> Rows:
    count = int(random.integers(1, most + 1))
    F = random.normal(size=(count, n))
    F[random.uniform(size=F.shape) < 0.5] = 0.0
    for row in F:
        row[random.integers(n)] = 1.0
    lower = numpy.where(random.uniform(size=count) < 0.7, -random.uniform(0.5, 3.0, count), -numpy.inf)
    upper = numpy.where(random.uniform(size=count) < 0.7, random.uniform(0.5, 3.0, count), numpy.inf)
    soft = random.uniform(size=count) < 0.7
    return Rows(bool(random.uniform() < 0.4), F, lower, upper,
                numpy.where(soft, 10.0 ** random.uniform(0, 4, count), numpy.inf))


def random_plant(random: numpy.random.Generator) -> Plant:
    n, m, horizon = int(random.integers(1, 7)), int(random.integers(1, 4)), int(random.integers(1, 13))
    A = random.normal(size=(n, n))
    A *= random.uniform(0.3, 1.1) / numpy.abs(numpy.linalg.eigvals(A)).max()
    B = random.normal(size=(n, m))
    if n > 1 and random.uniform() < 0.3:
        B[0] = 0.0  # with a row on this state alone, the first step is out of reach
    roots = [random.normal(size=(k, k)) for k in (n, m, n)]
    Q, R, P = (root @ root.T for root in roots)
    limits = [tuple(numpy.array([-1.0, 1.0])[:, None] * random.uniform(0.2, 1.5, (2, m)))
              if random.uniform() < 0.7 else None for _ in range(2)]
    blocks = [random_rows(random, n, n) for _ in range(int(random.integers(0, 3)))]
    terminal_blocks = [random_rows(random, n, n) for _ in range(int(random.integers(0, 2)))]
    return Plant(A, B, Q, R + 0.1 * numpy.eye(m), P, horizon, *limits, blocks, terminal_blocks)


def random_call(random: numpy.random.Generator, plant: Plant) -> Call:
    n, m = plant.B.shape
    walk = numpy.cumsum(0.5 * random.normal(size=(plant.horizon + 1, n)), axis=0)
    return Call(random.normal(size=n), walk, 0.3 * random.normal(size=(plant.horizon, m)), 0.2 * random.normal(size=n),
                0.3 * random.normal(size=m))


class SparseForm:
    """Variables: u_0 .. u_{N-1}, x_1 .. x_N, one violation for each soft row."""

    def __init__(self, plant: Plant, call: Call):
        n, m = plant.B.shape
        N = plant.horizon
        rows = [(step, block) for step in range(1, N + 1) for block in plant.blocks]
        rows += [(N, block) for block in plant.terminal_blocks]
        soft = sum(int(numpy.isfinite(block.weight).sum()) for _, block in rows)
        self.first_state, self.first_slack = N * m, N * (m + n)
        size = self.first_slack + soft
        self.H, self.f = numpy.zeros((size, size)), numpy.zeros(size)
        for k in range(N):
            u = slice(k * m, (k + 1) * m)
            self.H[u, u] = 2.0 * plant.R
            self.f[u] = -2.0 * plant.R @ call.input_reference[k]
            x = self.state(k + 1, n)
            weight = plant.P if k == N - 1 else plant.Q
            self.H[x, x] = 2.0 * weight
            self.f[x] = -2.0 * weight @ call.reference[k + 1]
        self.model(plant, call, size)
        self.G, self.h = [], []
        for k in range(N):
            for j in range(m):
                row = numpy.zeros(size)
                row[k * m + j] = 1.0
                if plant.inputs:
                    self.limit(row, plant.inputs[0][j], plant.inputs[1][j])
                row = row.copy()
                before = 0.0
                if k == 0:
                    before = call.input_before[j]
                else:
                    row[(k - 1) * m + j] = -1.0
                if plant.rates:
                    self.limit(row, plant.rates[0][j] + before, plant.rates[1][j] + before)
        slack = self.first_slack
        for step, block in rows:
            for i in range(len(block.F)):
                row = numpy.zeros(size)
                row[self.state(step, n)] = block.F[i]
                if numpy.isfinite(block.weight[i]):
                    row[slack] = -1.0
                    self.H[slack, slack] = block.weight[i]
                    slack += 1
                shift = block.F[i] @ call.reference[step] if block.relative else 0.0
                self.limit(row, block.lower[i] + shift, block.upper[i] + shift)
        self.G = numpy.array(self.G).reshape(-1, size)
        self.h = numpy.array(self.h)

    def state(self, k: int, n: int) -> slice:
        return slice(self.first_state + (k - 1) * n, self.first_state + k * n)

    def model(self, plant: Plant, call: Call, size: int) -> None:
        n, m = plant.B.shape
        self.E, self.e = numpy.zeros((plant.horizon * n, size)), numpy.tile(call.disturbance, plant.horizon)
        self.e[:n] += plant.A @ call.x
        for k in range(plant.horizon):
            rows = slice(k * n, (k + 1) * n)
            self.E[rows, self.state(k + 1, n)] = numpy.eye(n)
            self.E[rows, k * m:(k + 1) * m] = -plant.B
            if k > 0:
                self.E[rows, self.state(k, n)] = -plant.A

    def limit(self, row: numpy.ndarray, lower: float, upper: float) -> None:
        for sign, value in ((1.0, upper), (-1.0, -lower)):
            if numpy.isfinite(value):
                self.G.append(sign * row)
                self.h.append(value)

    def feasible(self) -> bool | None:
        """None: too close to decide. The largest slack t of all limits together, |t| <= 1, by a linear programme."""
        if len(self.h) == 0:
            return True
        size = len(self.f)
        cost = numpy.append(numpy.zeros(size), -1.0)
        G = numpy.hstack([self.G, numpy.ones((len(self.G), 1))])
        E = numpy.hstack([self.E, numpy.zeros((len(self.E), 1))])
        bounds = [(None, None)] * size + [(None, 1.0)]
        for method in ("highs-ds", "highs-ipm"):  # the simplex gives up on one of them, "Status 0: Error"
            solution = scipy.optimize.linprog(cost, G, self.h, E, self.e, bounds, method=method)
            if solution.status == 0:
                break
        assert solution.status == 0, solution.message
        slack = -solution.fun
        return None if abs(slack) < 1e-6 else slack > 0.0

    def optimum(self) -> numpy.ndarray:
        solution = cvxopt.solvers.qp(*(cvxopt.matrix(part) for part in (self.H, self.f, self.G, self.h, self.E, self.e)),
                                     options=PRECISE)
        z = numpy.array(solution["x"]).ravel()
        multipliers, slacks = numpy.array(solution["z"]).ravel(), self.h - self.G @ z
        for share in (1.0, 1e-2, 1e-4, 1e2, 1e4):
            better = self.polished(multipliers > share * slacks)
            if better is not None:
                return better
        # The cost is convex in the states and inputs, by twice the least eigenvalue: the gap bounds the distance.
        distance = numpy.sqrt(solution["gap"] / numpy.linalg.eigvalsh(self.H).min())
        violation = max(0.0, (self.G @ z - self.h).max(initial=0.0))
        assert distance < 1e-6 and violation < 1e-8, (solution["status"], distance, violation)
        return z

    def polished(self, active: numpy.ndarray) -> numpy.ndarray | None:
        """An interior point stops a little inside: the limits it presses on as equations. None unless the point keeps
        all others and presses on these, which makes it the optimum."""
        C = numpy.vstack([self.E, self.G[active]])
        K = numpy.block([[self.H, C.T], [C, numpy.zeros((len(C), len(C)))]])
        rhs = numpy.concatenate([-self.f, self.e, self.h[active]])
        solution = numpy.linalg.lstsq(K, rhs, rcond=None)[0]
        solution += numpy.linalg.lstsq(K, rhs - K @ solution, rcond=None)[0]
        z, pressure = solution[:len(self.f)], solution[len(self.f) + len(self.E):]
        size = 1.0 + numpy.abs(solution).max()
        holds = (self.G @ z - self.h).max(initial=0.0) < 1e-9 and pressure.min(initial=0.0) > -1e-12 * size
        solves = numpy.abs(K @ solution - rhs).max() < 1e-12 * size
        return z if holds and solves else None

    def cost(self, z: numpy.ndarray) -> float:
        return float(0.5 * z @ self.H @ z + self.f @ z)


def parse(words: list[str], plant: Plant) -> list[Answer]:
    n, m = plant.B.shape
    N = plant.horizon
    length = 3 + N * m + (N + 1) * n
    found = []
    for at in range(0, len(words), length):
        status, *rest = words[at:at + length]
        numbers = numpy.array([float(word) for word in rest])
        inputs, states = numbers[2:2 + N * m].reshape(N, m), numbers[2 + N * m:].reshape(N + 1, n)
        found.append(Answer(status, numbers[0], numbers[1], inputs, states))
    return found


def constant_cost(plant: Plant, call: Call) -> float:
    """What the cost of the sparse form has and the condensed one leaves out: the states under no input, and soft rows
    that no input reaches."""
    x, effect, total = call.x, numpy.zeros((len(call.x), 0)), 0.0
    for k in range(plant.horizon):
        x = plant.A @ x + call.disturbance
        effect = numpy.hstack([plant.A @ effect, plant.B])
        last = k == plant.horizon - 1
        weight = plant.P if last else plant.Q
        total += x @ weight @ x - 2.0 * x @ weight @ call.reference[k + 1]
        for block in plant.blocks + (plant.terminal_blocks if last else []):
            value = block.F @ (x - block.relative * call.reference[k + 1])
            violation = numpy.maximum(0.0, numpy.maximum(value - block.upper, block.lower - value))
            unreached = (block.F @ effect == 0.0).all(axis=1) & numpy.isfinite(block.weight)
            total += 0.5 * block.weight[unreached] @ violation[unreached] ** 2
    return float(total)


def fault_of(plant: Plant, call: Call, answer: Answer, counts: dict[str, int]) -> str | None:
    form = SparseForm(plant, call)
    feasible = form.feasible()
    if feasible is None:
        counts["too close to tell"] += 1
        return None
    if not feasible:
        counts["infeasible"] += 1
        return None if answer.status == "infeasible" else f"infeasible, but called {answer.status}"
    counts["solved"] += 1
    if answer.status != "solved":
        return answer.status
    z = form.optimum()
    n, m = plant.B.shape
    inputs = z[:form.first_state].reshape(-1, m)
    states = z[form.first_state:form.first_slack].reshape(-1, n)
    violation = max(0.0, numpy.abs(z[form.first_slack:]).max(initial=0.0))
    cost = form.cost(z) - constant_cost(plant, call)
    counts["at a limit"] += bool(len(form.h)) and bool((form.h - form.G @ z).min() < 1e-9)
    counts["soft row violated"] += violation > 1e-6
    differences = {
        "inputs": numpy.abs(answer.inputs - inputs).max(),
        "states": numpy.abs(answer.states[1:] - states).max(),
        "violation": abs(answer.violation - violation),
        "cost": abs(answer.cost - cost) / max(1.0, abs(cost)),
    }
    counts["worst"] = max(counts["worst"], differences["inputs"])
    wrong = [f"{name} differ by {value:.1e}" for name, value in differences.items() if not value <= TOLERANCE]
    return ", ".join(wrong) or None


def main(program: str) -> int:
    random = numpy.random.default_rng(20220702)
    plants = [random_plant(random) for _ in range(PLANTS)]
    calls = [[random_call(random, plant) for _ in range(CALLS)] for plant in plants]
    replies = answers(program, [
        request("mpc", *plant.parts(), [CALLS], *(part for call in group for part in call.parts()))
        for plant, group in zip(plants, calls, strict=True)])
    counts = dict.fromkeys(["solved", "at a limit", "soft row violated", "infeasible", "too close to tell", "worst"], 0)
    faults = []
    for i, (plant, group, words) in enumerate(zip(plants, calls, replies, strict=True)):
        for call, answer in zip(group, parse(words, plant), strict=True):
            fault = fault_of(plant, call, answer, counts)
            if fault:
                faults.append(f"plant {i}: {fault}")
    print(", ".join(f"{name}: {count:.3g}" for name, count in counts.items()))
    if min(counts[name] for name in ("at a limit", "soft row violated", "infeasible")) < 30:
        faults.append("the problems are too tame to judge by")
    return report(faults, PLANTS * CALLS, f"cvxopt {cvxopt.__version__} and scipy {scipy.__version__}")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
