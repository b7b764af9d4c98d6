#!/usr/bin/env python3
"""Runs a page of the tutorial as a test: writes its files, runs its commands, compares what they print.

    tutorial_test.py VINEROW PAGE [--keep FOLDER] [--update]

The page runs in an empty folder that stands for the project's: `assets`, `docs`, `tools` and `build/release` are links
into the tree, `vinerow` is on the PATH, `python3` is the Python that runs this script. --keep runs it in FOLDER, which
must not exist, and leaves it. --update writes the lines that differ into the page; look at the difference, since a
`...` within such a line is lost.

Blocks of a page that count, by the first line of their fence:

    ```console               `$ command`, below it what it prints, standard output and errors together
    ```console no-test       not run
    ```yaml file=a/b.yaml    writes that file; any language
    <!-- needs: ffmpeg, python3:numpy -->    skips the page (exit status 77) if a program or Python module is absent

A command that ends with a backslash continues on the next line. `...` alone on a line of output stands for any lines,
none included; `...` within a line stands for any text. Not compared are spaces at the end of lines, empty lines at the
end of an output, and lines of progress (`simulating  15 %  ...`), which a terminal overwrites. All commands of a page
run in one bash, so `cd` and `export` hold. If a command ends with a status other than 0, the next one must be
`$ echo $?`.
"""

import argparse
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77


@dataclasses.dataclass
class File:
    line: int
    path: str
    text: str


@dataclasses.dataclass
class Command:
    line: int
    text: str
    expected: list[str]
    first: int = 0  # line of the page at which its output begins, from 0


class PageError(Exception):
    """The page breaks the format, or does not show what its commands print."""


def read_page(text: str) -> list[File | Command]:
    steps, lines, i = [], text.splitlines(), 0
    while i < len(lines):
        fence = re.match(r"(```+)(.*)$", lines[i])
        if not fence:
            i += 1
            continue
        first, end = i + 1, i + 1
        while end < len(lines) and not re.fullmatch(re.escape(fence[1]) + r"\s*", lines[end]):
            end += 1
        if end == len(lines):
            raise PageError(f"line {i + 1}: the fence has no end")
        words = fence[2].split()
        named = [w.removeprefix("file=") for w in words if w.startswith("file=")]
        if named:
            path = pathlib.PurePosixPath(named[0])
            if path.is_absolute() or ".." in path.parts:
                raise PageError(f"line {i + 1}: {path} is not inside the folder")
            steps.append(File(i + 1, str(path), "\n".join(lines[first:end]) + "\n"))
        elif words[:1] == ["console"] and "no-test" not in words:
            steps += read_commands(lines, first, end)
        i = end + 1
    return steps


def read_commands(lines: list[str], first: int, end: int) -> list[Command]:
    commands, i = [], first
    while i < end:
        if lines[i].startswith("$ "):
            line, text = i + 1, lines[i][2:]
            while text.endswith("\\") and i + 1 < end:
                i += 1
                text += "\n" + lines[i]
            commands.append(Command(line, text, [], i + 1))
        elif not commands:
            raise PageError(f"line {i + 1}: a console block begins with `$ command`")
        else:
            commands[-1].expected.append(lines[i])
        i += 1
    return commands


def trimmed(lines: list[str]) -> list[str]:
    lines = [line.rstrip() for line in lines]
    while lines and not lines[-1]:
        lines.pop()
    return lines


def same(expected: str, printed: str) -> bool:
    return re.fullmatch(".*".join(map(re.escape, expected.split("..."))), printed) is not None


def compare(expected: list[str], printed: list[str]) -> list[str]:
    """Both as one text: `  ` in both (as expected), `- ` only expected, `+ ` only printed."""
    expected, printed = trimmed(expected), trimmed(printed)
    n, m = len(expected), len(printed)
    any_lines = [e.strip() == "..." for e in expected]
    cost = [[0] * (m + 1) for _ in range(n + 1)]  # least edits between expected[i:] and printed[j:]
    for i in range(n, -1, -1):
        for j in range(m, -1, -1):
            choices = [] if i < n or j < m else [0]
            if i < n and any_lines[i]:
                choices.append(cost[i + 1][j])
                if j < m:
                    choices.append(cost[i][j + 1])
            else:
                if i < n:
                    choices.append(cost[i + 1][j] + 1)
                if j < m:
                    choices.append(cost[i][j + 1] + 1)
                if i < n and j < m and same(expected[i], printed[j]):
                    choices.append(cost[i + 1][j + 1])
            cost[i][j] = min(choices)
    text, i, j = [], 0, 0
    while i < n or j < m:
        here = cost[i][j]
        if i < n and any_lines[i]:
            if here == cost[i + 1][j]:
                text.append("  " + expected[i])
                i += 1
            else:
                j += 1
        elif i < n and j < m and same(expected[i], printed[j]) and here == cost[i + 1][j + 1]:
            text.append("  " + expected[i])
            i, j = i + 1, j + 1
        elif i < n and here == cost[i + 1][j] + 1:
            text.append("- " + expected[i])
            i += 1
        else:
            text.append("+ " + printed[j])
            j += 1
    return text


class Shell:
    """One bash, commands one after the other."""

    MARK = "--- end of command, status "

    def __init__(self, folder: pathlib.Path, environment: dict[str, str]):
        self.process = subprocess.Popen(
            ["bash", "--norc", "--noprofile"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            cwd=folder, env=environment, encoding="utf-8", errors="replace",
        )  # fmt: skip
        self.status = 0

    def run(self, command: str) -> list[str]:
        quoted = "'" + command.replace("'", "'\\''") + "'"
        self.process.stdin.write(f"(exit {self.status}); eval {quoted} </dev/null; printf '\\n{self.MARK}%d\\n' $?\n")
        self.process.stdin.flush()
        printed = []
        progress = re.compile(r"[a-z][a-z, ]* +\d+ %  ")
        for line in self.process.stdout:
            if progress.match(line):
                continue
            if line.startswith(self.MARK):
                self.status = int(line.removeprefix(self.MARK))
                return [text.rstrip("\n") for text in printed]
            printed.append(line)
        raise PageError("the shell ended")

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def missing_needs(text: str, environment: dict[str, str]) -> list[str]:
    missing = []
    for need in (n.strip() for found in re.findall(r"<!-- needs:(.*?)-->", text) for n in found.split(",")):
        if need.startswith("python3:"):
            found = subprocess.run([sys.executable, "-c", f"import {need.removeprefix('python3:')}"], env=environment,
                                   stderr=subprocess.DEVNULL).returncode == 0  # fmt: skip
        else:
            found = shutil.which(need, path=environment["PATH"]) is not None
        if not found:
            missing.append(need)
    return missing


def make_folder(folder: pathlib.Path, vinerow: pathlib.Path) -> dict[str, str]:
    """Links into the tree, and the environment of the commands."""
    for name in ["assets", "docs", "tools"]:
        (folder / name).symlink_to(ROOT / name)
    (folder / "build").mkdir()
    (folder / "build/release").symlink_to(vinerow.parents[1])
    programs = folder / ".programs"
    programs.mkdir()
    for name, program in {"vinerow": vinerow, "python3": sys.executable}.items():
        (programs / name).write_text(f"#!/bin/sh\nexec '{program}' \"$@\"\n")
        (programs / name).chmod(0o755)
    own = {"PATH": f"{programs}:{os.environ['PATH']}", "LC_ALL": "C.UTF-8", "NO_COLOR": "1", "COLUMNS": "120"}
    return {**os.environ, **own}


def run_page(page: pathlib.Path, folder: pathlib.Path, environment: dict[str, str], update: bool) -> bool:
    steps, shell, good, start = read_page(page.read_text()), Shell(folder, environment), True, time.monotonic()
    changed = []
    for i, step in enumerate(steps):
        place = f"{page.name}:{step.line}"
        if isinstance(step, File):
            (folder / step.path).parent.mkdir(parents=True, exist_ok=True)
            (folder / step.path).write_text(step.text)
            print(f"{place}: wrote {step.path}")
            continue
        begin = time.monotonic()
        printed = shell.run(step.text)
        text = compare(step.expected, printed)
        print(f"{place}: $ {step.text}  ({time.monotonic() - begin:.1f} s)", flush=True)
        if any(line[0] != " " for line in text):
            good = False
            changed.append((step, [line[2:] for line in text if line[0] != "-"]))
            print(f"{place}: the page does not show what this prints (- page, + printed):", *text, sep="\n    ")
        after = steps[i + 1] if i + 1 < len(steps) else None
        if shell.status != 0 and not (isinstance(after, Command) and after.text == "echo $?"):
            good = False
            print(f"{place}: exit status {shell.status}; it printed:", *printed, sep="\n    ")
            print("    A command that ends with another status than 0 is followed by `$ echo $?`.")
    shell.close()
    print(f"{page.name}: {len(steps)} steps, {time.monotonic() - start:.0f} s")
    if not any(isinstance(step, Command) for step in steps):
        raise PageError("the page has no command to run")
    if update:
        lines = page.read_text().splitlines()
        for command, output in reversed(changed):
            lines[command.first : command.first + len(trimmed(command.expected))] = output
        page.write_text("\n".join(lines) + "\n")
    return good


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("vinerow", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="vinerow_tutorial_") as scratch:
        folder = (options.keep or pathlib.Path(scratch) / "vinerow").absolute()
        folder.mkdir()
        environment = make_folder(folder, options.vinerow.resolve())
        missing = missing_needs(options.page.read_text(), environment)
        if missing:
            print(f"skipped: {', '.join(missing)} absent")
            return SKIPPED
        try:
            return 0 if run_page(options.page, folder, environment, options.update) else 1
        except PageError as error:
            print(f"{options.page.name}: {error}")
            return 1


if __name__ == "__main__":
    sys.exit(main())
