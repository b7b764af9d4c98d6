#!/usr/bin/env python3
"""Sampled models, Riccati and Lyapunov equations of optimal_control_files against scipy.

usage: optimal_control_scipy_check.py <optimal_control_files>
Exit code 77 (skipped) where numpy or scipy are absent.
"""

import sys

try:
    import numpy
    import scipy
    import scipy.linalg
    from optimal_control_exchange import answers, matrices, report, request
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

CASES = 200
TOLERANCE = 1e-9


def relative_difference(ours: numpy.ndarray, theirs: numpy.ndarray) -> float:
    return float(numpy.linalg.norm(ours - theirs) / max(1e-300, numpy.linalg.norm(theirs)))


def sampled_models(random: numpy.random.Generator):
    """Rates from slow to 50 times the sample; inputs in units from 1e-3 to 1e3."""
    cases = []
    for _ in range(CASES):
        n, m = int(random.integers(1, 13)), int(random.integers(1, 5))
        A = 10.0 ** random.uniform(-1, 1.7) * random.normal(size=(n, n)) / numpy.sqrt(n)
        A -= max(0.0, numpy.linalg.eigvals(A).real.max()) * numpy.eye(n)
        B = random.normal(size=(n, m)) * 10.0 ** random.uniform(-3, 3, size=m)
        cases.append((n, m, 10.0 ** random.uniform(-2, 0), A, B))
    return cases


def fault_of_sampled_model(case, words: list[str]) -> str | None:
    n, m, period, A, B = case
    # The reference has B in a size of its own, so that scipy's scaling is not led astray either.
    size = numpy.abs(B).max(axis=0)
    generator = numpy.zeros((n + m, n + m))
    generator[:n, :n], generator[:n, n:] = A, B / size
    held = scipy.linalg.expm(period * generator)
    ours_A, ours_B = matrices(words[1:], (n, n), (n, m))
    difference = max(relative_difference(ours_A, held[:n, :n]), relative_difference(ours_B, held[:n, n:] * size))
    return None if difference < TOLERANCE else f"discretise {n} x {m}: differs by {difference:.1e}"


def regulators(random: numpy.random.Generator):
    """Random systems, four in ten of them unstable, some with a few inputs only, Q of any rank."""
    cases = []
    while len(cases) < CASES:
        n, m = int(random.integers(1, 13)), int(random.integers(1, 5))
        A = random.normal(size=(n, n))
        A *= random.uniform(0.3, 1.4) / numpy.abs(numpy.linalg.eigvals(A)).max()
        B = random.normal(size=(n, m)) * 10.0 ** random.uniform(-1, 1, size=m)
        root = random.normal(size=(int(random.integers(1, n + 1)), n))
        weight = random.normal(size=(m, m))
        R = weight @ weight.T + 10.0 ** random.uniform(-3, 1) * numpy.eye(m)
        cases.append((n, m, A, B, root.T @ root, R))
    return cases


def fault_of_regulator(case, words: list[str]) -> str | None:
    n, m, A, B, Q, R = case
    if words[0] != "ok":
        return f"dare {n} x {m}: {words[0]}"
    P, K = matrices(words[1:], (n, n), (m, n))
    theirs = scipy.linalg.solve_discrete_are(A, B, Q, R)
    theirs_K = numpy.linalg.solve(R + B.T @ theirs @ B, B.T @ theirs @ A)
    difference = max(relative_difference(P, theirs), numpy.abs(K - theirs_K).max() / max(1.0, numpy.abs(theirs_K).max()))
    return None if difference < TOLERANCE else f"dare {n} x {m}: differs by {difference:.1e}"


def hopeless_regulators(random: numpy.random.Generator):
    """One unstable mode that no input reaches, hidden by a change of coordinates."""
    cases = []
    for _ in range(20):
        n, m = int(random.integers(2, 9)), int(random.integers(1, 4))
        A = numpy.triu(random.normal(size=(n, n)), 1) + numpy.diag(random.uniform(-0.9, 0.9, n))
        A[n - 1, n - 1] = random.choice([-1, 1]) * random.uniform(1.0, 1.5)
        B = random.normal(size=(n, m))
        B[n - 1] = 0.0
        T, _ = numpy.linalg.qr(random.normal(size=(n, n)))
        cases.append((n, m, T @ A @ T.T, T @ B, numpy.eye(n), numpy.eye(m)))
    return cases


def sums(random: numpy.random.Generator):
    cases = []
    for _ in range(CASES):
        n = int(random.integers(1, 13))
        A = random.normal(size=(n, n))
        A *= random.uniform(0.1, 0.999) / numpy.abs(numpy.linalg.eigvals(A)).max()
        Q = random.normal(size=(n, n))
        cases.append((n, A, Q + Q.T))
    return cases


def fault_of_sum(case, words: list[str]) -> str | None:
    n, A, Q = case
    if words[0] != "ok":
        return f"lyapunov {n}: {words[0]}"
    (P,) = matrices(words[1:], (n, n))
    difference = relative_difference(P, scipy.linalg.solve_discrete_lyapunov(A.T, Q))
    return None if difference < TOLERANCE else f"lyapunov {n}: differs by {difference:.1e}"


def fault_of_verdict(case, words: list[str]) -> str | None:
    return None if words == ["failed"] else f"a problem without solution: {words[0]}"


def main(program: str) -> int:
    random = numpy.random.default_rng(20220704)
    groups = [
        ("discretise", sampled_models(random), fault_of_sampled_model),
        ("dare", regulators(random), fault_of_regulator),
        ("dare", hopeless_regulators(random), fault_of_verdict),
        ("lyapunov", sums(random), fault_of_sum),
        ("lyapunov", [(n, A / numpy.abs(numpy.linalg.eigvals(A)).max() * 1.001, Q) for n, A, Q in sums(random)[:20]],
         fault_of_verdict),
    ]
    cases = [(name, case, judge) for name, group, judge in groups for case in group]
    replies = answers(program, [request(name, *case) for name, case, _ in cases])
    faults = [judge(case, words) for (_, case, judge), words in zip(cases, replies, strict=True)]
    return report([fault for fault in faults if fault], len(cases), f"scipy {scipy.__version__}")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
