#!/usr/bin/env python3
"""Random numbers are drawn one after another.

GCC evaluates the arguments of a call from the last to the first, Clang from the first to the last, and C++ allows both. So two
draws in one expression give other numbers with another compiler. Declarations one by one, `const double x = random.normal(),
y = random.normal();`, and lists in braces have an order; the two branches of a condition are never both drawn.
"""

import re
import sys
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
FOLDERS = ["engine", "vehicles", "worlds", "controllers", "tools"]
DRAW = re.compile(r"(?:\.|->)(?:normal\(\)|uniform\(|next_u64\(\))")
COMMENT = re.compile(r"//[^\n]*")


def expressions(text):
    """(line, expression): text between what orders an evaluation; a comma does so outside parentheses."""
    depth = begin = 0
    for at, sign in enumerate(text):
        if sign in "([":
            depth += 1
        elif sign in ")]":
            depth -= 1
        elif sign in ";{}?:" or (sign == "," and depth == 0):
            yield text.count("\n", 0, at) + 1, text[begin:at]
            begin = at + 1
            if sign in "{}":
                depth = 0


def faults(text):
    code = COMMENT.sub("", text)
    return [line for line, expression in expressions(code) if len(DRAW.findall(expression)) > 1]


def main():
    # The finder itself: what it must find and what it must not.
    assert faults("f(1);\nconst V v(r.normal(), r.normal());") == [2]
    assert faults("s += r.uniform(1, 2) * q->normal();") == [1]
    assert faults("const double x = r.normal(), y = r.normal(); V v{r.normal(), r.normal()}; a ? r.normal() : r.uniform(0, 1);") == []
    failed = False
    for folder in FOLDERS:
        for path in sorted((TREE / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                for line in faults(path.read_text()):
                    print(f"{path.relative_to(TREE)}:{line}: two random numbers in one expression, whose order is the compiler's choice")
                    failed = True
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
