"""Parts of a scenario as Python classes: controllers, estimators, planners and guidance.

    from vinerow import parts

    @parts.controller("alley_centring", rate_Hz=20, reads=["sonar_left", "sonar_right"], writes=["actuators"])
    class AlleyCentring(parts.Controller):
        "Keeps the middle of an alley by two ultrasonic rangers"

        speed_mps = parts.Number(0.8, "m/s", "forward speed", more_than=0)

        def connect(self, ports):
            self.left = ports.read("sonar_left", "RangeSample")
            self.actuators = ports.write("actuators")

        def step(self, now_s):
            self.actuators.write({"wheel_fl_speed_radps": self.speed_mps / 0.2})

A scenario names the file: `plugins: [my_parts.py]`. Guide: docs/guides/python_parts.md.
"""

from __future__ import annotations

import inspect
import re
import sys
from typing import Any, Callable, Iterable, NamedTuple, Sequence

import numpy

from .errors import ConfigError
from .messages import Pose
from .world import Map, Vehicle

__all__ = [
    "Boolean", "Context", "Controller", "Estimator", "File", "Guidance", "Integer", "Mounting", "NoPath", "Number", "Numbers", "Parameter",
    "Part", "Planner", "REQUIRED", "Text", "Texts", "controller", "estimator", "guidance", "planner",
]

REQUIRED: Any = type("Required", (), {"__repr__": lambda self: "REQUIRED"})()
"""In place of a default: the scenario must give the parameter."""

_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-zA-Z0-9]+)*")  # the unit keeps its spelling: "rate_Hz"


class Parameter:
    """A parameter of a part: a class attribute, which in an object of the class is the value.

    default: the value if the scenario has none, REQUIRED, or None for "absent"
    unit: as the name's suffix says it: "m", "m/s", "deg"; values are those of the file, without conversion
    words: one sentence
    """

    kind = ""

    def __init__(self, default: Any, unit: str = "", words: str = "", *, more_than: float | None = None, at_least: float | None = None,
                 at_most: float | None = None, one_of: Iterable[str] = (), size: int = 0):
        if more_than is not None and at_least is not None:
            raise ConfigError("a parameter has either more_than or at_least")
        self.default, self.unit, self.words, self.size = default, unit, words, size
        self.low = more_than if at_least is None else at_least
        self.high, self.low_excluded, self.choices = at_most, more_than is not None, list(one_of)

    def __get__(self, part: Part | None, owner: type) -> Any:
        return self if part is None or self.default is REQUIRED else self.default


class Number(Parameter):
    """A float; Number(0.8, "m/s", "forward speed", more_than=0, at_most=3)."""

    kind = "number"


class Numbers(Parameter):
    """A list of floats, `size` of them if it is not 0. The range counts for each."""

    kind = "numbers"


class Integer(Parameter):
    """An int; Integer(5, "points of the stretch", at_least=1)."""

    kind = "integer"

    def __init__(self, default: Any, words: str = "", **range: Any):
        super().__init__(default, "", words, **range)


class Boolean(Parameter):
    kind = "boolean"

    def __init__(self, default: Any, words: str = ""):
        super().__init__(default, "", words)


class Text(Parameter):
    """A str; Text("left", "side of the row", one_of=["left", "right"])."""

    kind = "text"

    def __init__(self, default: Any, words: str = "", *, one_of: Iterable[str] = ()):
        super().__init__(default, "", words, one_of=one_of)


class Texts(Parameter):
    """A list of str."""

    kind = "texts"

    def __init__(self, default: Any, words: str = "", *, one_of: Iterable[str] = ()):
        super().__init__(default, "", words, one_of=one_of)


class File(Parameter):
    """Path of an existing file or folder, relative to the scenario; the value is absolute. Default: REQUIRED or None."""

    kind = "path"

    def __init__(self, default: Any = REQUIRED, words: str = ""):
        super().__init__(default, "", words)


class Mounting(NamedTuple):
    """A sensor as the data sheet has it: `pose` in the vehicle's frame, m; its x axis is the viewing direction."""

    name: str
    type: str
    pose: Pose


class Context:
    """Where a part runs.

    vehicle: a vinerow.Vehicle
    part: the full name, "rover.controller"
    period_s: between two steps; 0 for planners
    physics_step_s, gravity_mps2: of the run
    seed: of the run
    sensors: list of Mounting; empty for planners
    """

    vehicle: Vehicle
    part: str
    period_s: float
    physics_step_s: float
    gravity_mps2: float
    seed: int
    sensors: list[Mounting]

    def __init__(self, read_map: Callable[[], Map], seeds: Callable[[str], list[int]], **values: Any):
        self._read_map, self._seeds = read_map, seeds
        self._map: Map | None = None
        self.__dict__.update(values)

    @property
    def map(self) -> Map:
        """What the vehicle knows of the world: copies, made once."""
        if self._map is None:
            self._map = self._read_map()
        return self._map

    def random(self, component: str = "") -> numpy.random.Generator:
        """A new generator of this part, the same in each run with the same seed; `component` distinguishes several."""
        return numpy.random.Generator(numpy.random.PCG64(self._seeds(component)))


class Part:
    """Base of all parts. Parameters and `self.context` exist before __init__(self), which is optional."""

    context: Context


class SteppedPart(Part):
    """A part with a rate of its own."""

    def connect(self, ports: Any) -> None:
        """Declares the signals, once before the first step.

        ports.read(name, type="", optional=False): a reader. reader["range"] is one field and reader.value all fields, as
            copies; reader.has_value, reader.stamp_s and reader.count. An optional signal may have no writer.
        ports.write(name, type=""): a writer. writer.write({field: value}), or {name: number} for NamedValues.
        type: the message, "RangeSample". "truth", "estimate", "plan", "actuators", "command", "follower" and "authority"
            have one of their own.
        """
        raise NotImplementedError

    def step(self, now_s: float) -> None:
        """One tick at the simulated time now_s."""
        raise NotImplementedError


class Controller(SteppedPart):
    """Reads "estimate", "plan" or sensors; writes "actuators" or "command"."""

    def finished(self) -> bool:
        """The task is complete. Asked after each step."""
        return False

    def failure(self) -> str:
        """The reason why the task cannot be completed, or "". Asked after each step."""
        return ""


class Estimator(SteppedPart):
    """Reads sensors; writes "estimate"."""


class Guidance(SteppedPart):
    """Reads "estimate" and "plan"; writes the "reference" or "local_command" of a controller."""

    def failure(self) -> str:
        """The reason why the task cannot be completed, or "". Asked after each step."""
        return ""


class NoPath(Exception):
    """Raised by plan(): there is no path, for this reason. It ends the phase as failed, not the run as broken."""


class Planner(Part):
    """Makes a path from the map when the vehicle's phase starts."""

    numbers: dict[str, float] = {}
    """Report on the last plan(), for summary.json: {"nodes": 12}."""

    def plan(self, start: Pose) -> dict[str, Any]:
        """The fields of a PlannedPath: {"points": [{"position": [x, y, z], "yaw": 0.0, ...}, ...], "length": m}.

        Without "length" it is that of the polyline. Limit iterations, never wall time.
        """
        raise NotImplementedError


class Declaration(NamedTuple):
    """What a decorator notes about a class."""

    kind: str
    name: str
    words: str
    rate_Hz: float
    reads: list[str]
    writes: list[str]
    parameters: list[tuple[str, Parameter]]
    line: int


_BASES = {"controller": Controller, "estimator": Estimator, "guidance": Guidance, "planner": Planner}


def _declare(kind: str, name: str, rate_Hz: float, reads: Sequence[str], writes: Sequence[str], description: str) -> Callable[[type], type]:
    def note(part: type) -> type:
        base = _BASES[kind]
        if not (isinstance(part, type) and issubclass(part, base)):
            raise ConfigError(f"{kind} '{name}' must be a class derived from vinerow.parts.{base.__name__}")
        for method in ("plan",) if kind == "planner" else ("connect", "step"):
            if getattr(part, method) is getattr(base, method) or not callable(getattr(part, method)):
                raise ConfigError(f"{kind} '{name}': class {part.__name__} has no method {method}()")
        words = description or (part.__dict__.get("__doc__") or "").strip().split("\n")[0]
        if not words:
            raise ConfigError(f"{kind} '{name}' needs a description, or a docstring of its class")
        parameters = [(key, value) for key, value in inspect.getmembers_static(part) if isinstance(value, Parameter)]
        order = [key for cls in reversed(part.__mro__) for key in cls.__dict__]
        parameters.sort(key=lambda entry: order.index(entry[0]))
        for key, _ in parameters:
            if not _NAME.fullmatch(key) or key in dir(base) or key in ("context", "type"):
                raise ConfigError(f"{kind} '{name}': a parameter cannot be named '{key}'")
        declaration = Declaration(kind, name, words, rate_Hz, list(reads), list(writes), parameters, line)
        setattr(part, "__vinerow_part__", declaration)
        return part

    line = sys._getframe(2).f_lineno
    if not isinstance(name, str) or not re.fullmatch(r"[a-z][a-z0-9_]*", name):
        raise ConfigError(f"the name of a {kind} is {name!r}, must be a text in snake_case")
    if isinstance(rate_Hz, bool) or not isinstance(rate_Hz, (int, float)) or not 0 < rate_Hz <= 1e6 and kind != "planner":
        raise ConfigError(f"{kind} '{name}': rate_Hz = {rate_Hz!r}, must be a number > 0 and <= 1e6")
    return note


def controller(name: str, *, rate_Hz: float, reads: Sequence[str] = (), writes: Sequence[str] = (),
               description: str = "") -> Callable[[type], type]:
    """Makes a class the controller `name` of scenarios.

    rate_Hz: if the scenario has none
    reads, writes: local names of signals, for `vinerow list`
    description: one sentence; by default the first line of the docstring
    """
    return _declare("controller", name, rate_Hz, reads, writes, description)


def estimator(name: str, *, rate_Hz: float, reads: Sequence[str] = (), writes: Sequence[str] = ("estimate",),
              description: str = "") -> Callable[[type], type]:
    """As controller()."""
    return _declare("estimator", name, rate_Hz, reads, writes, description)


def guidance(name: str, *, rate_Hz: float, reads: Sequence[str] = (), writes: Sequence[str] = (),
             description: str = "") -> Callable[[type], type]:
    """As controller()."""
    return _declare("guidance", name, rate_Hz, reads, writes, description)


def planner(name: str, *, description: str = "") -> Callable[[type], type]:
    """As controller(); a planner has no rate and writes "plan"."""
    return _declare("planner", name, 0.0, [], ["plan"], description)
