#!/usr/bin/env python3
"""Times the 60 programmes of qpsolvers/mpc_qpbenchmark with our solver and with DAQP, cold, alternately in one run.

usage: qp_peers.py <qp_solve_files> <folder with outside data, unless VINEROW_DATA names it>
Needs the Python package daqp (pip install daqp). Both solvers are dense and active-set. A time is that of factorisation
and solution, the least of several turns; DAQP's are those that it measures itself, without Python. It factorises other
matrices before it solves, so only the sums compare.
"""

import math
import os
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "controllers" / "parts" / "solvers"))

import daqp
import numpy
from qp_benchmark_check import load_all
from qp_exchange import Programme, solve_all, times_us

TURNS = 200
DAQP_INFINITY = 1e30


def daqp_answer(programme: Programme):
    """Optimum, exit flag, and least time of set-up and solution, us."""
    # The benchmark's programmes have rows only.
    assert not numpy.isfinite(programme.lower).any() and not numpy.isfinite(programme.upper).any()
    low = numpy.clip(programme.row_lower, -DAQP_INFINITY, DAQP_INFINITY)
    up = numpy.clip(programme.row_upper, -DAQP_INFINITY, DAQP_INFINITY)
    kinds = numpy.zeros(len(low), dtype=numpy.int32)
    A = numpy.ascontiguousarray(programme.A, dtype=float)
    H = numpy.ascontiguousarray(programme.H, dtype=float)
    least_us = math.inf
    for _ in range(TURNS):
        x, _, flag, info = daqp.solve(H, programme.f, A, up, low, kinds)
        least_us = min(least_us, 1e6 * (info["setup_time"] + info["solve_time"]))
    return programme.cost(x), flag, least_us


def main(program: str, folder: pathlib.Path) -> int:
    optima, programmes = load_all(folder)
    answers = solve_all(program, programmes)
    before = times_us(program, programmes)
    peers = [daqp_answer(programme) for programme in programmes]
    ours = [min(sum(one), sum(other)) for one, other in zip(before, times_us(program, programmes), strict=True)]
    ratios = []
    solved = {"ours": 0, "DAQP": 0}
    for name, programme, own_us, answer, peer in zip(optima, programmes, ours, answers, peers, strict=True):
        cost, flag, peer_us = peer
        allowed = 1e-6 * max(1.0, abs(optima[name]))
        is_own = answer.status == "solved" and abs(programme.cost(answer.x) - optima[name]) <= allowed
        is_peer = flag == 1 and abs(cost - optima[name]) <= allowed
        solved["ours"] += is_own
        solved["DAQP"] += is_peer
        if is_own and is_peer:
            ratios.append(own_us / peer_us)
    ratios.sort()
    mean = math.exp(statistics.fmean(math.log(ratio) for ratio in ratios))
    print(f"within 1e-6 of the optimum: ours {solved['ours']}, DAQP {solved['DAQP']} of {len(optima)}")
    print(f"median time: ours {statistics.median(ours):.1f} us, DAQP {statistics.median(peer[2] for peer in peers):.1f} us")
    print(f"ours over DAQP: {mean:.2f} in the geometric mean of {len(ratios)}, {ratios[0]:.2f} to {ratios[-1]:.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], pathlib.Path(os.environ.get("VINEROW_DATA", sys.argv[2])) / "mpc_qpbenchmark"))
