#!/usr/bin/env python3
"""Solves random programmes with qp_solve_files and with the interior-point code of cvxopt.

usage: qp_cvxopt_check.py <qp_solve_files>
1000 feasible ones must have equal optima; 100 infeasible ones must be called so by both.
Exit code 77 (skipped) where numpy or cvxopt are absent.
"""

import sys

try:
    import cvxopt
    import cvxopt.solvers
    import numpy
    from qp_exchange import Answer, Programme, solve_all
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

FEASIBLE, INFEASIBLE = 1000, 100
TOLERANCE = 1e-6
PRECISE = {"show_progress": False, "abstol": 1e-11, "reltol": 1e-11, "feastol": 1e-11, "maxiters": 200}


def random_programme(random: numpy.random.Generator) -> Programme:
    """Feasible: built around a point. One row in five is repeated or a sum of two others."""
    n = int(random.integers(2, 21))
    m = int(random.integers(1, 41))
    Q, _ = numpy.linalg.qr(random.normal(size=(n, n)))
    H = (Q * 10.0 ** random.uniform(0.0, 3.0, n)) @ Q.T
    A = random.normal(size=(m, n))
    equalities = int(random.integers(0, min(n // 2, m) + 1))
    for row in range(max(equalities, 2), m):
        choice = random.uniform()
        first, second = random.integers(0, row, 2)
        if choice < 0.1:
            A[row] = A[first]
        elif choice < 0.2:
            A[row] = A[first] + A[second]
    point = random.normal(size=n)
    values = A @ point
    row_lower = numpy.where(random.uniform(size=m) < 0.6, values - random.uniform(0.1, 1.0, m), -numpy.inf)
    row_upper = numpy.where(random.uniform(size=m) < 0.6, values + random.uniform(0.1, 1.0, m), numpy.inf)
    row_lower[:equalities] = row_upper[:equalities] = values[:equalities]
    lower = numpy.where(random.uniform(size=n) < 0.5, point - random.uniform(0.1, 1.0, n), -numpy.inf)
    upper = numpy.where(random.uniform(size=n) < 0.5, point + random.uniform(0.1, 1.0, n), numpy.inf)
    f = 10.0 ** random.uniform(0.0, 3.0) * random.normal(size=n)
    return Programme(0.5 * (H + H.T), f, lower, upper, A, row_lower, row_upper)


def make_infeasible(programme: Programme, random: numpy.random.Generator) -> None:
    """Adds a row that is minus a positive combination of others with upper limits, with a limit too low for it
    (Farkas)."""
    finite = numpy.flatnonzero(numpy.isfinite(programme.row_upper))
    if len(finite) == 0:
        programme.row_upper[0] = programme.A[0] @ numpy.ones(len(programme.f)) + 1.0
        finite = numpy.array([0])
    chosen = random.choice(finite, size=min(len(finite), int(random.integers(1, 4))), replace=False)
    factors = random.uniform(0.5, 2.0, len(chosen))
    programme.A = numpy.vstack([programme.A, -factors @ programme.A[chosen]])
    gap = 10.0 ** random.uniform(-2.0, 0.0)
    programme.row_upper = numpy.append(programme.row_upper, -factors @ programme.row_upper[chosen] - gap)
    programme.row_lower = numpy.append(programme.row_lower, -numpy.inf)


def inequalities(programme: Programme):
    """G x <= h and A x = b in cvxopt's form."""
    n = len(programme.f)
    rows = numpy.vstack([numpy.eye(n), programme.A])
    low = numpy.concatenate([programme.lower, programme.row_lower])
    up = numpy.concatenate([programme.upper, programme.row_upper])
    equal = low == up
    above, below = numpy.isfinite(up) & ~equal, numpy.isfinite(low) & ~equal
    G = numpy.vstack([rows[above], -rows[below]])
    h = numpy.concatenate([up[above], -low[below]])
    return cvxopt.matrix(G), cvxopt.matrix(h), cvxopt.matrix(rows[equal]), cvxopt.matrix(up[equal])


def fault_of_optimum(programme: Programme, answer: Answer) -> str | None:
    G, h, A, b = inequalities(programme)
    reference = cvxopt.solvers.qp(cvxopt.matrix(programme.H), cvxopt.matrix(programme.f), G, h, A, b, options=PRECISE)
    x = numpy.array(reference["x"]).ravel()
    # "unknown" is what cvxopt says where rounding keeps it from the last digits: the gap decides.
    optimum, gap = reference["primal objective"], reference["gap"]
    size = max(1.0, abs(optimum))
    if gap > 1e-7 * size or programme.violation(x) > 1e-7:
        return f"cvxopt did not get there: {reference['status']}, gap {gap:.1e}"
    if answer.status != "solved":
        return answer.status
    difference = abs(programme.cost(answer.x) - optimum) / size
    violation = programme.violation(answer.x)
    if difference <= TOLERANCE and violation <= TOLERANCE:
        return None
    return f"optimum differs by {difference:.1e}, violation {violation:.1e}"


def fault_of_verdict(programme: Programme, answer: Answer) -> str | None:
    """cvxopt's linear programme gives the smallest t with which some |x| <= 100 keeps G x <= h + t, A x = b."""
    G, h, A, b = (numpy.array(part) for part in inequalities(programme))
    n = len(programme.f)
    G = numpy.block([[G, -numpy.ones((len(G), 1))], [numpy.eye(n + 1)], [-numpy.eye(n + 1)]])
    h = numpy.concatenate([h.ravel(), numpy.full(2 * (n + 1), 100.0)])
    A = numpy.hstack([A, numpy.zeros((len(A), 1))])
    cost = numpy.append(numpy.zeros(n), 1.0)
    reference = cvxopt.solvers.lp(*(cvxopt.matrix(part) for part in (cost, G, h, A, b.ravel())),
                                  options={"show_progress": False})
    # A dual point that misses its equations by 1e-6 bounds the violation of any such x from below to 5e-4, whether
    # or not its last digits were reached.
    if not (reference["dual objective"] > 1e-3 and reference["dual infeasibility"] < 1e-6):
        return f"cvxopt says {reference['status']}, violation {reference['primal objective']:.1e}"
    return None if answer.status == "infeasible" else answer.status


def main(program: str) -> int:
    random = numpy.random.default_rng(20220705)
    feasible = [random_programme(random) for _ in range(FEASIBLE)]
    infeasible = [random_programme(random) for _ in range(INFEASIBLE)]
    for programme in infeasible:
        make_infeasible(programme, random)
    answers = solve_all(program, feasible + infeasible)
    faults = [fault_of_optimum(*pair) for pair in zip(feasible, answers[:FEASIBLE], strict=True)]
    faults += [fault_of_verdict(*pair) for pair in zip(infeasible, answers[FEASIBLE:], strict=True)]
    for i, fault in enumerate(faults):
        if fault:
            print(f"programme {i}: {fault}")
    wrong = sum(fault is not None for fault in faults)
    print(f"{len(faults) - wrong} of {len(faults)} programmes agree with cvxopt {cvxopt.__version__}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
