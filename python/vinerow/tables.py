"""Tables of columns: those of a study, and of a log's messages."""

from __future__ import annotations

import csv
import pathlib
from typing import Any, Iterator

import numpy

from . import display, optional
from .arrays import Array
from .errors import ConfigError


class Table(dict[str, Array]):
    """Columns (n,) by name: int64 or float64 with NaN for missing values, and object for texts."""

    @property
    def row_count(self) -> int:
        return len(next(iter(self.values()), ()))

    def to_pandas(self) -> Any:
        """The same as a pandas.DataFrame."""
        return optional.package("pandas", "to_pandas()").DataFrame(dict(self))

    def __repr__(self) -> str:
        return f"Table of {self.row_count} rows: {', '.join(self)}"

    def _repr_html_(self) -> str:
        return display.table_html(self)


# Columns of a study's tables that stay texts, whatever their values look like.
_TEXTS = {"state", "reason", "digest", "machine"}


def _column(name: str, texts: list[str]) -> Array:
    if name not in _TEXTS:
        for convert in (lambda: numpy.array([int(text) for text in texts], numpy.int64),
                        lambda: numpy.array([float(text) if text else numpy.nan for text in texts])):
            try:
                return convert()
            except (ValueError, OverflowError):
                pass
    return numpy.array(texts, object)


def read_table(file: pathlib.Path) -> Table:
    """Reads a file of comma-separated values with a row of names. Raises ConfigError."""
    try:
        with file.open(newline="", encoding="utf-8") as lines:
            rows = list(csv.reader(lines))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ConfigError(f"{file}: cannot be read: {error}", file=str(file)) from None
    if not rows:
        raise ConfigError(f"{file}: is empty", file=str(file))
    names = rows[0]
    for line, row in enumerate(rows[1:], 2):
        if len(row) != len(names):
            raise ConfigError(f"{file}:{line}: has {len(row)} values, must have {len(names)}", file=str(file), line=line)
    return Table((name, _column(name, [row[k] for row in rows[1:]])) for k, name in enumerate(names))


def _components(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Columns (n,) of a field of n messages."""
    if hasattr(value, "_asdict"):  # a Pose
        for part, inner in value._asdict().items():
            yield from _components(f"{name}.{part}", inner)
    elif isinstance(value, numpy.ndarray) and value.ndim == 2:
        for axis, column in zip("xyzw", value.T):
            yield f"{name}.{axis}", column
    elif isinstance(value, numpy.ndarray):
        yield name, value
    else:
        column = numpy.empty(len(value), object)
        column[:] = value
        yield name, column


def _named_values(names: list[list[str]], values: list[Array]) -> Iterator[tuple[str, Array]]:
    """A column for each name of NamedValues; NaN where a message does not have it."""
    columns: dict[str, Array] = {}
    for row, (keys, numbers) in enumerate(zip(names, values)):
        for key, number in zip(keys, numbers):
            columns.setdefault(key, numpy.full(len(names), numpy.nan))[row] = number
    yield from columns.items()


def flat_columns(message: dict[str, Any], type: str) -> Table:
    """Columns of a log's messages: vectors by component ("pose.position.x"), NamedValues by name, lists as objects."""
    if type == "NamedValues":
        return Table([("stamp_s", message["stamp_s"]), *_named_values(message["name"], message["value"])])
    return Table(column for name, value in message.items() for column in _components(name, value))
