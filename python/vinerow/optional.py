"""Packages that vinerow uses where they are installed."""

from __future__ import annotations

import importlib
from typing import Any


def package(name: str, user: str) -> Any:
    """A package that only one feature needs. Raises ImportError with one sentence without it."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{user} needs the Python package {name}, which cannot be imported: {error}", name=name) from None
