"""Type of arrays; numpy's own needs two arguments."""

from __future__ import annotations

from typing import Any

import numpy

Array = numpy.ndarray[Any, numpy.dtype[Any]]
