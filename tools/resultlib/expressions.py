"""Arithmetics of the table: expressions over results of runs, in Python's notation and with few of its words.

    1e3 * mean("pursuit/0.75/0.33", "rover.average_deviation_m")

A path leads into what a run gave; numbers of it are taken from every seed.
"""

import ast
import math
import operator
import statistics
from collections.abc import Callable, Iterator


class TableError(Exception):
    """Fault of the table or of a number that it requests, in one sentence."""


class NotRun(Exception):
    """The run of a number was left out; says why."""


def rms(values: list[float]) -> float:
    return math.sqrt(sum(v * v for v in values) / len(values))


def deviation(values: list[float]) -> float:
    return statistics.stdev(values) if len(values) > 1 else 0.0


# Of all seeds of a run.
OVER_SEEDS: dict[str, Callable[[list[float]], float]] = {
    "one": lambda values: values[0],
    "mean": statistics.fmean,
    "rms": rms,
    "deviation": deviation,
    "largest": max,
    "least": min,
    "total": sum,
    "seeds": len,
}
PLAIN: dict[str, Callable] = {"abs": abs, "max": max, "min": min, "sqrt": math.sqrt, "tan": math.tan}
OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


def parse(text: str) -> ast.expr:
    try:
        return ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        raise TableError(f"'{text}' is no expression: {error.msg}") from None


def texts_of(call: ast.Call) -> list:
    arguments = [a.value for a in call.args if isinstance(a, ast.Constant)]
    if len(arguments) != len(call.args) or call.keywords:
        raise TableError(f"{ast.unparse(call)}: wants texts and numbers in its brackets")
    return arguments


def calls_of(text: str) -> Iterator[tuple[str, list]]:
    """Names and arguments of the calls that ask for results."""
    for node in ast.walk(parse(text)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id not in PLAIN:
            yield node.func.id, texts_of(node)


def evaluate(text: str, values_of: Callable[[str, str], list], asset: Callable) -> float | str:
    """@param values_of  (run, path) -> values of all seeds;  asset: (file, key[, index]) -> number of a parameter file"""

    def value(node: ast.expr):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
            return node.value
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            return -value(node.operand)
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](value(node.left), value(node.right))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            return call(node.func.id, node)
        raise TableError(f"'{text}': {ast.unparse(node)} is not known")

    def call(name: str, node: ast.Call):
        if name in PLAIN:
            return PLAIN[name](*[value(a) for a in node.args])
        if name == "asset":
            return asset(*texts_of(node))
        if name not in OVER_SEEDS:
            known = ", ".join([*OVER_SEEDS, "asset", *PLAIN])
            raise TableError(f"'{text}': no function {name}, there are {known}")
        run, path = texts_of(node)
        values = values_of(run, path)
        if any(v is None for v in values):
            raise TableError(f"{run}: {path} was not measured")
        return OVER_SEEDS[name](values)

    return value(parse(text))
