"""Files with parts: how they are loaded, and where in them an exception arose. Called by vinerow._core."""

from __future__ import annotations

import pathlib
import sys
import traceback
import types
from typing import Any

from .errors import ConfigError, SimulationError, UsageError
from .parts import Declaration

_OWN = (ConfigError, SimulationError, UsageError)  # their texts are sentences already


def load(file: str) -> list[tuple[type, Declaration]]:
    """Runs a file afresh, so that each scenario has classes and module variables of its own.

    Returns the classes with a declaration, in the file's order. Its folder is searched for modules that it imports.
    """
    path = pathlib.Path(file)
    folder = str(path.parent)
    if folder not in sys.path:
        sys.path.append(folder)
    module = types.ModuleType(path.stem)
    module.__file__ = file
    # By its name, for what looks up the module of a class: pickle, dataclasses.
    if path.stem not in sys.modules or getattr(sys.modules[path.stem], "__file__", None) == file:
        sys.modules[path.stem] = module
    try:
        exec(compile(path.read_bytes(), file, "exec", dont_inherit=True), module.__dict__)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # SystemExit too: a file of parts must not end the program
        sentence, line = describe(error, file)
        raise ConfigError(f"{file}:{line}: {sentence}" if line else f"{file}: {sentence}", file, line) from error
    classes: dict[type, Declaration] = {}
    for value in list(module.__dict__.values()):
        if isinstance(value, type) and "__vinerow_part__" in value.__dict__:
            classes.setdefault(value, value.__dict__["__vinerow_part__"])
    if not classes:
        raise ConfigError(f"{file}: has no part: no class with a decorator of vinerow.parts", file)
    return list(classes.items())


def describe(error: BaseException, file: str) -> tuple[str, int | None]:
    """Type and text of an exception in one line, and the line of the file that it arose from."""
    line = None
    for frame, number in traceback.walk_tb(error.__traceback__):
        if frame.f_code.co_filename == file:
            line = number
    if isinstance(error, SyntaxError) and error.filename == file:
        line, text = error.lineno, error.msg
    else:
        try:
            text = str(error)
        except Exception:  # a __str__ of its own that fails
            text = ""
    text = " ".join(text.split())
    if isinstance(error, _OWN):
        return text, line
    kind = type(error).__name__
    return (f"{kind}: {text}" if text else kind), line


def make(cls: type[Any], context: Any, values: dict[str, Any]) -> Any:
    """An object of the class with its context and parameters."""
    part: Any = object.__new__(cls)
    part.context = context
    for name, value in values.items():
        setattr(part, name, value)
    part.__init__()
    return part
