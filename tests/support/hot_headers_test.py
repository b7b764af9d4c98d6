#!/usr/bin/env python3
"""Counts the sources that see each header, and fails where one of those below is seen by a larger share than it may be.

An edit of such a header compiles all of them again. Headers that only point at a type include
engine/api/forward.h instead of the header that defines it. Every source sees what is precompiled. `--all` prints every header's count.
"""

import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ["engine", "vehicles", "worlds", "controllers", "tools", "tests"]
EXTRA = [ROOT, ROOT / "tools/testing/include"]

# Percent of all sources, so that a new source does not break the build; a header that turns hot does.
MOST = {
    "engine/api/map.h": 21,
    "engine/api/world_model.h": 24,
    "engine/api/mesh.h": 38,
    "engine/api/height_field.h": 36,
    "engine/api/messages.h": 9,
}

PRECOMPILED = [ROOT / "cmake/targets.cmake", ROOT / "tests/CMakeLists.txt"]
INCLUDE = re.compile(r'^\s*#\s*include\s+[<"]([^">]+)[">]', re.MULTILINE)


def direct_includes(path: pathlib.Path, known: dict) -> list:
    if path not in known:
        known[path] = []
        for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
            found = next((base / name for base in [*EXTRA, path.parent] if (base / name).is_file()), None)
            if found:
                known[path].append(found.resolve())
    return known[path]


def all_includes(begin: list, known: dict) -> set:
    headers, stack = set(begin), list(begin)
    while stack:
        for header in direct_includes(stack.pop(), known):
            if header not in headers:
                headers.add(header)
                stack.append(header)
    return headers


def main() -> int:
    known: dict = {}
    seen_by = collections.Counter()
    named = [ROOT / name for file in PRECOMPILED for name in re.findall(r"<(engine/[^>]+)>", file.read_text(encoding="utf-8"))]
    precompiled = all_includes(named, known)
    sources = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.cpp")]
    for source in sources:
        headers = all_includes([source.resolve()], known) | precompiled
        seen_by.update(header.relative_to(ROOT).as_posix() for header in headers)
    if "--all" in sys.argv[1:]:
        for header, count in seen_by.most_common():
            print(f"{count:5} {header}")
    faults = [f"{name} is seen by {seen_by[name]} of {len(sources)} sources, at most {most} % should be"
              for name, most in MOST.items() if 100 * seen_by[name] > most * len(sources)]
    print("\n".join(faults) if faults else f"{len(sources)} sources: no header is hotter than it may be")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
