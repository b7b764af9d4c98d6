"""A VectorEnv as stable-baselines3's VecEnv.

    from stable_baselines3 import PPO
    from vinerow.gym.stable_baselines import VecEnv
    PPO("MlpPolicy", VecEnv(64, "row_following")).learn(100_000)
"""

from __future__ import annotations

from typing import Any

import numpy

try:
    from stable_baselines3.common.vec_env import VecEnv as _Base
except ImportError as missing:
    raise ImportError("vinerow.gym.stable_baselines needs the package stable-baselines3: pip install stable-baselines3") from missing

from ..arrays import Array
from ..errors import UsageError
from .environment import VectorEnv


class VecEnv(_Base):
    """Args: those of VectorEnv, without autoreset_mode."""

    def __init__(self, num_envs: int = 1, task: str = "row_following", **options: Any):
        self.render_mode = None
        self.environments = VectorEnv(num_envs, task, autoreset_mode="same_step", **options)
        self._actions: Array = numpy.zeros(0, numpy.float32)
        self._returns = numpy.zeros(num_envs)
        self._lengths = numpy.zeros(num_envs, int)
        super().__init__(num_envs, self.environments.single_observation_space, self.environments.single_action_space)

    def reset(self) -> Array:
        seeds = None if self._seeds[0] is None else list(self._seeds)
        observations, _ = self.environments.reset(seed=seeds)
        self._returns[:], self._lengths[:] = 0.0, 0
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: Array) -> None:
        self._actions = actions

    def step_wait(self) -> tuple[Array, Array, Array, list[dict[str, Any]]]:
        observations, rewards, terminated, truncated, infos = self.environments.step(self._actions)
        self._returns += rewards
        self._lengths += 1
        done = terminated | truncated
        entries: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for i in numpy.flatnonzero(done):
            final = infos["final_info"]
            entries[i] = {name: final[name][i] for name in final if not name.startswith("_")}
            entries[i]["terminal_observation"] = infos["final_obs"][i]
            entries[i]["TimeLimit.truncated"] = bool(truncated[i])
            entries[i]["episode"] = {"r": self._returns[i], "l": self._lengths[i], "t": 0.0}
        self._returns[done], self._lengths[done] = 0.0, 0
        return observations, rewards.astype(numpy.float32), done, entries

    def close(self) -> None:
        self.environments.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self.environments, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        raise UsageError("the environments of one VectorEnv share their attributes; make it with other options")

    def env_method(self, method_name: str, *arguments: Any, indices: Any = None, **named: Any) -> list[Any]:
        return [getattr(self.environments, method_name)(i, *arguments, **named) for i in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        return [False] * len(list(self._get_indices(indices)))
