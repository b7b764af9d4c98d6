"""Tasks that ship: scenario, agent and what varies between episodes."""

from __future__ import annotations

import pathlib
from typing import Any, Mapping, NamedTuple

from .. import _core

SCENARIOS = pathlib.Path(__file__).parent / "scenarios"


class TaskDefinition(NamedTuple):
    """A task with its defaults. `factors` has the form of a study's (docs/guides/studies.md)."""

    id: str
    task: str
    vehicle: str
    scenario: pathlib.Path
    factors: Mapping[str, Any]


# Starts of a vehicle in an alley: any alley, both directions, off the centre line and its heading.
def _starts(vehicle: str, alleys: int, lateral_m: float, turn_deg: float) -> dict[str, Any]:
    return {
        "alley": {"key": f"{vehicle}.spawn.alley", "values": list(range(alleys))},
        "reverse": {"key": f"{vehicle}.spawn.reverse", "values": [False, True]},
        "lateral": {"key": f"{vehicle}.spawn.lateral_m", "from": -lateral_m, "to": lateral_m, "count": 11},
        "heading": {"key": f"{vehicle}.spawn.turn_deg", "from": -turn_deg, "to": turn_deg, "count": 11},
    }


TASKS: dict[str, TaskDefinition] = {
    definition.task: definition
    for definition in (
        TaskDefinition("vinerow/RowFollowing-v0", "row_following", "rover", SCENARIOS / "row_following.yaml",
                       _starts("rover", 7, 0.1, 4.0)),
        TaskDefinition("vinerow/HeadlandTurn-v0", "headland_turn", "rover", SCENARIOS / "headland_turn.yaml",
                       _starts("rover", 5, 0.1, 4.0)),
        TaskDefinition("vinerow/RowFlight-v0", "row_flight", "drone", SCENARIOS / "row_flight.yaml",
                       {**_starts("drone", 5, 0.2, 10.0),
                        "wind": {"key": "world.wind.from_deg", "values": [30, 120, 210, 300]}}),
        TaskDefinition("vinerow/Spraying-v0", "spraying", "rover", SCENARIOS / "spraying.yaml",
                       _starts("rover", 3, 0.1, 4.0)),
    )
}


def describe() -> list[dict[str, Any]]:
    """What each task observes, does and is rewarded for: a list of dicts with the keys name, description, parameters (name, unit,
    default, allowed, description), observation and action (name, low, high), numbers."""
    return _core.task_specs()
