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
# The functions of a sanitizer must come before these.
_own_first = 0 if "libasan" in os.environ.get("LD_PRELOAD", "") else os.RTLD_DEEPBIND
_flags = sys.getdlopenflags()
sys.setdlopenflags(os.RTLD_NOW | os.RTLD_LOCAL | _own_first)
try:
    from . import _core
finally:
    sys.setdlopenflags(_flags)

from . import _arguments
from ._core import Scenario, Session, Signal, __version__
from .errors import ConfigError, SimulationError, UsageError
from .logs import Log, read_log
from .messages import Crash, Event, Message, Phase, Pose
from .pictures import Picture
from .runs import Criterion, Run, read_run, run_scenario
from .studies import Study, read_study
from .tables import Table
from .world import Actuator, Alley, Grid, Map, Row, RowMesh, SpawnPoint, Terrain, Vehicle, World

__all__ = [
    "Actuator", "Alley", "ConfigError", "Crash", "Criterion", "Event", "Grid", "Log", "Map", "Message", "Phase", "Picture", "Pose", "Row",
    "RowMesh", "Run", "Scenario", "Session", "Signal", "SimulationError", "SpawnPoint", "Study", "Table", "Terrain", "UsageError",
    "Vehicle", "World", "__version__", "load", "open", "read_log", "read_run", "read_study", "run",
]


def load(source: str | os.PathLike[str] | Mapping[str, Any], overrides: Mapping[str, Any] | None = None, *,
         sets: Iterable[str] = (), seed: int | None = None, folder: str | os.PathLike[str] = ".") -> Scenario:
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
    values, texts = _arguments.mapping("overrides", overrides), _arguments.texts("sets", sets)
    if isinstance(source, Mapping):
        return _core.load_tree(dict(source), _arguments.path("folder", folder), values, texts, seed)
    if not isinstance(source, (str, os.PathLike)):
        _arguments.refuse("source", "a file or a dict", source)
    return _core.load_file(_arguments.path("source", source), values, texts, seed)


def _loaded(source: Scenario | str | os.PathLike[str] | Mapping[str, Any], overrides: Mapping[str, Any] | None,
            options: Mapping[str, Any]) -> Scenario:
    if not isinstance(source, Scenario):
        return load(source, overrides, **options)
    if overrides or options:
        raise UsageError("a loaded Scenario takes no overrides; give them to load()")
    return source


def open(source: Scenario | str | os.PathLike[str] | Mapping[str, Any], overrides: Mapping[str, Any] | None = None, *,
         take_over: Iterable[Any] = (), **options: Any) -> Session:
    """Opens a session of a scenario, at time 0.

    Args:
        source: a Scenario, or what load() takes
        overrides: as for load(), like further keyword arguments
        take_over: signals that command() writes in place of a part of the scenario: "rover/actuators", or
            ("drone/reference", "AirReference") if the name does not determine the type
    """
    scenario = _loaded(source, overrides, options)
    return Session(scenario, [take_over] if isinstance(take_over, str) else take_over)


def run(source: Scenario | str | os.PathLike[str] | Mapping[str, Any], overrides: Mapping[str, Any] | None = None, *,
        out: str | os.PathLike[str] | None = None, log: bool = True, pictures: bool = True, report: bool = True,
        **options: Any) -> Run:
    """Runs a scenario and writes the same files as `vinerow run`, with the same bits.

    A criterion that fails, a crash and a run that breaks off raise nothing: see `met`, `verdict` and `error` of the result.

    Args:
        source, overrides: as for open(), like further keyword arguments
        out: folder of the files; default: runs/<name of the scenario>
        log, pictures, report: whether to write these; pictures need the log
    Raises:
        ConfigError: on bad input, or if another run uses the folder
        KeyboardInterrupt: on Ctrl-C; verdict, log and the pictures so far are kept
    """
    return run_scenario(_loaded(source, overrides, options), out, log, pictures, report)
