"""The simulator's sin, exp, pow, ...: the same bits on every machine, unlike those of math and numpy.

Arguments are floats or arrays, which broadcast; the results are float64. Angles in rad.
"""

from ._core import acos, asin, atan, atan2, cbrt, cos, cosh, erf, exp, expm1, hypot, log, log1p, log2, log10, pow, sin, sinh, tan, tanh

__all__ = ["acos", "asin", "atan", "atan2", "cbrt", "cos", "cosh", "erf", "exp", "expm1", "hypot", "log", "log1p", "log2", "log10", "pow",
           "sin", "sinh", "tan", "tanh"]
