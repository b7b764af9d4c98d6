"""Clouds, maps, and what payloads leave on the canopy."""

import json
import re

import numpy as np

from .runs import ASSETS, Runs
from .style import COLOURS, GREY, panels

VINEYARD = """
vinerow: 1
name: small
world: {type: vineyard, row_count: 4, row_length_m: 30, row_bearing_deg: 90, relief_m: 2, surroundings_m: 200}
"""


def draw_mesh_volume(runs: Runs) -> None:
    noises = [0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05]
    figure, (axes,) = panels(1, 1, width=6.0, height=3.3)
    rows = []
    for noise in noises:
        def make(folder, noise=noise):
            (folder / "scenario.yaml").write_text(VINEYARD + "vehicles: {}\n")
            runs.call("cloud", folder / "scenario.yaml", "--uniform", 1000, "--noise", noise, "--out", folder / "cloud.las")
            (folder / "output").write_text(runs.call("map", folder / "cloud.las", "--truth", folder / "cloud.truth.json", "--no-pictures", "--out",
                                                     folder / "map"))
        text = (runs.once(f"volume_{noise}", VINEYARD, make) / "output").read_text()
        rows.append([float(x) for x in re.search(r"volume +([-+.\d]+) % .* seen ([-+.\d]+) %", text).groups()])
    inside, seen = np.array(rows).T
    axes.plot([100 * n for n in noises], inside, "o-", color=COLOURS[0], ms=4, label="inside the meshes")
    axes.plot([100 * n for n in noises], seen, "s--", color=COLOURS[1], ms=4, label="of the canopy seen")
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set(title="Volume of the map's rows against the truth", xlabel="noise of each coordinate (1σ), cm", ylabel="volume error, %")
    axes.legend()
    runs.save(figure, "mesh_volume")


def survey_cloud(runs: Runs):
    """Cloud of a planned survey over the small vineyard, with true classes."""
    def make(folder):
        (folder / "scenario.yaml").write_text(VINEYARD + f"""vehicles:
  plane:
    include: {ASSETS}/vehicles/mh900_like.yaml
    spawn: {{x_m: -90, y_m: -30, yaw_deg: 90}}
    sensors: {{camera: {{type: camera_trigger, camera: rx100, rotation_deg: [0, 97, 0]}}}}
    planner: {{type: survey, camera: rx100, height_m: 95, margin_m: 40, forward_overlap: 0.85, side_overlap: 0.75}}
    guidance: {{type: waypoint_guidance}}
    controller: {{type: fixed_wing_pid}}
""")
        runs.call("cloud", folder / "scenario.yaml", "--density", 1500, "--georeference", "truth", "--out", folder / "survey.xyz")
        runs.call("cloud", folder / "scenario.yaml", "--uniform", 1500, "--out", folder / "uniform.xyz")
        runs.call("cloud", folder / "scenario.yaml", "--density", 1500, "--georeference", "truth", "--out", folder / "survey.las")
        runs.call("map", folder / "survey.las", "--no-pictures", "--out", folder / "map")
    return runs.once("cloud", VINEYARD, make)


def points(path) -> np.ndarray:
    with open(path) as file:
        names = file.readline().split()
    return np.loadtxt(path, skiprows=1 if names[0].isalpha() else 0, usecols=(0, 1, 2))


def draw_photogrammetry(runs: Runs) -> None:
    folder = survey_cloud(runs)
    figure, axes = panels(1, 2, height=2.1, sharey=True)
    for ax, (name, title) in zip(axes, (("uniform", "every surface, evenly (--uniform)"), ("survey", "as 95 m high pictures show it"))):
        cloud = points(folder / f"{name}.xyz")
        middle = np.median(cloud[:, 0])
        part = cloud[np.abs(cloud[:, 0] - middle) < 0.6]
        ax.plot(part[:, 1], part[:, 2], ".", color=COLOURS[0], ms=1.3)
        ax.set(title=title, xlabel="across the rows, m", xlim=(np.median(part[:, 1]) - 4.2, np.median(part[:, 1]) + 4.2), aspect="equal")
    axes[0].set_ylabel("z, m")
    runs.save(figure, "photogrammetry")


def ply_mesh(path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of a PLY file, ascii or little-endian."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    count = {words[1]: int(words[2]) for words in map(str.split, lines) if words[0] == "element"}
    kinds = {"float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8"}
    types = [kinds[words[1]] for words in map(str.split, lines) if words[0] == "property" and words[1] in kinds][:3]
    vertex = np.dtype([(axis, kind) for axis, kind in zip("xyz", types)])
    vertices = np.frombuffer(body, vertex, count["vertex"])
    face = np.dtype([("n", "u1"), ("i", "<i4", 3)])
    faces = np.frombuffer(body, face, count["face"], vertex.itemsize * count["vertex"])
    return np.stack([vertices[axis] for axis in "xyz"], 1).astype(float), faces["i"]


def draw_maps(runs: Runs) -> None:
    folder = survey_cloud(runs)
    cloud = points(folder / "uniform.xyz")
    sources = []
    for levels in (3, 6):
        runs.run(f"row_mesh_{levels}", VINEYARD + f"""duration_s: 0.1
vehicles:
  rover:
    include: {ASSETS}/vehicles/rover_paper_b.yaml
    spawn: {{alley: 0, offset_m: 3}}
    map: {{type: row_mesh, levels: {levels}, save_to: {runs.work}/meshes_{levels}}}
    planner: {{type: coverage}}
    controller: {{type: path_follower}}
""")
        sources.append((f"row_mesh, {levels} levels", sorted((runs.work / f"meshes_{levels}").glob("row_01_hull_*.ply"))[0]))
    sources.append(("cloud_map, from pictures", sorted((folder / "map").glob("**/row_0[12]_hull_*.ply"))[0]))
    figure, axes = panels(1, 3, width=9.4, height=2.9, sharey=True)
    for ax, (title, path) in zip(axes, sources):
        vertices, faces = ply_mesh(path)
        at = vertices[:, 0].mean() + 0.3
        y = vertices[:, 1].mean()
        part = cloud[(np.abs(cloud[:, 0] - at) < 0.12) & (np.abs(cloud[:, 1] - y) < 1.2)]
        ground = part[:, 2].min()
        ax.plot(part[:, 1] - y, part[:, 2] - ground, ".", color="0.6", ms=2, label="true surface")
        for triangle in faces:  # the plane x = at
            corners = vertices[triangle]
            over = corners[:, 0] > at
            if over.all() or not over.any():
                continue
            cut = [corners[i] + (at - corners[i, 0]) / (corners[j, 0] - corners[i, 0]) * (corners[j] - corners[i])
                   for i, j in ((0, 1), (1, 2), (2, 0)) if over[i] != over[j]]
            ax.plot([c[1] - y for c in cut], [c[2] - ground for c in cut], color=COLOURS[0], lw=1.5)
        ax.set(title=title, xlabel="across the row, m", xlim=(-1.1, 1.1), ylim=(-0.1, 2.4), aspect="equal")
    axes[0].set_ylabel("height, m")
    axes[0].legend(loc="upper right")
    runs.save(figure, "maps")


def draw_payloads(runs: Runs) -> None:
    run = runs.run("payloads", f"""
vinerow: 1
name: payloads
duration_s: 300
world: {{type: vineyard, row_count: 4, row_length_m: 30, row_bearing_deg: 90, relief_m: 2,
  wind: {{mean_speed_mps: 2, from_deg: 20, turbulence: 1.0}}}}
vehicles:
  rover:
    include: {ASSETS}/vehicles/rover_paper_a.yaml
    spawn: {{alley: 0, offset_m: 3}}
    planner: {{type: coverage, alleys: [0, 1], headland_m: 2, turn: dubins}}
    controller: {{type: four_wheel_steering, speed_mps: 1.0}}
    payloads: {{sprayer: {{type: sprayer, tank_l: 60}}}}
  drone:
    include: {ASSETS}/vehicles/quadrotor_q4t.yaml
    spawn: {{alley: 2, offset_m: 3}}
    planner: {{type: row_flight, alleys: [2]}}
    guidance: {{type: trajectory}}
    controller: {{type: quadrotor_mpc, rate_Hz: 20}}
    payloads: {{scout: {{type: canopy_camera, yaws_deg: [90, -90], rate_Hz: 2}}}}
""")
    figure, axes = panels(4, 1, width=8.6, height=1.15, sharex=True)
    for pair, (file, row, label, top) in ((axes[:2], ("rover_sprayer", 1, "deposit, ml/m²", 12)), (axes[2:], ("drone_scout", 2, "pictures", 4))):
        data = json.loads((run / "canopy" / f"{file}.json").read_text())
        patches = data["patches"]
        sides = [(side, [p for p in patches if p[0] == row and p[1] == side]) for side in (1, -1)]
        for ax, (side, mine) in zip(pair, sides):
            along = np.array([p[2] for p in mine]) * data["step_m"]
            band = np.array([p[3] for p in mine]) * data["band_m"]
            shown = ax.scatter(along, band, c=[p[8] for p in mine], s=25, marker="s", cmap="viridis", vmin=0, vmax=top, linewidths=0)
            ax.set(title=f"{'sprayer' if file.startswith('rover') else 'canopy_camera'}: row {row}, {'left' if side > 0 else 'right'} side", ylabel="height, m", ylim=(0.2, 2.4))
            ax.grid(False)
        figure.colorbar(shown, ax=pair, label=label, pad=0.01)
    axes[-1].set_xlabel("along the row, m")
    runs.save(figure, "payloads")
