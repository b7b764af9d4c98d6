#!/usr/bin/env python3
"""Reads every #include of the tree and fails on an arrow the wrong way (docs/architecture.md holds the table)."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

CORE, MATH, API = "engine/core", "engine/math", "engine/api"
BASE = [CORE, MATH, API]
PHYSICS, IO, SCENARIO, SENSORS = "engine/physics", "engine/io", "engine/scenario", "engine/sensors"
IMAGING, RENDER, RECORD, METRICS = "engine/imaging", "engine/render", "engine/record", "engine/metrics"
NETS = "engine/nets"
SIM, PLAYBACK, RUN = "engine/sim", "engine/playback", "engine/run"
ROS2, LIVE, MAVLINK = "engine/ros2", "engine/live", "engine/mavlink"
FILES, GEO, CLOUDS = "engine/io/files", "engine/io/geo", "engine/io/clouds"
VEHICLE_PARTS, WORLD_PARTS, PLANTS = "vehicles/parts", "worlds/parts", "worlds/plants"
SOLVERS, PATHS = "controllers/parts/solvers", "controllers/parts/paths"
CONTROLLER_PARTS = ["controllers/parts"]
FIRMWARE = "controllers/autopilot/firmware"
AUTOPILOT_PARTS = [f"controllers/autopilot/{part}" for part in ("frames", "link", "mavlink", "outputs")]
ESTIMATION_PARTS = "controllers/estimation/parts"
SEARCH, ROUTES, SURVEY = "controllers/planning/search", "controllers/planning/routes", "controllers/planning/survey"
MAPPING = "worlds/mapping"
MODEL, READING, ROWS = f"{MAPPING}/model", f"{MAPPING}/reading", f"{MAPPING}/rows"
HULLS, GRID, FOLDER, PIPELINE = f"{MAPPING}/hulls", f"{MAPPING}/grid", f"{MAPPING}/folder", f"{MAPPING}/pipeline"

# What the rooms may include. The entry of the longest path that holds a file counts; a folder in a list includes all folders below it.
# The rooms of a folder without an entry of their own may include each other only where that folder's list says so.
ALLOWED = {
    CORE: [],
    MATH: [CORE],
    API: [CORE, MATH],
    IMAGING: BASE,
    PHYSICS: BASE,
    FILES: BASE,
    GEO: BASE + [FILES],
    CLOUDS: BASE + [FILES, GEO],
    "engine/io/meshes": BASE + [FILES, CLOUDS],
    "engine/io/missions": BASE + [FILES, GEO, MAVLINK],
    "engine/io/grids": BASE + [FILES],
    "engine/io/robots": BASE,
    SCENARIO: BASE + [FILES],
    SENSORS: BASE + [IMAGING],
    RENDER: BASE + [IMAGING],
    RECORD: BASE + [IMAGING],
    METRICS: BASE,
    SIM: BASE + [PHYSICS, IO, SCENARIO, SENSORS, METRICS],
    PLAYBACK: BASE + [IMAGING, PHYSICS, IO, SCENARIO, RENDER, RECORD, METRICS, SIM],
    RUN: BASE + [IO, SCENARIO, RECORD, SIM, PLAYBACK],
    ROS2: BASE + [RECORD],
    MAVLINK: [CORE],
    NETS: [CORE],
    LIVE: BASE + [IO, SCENARIO, RECORD, SIM, RUN, ROS2, MAVLINK],
    # One folder for each vehicle, which knows the shared parts and no other vehicle.
    "vehicles": BASE + [PHYSICS, IO, VEHICLE_PARTS],
    VEHICLE_PARTS: BASE + [PHYSICS],
    "vehicles/payloads": BASE + [VEHICLE_PARTS],
    # One folder for each world.
    "worlds": BASE + [PHYSICS, IO, WORLD_PARTS, PLANTS, MAPPING],
    WORLD_PARTS: BASE + [IO, MODEL],
    PLANTS: BASE + [WORLD_PARTS, MODEL],
    MODEL: BASE,
    READING: BASE + [IO, MODEL],
    ROWS: BASE + [MODEL],
    HULLS: BASE + [MODEL, ROWS],
    GRID: BASE + [MODEL],
    FOLDER: BASE + [IO, MODEL, READING, GRID],
    PIPELINE: BASE + [MODEL, ROWS, HULLS, GRID],
    f"{MAPPING}/photogrammetry": BASE + [IO, MODEL, FOLDER],
    f"{MAPPING}/from_truth": BASE + [IO, MODEL, FOLDER, GRID],
    f"{MAPPING}/jobs": BASE + [MAPPING, GEO],
    # One folder for each controller.
    "controllers": BASE + CONTROLLER_PARTS,
    "controllers/autopilot/link": [CORE, MAVLINK],
    "controllers/autopilot/frames": BASE + ["engine/io/missions"],
    "controllers/autopilot/mavlink": BASE + [MAVLINK, "engine/io/missions", "controllers/autopilot/frames", "controllers/autopilot/link"],
    "controllers/autopilot/outputs": BASE + ["controllers/parts/ground_drive"],
    "controllers/autopilot/firmware": BASE + ["engine/io/missions", MAVLINK] + AUTOPILOT_PARTS,
    "controllers/autopilot/ardupilot": BASE + [MAVLINK, FIRMWARE] + AUTOPILOT_PARTS,
    "controllers/autopilot/px4": BASE + [MAVLINK, FIRMWARE] + AUTOPILOT_PARTS,
    "controllers/autopilot/replay": BASE + [FIRMWARE, "controllers/autopilot/ardupilot", "controllers/autopilot/px4"],
    SOLVERS: [CORE, MATH],
    PATHS: BASE,
    "controllers/parts/ground_drive": BASE + [PATHS],
    "controllers/parts/rotorcraft": BASE + [PATHS, SOLVERS],
    "controllers/parts/aircraft": BASE + [PATHS, SOLVERS],
    ESTIMATION_PARTS: BASE + CONTROLLER_PARTS,
    "controllers/estimation/inertial": BASE + [ESTIMATION_PARTS],
    "controllers/estimation/odometry": BASE + CONTROLLER_PARTS + [ESTIMATION_PARTS],
    "controllers/estimation/row_localisation": BASE + [ESTIMATION_PARTS],
    # The ground of a map of rows.
    "controllers/estimation/row_camera": BASE + [NETS, ESTIMATION_PARTS, "controllers/estimation/row_localisation"],
    SEARCH: BASE + [PATHS],
    SURVEY: BASE + [PATHS, GEO, "engine/io/missions"],  # parcels and missions of ground stations
    ROUTES: BASE + [PATHS, SEARCH, GEO, "engine/io/missions"],  # points and missions from files
    "controllers/planning/flight": BASE + [PATHS, SEARCH, ROUTES, SURVEY],
    # Tools: each may include those below it, in this order.
    "tools": ["engine", "vehicles", "worlds", "controllers", "tools", "vinerow"],
    "tools/parts": ["engine", "vehicles", "worlds", "controllers"],
    "tools/terminal": BASE + [SIM],
    "tools/export": BASE + [IMAGING, FILES, GEO, CLOUDS, RECORD, PLAYBACK],
    "tools/compare": BASE + ["tools/terminal"],
    "tools/pictures": ["engine", "worlds", "controllers"],
    "tools/replay": ["engine", "tools/export"],
    "tools/report": ["engine", MODEL, "tools/parts", "tools/export", "tools/pictures", "tools/replay"],
    "tools/study/plots": [CORE, MATH, "engine/io/files", "tools/pictures", "tools/report"],
    "tools/study": ["engine", "tools/parts", "tools/report", "tools/study/plots"],
    "tools/photos": ["engine"],
    "tools/dataset": ["engine", "tools/export", "tools/study"],
    "python": ["engine", "tools/parts", "tools/report", "tools/replay", "python/tasks", "vinerow"],
    "python/tasks": ["engine"],
    "tests": ["engine", "vehicles", "worlds", "controllers", "tools", "tests", "vinerow"],
}

# These sources list everything of their folder.
REGISTERS = re.compile(r"(vehicles|worlds|controllers)/register_\w+\.(h|cpp)")

# The stages from points to a map work on points alone: they run on real clouds, without a world.
WITHOUT_WORLD = [MODEL, READING, ROWS, HULLS, GRID, FOLDER, PIPELINE]
WORLD_HEADERS = ["engine/api/world_model.h", "engine/api/scene_query.h"]

# Namespaces follow folders. `vinerow` itself is what plug-ins and programs of others see.
NAMESPACE = {
    **{room: "vinerow" for room in (CORE, MATH, API, SIM, "tools/parts")},
    "tools/testing": "vinerow",
    **{room: "vinerow::" + room.split("/")[1]
       for room in (IMAGING, NETS, PHYSICS, IO, SCENARIO, SENSORS, RENDER, RECORD, METRICS, PLAYBACK, RUN)},
    "vehicles": "vinerow::vehicles",
    "worlds": "vinerow::worlds",
    MAPPING: "vinerow::mapping",
    "controllers": "vinerow::controllers",
    "tools": "vinerow::tools",
    "tools/study": "vinerow::study",
    "tools/dataset": "vinerow::dataset",
    "python": "vinerow::python",
    "python/tasks": "vinerow::tasks",
}

# An outside library is included in one folder only: pattern of the header -> folders.
OUTSIDE = {
    r"bt[A-Z]|Bullet": [PHYSICS, "tests/benchmarks"],
    r"embree": [PHYSICS, "tests/benchmarks"],
    r"assimp/": ["engine/io/meshes"],
    r"gdal|ogr_|cpl_": [IO],
    r"GeographicLib/": [MATH, IO],
    r"yaml-cpp/": [FILES],
    r"urdf": ["engine/io/robots"],
    r"tinyxml2": ["engine/io/robots", "engine/io/meshes"],
    r"GL/": [RENDER],
    r"png\.h": [IMAGING, "tests"],
    r"jpeglib": [IMAGING],
    r"ft2build|freetype": [RENDER],
    r"zstd|lz4|zlib": [RECORD],
    r"ompl/": [SEARCH],
    r"opencv2/": [NETS],
    r"CLI/": ["tools"],
    r"boost/random": [SCENARIO],
    r"sqlite3": ["tools/study"],
    r"muParser": ["tools/study"],
    r"boost/math": ["tools/study"],
    r"boost/(beast|asio)": [LIVE],
    r"dds/|openssl/": [ROS2],
    r"pybind11/": ["python"],
}

INCLUDE = re.compile(r'^\s*#include\s+(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)


def folder_of(path: str) -> str:
    return path.rsplit("/", 1)[0]


def holds(room: str, path: str) -> bool:
    return path == room or path.startswith(room + "/")


def free_space_of(path: str) -> str:
    """The entry of ALLOWED that counts for a file."""
    rooms = [room for room in ALLOWED if holds(room, path)]
    return max(rooms, key=len) if rooms else ""


def may_include(name: str, ours: str) -> bool:
    room = free_space_of(name)
    if REGISTERS.fullmatch(name) or any(holds(other, ours) for other in ALLOWED.get(room, [])):
        return True
    # A room that is one folder for each thing: each may include its own.
    return room == free_space_of(ours) and (room != name.split("/")[0] or folder_of(name) == folder_of(ours))


def faults_of(file: pathlib.Path) -> list[str]:
    name = file.relative_to(ROOT).as_posix()
    here = folder_of(name)
    faults = []
    for ours, outside in INCLUDE.findall(file.read_text(encoding="utf-8")):
        if ours:
            if not may_include(name, ours):
                faults.append(f"{name} includes {ours}: {here} must not know {folder_of(ours)}")
            if ours in WORLD_HEADERS and free_space_of(name) in WITHOUT_WORLD:
                faults.append(f"{name} includes {ours}: {free_space_of(name)} works without a world")
        else:
            for pattern, folders in OUTSIDE.items():
                if re.match(pattern, outside) and not any(holds(f, name) for f in folders):
                    faults.append(f"{name} includes <{outside}>: only {', '.join(folders)} may")
    return faults


def wrong_namespace(file: pathlib.Path) -> list[str]:
    """The last one opened counts: forward declarations of others stand before it."""
    name = file.relative_to(ROOT).as_posix()
    rooms = [room for room in NAMESPACE if holds(room, name)]
    opened = re.findall(r"^namespace (vinerow[\w:]*) \{", file.read_text(encoding="utf-8"), re.MULTILINE)
    if not rooms or not opened:
        return []
    wanted = NAMESPACE[max(rooms, key=len)]
    if opened[-1] in (wanted, "vinerow::internal", "vinerow::testing"):
        return []
    if wanted != "vinerow" and opened[-1].startswith(wanted + "::"):
        return []
    return [f"{name} is in namespace {opened[-1]}, its folder's is {wanted}"]


def circles() -> list[str]:
    """Rooms that ALLOWED lets include each other."""
    def reach(room, seen):
        for other in ALLOWED:
            if other not in seen and any(holds(allowed, other) for allowed in ALLOWED[room]):
                seen.add(other)
                reach(other, seen)
        return seen
    return [f"{room} may include itself by way of others" for room in ALLOWED
            if room not in ("tools", "tests", f"{MAPPING}/jobs") and room in reach(room, set())]


def main() -> int:
    faults = circles()
    count = 0
    for top in ("engine", "vehicles", "worlds", "controllers", "tools", "python", "tests"):
        for file in sorted((ROOT / top).rglob("*")):
            if file.suffix in (".h", ".cpp") and "node_modules" not in file.parts:
                count += 1
                faults += faults_of(file) + wrong_namespace(file)
    for fault in faults:
        print(fault)
    print(f"{count} files, {len(faults)} wrong includes")
    return 1 if faults or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
