"""Env and VectorEnv on the environments in C++."""

from __future__ import annotations

import os
from typing import Any, Iterable, Mapping, Sequence

import gymnasium
import numpy
from gymnasium import spaces
from gymnasium.vector.utils import batch_space

from .. import _arguments, _core
from ..arrays import Array
from ..errors import ConfigError
from .tasks import TASKS

_AUTORESET: dict[str, Any] = {name: name for name in ("next_step", "same_step", "disabled")}
if hasattr(gymnasium.vector, "AutoresetMode"):  # from gymnasium 1.1 on
    _AUTORESET = {name: gymnasium.vector.AutoresetMode[name.upper()] for name in _AUTORESET}


def box(elements: Iterable[tuple[str, float, float]]) -> spaces.Box:
    """Space of an observation or action."""
    _, low, high = zip(*elements)
    return spaces.Box(numpy.array(low, numpy.float32), numpy.array(high, numpy.float32), dtype=numpy.float32)


def _seed(value: Any) -> int | None:
    if value is None:
        return None
    if isinstance(value, (bool, numpy.bool_)) or not isinstance(value, (int, numpy.integer)) or not 0 <= value < 2**64:
        raise ConfigError(f"seed = {value!r}, must be a whole number from 0 to {2**64 - 1}", key="seed")
    return int(value)


def _check_reset(options: Mapping[str, Any] | None, known: tuple[str, ...] = ()) -> None:
    for name in _arguments.mapping("options", options):
        if name not in known:
            raise ConfigError(f"reset() has no option '{name}'; options of the task are arguments of the environment", key=str(name))


def _open(task: str, count: int, threads: int, autoreset: str, *, scenario: str | os.PathLike[str] | None, vehicle: str | None,
          overrides: Mapping[str, Any] | None, sets: Iterable[str], factors: Mapping[str, Any] | None,
          options: Mapping[str, Any] | None, control_rate_Hz: float) -> _core.Environments:
    if _arguments.text("task", task) not in TASKS:
        _core.check_task(task)  # raises
    definition = TASKS[task]
    if factors is None:
        factors = definition.factors if scenario is None else {}
    return _core.Environments(
        _arguments.path("scenario", definition.scenario if scenario is None else scenario), _arguments.mapping("overrides", overrides),
        _arguments.texts("sets", sets), _arguments.mapping("factors", factors),
        definition.vehicle if vehicle is None else _arguments.text("vehicle", vehicle), task, _arguments.mapping("options", options),
        1.0 / control_rate_Hz, count, threads, autoreset)


def with_camera(overrides: Mapping[str, Any] | None, render_mode: str | None,
                camera: str | Mapping[str, Any] | None) -> tuple[dict[str, Any], str]:
    """Overrides of the scenario with this camera in it, and the camera's name."""
    if render_mode not in (None, "rgb_array"):
        raise ConfigError(f"render_mode = {render_mode!r}, must be None or 'rgb_array'", key="render_mode")
    if isinstance(camera, Mapping):
        return {**_arguments.mapping("overrides", overrides), "pictures.cameras.view": dict(camera)}, "view"
    if camera is not None and not isinstance(camera, str):
        raise ConfigError(f"camera must be the name of a camera or a dict of its keys, not {type(camera).__name__}", key="camera")
    return _arguments.mapping("overrides", overrides), camera or ""


class Env(gymnasium.Env[Array, Array]):
    """One vehicle with one task.

    Args:
        task: "row_following", "headland_turn", "row_flight" or "spraying"
        scenario: a scenario file instead of the task's own; without `factors`, nothing but the seed then varies
        vehicle: the agent's vehicle in that scenario
        overrides, sets: as for vinerow.load()
        factors: what varies between episodes, as in a study; {} for nothing but the seed; default: the task's
        options: prices, limits and speeds of the task (vinerow.gym.describe())
        control_rate_Hz: actions per second
        render_mode: "rgb_array" if render() is called, else None
        camera: name of a camera of the scenario, or a dict with the keys of one; default: the first, with the rays of range sensors
        width, height: of the picture, pixels

    Observations and actions are float32 arrays; actions outside -1 to 1 are clipped. The info of a step has the task's numbers; that of
    reset() also the levels of the factors. reset() without a seed begins the next episode of the last seed (0 at first).
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 50}

    def __init__(self, task: str = "row_following", *, scenario: str | os.PathLike[str] | None = None, vehicle: str | None = None,
                 overrides: Mapping[str, Any] | None = None, sets: Iterable[str] = (), factors: Mapping[str, Any] | None = None,
                 options: Mapping[str, Any] | None = None, control_rate_Hz: float = 50.0, render_mode: str | None = None,
                 camera: str | Mapping[str, Any] | None = None, width: int = 640, height: int = 360):
        overrides, name = with_camera(overrides, render_mode, camera)
        control_rate_Hz = _arguments.above_zero("control_rate_Hz", "Hz", control_rate_Hz)
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": max(1, round(control_rate_Hz))}
        self._environments = _open(task, 1, 1, "disabled", scenario=scenario, vehicle=vehicle, overrides=overrides, sets=sets,
                                   factors=factors, options=options, control_rate_Hz=control_rate_Hz)
        if render_mode is not None:
            self._environments.watch(name, _arguments.whole("width", width), _arguments.whole("height", height))
        self.observation_space = box(self._environments.observation)
        self.action_space = box(self._environments.action)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        seed = _seed(seed)
        _check_reset(options)
        super().reset(seed=seed)
        self._environments.reset([seed], [])
        observations, _, _, _ = self._environments.results()
        return observations[0], {**self._environments.numbers_of(0), "levels": self._environments.levels(0)}

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        return self._environments.step_single(action)

    def render(self) -> Array | None:  # type: ignore[override]
        """The present instant, (height, width, 3) uint8, if render_mode is "rgb_array".

        Raises:
            UsageError: before the first reset()
            ConfigError: from reset() already, if the camera does not exist or this machine cannot draw
        """
        return None if self.render_mode is None else self._environments.draw()

    @property
    def digest(self) -> str:
        """Digest of the present episode: that of any other run with these actions."""
        return self._environments.digest(0)

    @property
    def run_seed(self) -> int:
        """Seed of the present episode's run."""
        return self._environments.run_seed(0)

    @property
    def now_s(self) -> float:
        """Simulated time of the next action, from the start of the run."""
        return self._environments.now_s(0)

    def close(self) -> None:
        self._environments.close()


class VectorEnv(gymnasium.vector.VectorEnv[Array, Array, Array]):
    """Many environments of one task, stepped on several threads.

    Args:
        task, scenario, vehicle, overrides, sets, factors, options, control_rate_Hz: as for Env
        num_envs: number of environments; environment i has the bits of an Env with seed + i
        threads: that step them; default: one for each processor
        autoreset_mode: "next_step" (default), "same_step" or "disabled", as in Gymnasium; with "disabled", reset() with
            options={"reset_mask": mask} begins new episodes

    Infos have the task's numbers as arrays. With "same_step", `final_obs` and `final_info` are those before the reset.
    """


    def __init__(self, num_envs: int = 1, task: str = "row_following", *, threads: int | None = None,
                 autoreset_mode: Any = "next_step", scenario: str | os.PathLike[str] | None = None, vehicle: str | None = None,
                 overrides: Mapping[str, Any] | None = None, sets: Iterable[str] = (), factors: Mapping[str, Any] | None = None,
                 options: Mapping[str, Any] | None = None, control_rate_Hz: float = 50.0, render_mode: None = None):
        if render_mode is not None:
            raise ConfigError(f"render_mode = {render_mode!r}, must be None: an Env with the same seed draws the same episode")
        mode = getattr(autoreset_mode, "name", str(autoreset_mode)).lower()
        if threads is None:
            threads = len(os.sched_getaffinity(0))
        num_envs, threads = _arguments.whole("num_envs", num_envs), _arguments.whole("threads", threads)
        control_rate_Hz = _arguments.above_zero("control_rate_Hz", "Hz", control_rate_Hz)
        self._environments = _open(task, num_envs, threads, mode, scenario=scenario, vehicle=vehicle, overrides=overrides, sets=sets,
                                   factors=factors, options=options, control_rate_Hz=control_rate_Hz)
        self._mode = mode
        self._names = self._environments.number_names
        self.num_envs = num_envs
        self.render_mode = None
        self.metadata = {"render_modes": [], "autoreset_mode": _AUTORESET[mode]}
        self.single_observation_space = box(self._environments.observation)
        self.single_action_space = box(self._environments.action)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def reset(self, *, seed: int | Sequence[int | None] | None = None,
              options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        _check_reset(options, ("reset_mask",))
        if seed is None or not isinstance(seed, Iterable):
            first = _seed(seed)
            seeds = [None if first is None else _seed(first + i) for i in range(self.num_envs)]
        else:
            seeds = [_seed(one) for one in seed]
            if len(seeds) != self.num_envs:
                raise ConfigError(f"seed has {len(seeds)} entries, must have {self.num_envs}, one for each environment")
        self._environments.reset(seeds, self._chosen(options))
        observations, _, _, _ = self._environments.results()
        return observations, self._infos()

    def _chosen(self, options: dict[str, Any] | None) -> list[bool]:
        mask = (options or {}).get("reset_mask")
        if mask is None:
            return []
        mask = numpy.asarray(mask)
        if mask.dtype != bool or mask.shape != (self.num_envs,):
            raise ConfigError(f"reset_mask must be {self.num_envs} bools, not {mask.dtype} of shape {mask.shape}")
        return [bool(one) for one in mask]

    def step(self, actions: Array) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        self._environments.step(actions)
        return (*self._environments.results(), self._infos())

    def _infos(self) -> dict[str, Any]:
        values = self._environments.numbers()
        everywhere = numpy.ones(self.num_envs, bool)
        infos: dict[str, Any] = {}
        for column, name in enumerate(self._names):
            infos[name], infos["_" + name] = values["numbers"][:, column], everywhere
        infos["succeeded"], infos["_succeeded"] = values["succeeded"], everywhere
        ended = values["ended"]
        if self._mode == "same_step" and ended.any():
            infos["final_obs"], infos["_final_obs"] = values["final_observations"], ended
            final: dict[str, Any] = {}
            for column, name in enumerate(self._names):
                final[name], final["_" + name] = values["final_numbers"][:, column], ended
            final["succeeded"], final["_succeeded"] = values["succeeded"], ended
            infos["final_info"], infos["_final_info"] = final, ended
        return infos

    def digest(self, index: int) -> str:
        """Digest of an environment's present episode."""
        return self._environments.digest(self._index(index))

    def levels(self, index: int) -> dict[str, str]:
        """Levels of the factors in an environment's present episode."""
        return self._environments.levels(self._index(index))

    def _index(self, index: int) -> int:
        if not 0 <= _arguments.whole("index", index) < self.num_envs:
            raise ConfigError(f"index = {index}, must be 0 to {self.num_envs - 1}", key="index")
        return int(index)

    def close_extras(self, **options: Any) -> None:
        # A constructor that failed made none.
        if "_environments" in self.__dict__:
            self._environments.close()
