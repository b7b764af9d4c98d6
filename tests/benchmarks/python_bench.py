#!/usr/bin/env python3
"""Prints what the Python package costs, in CPU time of one thread. Table of docs/contributing/performance.md.

Times are those of the fastest of 15 turns: what else runs on the machine slows the others, by up to a half.

usage: python_bench.py [calls] [steps] [reset] [resets] [first_update]     run in the environment of tools/python_environment

  calls         a call of Session.step() that has nothing to do, and one field of a signal
  steps         environment steps at 50 Hz, 16 and 64 environments on one thread: the processor's cache holds 16
  reset         a reset of each task, with a new seed
  resets        memory of 10^6 resets (takes about 10 minutes)
  first_update  wall clock from the start of the interpreter to the first update of PPO
"""

import pathlib
import subprocess
import sys
import time

import numpy

import vinerow
import vinerow.gym
from vinerow.gym.tasks import SCENARIOS

TURNS = 15


def cpu_us(call, count: int) -> float:
    """CPU time of a call, us."""
    times = []
    for _ in range(TURNS):
        begin = time.process_time()
        for _ in range(count):
            call()
        times.append((time.process_time() - begin) / count * 1e6)
    return min(times)


def calls() -> None:
    with vinerow.open(SCENARIOS / "row_following.yaml") as session:
        session.step(1.0)
        truth = session.signal("rover/truth")
        step = session.step
        print(f"call of step() that has nothing to do: {cpu_us(lambda: step(0.5), 200_000):.2f} us")
        print(f"one field of a signal: {cpu_us(lambda: truth['pose'], 100_000):.2f} us")


def steps() -> None:
    physical = {"rover.fidelity": "physics", "physics.step_s": 0.0025}
    for name, task, overrides, count in (
            ("kinematic rover on the headland", "headland_turn", {}, 1500),
            ("kinematic rover in a row, four range sensors", "row_following", {}, 450),
            ("the same with wheels and tyres, steps of 2.5 ms", "row_following", physical, 150),
            ("quadrotor in gusts, steps of 4 ms", "row_flight", {}, 150),
            ("rover with sprayer", "spraying", {}, 150)):
        for environments in (16, 64):
            env = vinerow.gym.VectorEnv(environments, task, threads=1, factors={}, overrides=overrides)
            env.reset(seed=1)
            # In the row slowly straight on, on the headland on the spot: no episode ends.
            action = numpy.tile(numpy.float32([-0.8] + [0.0] * (env.single_action_space.shape[0] - 1)), (environments, 1))
            if task == "headland_turn":
                action[:] = (0.0, 0.2)
            ends = []

            def step():
                _, _, terminated, truncated, _ = env.step(action)
                ends.append(int(terminated.sum() + truncated.sum()))
            per_step_us = cpu_us(step, count // TURNS) / environments
            print(f"{name}, {environments} environments: {per_step_us:.2f} us a step, {1e6 / per_step_us:,.0f} steps/s "
                  f"({sum(ends)} episodes ended)")
            env.close()


def reset() -> None:
    for task in ("headland_turn", "row_following", "row_flight", "spraying"):
        env = vinerow.gym.Env(task, factors={})
        seeds = iter(range(1, 1_000_000))
        env.reset(seed=next(seeds))
        print(f"reset of {task}: {cpu_us(lambda: env.reset(seed=next(seeds)), 20) / 1e3:.2f} ms")
        env.close()


def resident_kB() -> int:
    lines = pathlib.Path("/proc/self/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmRSS")).split()[1])


def resets() -> None:
    env = vinerow.gym.Env("headland_turn", factors={})
    for _ in range(2000):
        env.reset()
    before, begin = resident_kB(), time.process_time()
    for _ in range(1_000_000):
        env.reset()
    print(f"10^6 resets: {resident_kB() - before} kB more, {time.process_time() - begin:.0f} s")


FIRST_UPDATE = """
from stable_baselines3 import PPO
from vinerow.gym.stable_baselines import VecEnv
PPO("MlpPolicy", VecEnv(64, "row_following"), n_steps=32).learn(2048)
"""


def first_update() -> None:
    begin = time.monotonic()
    subprocess.run([sys.executable, "-c", FIRST_UPDATE], check=True)
    print(f"first update of PPO: {time.monotonic() - begin:.1f} s after the start of the interpreter")


if __name__ == "__main__":
    chosen = sys.argv[1:] or ["calls", "steps", "reset", "first_update"]
    for one in chosen:
        {"calls": calls, "steps": steps, "reset": reset, "resets": resets, "first_update": first_update}[one]()
