# Made by tools/python_stubs.
"""
C++ part of vinerow.
"""
from __future__ import annotations
import collections.abc
import numpy
import os
import typing
import vinerow.messages
import vinerow.world
class Scenario:
    """
    A checked scenario. vinerow.load() makes it; it does not change.
    """
    def _repr_html_(self) -> str:
        ...
    @property
    def description(self) -> str:
        ...
    @property
    def duration_s(self) -> float:
        """
        The run ends here at the latest, s.
        """
    @property
    def name(self) -> str:
        ...
    @property
    def physics_step_s(self) -> float:
        """
        Time between two instants, s.
        """
    @property
    def seed(self) -> int:
        ...
    @property
    def vehicles(self) -> list[str]:
        """
        Names, in the scenario's order.
        """
    @property
    def warnings(self) -> list[str]:
        """
        Sentences about former names of keys.
        """
    @property
    def yaml(self) -> str:
        """
        The scenario with includes, overrides and defaults written out.
        """
class Signal:
    """
    A signal of a session; remains valid after reset().
    
    signal["pose"] is one field of the last value, signal.value a copy of all fields. Vectors (3,), quaternions
    (4,) x, y, z, w and poses are read-only views of the simulator's memory, which change with each step; after
    reset() or close() they keep the last values of their run. Numbers, texts and lists are copies.
    """
    def __getitem__(self, field: str) -> typing.Any:
        """
        One field of the last value.
        
        Raises KeyError without such a field, UsageError without a value or session.
        """
    @property
    def count(self) -> int:
        """
        Number of writes so far.
        """
    @property
    def fields(self) -> dict[str, tuple[str, str, str]]:
        """
        {name: (type, unit, description)}
        """
    @property
    def name(self) -> str:
        ...
    @property
    def stamp_s(self) -> float:
        """
        Time of the value, s; for a sensor with a delay, of the measurement.
        """
    @property
    def type(self) -> str:
        """
        Name of the message, "Odometry".
        """
    @property
    def value(self) -> vinerow.messages.Message:
        """
        A vinerow.Message of copies.
        """
    @property
    def writer(self) -> str:
        """
        Part that writes it; "outside" for command().
        """
class Session:
    """
    A run that the calling program steps. vinerow.open() makes it.
    
    Times are simulated seconds, rounded to nanoseconds. How a run is divided into calls changes no bit of its
    result. One thread at a time may use a session. Methods raise UsageError after close(), in another thread's
    step, or in a forked child.
    """
    def __enter__(self) -> Session:
        ...
    def __exit__(self, *args: typing.Any) -> None:
        ...
    def __init__(self, scenario: Scenario, take_over: typing.Iterable[typing.Any]) -> None:
        ...
    def _repr_html_(self) -> str:
        ...
    def close(self) -> None:
        """
        Frees the run, except for memory that views refer to.
        """
    def command(self, signal: str, value: typing.Any, at_s: float | None = None) -> None:
        """
        Sets a signal that was taken over, at the first instant at or after at_s (default: now).
        
        value: {name: number} for actuators, else {field: value}; fields that are absent keep their default.
        Raises ConfigError on an unknown signal, field or actuator, a wrong type or shape, NaN, or a time in the past.
        """
    def crashes(self) -> list[vinerow.messages.Crash]:
        """
        List of vinerow.Crash.
        """
    def map(self, vehicle: str) -> vinerow.world.Map:
        """
        A vinerow.Map: the world as the vehicle knows it.
        """
    def metrics(self) -> dict[str, dict[str, float]]:
        """
        Present values: {vehicle: {metric: number}}, and {phase: {number}} for jobs.
        """
    def phases(self) -> list[vinerow.messages.Phase]:
        """
        List of vinerow.Phase; empty without a mission.
        """
    def reset(self, seed: int | None = None) -> None:
        """
        Restarts at time 0, with the same seed if none is given. Signals remain valid; views keep the old run's values.
        """
    def signal(self, name: str) -> Signal:
        """
        A signal by name, "rover/truth". Raises ConfigError without one.
        """
    def signals(self) -> dict[str, tuple[str, str]]:
        """
        {name: (type, writer)} of all signals.
        """
    def step(self, until_s: float) -> None:
        """
        Processes every instant up to and including until_s, or to the end of the run.
        
        Raises SimulationError if the run breaks off, ConfigError if it is over or a plan cannot be made.
        """
    def step_for(self, duration_s: float) -> None:
        """
        Processes the instants of the next duration_s, at least one physics step. Raises what step() raises.
        """
    def take_events(self) -> list[vinerow.messages.Event]:
        """
        List of vinerow.Event since the last call.
        """
    def twin(self) -> Session:
        """
        Another session of the same scenario, at time 0, for another thread; shares the world.
        """
    def vehicle(self, vehicle: str) -> vinerow.world.Vehicle:
        """
        A vinerow.Vehicle: its description.
        """
    def world(self) -> vinerow.world.World:
        """
        A vinerow.World: copies of terrain, rows and alleys.
        """
    @property
    def closed(self) -> bool:
        ...
    @property
    def digest(self) -> str:
        """
        Digest of every signal so far; that of `vinerow run` at the end.
        """
    @property
    def finished(self) -> bool:
        """
        Every controller has finished and no vehicle crashed; in a mission, every phase succeeded.
        """
    @property
    def now_s(self) -> float:
        """
        The next instant to be processed; 0 at the start.
        """
    @property
    def over(self) -> bool:
        """
        The run has ended.
        """
    @property
    def seed(self) -> int:
        ...
    @property
    def vehicles(self) -> list[str]:
        """
        Names, in the scenario's order.
        """
class Log:
    """
    A log of a run, by topic.
    
    log["rover/truth"] reads all messages of a signal: a Message with `stamp_s` (n,) and one column per field.
    """
    def __contains__(self, topic: typing.Any) -> bool:
        ...
    def __getitem__(self, topic: str) -> vinerow.messages.Message:
        ...
    def __init__(self, file: str | os.PathLike[str]) -> None:
        ...
    def read(self, topics: collections.abc.Iterable[str]) -> dict[str, vinerow.messages.Message]:
        """
        {topic: Message} of several signals. Reads the file once, not once for each.
        """
    def render_at(self, times_s: list[float], camera: typing.Any, width: int | None, height: int | None) -> list[numpy.ndarray[typing.Any, numpy.dtype[numpy.uint8]]]:
        """
        Pictures (h, w, 3) at increasing times.
        """
    def topics(self) -> dict[str, tuple[str, int]]:
        """
        {name: (type, number of messages)}
        """
    @property
    def complete(self) -> bool:
        """
        False if the run was interrupted.
        """
    @property
    def file(self) -> str:
        ...
    @property
    def first_s(self) -> float:
        """
        Simulated time of the first message.
        """
    @property
    def last_s(self) -> float:
        """
        Simulated time of the last message.
        """
    @property
    def metadata(self) -> dict[str, str]:
        """
        {key: text} about the run: scenario, seed, version.
        """
    @property
    def warnings(self) -> list[str]:
        """
        Sentences about damaged parts of the file.
        """
class Environments:
    """
    Environments with one agent each.
    """
    def __init__(self, file: str, overrides: dict[str, typing.Any], sets: list[str], factors: dict[str, typing.Any], vehicle: str, task: str, options: dict[str, typing.Any], period_s: float, count: int, threads: int, autoreset: str) -> None:
        ...
    def close(self) -> None:
        ...
    def digest(self, arg0: int) -> str:
        ...
    def draw(self) -> numpy.ndarray[typing.Any, numpy.dtype[numpy.uint8]]:
        ...
    def levels(self, arg0: int) -> dict[str, str]:
        ...
    def now_s(self, arg0: int) -> float:
        ...
    def numbers(self) -> dict[str, typing.Any]:
        ...
    def numbers_of(self, arg0: int) -> dict[str, typing.Any]:
        ...
    def reset(self, seeds: list[int | None], chosen: list[bool]) -> None:
        ...
    def results(self) -> tuple[typing.Any, typing.Any, typing.Any, typing.Any]:
        ...
    def run_seed(self, arg0: int) -> int:
        ...
    def step(self, actions: typing.Any) -> None:
        """
        actions: (environments, elements), finite
        """
    def step_single(self, action: typing.Any) -> tuple[typing.Any, float, bool, bool, dict[str, typing.Any]]:
        ...
    def watch(self, camera: str, width: int, height: int) -> None:
        """
        Lets draw() picture the first environment, from its next reset on.
        """
    @property
    def action(self) -> list[tuple[str, float, float]]:
        """
        List of (name, low, high).
        """
    @property
    def number_names(self) -> list[str]:
        ...
    @property
    def observation(self) -> list[tuple[str, float, float]]:
        """
        List of (name, low, high).
        """
class Episodes:
    """
    One session with several agents.
    """
    def __init__(self, file: str, overrides: dict[str, typing.Any], sets: list[str], factors: dict[str, typing.Any], agents: list[tuple[str, str, dict[str, typing.Any]]], period_s: float) -> None:
        ...
    def agents(self) -> dict[str, tuple[typing.Any, float, bool, bool, dict[str, typing.Any]]]:
        ...
    def digest(self) -> str:
        ...
    def draw(self) -> numpy.ndarray[typing.Any, numpy.dtype[numpy.uint8]]:
        ...
    def levels(self) -> dict[str, str]:
        ...
    def now_s(self) -> float:
        ...
    def reset(self, seed: int | None) -> None:
        ...
    def spaces(self) -> dict[str, tuple[list[tuple[str, float, float]], list[tuple[str, float, float]]]]:
        ...
    def step(self, actions: dict[str, typing.Any]) -> None:
        ...
    def watch(self, camera: str, width: int, height: int) -> None:
        """
        Lets draw() picture the episodes from the next reset on.
        """
class PartReader:
    """
    A signal as a part reads it; only in its step().
    """
    def __getitem__(self, field: str) -> typing.Any:
        """
        A copy of one field. Raises KeyError without such a field, UsageError without a value.
        """
    @property
    def count(self) -> int:
        """
        Number of writes so far.
        """
    @property
    def has_value(self) -> bool:
        ...
    @property
    def stamp_s(self) -> float:
        """
        Time of the value, s.
        """
    @property
    def value(self) -> typing.Any:
        """
        A vinerow.Message of copies.
        """
class PartWriter:
    """
    A signal as a part writes it; only in its step().
    """
    def write(self, value: typing.Any) -> None:
        """
        {name: number} for actuators, else {field: value}; fields that are absent keep their default. Raises ConfigError.
        """
class PartPorts:
    """
    Where a part connects its signals.
    """
    def read(self, name: str, type: str = '', optional: bool = False) -> PartReader:
        ...
    def write(self, name: str, type: str = '') -> PartWriter:
        ...
def acos(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def asin(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def atan(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def atan2(y: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]], x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def cbrt(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def check_task(name: str) -> None:
    """
    Raises ConfigError on an unknown task.
    """
def cos(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def cosh(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def encode_picture(picture: numpy.ndarray[typing.Any, numpy.dtype[numpy.uint8]]) -> bytes:
    """
    A PNG of (h, w, 3) pixels.
    """
def erf(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def exp(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def expm1(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def hypot(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]], y: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def load_file(file: str | os.PathLike[str], overrides: dict[str, typing.Any], sets: list[str], seed: int | None) -> Scenario:
    ...
def load_tree(tree: dict[str, typing.Any], folder: str | os.PathLike[str], overrides: dict[str, typing.Any], sets: list[str], seed: int | None) -> Scenario:
    ...
def log(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def log10(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def log1p(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def log2(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def pow(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]], y: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def read_picture(file: str | os.PathLike[str]) -> numpy.ndarray[typing.Any, numpy.dtype[numpy.uint8]]:
    """
    Pixels of a PNG, (h, w, 3).
    """
def run_files(scenario: Scenario, out: str | os.PathLike[str], log: bool, pictures: bool, report: bool) -> list[str]:
    """
    Runs a scenario and writes its files into a folder, as `vinerow run` does.
    
    Returns sentences about files that could not be made.
    """
def sin(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def sinh(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def tan(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def tanh(x: numpy.ndarray[typing.Any, numpy.dtype[numpy.float64]]) -> typing.Any:
    ...
def task_specs() -> list[dict[str, typing.Any]]:
    """
    List of dicts: name, description, parameters, observation, action, numbers.
    """
def write_replay(folder: str | os.PathLike[str]) -> None:
    """
    Writes replay.html into the folder of a run.
    """
def write_report(folder: str | os.PathLike[str]) -> None:
    """
    Writes report.html into the folder of a run.
    """
__version__: str = '0.1.0'
