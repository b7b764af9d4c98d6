"""Exceptions of vinerow. Each text is one sentence for people."""

from __future__ import annotations


class ConfigError(ValueError):
    """Bad input: a scenario, file, parameter, name or value.

    Attributes:
        file: the file that contains the mistake, or None
        line: its line, from 1, or None
        key: path of the parameter, e.g. "vehicles.rover.controller.speed_mps", or None
    """

    def __init__(self, text: str, file: str | None = None, line: int | None = None, key: str | None = None):
        super().__init__(text)
        self.file, self.line, self.key = file, line, key


class SimulationError(RuntimeError):
    """The run broke off: a state that is not finite, or a part that failed.

    Attributes:
        part: the part that failed, e.g. "rover.controller (pure_pursuit)"
        time_s: simulated time of the failure
    """

    def __init__(self, text: str, part: str | None = None, time_s: float | None = None):
        super().__init__(text)
        self.part, self.time_s = part, time_s


class UsageError(RuntimeError):
    """A call that is not possible now: the session is closed, or another thread uses it."""
