#!/usr/bin/env python3
"""Runs a test in the Python environment that tools/python_environment makes; skips it (exit status 77) without one.

    in_environment.py SCRIPT ARGUMENT...
"""

import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = ROOT / "build" / "python_environment"
WANTED = ROOT / "tests" / "python" / "requirements.txt"


def main() -> int:
    present = ENVIRONMENT / "requirements.txt"
    if not present.is_file() or present.read_bytes() != WANTED.read_bytes():
        print("skipped: build/python_environment is absent or old; run tools/python_environment")
        return 77
    python = ENVIRONMENT / "bin" / "python"
    os.execv(python, [str(python), "-B", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
