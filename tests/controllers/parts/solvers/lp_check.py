#!/usr/bin/env python3
"""Solves linear programmes with lp_solve_files, with HiGHS (scipy) and with GLPK (cvxopt).

usage: lp_check.py <lp_solve_files>
Random and degenerate ones, with repeated and dependent rows, cones, badly scaled, infeasible and unbounded: verdicts
must be the same, optima equal to 1e-8 of their size, and each answer must prove itself by its multipliers to 1e-9.
Exit code 77 (skipped) where numpy, scipy or cvxopt are absent.
"""

import itertools
import sys

try:
    import cvxopt
    import cvxopt.glpk
    import cvxopt.solvers
    import numpy
    import scipy
    from lp_exchange import Answer, Programme, solve_all
    from scipy.optimize import linear_sum_assignment, linprog
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

TOLERANCE = 1e-8
HIGHS = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


def around_a_point(random: numpy.random.Generator) -> Programme:
    """Feasible; with few rows mostly unbounded."""
    n = int(random.integers(1, 17))
    m = int(random.integers(1, 12 * n))
    F = random.normal(size=(m, n))
    return Programme("random", F, F @ random.normal(size=n) + random.uniform(0.0, 1.0, m), random.normal(size=n))


def of_small_integers(random: numpy.random.Generator) -> Programme:
    """Many ties: rows repeated, parallel, zero or through one point; the cost often one of the rows."""
    n = int(random.integers(1, 9))
    m = int(random.integers(1, 40))
    F = random.integers(-2, 3, size=(m, n)).astype(float)
    g = random.integers(0, 3, size=m).astype(float)
    if random.uniform() < 0.3:
        g -= 1.0
    if random.uniform() < 0.3:
        g[:] = 0.0
    if random.uniform() < 0.5:
        box = numpy.eye(n)
        F, g = numpy.vstack([F, box, -box]), numpy.concatenate([g, numpy.ones(2 * n)])
    choice = random.uniform()
    if choice < 0.3:
        c = F[random.integers(0, len(F))].copy()
    elif choice < 0.4:
        c = numpy.zeros(n)
    else:
        c = random.integers(-2, 3, size=n).astype(float)
    return Programme("small integers", F, g, c)


def badly_scaled(random: numpy.random.Generator) -> Programme:
    programme = around_a_point(random)
    m, n = programme.F.shape
    columns = 10.0 ** random.uniform(-3.0, 3.0, n)
    rows = 10.0 ** random.uniform(-3.0, 3.0, m)
    return Programme("badly scaled", programme.F * columns * rows[:, None], programme.g * rows, programme.c * columns)


def without_full_rank(random: numpy.random.Generator) -> Programme:
    """Directions that no row sees; the cost sees them or does not."""
    n = int(random.integers(2, 11))
    rank = int(random.integers(1, n))
    m = int(random.integers(rank, 8 * n))
    seen = random.normal(size=(rank, n))
    F = random.normal(size=(m, rank)) @ seen
    c = random.normal(size=rank) @ seen
    if random.uniform() < 0.3:
        c += random.normal(size=n)
    return Programme("without full rank", F, F @ random.normal(size=n) + random.uniform(0.0, 1.0, m), c)


def without_room(random: numpy.random.Generator) -> Programme:
    """A row that is minus a positive combination of others, with a limit too low for it."""
    programme = around_a_point(random)
    chosen = random.choice(len(programme.F), size=min(len(programme.F), int(random.integers(1, 6))), replace=False)
    factors = random.uniform(0.5, 2.0, len(chosen))
    gap = 10.0 ** random.uniform(-4.0, 0.0)
    F = numpy.vstack([programme.F, -factors @ programme.F[chosen]])
    g = numpy.append(programme.g, -factors @ programme.g[chosen] - gap)
    return Programme("without room", F, g, programme.c)


def without_inside(random: numpy.random.Generator) -> Programme:
    """Equalities as pairs of rows, one of them repeated: the set has no inside."""
    n = int(random.integers(2, 11))
    E = random.integers(-3, 4, size=(int(random.integers(1, n)), n)).astype(float)
    E = numpy.vstack([E, E[0]])
    point = random.integers(-3, 4, size=n).astype(float)
    box = numpy.vstack([numpy.eye(n), -numpy.eye(n)])
    F = numpy.vstack([E, -E, box])
    return Programme("without inside", F, numpy.concatenate([E @ point, -E @ point, box @ point + 1.0]),
                     random.normal(size=n))


def famous() -> list[Programme]:
    programmes = []
    # Beale 1955: cycles under the largest-coefficient rule.
    A = numpy.array([[0.25, -8, -1, 9], [0.5, -12, -0.5, 3], [0, 0, 1, 0]])
    programmes.append(Programme("Beale", numpy.vstack([A, -numpy.eye(4)]), numpy.array([0, 0, 1, 0, 0, 0, 0.0]),
                                numpy.array([0.75, -20, 0.5, -6]), 1.25))
    # Kuhn's example of cycling; unbounded without its last row.
    A = numpy.array([[-2, -9, 1, 9], [1 / 3, 1, -1 / 3, -2], [2, 3, -1, -12]])
    programmes.append(Programme("Kuhn", numpy.vstack([A, -numpy.eye(4)]), numpy.array([0, 0, 2, 0, 0, 0, 0.0]),
                                numpy.array([2, 3, -1, -12.0]), 2.0))
    for n in (4, 8, 12):  # Klee and Minty 1972
        F = numpy.eye(n) + numpy.tril(numpy.array([[2.0 ** (i - j + 1) for j in range(n)] for i in range(n)]), -1)
        programmes.append(Programme(f"Klee-Minty {n}", numpy.vstack([F, -numpy.eye(n)]),
                                    numpy.concatenate([5.0 ** numpy.arange(1, n + 1), numpy.zeros(n)]),
                                    2.0 ** numpy.arange(n - 1, -1, -1), 5.0 ** n))
    for n in (3, 7, 10):  # the 1-norm ball: 2^n rows, 2n vertices of 2^(n-1) rows each
        F = numpy.array(list(itertools.product([-1.0, 1.0], repeat=n)))
        c = numpy.random.default_rng(n).normal(size=n)
        programmes.append(Programme(f"1-norm ball {n}", F, numpy.ones(2 ** n), c, numpy.abs(c).max()))
    for k in (2, 3, 4):  # assignments: k^2 variables, 2k equalities of rank 2k - 1, highly degenerate
        for seed in range(10):
            worth = numpy.random.default_rng(seed).integers(0, 6, size=(k, k)).astype(float)
            sums = numpy.vstack([numpy.kron(numpy.eye(k), numpy.ones(k)), numpy.kron(numpy.ones(k), numpy.eye(k))])
            F = numpy.vstack([sums, -sums, -numpy.eye(k * k)])
            g = numpy.concatenate([numpy.ones(2 * k), -numpy.ones(2 * k), numpy.zeros(k * k)])
            best = worth[linear_sum_assignment(worth, maximize=True)].sum()
            programmes.append(Programme(f"assignment {k}", F, g, worth.ravel(), best))
    random = numpy.random.default_rng(5)
    for n in (3, 8, 16):  # planes that touch a ball
        F = random.normal(size=(2000, n))
        F /= numpy.linalg.norm(F, axis=1)[:, None]
        programmes.append(Programme(f"ball {n}", F, numpy.ones(2000), random.normal(size=n)))
    return programmes


def verdict_of_highs(programme: Programme) -> tuple[str, float]:
    finite = numpy.isfinite(programme.g)
    def solve(cost):
        return linprog(-cost, programme.F[finite], programme.g[finite], bounds=(None, None), method="highs-ds",
                       options=HIGHS)
    result = solve(programme.c)
    if result.status == 0:
        return "solved", -result.fun
    # HiGHS may say "infeasible or unbounded": whether there is a point at all decides.
    return ("unbounded" if solve(0.0 * programme.c).status == 0 else "infeasible"), numpy.nan


def verdict_of_glpk(programme: Programme) -> tuple[str, float]:
    finite = numpy.isfinite(programme.g)
    F, g = cvxopt.matrix(programme.F[finite]), cvxopt.matrix(programme.g[finite])
    def solve(cost):
        return cvxopt.glpk.lp(cvxopt.matrix(-cost), F, g, options={"msg_lev": "GLP_MSG_OFF"})
    status, x, *_ = solve(programme.c)
    if status == "optimal":
        return "solved", float(programme.c @ numpy.array(x).ravel())
    return ("unbounded" if solve(0.0 * programme.c)[0] == "optimal" else "infeasible"), numpy.nan


def fault(programme: Programme, answer: Answer) -> str | None:
    if proof := answer.fault_of_proof(programme):
        return f"{answer.status}: {proof}"
    size = max(1.0, abs(answer.value), numpy.abs(programme.c) @ numpy.abs(answer.x))
    if programme.optimum is not None and not abs(answer.value - programme.optimum) <= 1e-9 * size:
        return f"value {answer.value!r}, known {programme.optimum!r}"
    for judge, verdict in (("HiGHS", verdict_of_highs), ("GLPK", verdict_of_glpk)):
        status, value = verdict(programme)
        if status != answer.status:
            return f"{answer.status}, {judge} says {status}"
        if status == "solved" and not abs(value - answer.value) <= TOLERANCE * size:
            return f"value {answer.value!r}, {judge} {value!r}"
    return None


def main(program: str) -> int:
    random = numpy.random.default_rng(19540101)
    programmes = famous()
    for make, count in ((around_a_point, 300), (of_small_integers, 1000), (badly_scaled, 200),
                        (without_full_rank, 200), (without_room, 200), (without_inside, 200)):
        programmes += [make(random) for _ in range(count)]
    answers = solve_all(program, programmes)
    wrong = 0
    for i, (programme, answer) in enumerate(zip(programmes, answers, strict=True)):
        if words := fault(programme, answer):
            print(f"programme {i} ({programme.name}, {programme.F.shape[0]} x {programme.F.shape[1]}): {words}")
            wrong += 1
    verdicts = {status: sum(answer.status == status for answer in answers)
                for status in ("solved", "infeasible", "unbounded")}
    print(f"{len(answers) - wrong} of {len(answers)} programmes agree with scipy {scipy.__version__} and cvxopt "
          f"{cvxopt.__version__}: {verdicts}, at most {max(answer.iterations for answer in answers)} pivots")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
