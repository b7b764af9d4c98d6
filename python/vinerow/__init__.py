"""Vinerow: simulation of robots in vineyards and orchards.

    import vinerow

    with vinerow.open("riseholme_rover.yaml") as session:
        truth = session.signal("rover/truth")
        while not session.over:
            session.step_for(0.05)
            print(truth["pose"].position)

Guide: docs/guides/python.md.
"""

from __future__ import annotations

import numbers
import os
import sys
from typing import Any, Iterable, Mapping

# The interpreter has loaded the C library's sin, exp, ... already. The simulator's own functions (engine/elementary) must come
# first in the simulator and its libraries, or the bits of a run would be others than those of `vinerow run`.
_flags = sys.getdlopenflags()
sys.setdlopenflags(os.RTLD_NOW | os.RTLD_LOCAL | os.RTLD_DEEPBIND)
try:
    from . import _core
finally:
    sys.setdlopenflags(_flags)

from ._core import Log, Scenario, Session, Signal, __version__
from .errors import ConfigError, SimulationError, UsageError
from .messages import Crash, Event, Message, Phase, Pose
from .world import Actuator, Alley, Grid, Map, Row, RowMesh, SpawnPoint, Terrain, Vehicle, World

__all__ = [
    "Actuator", "Alley", "ConfigError", "Crash", "Event", "Grid", "Log", "Map", "Message", "Phase", "Pose", "Row", "RowMesh",
    "Scenario", "Session", "Signal", "SimulationError", "SpawnPoint", "Terrain", "UsageError", "Vehicle", "World", "__version__", "load",
    "open", "read_log",
]


def load(source: str | os.PathLike | Mapping[str, Any], overrides: Mapping[str, Any] | None = None, *,
         sets: Iterable[str] = (), seed: int | None = None, folder: str | os.PathLike = ".") -> Scenario:
    """Loads and checks a scenario.

    Args:
        source: a scenario file, or the scenario itself as a dict with the keys of such a file
        overrides: values by key path, {"rover.controller.speed_mps": 1.0}
        sets: the same as texts of the command line, ["rover.controller.speed_mps=1"]; they come last
        seed: replaces the scenario's seed
        folder: where relative paths of a dict start
    Raises:
        ConfigError: with one sentence about the first mistake
    """
    if seed is not None and not (isinstance(seed, numbers.Integral) and 0 <= seed < 2**64):
        raise ConfigError(f"seed = {seed!r}, must be a whole number from 0 to {2**64 - 1}", key="seed")
    values, texts = dict(overrides or {}), list(sets)
    if isinstance(source, Mapping):
        return _core.load_text(_core.dict_to_yaml(dict(source)), os.fspath(folder), values, texts, seed)
    return _core.load_file(os.fspath(source), values, texts, seed)


def open(source: Scenario | str | os.PathLike | Mapping[str, Any], overrides: Mapping[str, Any] | None = None, *,
         take_over: Iterable[Any] = (), **options: Any) -> Session:
    """Opens a session of a scenario, at time 0.

    Args:
        source: a Scenario, or what load() takes
        overrides: as for load(), like further keyword arguments
        take_over: signals that command() writes in place of a part of the scenario: "rover/actuators", or
            ("drone/reference", "AirReference") if the name does not determine the type
    """
    if isinstance(source, Scenario):
        if overrides or options:
            raise UsageError("a loaded Scenario takes no overrides; give them to load()")
        scenario = source
    else:
        scenario = load(source, overrides, **options)
    return Session(scenario, [take_over] if isinstance(take_over, str) else take_over)


def read_log(file: str | os.PathLike) -> Log:
    """Opens a log of a run; `log["rover/truth"]` then reads all messages of a signal as arrays."""
    return Log(os.fspath(file))
