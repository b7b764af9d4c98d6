#!/usr/bin/env python3
"""Reads every #include of the tree and fails on an arrow the wrong way (docs/architecture.md holds the table)."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

CORE, MATH, API = "engine/core", "engine/math", "engine/api"
PHYSICS, IO, SENSORS = "engine/physics", "engine/io", "engine/sensors"
RENDER, RECORD, SIM = "engine/render", "engine/record", "engine/sim"
ENGINE = [CORE, MATH, API, PHYSICS, IO, SENSORS, RENDER, RECORD, SIM]

ALLOWED = {
    CORE: [],
    MATH: [CORE],
    API: [CORE, MATH],
    PHYSICS: [CORE, MATH, API],
    IO: [CORE, MATH, API],
    SENSORS: [CORE, MATH, API, IO],
    RENDER: [CORE, MATH, API],
    RECORD: [CORE, MATH, API],
    SIM: ENGINE,
    "vehicles": [CORE, MATH, API, PHYSICS, IO],
    "worlds": [CORE, MATH, API, PHYSICS, IO],
    "controllers": [CORE, MATH, API],
    "tools": ENGINE + ["vehicles", "worlds", "controllers", "vinerow"],
    "tests": ENGINE + ["vehicles", "worlds", "controllers", "tools", "vinerow"],
}

# What a folder inside these may know beyond that.
ALLOWED_INSIDE = {
    "controllers/planning": [IO],  # missions and areas of ground stations
}

# An outside library is included in one folder only: pattern of the header -> folders.
OUTSIDE = {
    r"bt[A-Z]|Bullet": [PHYSICS],
    r"embree": [PHYSICS],
    r"assimp/": [IO],
    r"gdal|ogr_|cpl_": [IO],
    r"GeographicLib/": [IO],
    r"yaml-cpp/": [IO],
    r"urdf": [IO],
    r"tinyxml2": [IO],
    r"GL/": [RENDER],
    r"png\.h": [RENDER, "tests"],
    r"ft2build|freetype": [RENDER],
    r"zstd|lz4": [RECORD],
    r"ompl/": ["controllers/planning"],
    r"CLI/": ["tools"],
    r"boost/random": [IO],
    r"sqlite3": ["tools/study"],
    r"muParser": ["tools/study"],
    r"boost/math": ["tools/study"],
}

INCLUDE = re.compile(r'^\s*#include\s+(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)


def folder_of(path: str) -> str:
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] == "engine" else parts[0]


def faults_of(file: pathlib.Path) -> list[str]:
    name = file.relative_to(ROOT).as_posix()
    here = folder_of(name)
    faults = []
    for ours, outside in INCLUDE.findall(file.read_text(encoding="utf-8")):
        if ours:
            there = folder_of(ours)
            inside = ALLOWED_INSIDE.get("/".join(name.split("/")[:2]), [])
            if there != here and there not in ALLOWED[here] + inside:
                faults.append(f"{name} includes {ours}: {here} must not know {there}")
            # Vehicles, worlds and controllers share their parts, not each other's folders.
            if here == there and here in ("vehicles", "worlds", "controllers"):
                mine, theirs = name.split("/")[1], ours.split("/")[1]
                shared = ("parts", "planning", "estimation", "guidance", "mapping")
                registers = mine.startswith("register")
                if "/" in ours[len(there) + 1:] and theirs != mine and theirs not in shared and not registers:
                    faults.append(f"{name} includes {ours}: {mine} must not know {theirs}")
        else:
            for pattern, folders in OUTSIDE.items():
                if re.match(pattern, outside) and not any(name.startswith(f + "/") for f in folders):
                    faults.append(f"{name} includes <{outside}>: only {', '.join(folders)} may")
    return faults


def main() -> int:
    faults = []
    count = 0
    for top in ("engine", "vehicles", "worlds", "controllers", "tools", "tests"):
        for file in sorted((ROOT / top).rglob("*")):
            if file.suffix in (".h", ".cpp") and "node_modules" not in file.parts:
                count += 1
                faults += faults_of(file)
    for fault in faults:
        print(fault)
    print(f"{count} files, {len(faults)} wrong includes")
    return 1 if faults or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
