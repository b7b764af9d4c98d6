"""`python3 -m vinerow`: the command that belongs to this package."""

from __future__ import annotations

import os
import pathlib
import sys

from .errors import UsageError


def command() -> pathlib.Path:
    """The program `vinerow` of the same installation: in a wheel, a prefix (lib/python3/dist-packages) or a build folder.

    Raises:
        UsageError: if there is none
    """
    package = pathlib.Path(__file__).parent  # not resolved: a build folder has links to the sources
    for folder in (package, *package.parents[:4]):
        program = folder / "bin" / "vinerow"
        if program.is_file():
            return program
    raise UsageError(f"the command vinerow is not installed with the package in {package}")


def main() -> None:
    """Replaces the interpreter by the command, with the same arguments."""
    try:
        program = command()
    except UsageError as error:
        sys.exit(f"vinerow: {error}")
    os.execv(program, [os.fspath(program), *sys.argv[1:]])


if __name__ == "__main__":
    main()
