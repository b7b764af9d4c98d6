#!/usr/bin/env python3
"""Trains PPO to follow rows from four range sensors, and compares it with pure pursuit on rows that it has not seen.

    train_row_following.py [--steps 1600000] [--out runs/row_following]

Needs stable-baselines3 and matplotlib. One core: about 8 minutes for the default. Writes policy.zip, learning.csv, learning.svg
and prints the comparison; docs/guides/gym.md has its figures.
"""

import argparse
import csv
import pathlib

import numpy
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

import vinerow
import vinerow.gym
from vinerow.gym.stable_baselines import VecEnv

SEED = 1
RATE_Hz = 10.0  # that of the range sensors
# Rows of 40 m with more gaps than usual; six different ones for training, four others for the comparison.
WORLD = {"world.row_length_m": 40, "world.missing_vine_share": 0.03}
TRAINING_PLANTS, UNSEEN_PLANTS = [11, 12, 13, 14, 15, 16], [101, 102, 103, 104]
ALLEYS = range(7)


def environments(count: int, plants: list[int], **options) -> VecEnv:
    factors = {**vinerow.gym.TASKS["row_following"].factors, "plants": {"key": "world.plant_seed", "values": plants}}
    return VecEnv(count, "row_following", threads=1, control_rate_Hz=RATE_Hz, factors=factors, overrides=WORLD, **options)


class LearningCurve(BaseCallback):
    """Mean return and deviation of the last 100 episodes after each rollout."""

    def __init__(self):
        super().__init__()
        self.rows: list[tuple[int, float, float, float]] = []
        self.ended: list[tuple[float, float, bool]] = []

    def _on_step(self) -> bool:
        for info in self.locals["infos"]:
            if "episode" in info:
                self.ended.append((info["episode"]["r"], info["average_deviation_m"], info["succeeded"]))
        return True

    def _on_rollout_end(self) -> None:
        if self.ended:
            last = numpy.array(self.ended[-100:], float)
            self.rows.append((self.num_timesteps, *last.mean(axis=0)))


def train(steps: int) -> tuple[PPO, LearningCurve]:
    torch.set_num_threads(1)
    model = PPO("MlpPolicy", environments(64, TRAINING_PLANTS, options={"deviation_price_per_m": 10.0}), n_steps=128,
                batch_size=1024, n_epochs=10, gamma=0.98, learning_rate=lambda left: 5e-4 * left, policy_kwargs={"log_std_init": -1.0},
                seed=SEED, device="cpu")
    curve = LearningCurve()
    model.learn(steps, callback=curve)
    return model, curve


def evaluate(model: PPO, episodes: int = 64) -> numpy.ndarray:
    """(episodes, 3): mean deviation in m, reached the end, mean speed in m/s; on unseen rows, without exploration."""
    env = environments(episodes, UNSEEN_PLANTS)
    env.seed(1000)
    observations, results = env.reset(), {}
    while len(results) < episodes:
        actions, _ = model.predict(observations, deterministic=True)
        observations, _, done, infos = env.step(actions)
        for i in numpy.flatnonzero(done):
            time_s = infos[i]["episode"]["l"] / RATE_Hz
            results.setdefault(i, (infos[i]["average_deviation_m"], infos[i]["succeeded"], infos[i]["distance_m"] / time_s))
    return numpy.array(list(results.values()), float)


def pure_pursuit(sensors: dict, estimator: dict | None, folder: pathlib.Path) -> numpy.ndarray:
    """(runs, 3): mean deviation in m, reached the end without a contact, mean speed in m/s; one run for each alley and plant seed."""
    results = []
    for plants in UNSEEN_PLANTS:
        for alley in ALLEYS:
            rover = {"type": "diff_drive_rover", "fidelity": "kinematic", "spawn": {"alley": alley},
                     "sensors": {"imu": {"type": "imu", "rate_Hz": 100}, **sensors},
                     "planner": {"type": "coverage", "alleys": [alley], "approach": False},
                     "controller": {"type": "pure_pursuit", "speed_mps": 1.5}}
            if estimator:
                rover["estimator"] = estimator
            scenario = {"vinerow": 1, "name": "pure_pursuit", "duration_s": 120, "physics": {"step_s": 0.005},
                        "world": {"type": "vineyard", "row_count": 8, "relief_m": 4, "leaf_cards_per_m": 20, "plant_seed": plants,
                                  **{key.removeprefix("world."): value for key, value in WORLD.items()}},
                        "vehicles": {"rover": rover}}
            with vinerow.open(scenario, seed=alley + 1, folder=folder) as session:
                session.step(120.0)
                metrics = session.metrics()["rover"]
            reached = bool(metrics["finished"]) and metrics["contact_count"] == 0
            results.append((metrics["average_deviation_m"], reached, metrics["distance_m"] / metrics["time_s"]))
    return numpy.array(results, float)


def report(name: str, results: numpy.ndarray) -> None:
    deviation_mm = 1000.0 * results[:, 0]
    print(f"{name}: ATD {deviation_mm.mean():.0f} mm ({deviation_mm.min():.0f} to {deviation_mm.max():.0f}), "
          f"{100.0 * results[:, 1].mean():.0f} % reach the end, {results[:, 2].mean():.2f} m/s, {len(results)} runs")


def draw(curve: LearningCurve, file: pathlib.Path) -> None:
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "vinerow"
    from matplotlib import pyplot
    steps, _, deviation, success = numpy.array(curve.rows).T
    figure, axes = pyplot.subplots(1, 2, figsize=(9.0, 3.2), constrained_layout=True)
    for axis, values, label in ((axes[0], 100.0 * success, "episodes that reach the end, %"), (axes[1], 1000.0 * deviation, "ATD, mm")):
        axis.plot(steps / 1e6, values, color="#4a7c2c")
        axis.set_xlabel("million steps")
        axis.set_ylabel(label)
        axis.set_ylim(bottom=0.0)
        axis.grid(color="0.9")
    figure.savefig(file, metadata={"Date": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=1_600_000)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("runs/row_following"))
    parser.add_argument("--devices", type=pathlib.Path, default=pathlib.Path("assets/sensors"), help="folder of the receivers' files")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)

    model, curve = train(options.steps)
    model.save(options.out / "policy.zip")
    with open(options.out / "learning.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([("steps", "return", "average_deviation_m", "succeeded"), *curve.rows])
    draw(curve, options.out / "learning.svg")

    folder = options.devices.resolve()
    antenna = {"position_m": [0, 0, 1.0]}
    report("PPO, four range sensors", evaluate(model))
    report("pure pursuit, RTK receiver", pure_pursuit(
        {"gps": {"include": "zed_f9p_rtk.yaml", "rate_Hz": 10, **antenna}}, {"type": "odometry_filter"}, folder))
    report("pure pursuit, receiver without corrections", pure_pursuit(
        {"gps": {"include": "neo_m8n.yaml", "rate_Hz": 5, **antenna}}, {"type": "odometry_filter"}, folder))
    report("pure pursuit, paper B's error of 0.1 m and exact heading", pure_pursuit(
        {"gps": {"type": "gps", "rate_Hz": 40, "error": "uniform", "accuracy_m": 0.1}}, {"type": "gps_pose"}, folder))
    report("pure pursuit, exact position", pure_pursuit({}, None, folder))


if __name__ == "__main__":
    main()
