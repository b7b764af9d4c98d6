#!/usr/bin/env python3
"""Environments for learning: the checkers of Gymnasium, PettingZoo and stable-baselines3, the same bits for any number of environments
and threads, rewards computed here from the truth, and misuse.

    gym_test.py
"""

import contextlib
import io
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

import gymnasium
import numpy

import vinerow
import vinerow.gym
from vinerow.gym import Env, VectorEnv
from vinerow.gym.tasks import SCENARIOS

TASKS = list(vinerow.gym.TASKS)
SHORT = {"duration_s": 3.0}


def actions_for(env, steps, seed=5):
    """The same random actions in every call, (steps, elements)."""
    random = numpy.random.default_rng(seed)
    return random.uniform(-1.0, 1.0, (steps, *env.action_space.shape)).astype(numpy.float32)


class Checkers(unittest.TestCase):
    def test_gymnasium(self):
        from gymnasium.utils.env_checker import check_env
        for name, task in vinerow.gym.TASKS.items():
            with self.subTest(name), warnings.catch_warnings():
                warnings.simplefilter("error")
                warnings.filterwarnings("ignore", message=".*not specifying render modes.*|.*render_modes.*|.*No render.*")
                check_env(gymnasium.make(task.id).unwrapped)

    def test_stable_baselines(self):
        from stable_baselines3.common.env_checker import check_env
        for task in TASKS:
            with self.subTest(task), warnings.catch_warnings():
                warnings.simplefilter("error", UserWarning)
                check_env(Env(task))

    def test_pettingzoo(self):
        from pettingzoo.test import parallel_api_test, parallel_seed_test
        parallel_api_test(vinerow.gym.parallel_env(overrides=SHORT), num_cycles=200)
        parallel_seed_test(lambda: vinerow.gym.parallel_env(overrides=SHORT), num_cycles=60)

    def test_ids_are_registered(self):
        for task in vinerow.gym.TASKS.values():
            self.assertIsInstance(gymnasium.make(task.id).unwrapped, Env)
        many = gymnasium.make_vec("vinerow/HeadlandTurn-v0", num_envs=3, vectorization_mode="vector_entry_point", threads=1)
        self.assertIsInstance(many.unwrapped, VectorEnv)
        self.assertEqual(many.reset(seed=1)[0].shape, (3, 8))


class SameBits(unittest.TestCase):
    def assert_same(self, a, b, where):
        self.assertEqual(numpy.asarray(a).tobytes(), numpy.asarray(b).tobytes(), where)

    def test_many_environments_have_the_bits_of_single_ones(self):
        """Gymnasium's own SyncVectorEnv of scalar environments is the judge; episodes end and begin on the way."""
        for task, count, steps in (("row_following", 1, 200), ("row_following", 8, 200), ("headland_turn", 64, 160), ("row_flight", 8, 160),
                                   ("spraying", 2, 160)):
            with self.subTest(task=task, count=count):
                single = gymnasium.vector.SyncVectorEnv([lambda: Env(task, overrides=SHORT)] * count)
                many = VectorEnv(count, task, overrides=SHORT, threads=2)
                self.assert_same(single.reset(seed=7)[0], many.reset(seed=7)[0], "reset")
                ends = 0
                for i, action in enumerate(actions_for(many, steps)):
                    for a, b, what in zip(single.step(action)[:4], many.step(action)[:4], ("observation", "reward", "terminated", "truncated")):
                        self.assert_same(numpy.asarray(a), numpy.asarray(b, a.dtype), f"{what} of step {i}")
                        ends += what == "truncated" and int(a.sum())
                self.assertGreater(ends, 0)

    def test_threads_change_no_bit(self):
        def run(threads):
            env = VectorEnv(6, "row_following", overrides=SHORT, threads=threads)
            env.reset(seed=3)
            rewards = [env.step(action)[1] for action in actions_for(env, 100)]
            return numpy.array(rewards).tobytes(), [env.digest(i) for i in range(6)]
        one = run(1)
        for threads in (2, 5):
            self.assertEqual(run(threads), one)
        self.assertEqual(len(set(one[1])), 6)

    def test_episode_is_the_session_with_the_same_commands(self):
        """A session of the same scenario that is given the wheel speeds of the actions has the same digest."""
        env = Env("row_following")
        _, info = env.reset(seed=11)
        levels = info["levels"]
        spawn = {"rover.spawn.alley": int(levels["alley"]), "rover.spawn.reverse": levels["reverse"] == "true",
                 "rover.spawn.lateral_m": float(levels["lateral"]), "rover.spawn.turn_deg": float(levels["heading"])}
        with vinerow.open(SCENARIOS / "row_following.yaml", spawn, seed=env.run_seed, take_over=["rover/actuators"]) as session:
            session.step(0.0)
            for action in actions_for(env, 120):
                env.step(action)
                speed, rate = 0.5 * (float(action[0]) + 1.0) * 1.5, float(action[1]) * 0.6
                side = {"l": -1.0, "r": 1.0}
                wheels = [actuator.name for actuator in session.vehicle("rover").actuators]
                session.command("rover/actuators", {name: (speed + side[name[7]] * 0.5 * rate) / 0.2 for name in wheels})
                session.step_for(0.02)
            self.assertEqual(session.digest, env.digest)

    def test_seed_alone_determines_the_episodes(self):
        env = Env("row_following", overrides=SHORT)

        def episodes(seed):
            starts = [env.reset(seed=seed), env.reset(), env.reset()]
            return [(observation.tobytes(), info["levels"]) for observation, info in starts]
        first = episodes(4)
        self.assertEqual(episodes(4), first)
        self.assertNotEqual(episodes(5), first)
        self.assertNotEqual(first[0], first[1])

    def test_number_of_steps_does_not_change_the_next_episode(self):
        def second_start(steps):
            env = Env("row_following", overrides=SHORT)
            env.reset(seed=9)
            for action in actions_for(env, steps):
                env.step(action)
            return env.reset()[0].tobytes()
        self.assertEqual(second_start(3), second_start(50))


class Rewards(unittest.TestCase):
    """Rewards from the documented formulas and a second session's truth."""

    def alley_place(self, alley, reverse, pose):
        line = alley.line[::-1, :2] if reverse else alley.line[:, :2]
        start, end = line[0], line[-1]
        along = (end - start) / numpy.linalg.norm(end - start)
        offset = pose.position[:2] - start
        heading = float(pose.yaw) - math.atan2(along[1], along[0])
        return offset @ along, along[0] * offset[1] - along[1] * offset[0], math.remainder(heading, 2.0 * math.pi)

    def test_row_following(self):
        # Level ground: the alleys are straight lines of two points or more.
        options = {"deviation_price_per_m": 3.0, "steering_price": 0.2}
        factors = {"lateral": {"key": "rover.spawn.lateral_m", "values": [0.07]}}
        env = Env("row_following", factors=factors, options=options, overrides={"rover.spawn.alley": 2, "world.relief_m": 0})
        env.reset(seed=2)
        changes = {"rover.spawn.alley": 2, "world.relief_m": 0, "rover.spawn.lateral_m": 0.07}
        with vinerow.open(SCENARIOS / "row_following.yaml", changes, seed=env.run_seed, take_over=["rover/actuators"]) as session:
            alley = next(alley for alley in session.world().alleys if alley.id == 2)
            truth = session.signal("rover/truth")
            session.step(0.0)
            before, last, wheels = self.alley_place(alley, False, truth["pose"])[0], 0.0, [a.name for a in session.vehicle("rover").actuators]
            for action in actions_for(env, 100):
                _, reward, _, _, info = env.step(action)
                speed, rate = 0.75 * (float(action[0]) + 1.0), float(action[1]) * 0.6
                session.command("rover/actuators", {n: (speed + (-0.5 if n[7] == "l" else 0.5) * rate) / 0.2 for n in wheels})
                session.step_for(0.02)
                along, lateral, _ = self.alley_place(alley, False, truth["pose"])
                wanted = (along - before) / 0.03 - 3.0 * abs(lateral) - 0.2 * (float(action[1]) - last) ** 2
                self.assertAlmostEqual(reward, wanted, places=6)
                self.assertAlmostEqual(info["lateral_m"], lateral, places=9)
                before, last = along, float(action[1])

    def test_headland_turn_sums_to_its_potential(self):
        """Without a price of time, rewards are differences of one potential: their sum is that of the last state alone."""
        env = Env("headland_turn", options={"time_price_per_s": 0.0, "success_reward": 0.0})
        _, start = env.reset(seed=1)

        def potential(info):
            before = max(1.0 - info["along_m"], 0.0)
            return -math.hypot(before, info["lateral_m"]) - 2.0 * 0.5 * (1.0 - math.cos(info["heading_rad"]))
        total = 0.0
        for action in actions_for(env, 150):
            _, reward, terminated, _, info = env.step(action)
            total += reward
            if terminated:
                break
        self.assertFalse(terminated)
        self.assertAlmostEqual(total, potential(info) - potential(start), places=9)

    def test_turn_on_the_headland(self):
        """Straight out, a half circle of half the distance between the alleys, straight in."""
        env = Env("headland_turn", factors={})
        _, info = env.reset(seed=1)
        radius = abs(info["lateral_m"]) / 2.0
        side = -1.0 if info["lateral_m"] < 0.0 else 1.0  # the next alley's direction is opposite: left of it is right of the rover
        legs = [(info["along_m"] + 0.8, 0.0), (math.pi * radius, 1.0 / radius), (4.0, 0.0)]
        for length, curvature in legs:
            for _ in range(round(length / 0.02 / 0.6)):
                observation, reward, terminated, truncated, info = env.step([0.6, side * curvature * 0.6 / 0.8])
                if terminated or truncated:
                    break
        self.assertTrue(info["succeeded"], info)
        self.assertGreater(reward, 19.0)

    def test_row_flight_takes_off_to_its_height(self):
        env = Env("row_flight", overrides={"world.wind.mean_speed_mps": 0, "world.wind.turbulence": 0, "world.relief_m": 0, "world.waves_m": 0}, factors={})
        observation, _ = env.reset(seed=1)
        down = [name for name, _, _ in env._environments.observation].index("down_m")
        self.assertAlmostEqual(float(observation[down]), 1.4, delta=0.1)  # the sensor is 0.1 m below the centre
        for _ in range(250):
            observation, _, terminated, _, info = env.step([0.0, 0.0, 0.0, 0.0])
            self.assertFalse(terminated)
        self.assertAlmostEqual(info["distance_m"], 5.0, delta=0.4)  # half of 2 m/s, 5 s
        self.assertLess(info["average_height_error_m"], 0.1)

    def test_contact_costs_its_price(self):
        env = Env("row_following", factors={}, options={"contact_price": 7.0, "deviation_price_per_m": 0.0, "steering_price": 0.0})
        env.reset(seed=1)
        for _ in range(400):
            _, reward, terminated, _, info = env.step([1.0, 1.0])
            if terminated:
                break
        self.assertTrue(terminated)
        self.assertFalse(info["succeeded"])
        self.assertLess(reward, -6.0)

    def test_spraying_rewards_covered_canopy(self):
        env = Env("spraying", factors={}, options={"steering_price": 0.0, "contact_price": 0.0})
        env.reset(seed=1)
        total, steps = 0.0, 0
        for _ in range(200):
            _, reward, _, _, info = env.step([-0.2, 0.0])
            total, steps = total + reward, steps + 1
        self.assertGreater(info["covered_rows"], 0.01)
        self.assertAlmostEqual(total, 100.0 * info["covered_rows"] - 0.5 * 0.02 * steps, places=6)

    def test_spraying_bare_vines_costs_its_time(self):
        env = Env("spraying", factors={}, options={"steering_price": 0.0}, overrides={"world.vines.bbch": 0})
        env.reset(seed=1)
        total = 0.0
        for _ in range(100):  # two seconds at half a unit of price
            _, reward, _, _, info = env.step([-0.2, 0.0])
            total += reward
        self.assertEqual(info["covered_rows"], 0.0)
        self.assertAlmostEqual(total, -1.0)


class Autoreset(unittest.TestCase):
    def test_same_step(self):
        env = VectorEnv(3, "row_following", overrides={"duration_s": 1.0}, autoreset_mode="same_step", threads=1)
        reference = VectorEnv(3, "row_following", overrides={"duration_s": 1.0}, threads=1)
        env.reset(seed=1)
        reference.reset(seed=1)
        for action in actions_for(env, 60):
            observation, reward, terminated, truncated, infos = env.step(action)
            wanted = reference.step(action)
            if not wanted[3].any():
                continue
            # The last observation is beside the first of the next episode, which the other mode gives in its next step.
            numpy.testing.assert_array_equal(infos["final_obs"], wanted[0])
            numpy.testing.assert_array_equal(infos["_final_obs"], wanted[3])
            numpy.testing.assert_array_equal(reward, wanted[1])
            numpy.testing.assert_array_equal(infos["final_info"]["lateral_m"], wanted[4]["lateral_m"])
            numpy.testing.assert_array_equal(observation, reference.step(action)[0])
            return
        self.fail("no episode ended")

    def test_next_step_ignores_the_action_and_gives_no_reward(self):
        env = VectorEnv(2, "row_following", overrides={"duration_s": 1.0}, threads=1)
        env.reset(seed=1)
        for action in actions_for(env, 60):
            _, _, _, truncated, _ = env.step(action)
            if truncated.any():
                break
        _, reward, terminated, truncated, _ = env.step(numpy.ones((2, 2), numpy.float32))
        self.assertEqual((reward.tolist(), terminated.tolist(), truncated.tolist()), ([0.0, 0.0], [False, False], [False, False]))

    def test_disabled(self):
        env = VectorEnv(2, "row_following", overrides={"duration_s": 1.0}, autoreset_mode="disabled", threads=1)
        first, _ = env.reset(seed=1)
        for action in actions_for(env, 60):
            observation, _, _, truncated, _ = env.step(action)
            if truncated.any():
                break
        with self.assertRaisesRegex(vinerow.UsageError, r"^the episode of environment 0 is over; reset\(\) begins the next one$"):
            env.step(action)
        again, _ = env.reset(options={"reset_mask": numpy.array([True, False])})
        numpy.testing.assert_array_equal(again[1], observation[1])
        self.assertNotEqual(again[0].tolist(), observation[0].tolist())


class Factors(unittest.TestCase):
    def test_each_level_is_drawn_about_as_often(self):
        factors = {"side": {"key": "rover.spawn.lateral_m", "values": [-0.1, 0, 0.1]},
                   "turn": {"key": "rover.spawn.turn_deg", "from": -2, "to": 2, "step": 2}}
        env = Env("row_following", factors=factors)
        drawn = [env.reset()[1]["levels"] for _ in range(300)]
        for name, levels in (("side", ("-0.1", "0", "0.1")), ("turn", ("-2", "0", "2"))):
            counts = [sum(one[name] == level for one in drawn) for level in levels]
            # 300 draws of three: 100 each, standard deviation 8.2.
            self.assertEqual(sum(counts), 300)
            self.assertLess(max(abs(count - 100) for count in counts), 33)
        together = {(one["side"], one["turn"]) for one in drawn}
        self.assertEqual(len(together), 9)

    def test_level_is_the_start(self):
        env = Env("row_following", factors={"side": {"key": "rover.spawn.lateral_m", "values": [-0.1, 0.1]}})
        for _ in range(6):
            _, info = env.reset()
            self.assertAlmostEqual(info["lateral_m"], float(info["levels"]["side"]), delta=0.03)  # the ground is not level


class Misuse(unittest.TestCase):
    def assert_refused(self, error, text, call):
        with self.assertRaises(error) as caught:
            call()
        self.assertEqual(str(caught.exception), text)

    def test_actions(self):
        env = Env("row_following", overrides=SHORT)
        self.assert_refused(vinerow.UsageError, "reset() comes before the first step()", lambda: env.step([0.0, 0.0]))
        env.reset()
        self.assert_refused(vinerow.ConfigError, "the action must have the shape (2,), not (3,)", lambda: env.step([0.0, 0.0, 0.0]))
        self.assert_refused(vinerow.ConfigError, "the action must have the shape (2,), not ()", lambda: env.step(0.0))
        self.assert_refused(vinerow.ConfigError, "the action must be numbers, not <U4", lambda: env.step(["left", "fast"]))
        self.assert_refused(vinerow.ConfigError, "the action must be numbers, not object", lambda: env.step(None))
        self.assert_refused(vinerow.ConfigError, "the action must be numbers, not complex128", lambda: env.step([1j, 0.0]))
        self.assert_refused(vinerow.ConfigError, "the action of environment 0 is nan in its element 1 ('steering')",
                            lambda: env.step([0.0, math.nan]))
        self.assert_refused(vinerow.ConfigError, "the action of environment 0 is inf in its element 0 ('speed')",
                            lambda: env.step([math.inf, 0.0]))
        # Nothing of that has moved it; actions beyond the bounds are clipped.
        before = env.digest
        env.step(numpy.array([5.0, -9.0]))
        self.assertNotEqual(env.digest, before)
        self.assertEqual(env._environments.results()[0][0, -2:].tolist(), [1.0, -1.0])

    def test_after_the_end(self):
        env = Env("row_following", overrides={"duration_s": 0.5})
        env.reset()
        truncated = False
        while not truncated:
            _, _, _, truncated, _ = env.step([0.0, 0.0])
        self.assert_refused(vinerow.UsageError, "the episode of environment 0 is over; reset() begins the next one",
                            lambda: env.step([0.0, 0.0]))
        env.reset()
        env.step([0.0, 0.0])
        env.close()
        env.close()
        self.assert_refused(vinerow.UsageError, "the environment is closed", lambda: env.step([0.0, 0.0]))

    def test_options(self):
        for text, arguments in (
                ("no task 'row_folowing'; did you mean 'row_following'? (known: headland_turn, row_flight, row_following, spraying)",
                 {"task": "row_folowing"}),
                ("options.sped_mps: unknown key of task 'row_following'; did you mean 'speed_mps'?", {"options": {"sped_mps": 1.0}}),
                ("options.speed_mps = -1 m/s, must be > 0 m/s", {"options": {"speed_mps": -1.0}}),
                ("the period of an action, 0.03 s, is not a whole number of physics steps of 0.02 s", {"control_rate_Hz": 100.0 / 3.0}),
                ("control_rate_Hz = 0, must be > 0 Hz", {"control_rate_Hz": 0}),
                ("render_mode = 'human', must be None or 'rgb_array'", {"render_mode": "human"})):
            with self.subTest(text), self.assertRaises(vinerow.ConfigError) as caught:
                Env(**arguments)
            self.assertTrue(str(caught.exception).startswith(text), str(caught.exception))
        self.assert_refused(vinerow.ConfigError, "num_envs = 0, must be 1 to 100000", lambda: VectorEnv(0))
        self.assert_refused(vinerow.ConfigError, "threads = 0, must be 1 to 1024", lambda: VectorEnv(1, threads=0))
        self.assert_refused(vinerow.ConfigError, "autoreset_mode = 'sometimes', must be one of: next_step, same_step, disabled",
                            lambda: VectorEnv(1, autoreset_mode="sometimes"))
        self.assert_refused(vinerow.ConfigError, f"seed = -1, must be a whole number from 0 to {2**64 - 1}",
                            lambda: Env().reset(seed=-1))
        for env in (Env(), VectorEnv(1)):
            self.assert_refused(vinerow.ConfigError,
                                "reset() has no option 'speed_mps'; options of the task are arguments of the environment",
                                lambda env=env: env.reset(options={"speed_mps": 1.0}))
            env.reset(seed=1, options={})
        self.assert_refused(vinerow.ConfigError, "seed has 1 entries, must have 2, one for each environment",
                            lambda: VectorEnv(2).reset(seed=[1]))

    def test_wrong_types_are_one_sentence_with_the_arguments_name(self):
        env, many = Env(), VectorEnv(2)
        many.reset(seed=1)
        for text, call in (
                ("num_envs must be a whole number, not float", lambda: VectorEnv(1.5)),
                ("num_envs must be a whole number, not bool", lambda: VectorEnv(True)),
                (f"num_envs = {2**70}, is out of range", lambda: VectorEnv(2**70)),
                ("threads must be a whole number, not str", lambda: VectorEnv(1, threads="2")),
                ("task must be a str, not int", lambda: VectorEnv(1, 2)),
                ("task must be a str, not list", lambda: Env([1])),
                ("scenario must be a path, not int", lambda: Env(scenario=1)),
                ("vehicle must be a str, not int", lambda: Env(vehicle=0)),
                ("overrides must be a dict, not list", lambda: Env(overrides=[1])),
                ("sets must be a list of str, not str", lambda: Env(sets="duration_s=1")),
                ("an entry of sets must be a str, not int", lambda: Env(sets=[1])),
                ("factors must be a dict, not float", lambda: Env(factors=1.5)),
                ("options must be a dict, not str", lambda: Env(options="x")),
                ("control_rate_Hz must be a number, not str", lambda: Env(control_rate_Hz="2")),
                ("control_rate_Hz = nan, must be > 0 Hz and finite", lambda: Env(control_rate_Hz=float("nan"))),
                ("width must be a whole number, not float", lambda: Env(render_mode="rgb_array", width=64.0)),
                ("height must be a whole number, not NoneType", lambda: Env(render_mode="rgb_array", height=None)),
                ("options must be a dict, not int", lambda: env.reset(options=1)),
                (f"seed = 1.5, must be a whole number from 0 to {2**64 - 1}", lambda: many.reset(seed=1.5)),
                ("index must be a whole number, not float", lambda: many.digest(0.0)),
                ("index = -1, must be 0 to 1", lambda: many.levels(-1))):
            with self.subTest(text):
                self.assert_refused(vinerow.ConfigError, text, call)
        self.assertEqual(VectorEnv(numpy.int64(2), threads=numpy.int32(1)).num_envs, 2)

    def test_scenario_without_what_the_task_needs(self):
        here = pathlib.Path(__file__).resolve().parents[2] / "docs" / "examples" / "session" / "free_rover.yaml"
        with self.assertRaisesRegex(vinerow.ConfigError, "no signal 'rover/left_front'"):
            Env("row_following", scenario=here).reset()
        with self.assertRaisesRegex(vinerow.ConfigError, "needs a vehicle with rotors|no signal|is taken over, but no part reads it"):
            Env("row_flight", scenario=here, vehicle="rover").reset()
        with self.assertRaisesRegex(vinerow.ConfigError, "^task headland_turn of 'rover' needs a world with two alleys; this one has 1$"):
            Env("headland_turn", scenario=here).reset()

    def test_run_that_ends_before_the_take_off(self):
        with self.assertRaisesRegex(vinerow.ConfigError, "^task row_flight of 'drone': the run is over after 1 s, but the take-off takes "):
            Env("row_flight", overrides={"duration_s": 1.0}).reset()

    def test_two_threads(self):
        env = VectorEnv(8, "row_flight", threads=1)
        started, refused = threading.Event(), []

        def reset():
            started.set()
            env.reset(seed=1)
        other = threading.Thread(target=reset)
        other.start()
        started.wait()
        while other.is_alive():
            try:
                env.step(numpy.zeros((8, 4), numpy.float32))
            except vinerow.UsageError as error:
                refused.append(str(error))
        other.join()
        self.assertIn("the environment is in use by another thread; give each thread its own", refused)

    def test_fork(self):
        env = VectorEnv(2, "row_following", threads=2)
        env.reset()
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                env.step(numpy.zeros((2, 2), numpy.float32))
            except vinerow.UsageError as error:
                os.write(writing, str(error).encode())
            del env
            os._exit(0)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertEqual(os.read(reading, 1000).decode(),
                         "the environment belongs to the process that made it; make environments after the fork")
        env.step(numpy.zeros((2, 2), numpy.float32))

    def test_missing_packages(self):
        for package, line, text in (
                ("gymnasium", "import vinerow.gym", "vinerow.gym needs the package gymnasium: pip install gymnasium"),
                ("pettingzoo", "import vinerow.gym; vinerow.gym.parallel_env()",
                 "vinerow.gym.parallel_env() needs the package pettingzoo: pip install pettingzoo"),
                ("stable_baselines3", "import vinerow.gym.stable_baselines",
                 "vinerow.gym.stable_baselines needs the package stable-baselines3: pip install stable-baselines3")):
            run = subprocess.run([sys.executable, "-c", f"import sys; sys.modules['{package}'] = None; {line}"], capture_output=True,
                                 text=True, check=False)
            self.assertEqual(run.stderr.strip().splitlines()[-1], f"ImportError: {text}")


class Pictures(unittest.TestCase):
    OPTIONS = {"render_mode": "rgb_array", "width": 320, "height": 200}

    def test_it_is_the_picture_of_a_log(self):
        """A rover that stands, with the same camera and seed, in a run with a log."""
        env = Env("headland_turn", factors={}, **self.OPTIONS)
        env.reset(seed=1)
        for _ in range(24):
            env.step(numpy.zeros(2, numpy.float32))
        with tempfile.TemporaryDirectory() as out:
            run = vinerow.run(SCENARIOS / "headland_turn.yaml", out=out, overrides={"duration_s": 1.0}, seed=env.run_seed, pictures=False,
                              report=False)
            expected = run.log.render(env.now_s, width=320, height=200)
        numpy.testing.assert_array_equal(env.render(), expected)

    def test_it_changes_no_bit_and_shows_what_moves(self):
        digests, pictures = [], []
        for options in ({}, self.OPTIONS):
            env = Env("row_following", **options)
            env.reset(seed=3)
            for action in actions_for(env, 60):
                env.step(action)
                if options and len(pictures) < 2:
                    pictures.append(env.render())
            digests.append(env.digest)
        self.assertEqual(*digests)
        self.assertEqual([(picture.shape, picture.dtype) for picture in pictures], 2 * [((200, 320, 3), numpy.uint8)])
        self.assertGreater(int((pictures[0] != pictures[1]).sum()), 100)
        self.assertIsNone(Env("row_following").render())

    def test_another_world_and_a_camera_of_its_own(self):
        env = Env("headland_turn", factors={"vines": {"key": "world.plant_seed", "values": [1, 2]}}, **self.OPTIONS,
                  camera={"kind": "top", "height_m": 8, "vehicle": "rover"})
        pictures = {}
        for seed in range(8):
            _, info = env.reset(seed=seed)
            pictures.setdefault(info["levels"]["vines"], env.render())
        self.assertGreater(int((pictures["1"] != pictures["2"]).any(2).sum()), 500)

    def test_two_vehicles(self):
        env = vinerow.gym.parallel_env(overrides=SHORT, **self.OPTIONS)
        env.reset(seed=1)
        self.assertEqual(env.render().shape, (200, 320, 3))

    def test_misuse(self):
        with self.assertRaisesRegex(vinerow.UsageError, "reset\\(\\) comes first: no episode has begun"):
            Env("headland_turn", **self.OPTIONS).render()
        with self.assertRaisesRegex(vinerow.ConfigError, "no camera 'tpo' in scenario 'headland_turn' \\(known: chase\\)"):
            Env("headland_turn", render_mode="rgb_array", camera="tpo").reset()
        with self.assertRaisesRegex(vinerow.ConfigError, "camera must be the name of a camera or a dict of its keys, not int"):
            Env("headland_turn", render_mode="rgb_array", camera=7)
        with self.assertRaisesRegex(vinerow.ConfigError, "width = 1, must be from 16 to 8192 pixels"):
            Env("headland_turn", render_mode="rgb_array", width=1)
        with self.assertRaisesRegex(vinerow.ConfigError, "an Env with the same seed draws the same episode"):
            VectorEnv(2, "headland_turn", render_mode="rgb_array")


class Parallel(unittest.TestCase):
    def test_an_agent_that_is_done_leaves_and_rests(self):
        env = vinerow.gym.parallel_env(factors={})
        env.reset(seed=1)
        self.assertEqual(env.agents, ["rover", "drone"])
        left = None
        for _ in range(400):
            actions = {"rover": numpy.array([1.0, 1.0]), "drone": numpy.zeros(4)}  # the rover drives into a row
            _, rewards, terminated, _, _ = env.step({agent: actions[agent] for agent in env.agents})
            if terminated.get("rover"):
                left = rewards["rover"]
                break
        self.assertLess(left, -15.0)
        self.assertEqual(env.agents, ["drone"])
        observations, _, _, _, _ = env.step({"drone": numpy.zeros(4)})
        self.assertEqual(list(observations), ["drone"])

    def test_misuse(self):
        env = vinerow.gym.parallel_env(overrides=SHORT)
        with self.assertRaisesRegex(vinerow.UsageError, r"^the episode is over; reset\(\) begins the next one$"):
            env.step({})
        env.reset(seed=1)
        with self.assertRaisesRegex(vinerow.ConfigError, "^there is no action for agent 'drone'$"):
            env.step({"rover": numpy.zeros(2)})
        with self.assertRaisesRegex(vinerow.ConfigError, r"^the action of 'drone' must have the shape \(4,\), not \(2,\)$"):
            env.step({"rover": numpy.zeros(2), "drone": numpy.zeros(2)})
        with self.assertRaisesRegex(vinerow.ConfigError, r"^the action of 'rover' is nan in its element 0 \('speed'\)$"):
            env.step({"rover": numpy.array([math.nan, 0.0]), "drone": numpy.zeros(4)})


class StableBaselines(unittest.TestCase):
    def test_first_update_of_ppo(self):
        from stable_baselines3 import PPO
        from vinerow.gym.stable_baselines import VecEnv
        model = PPO("MlpPolicy", VecEnv(8, "row_following", overrides=SHORT), n_steps=64, batch_size=128, seed=1, device="cpu")
        before = [value.clone() for value in model.policy.parameters()]
        model.learn(512)
        self.assertTrue(any((a != b).any() for a, b in zip(before, model.policy.parameters())))
        # Episodes of 3 s have 150 steps; the adapter reports them.
        self.assertEqual({entry["l"] for entry in model.ep_info_buffer} - {149, 150}, set())


class Documents(unittest.TestCase):
    ROOT = pathlib.Path(__file__).resolve().parents[2] / "docs"

    def test_reference_is_up_to_date(self):
        from vinerow.gym.__main__ import page
        self.assertEqual((self.ROOT / "reference" / "gym.md").read_text(), page(), "write it again: python3 -m vinerow.gym")

    def test_examples_of_the_guide(self):
        examples = re.findall(r"```python\n(.*?)```", (self.ROOT / "guides" / "gym.md").read_text(), re.DOTALL)
        self.assertEqual(len(examples), 4)
        printed, names = io.StringIO(), {}
        with contextlib.redirect_stdout(printed):
            for example in examples:
                exec(compile(example, "docs/guides/gym.md", "exec"), names)
        self.assertRegex(printed.getvalue(), r"^\{'alley': '[012]', 'noise': '0\.\d+', 'vines': '[123]'\}$")
        self.assertEqual(names["model"].num_timesteps, 2048)
        self.assertEqual(names["picture"].shape, (360, 640, 3))


class Memory(unittest.TestCase):
    @unittest.skipIf("libasan" in os.environ.get("LD_PRELOAD", ""), "the address sanitizer keeps released memory")
    def test_resets_do_not_leak(self):
        def resident_kB():
            lines = pathlib.Path("/proc/self/status").read_text().splitlines()
            return int(next(line for line in lines if line.startswith("VmRSS")).split()[1])
        for factors in ({}, None):
            env = Env("headland_turn", factors=factors)
            for _ in range(300):
                env.reset()
            before = resident_kB()
            for _ in range(1000):
                env.reset()
            # The benchmark makes 10^6 resets; 1,000 that leak 1 kB each are seen here.
            self.assertLess(resident_kB() - before, 900)


if __name__ == "__main__":
    unittest.main()
