"""Rendered frames of worlds and vehicles."""

import re


from .runs import ASSETS, ROOT, Runs
from .style import bare, panels

LISTING = re.compile(r"```xml file=scout\.urdf\n(.*?)```", re.S)
HALL = """mtllib colours.mtl
usemtl wall
v -4 -3 0\nv 4 -3 0\nv 4 3 0\nv -4 3 0\nv -4 -3 3\nv 4 -3 3\nv 4 3 3\nv -4 3 3\nv -4 0 5\nv 4 0 5
f 1 2 6 5\nf 2 3 7\nf 2 7 10\nf 2 10 6\nf 3 4 8 7\nf 4 1 5\nf 4 5 9\nf 4 9 8\nusemtl roof\nf 5 6 10 9\nf 7 8 9 10
"""
HEDGE = "mtllib colours.mtl\nusemtl leaf\n" + "\n".join(f"v {x} {y} {z}" for x in (-6, 6) for y, z in ((-0.3, 0.5), (0.3, 0.5), (0.35, 1.7), (0, 2.1), (-0.35, 1.7))) + """
f 1 2 7 6\nf 2 3 8 7\nf 3 4 9 8\nf 4 5 10 9\nf 5 1 6 10\nf 1 5 4 3 2\nf 6 7 8 9 10
"""


COLOURS_OF_MESHES = "newmtl wall\nKd 0.80 0.74 0.62\nnewmtl roof\nKd 0.55 0.20 0.14\nnewmtl leaf\nKd 0.16 0.34 0.08\n"


def draw_worlds(runs: Runs) -> None:
    hedges = "\n".join(f"  - {{file: hedge.obj, name: hedge_{i}, up_axis: z, x_m: 6, y_m: {-5 + 3 * i}, surface: canopy}}" for i in range(4))
    cases = {
        "vineyard": ("{type: vineyard}", "{position_m: [0, -6, 16], look_at_m: [75, 42, -4]"),
        "orchard": ("{type: orchard, waves_m: 0.3}", "{position_m: [8, -14, 8], look_at_m: [48, 45, 0]"),
        "surveyed": (f"{{type: surveyed, survey_file: {ASSETS}/worlds/riseholme/riseholme.geojson, origin_latitude_deg: 53.26810042662116, "
                     "origin_longitude_deg: -0.5244249078498293, leaf_cards_per_m: 340, sun_azimuth_deg: 112, sun_elevation_deg: 30}",
                     "{position_m: [-19, -17, 6.5], look_at_m: [0, 0, 0]"),
        "mesh": (f"""
  type: mesh
  items:
  - {{file: hall.obj, up_axis: z, x_m: 16, y_m: 12, yaw_deg: 20}}
{hedges}
  ground: flat
  ground_margin_m: 40
  waves_m: 0.6""", "{position_m: [-12, -15, 7], look_at_m: [8, 2, 1]"),
    }
    figure, axes = panels(2, 2, width=9.0, height=2.65)
    for ax, (name, (world, camera)) in zip(axes, cases.items()):
        run = runs.run(f"world_{name}", f"""
vinerow: 1
name: {name}
duration_s: 0.1
world: {world}
vehicles: {{}}
pictures: {{width: 960, height: 540, shares: [1.0], cameras: {{view: {camera}, kind: fixed, fov_deg: 42}}}}}}
""", files={"hall.obj": HALL, "hedge.obj": HEDGE, "colours.mtl": COLOURS_OF_MESHES}, pictures=True)
        picture = runs.frame(run, "view", 720)
        ax.imshow(picture)
        ax.set_title(name)
        bare(ax)
    runs.save(figure, "worlds", colours=224, dpi=110)


def draw_seasons(runs: Runs) -> None:
    """Rows of Nebbiolo from winter to leaf fall."""
    stages = {0: "pruned (0)", 15: "five leaves (15)", 57: "before flowering (57)", 75: "pea-sized berries (75)", 84: "ripening (84)",
              94: "leaf fall (94)"}
    figure, axes = panels(2, 3, width=9.0, height=2.25)
    for ax, (stage, title) in zip(axes, stages.items()):
        run = runs.run(f"season_{stage}", f"""
vinerow: 1
name: season_{stage}
duration_s: 0.1
world: {{type: vineyard, row_count: 3, row_length_m: 24, relief_m: 0, waves_m: 0.1, centre_x_m: 0, centre_y_m: 0, row_bearing_deg: 90,
  missing_vine_share: 0, sun_azimuth_deg: 160, sun_elevation_deg: 38, vines: {{include: {ASSETS}/vines/nebbiolo.yaml, bbch: {stage}}}}}
vehicles: {{}}
pictures: {{width: 960, height: 720, shares: [1.0], cameras: {{view: {{kind: fixed, position_m: [-2.6, -4.6, 1.5], look_at_m: [0.4, -2.5, 1.05], fov_deg: 46}}}}}}
""", pictures=True)
        ax.imshow(runs.frame(run, "view", 640))
        ax.set_title(title)
        bare(ax)
    runs.save(figure, "seasons", colours=224, dpi=110)


def draw_orchard_seasons(runs: Runs) -> None:
    """Apple trees from winter to leaf fall, and ripe ones under clouds."""
    stages = {"dormant (0)": (0, 0), "full bloom (65)": (65, 0), "half-grown fruit (75)": (75, 0), "ripe (89)": (89, 0),
              "ripe, overcast": (89, 1), "leaf fall (95)": (95, 0)}
    figure, axes = panels(2, 3, width=9.0, height=2.25)
    for ax, (title, (stage, clouds)) in zip(axes, stages.items()):
        run = runs.run(f"orchard_season_{stage}_{clouds}", f"""
vinerow: 1
name: orchard_season
duration_s: 0.1
world: {{type: orchard, plant_rows: 2, row_length_m: 20, field_length_m: 24, field_width_m: 12, row_start_y_m: 2, tree_spacing_m: 1.6,
  row_width_m: 1.4, crown_base_m: 0.6, tree_height_m: 3, waves_m: 0.1, sun_azimuth_deg: 160, sun_elevation_deg: 38, cloud_cover: {clouds},
  leaves: {{crop: apple, bbch: {stage}, fruits: 90}}}}
vehicles: {{}}
pictures: {{width: 960, height: 720, shares: [1.0], cameras: {{view: {{kind: fixed, position_m: [0.6, 1.0, 1.7], look_at_m: [4.4, 6.5, 1.5], fov_deg: 46}}}}}}
""", pictures=True)
        ax.imshow(runs.frame(run, "view", 640))
        ax.set_title(title)
        bare(ax)
    runs.save(figure, "orchard_seasons", colours=224, dpi=110)


def draw_vehicles(runs: Runs) -> None:
    robot = LISTING.search((ROOT / "docs/tutorial/3_your_robot.md").read_text()).group(1)
    cases = {
        "diff_drive_rover": (f"include: {ASSETS}/vehicles/rover_paper_b.yaml", 4.4, 1.8, 0.0),
        "four_wheel_steering_rover": (f"include: {ASSETS}/vehicles/rover_paper_a.yaml", 4.6, 1.9, 0.0),
        "urdf_rover": ("type: urdf_rover\n    urdf: scout.urdf", 2.6, 1.0, 0.0),
        "quadrotor": (f"include: {ASSETS}/vehicles/quadrotor_q4t.yaml", 1.9, 0.8, 0.0),
        "fixed_wing": (f"include: {ASSETS}/vehicles/mh900_like.yaml\n    launch: air\n    start_height_m: 6", 1.7, 0.6, 0.0),
    }
    figure, axes = panels(2, 3, width=9.4, height=2.2)
    for ax, (name, (vehicle, distance, height, _)) in zip(axes, cases.items()):
        run = runs.run(f"vehicle_{name}", f"""
vinerow: 1
name: {name}
duration_s: 0.2
world: {{type: orchard, waves_m: 0}}
vehicles:
  v:
    {vehicle}
    spawn: {{x_m: 40, y_m: 4, yaw_deg: 20}}
pictures: {{width: 800, height: 600, shares: [1.0], cameras: {{view: {{kind: chase, vehicle: v, distance_m: {distance}, height_m: {height}, yaw_deg: 150,
  fov_deg: 42, show_trail: false, show_plan: false}}}}}}
""", files={"scout.urdf": robot}, pictures=True)
        picture = runs.frame(run, "view", 560)
        ax.imshow(picture)
        ax.set_title(name)
        bare(ax)
    axes[-1].set_visible(False)
    runs.save(figure, "vehicles", colours=224, dpi=110)
