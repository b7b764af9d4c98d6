"""Values of signals."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy

from . import display, optional
from .arrays import Array
from .errors import UsageError
from .tables import flat_columns


class Pose(NamedTuple):
    """A pose, or a list of n poses.

    position: (3,) or (n, 3), m
    orientation: (4,) or (n, 4), unit quaternion x, y, z, w
    """

    position: Array
    orientation: Array

    @property
    def yaw(self) -> Any:
        """Heading of the x axis in the horizontal plane, rad."""
        x, y, z, w = numpy.moveaxis(self.orientation, -1, 0)
        return numpy.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


class Event(NamedTuple):
    """What a part reported. level: "INFO", "WARN" or "ERROR"."""

    time_s: float
    level: str
    source: str
    text: str


class Crash(NamedTuple):
    """A vehicle that crashed."""

    vehicle: str
    time_s: float
    text: str


class Phase(NamedTuple):
    """State of a phase of a mission: "waiting", "running", "succeeded", "failed", "blocked"."""

    name: str
    state: str
    begin_s: float | None
    end_s: float | None
    reason: str
    numbers: dict[str, float]


class Message(dict[str, Any]):
    """Fields of a message by name; `message.speed` is `message["speed"]`."""

    def __init__(self, type: str):
        super().__init__()
        object.__setattr__(self, "type", type)

    def __getattr__(self, field: str) -> Any:
        try:
            return self[field]
        except KeyError:
            raise AttributeError(f"{self.type} has no field '{field}'; it has {', '.join(self)}") from None

    def __reduce__(self) -> Any:
        return Message, (self.type,), None, None, iter(self.items())  # pickle and copy set no type otherwise

    def to_pandas(self) -> Any:
        """Messages of a log as a pandas.DataFrame; see Log.frame()."""
        pandas = optional.package("pandas", "to_pandas()")
        if "stamp_s" not in self:
            raise UsageError("only the messages of a log make a table; this is one value")
        return pandas.DataFrame(dict(flat_columns(self, self.type))).set_index("stamp_s")

    def _repr_html_(self) -> str:
        return display.message_html(self)

    def __repr__(self) -> str:
        return f"{self.type}({', '.join(f'{name}={value!r}' for name, value in self.items())})"
