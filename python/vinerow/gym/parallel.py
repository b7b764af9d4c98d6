"""PettingZoo's ParallelEnv: several vehicles of one session, each with its task."""

from __future__ import annotations

import functools
import os
from typing import Any, Iterable, Mapping

from gymnasium import spaces

try:
    import pettingzoo  # type: ignore[import-untyped]
except ImportError as missing:
    raise ImportError("vinerow.gym.parallel_env() needs the package pettingzoo: pip install pettingzoo") from missing

from .. import _arguments, _core
from ..arrays import Array
from ..errors import UsageError
from .environment import _seed, box, with_camera
from .tasks import SCENARIOS, _starts

FACTORS = {**{f"rover_{name}": factor for name, factor in _starts("rover", 2, 0.1, 4.0).items()},
           "drone_lateral": {"key": "drone.spawn.lateral_m", "from": -0.2, "to": 0.2, "count": 11},
           "drone_heading": {"key": "drone.spawn.turn_deg", "from": -10.0, "to": 10.0, "count": 11}}


def _tasks_of(agents: Mapping[str, tuple[str, Mapping[str, Any]]]) -> list[tuple[str, str, dict[str, Any]]]:
    """(vehicle, task, options) of each agent."""
    for agent in agents.values():
        if not isinstance(agent, (tuple, list)) or len(agent) != 2:
            _arguments.refuse("an agent", "a pair of task and options", agent)
    return [(_arguments.text("an agent's vehicle", vehicle), _arguments.text("an agent's task", task), _arguments.mapping("an agent's options", options))
            for vehicle, (task, options) in agents.items()]


class ParallelEnv(pettingzoo.ParallelEnv):  # type: ignore[misc]
    """A rover that follows its alley and a quadrotor that flies along its own, in one session.

    Args:
        agents: {vehicle: (task, options of the task)}
        scenario: a scenario file with these vehicles
        overrides, sets, factors, control_rate_Hz, render_mode, camera, width, height: as for Env

    An agent whose episode is over leaves `agents`; its vehicle stops, or hovers, until the others are done.
    """

    metadata = {"name": "vinerow_rover_and_drone_v0", "render_modes": ["rgb_array"], "render_fps": 50}

    def __init__(self, *, agents: Mapping[str, tuple[str, Mapping[str, Any]]] | None = None, scenario: str | os.PathLike[str] | None = None,
                 overrides: Mapping[str, Any] | None = None, sets: Iterable[str] = (), factors: Mapping[str, Any] | None = None,
                 control_rate_Hz: float = 50.0, render_mode: str | None = None, camera: str | Mapping[str, Any] | None = None,
                 width: int = 640, height: int = 360):
        overrides, name = with_camera(overrides, render_mode, camera)
        agents = _arguments.mapping("agents", agents) or {"rover": ("row_following", {}), "drone": ("row_flight", {})}
        if factors is None:
            factors = FACTORS if scenario is None else {}
        self.render_mode = render_mode
        self._episodes = _core.Episodes(
            _arguments.path("scenario", scenario if scenario is not None else SCENARIOS / "rover_and_drone.yaml"), overrides,
            _arguments.texts("sets", sets), _arguments.mapping("factors", factors), _tasks_of(agents),
            1.0 / _arguments.above_zero("control_rate_Hz", "Hz", control_rate_Hz))
        if render_mode is not None:
            self._episodes.watch(name, _arguments.whole("width", width), _arguments.whole("height", height))
        self._spaces = {agent: (box(observation), box(action)) for agent, (observation, action) in self._episodes.spaces().items()}
        self.possible_agents = list(self._spaces)
        self.agents: list[str] = []

    @functools.lru_cache(maxsize=None)
    def observation_space(self, agent: str) -> spaces.Box:
        return self._spaces[agent][0]

    @functools.lru_cache(maxsize=None)
    def action_space(self, agent: str) -> spaces.Box:
        return self._spaces[agent][1]

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict[str, Array], dict[str, Any]]:
        _arguments.mapping("options", options)  # none is known; PettingZoo's own test passes some
        self._episodes.reset(_seed(seed))
        self.agents = list(self.possible_agents)
        states, levels = self._episodes.agents(), self._episodes.levels()
        return ({agent: states[agent][0] for agent in self.agents},
                {agent: {**states[agent][4], "levels": levels} for agent in self.agents})

    def step(self, actions: Mapping[str, Array]) -> tuple[dict[str, Any], ...]:
        if not self.agents:
            raise UsageError("the episode is over; reset() begins the next one")
        self._episodes.step(_arguments.mapping("actions", actions))
        states = self._episodes.agents()
        observations, rewards, terminated, truncated, infos = (
            dict(zip(self.agents, column)) for column in zip(*(states[agent] for agent in self.agents)))
        self.agents = [agent for agent in self.agents if not (terminated[agent] or truncated[agent])]
        return observations, rewards, terminated, truncated, infos

    def render(self) -> Array | None:
        """As Env.render()."""
        return None if self.render_mode is None else self._episodes.draw()

    @property
    def digest(self) -> str:
        """Digest of the present episode."""
        return self._episodes.digest()
