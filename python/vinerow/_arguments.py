"""Checks of arguments: a wrong type is one sentence with the argument's name."""

from __future__ import annotations

import math
import numbers
import os
from typing import Any, Iterable, Mapping, NoReturn

from .errors import ConfigError


def refuse(name: str, wanted: str, value: Any) -> NoReturn:
    raise ConfigError(f"{name} must be {wanted}, not {type(value).__name__}", key=name)


def path(name: str, value: Any) -> str:
    if isinstance(value, (str, os.PathLike)):
        text = os.fspath(value)
        if isinstance(text, str):
            return text
    refuse(name, "a path", value)


def mapping(name: str, value: Any) -> dict[Any, Any]:
    """A copy; empty for None."""
    if value is None:
        return {}
    if isinstance(value, Mapping):
        return dict(value)
    refuse(name, "a dict", value)


def texts(name: str, value: Any) -> list[str]:
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        refuse(name, "a list of str", value)
    listed = list(value)
    for one in listed:
        if not isinstance(one, str):
            refuse(f"an entry of {name}", "a str", one)
    return listed


def text(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    refuse(name, "a str", value)


def whole(name: str, value: Any) -> int:
    """A whole number that C++ can take; it knows the range."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        refuse(name, "a whole number", value)
    number = int(value)
    if not -2**31 <= number < 2**31:
        raise ConfigError(f"{name} = {number}, is out of range", key=name)
    return number


def above_zero(name: str, unit: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        refuse(name, "a number", value)
    number = float(value)
    if not 0.0 < number < math.inf:
        raise ConfigError(f"{name} = {value!r}, must be > 0 {unit}{'' if math.isfinite(number) else ' and finite'}", key=name)
    return number
