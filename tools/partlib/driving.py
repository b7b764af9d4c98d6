"""Planners, guidance, controllers."""

import numpy as np
from matplotlib.patches import Rectangle

from .runs import ASSETS, Runs
from .style import COLOURS, GREY, panels

WORLD = "world: {type: vineyard, row_count: 5, row_length_m: 24, row_bearing_deg: 90, relief_m: 1.5}"
PLAIN = {"rover": f"include: {ASSETS}/vehicles/rover_paper_b.yaml", "steered": f"include: {ASSETS}/vehicles/rover_paper_a.yaml",
         "drone": f"include: {ASSETS}/vehicles/quadrotor_q4t.yaml", "plane": f"include: {ASSETS}/vehicles/mh900_like.yaml"}


def draw_planners(runs: Runs) -> None:
    # Waypoints of Mission Planner's text, relative to home at the world's origin.
    degrees = 1 / 111_132.0
    latitude, longitude = 44.61535, 7.9253
    east = degrees / np.cos(np.radians(latitude))
    points = [(52, 37.65), (90, 37.65), (90, 40.15), (52, 40.15), (51, 45)]
    lines = ["QGC WPL 110", f"0\t1\t0\t16\t0\t0\t0\t0\t{latitude:.7f}\t{longitude:.7f}\t0\t1"]
    lines += [f"{i + 1}\t0\t3\t16\t0\t0\t0\t0\t{latitude + y * degrees:.7f}\t{longitude + x * east:.7f}\t0\t1" for i, (x, y) in enumerate(points)]
    cases = [
        ("coverage", "rover", "{type: coverage, headland_m: 1.5}", ""),
        ("waypoints", "rover", "{type: waypoints, x_m: [52, 52, 57, 90.5], y_m: [33, 37.65, 37.65, 37.65]}", ""),
        ("go_to", "steered", "{type: go_to, x_m: [71, 71], y_m: [37.65, 40.15]}", ""),
        ("mission_file", "rover", "{type: mission_file, file: mission.waypoints}", ""),
        ("rrt_star", "steered", "{type: rrt_star, alleys: [0, 1, 2]}", ""),
        ("rrt_quartile", "steered", "{type: rrt_quartile, alleys: [0, 1, 2], smooth: false}", ""),
        ("row_flight", "drone", "{type: row_flight}", "guidance: {type: trajectory}"),
        ("survey", "plane", "{type: survey, height_m: 120, margin_m: 30}", "guidance: {type: waypoint_guidance}"),
    ]
    controllers = {"rover": "path_follower", "steered": "four_wheel_steering", "drone": "quadrotor_pid", "plane": "fixed_wing_pid"}
    figure, axes = panels(2, 4, width=9.6, height=1.7)
    for ax, (name, vehicle, planner, extra) in zip(axes, cases):
        start = "{alley: 0, offset_m: 3}" if name not in ("waypoints", "mission_file", "survey", "go_to") else \
            "{x_m: 0, y_m: 0, yaw_deg: 90}" if name == "survey" else "{alley: 0, offset_m: 3}"
        world = WORLD.replace("relief_m: 1.5", "relief_m: 1.5, surroundings_m: 200") if name == "survey" else WORLD.replace(
            "relief_m: 1.5", "relief_m: 1.5, surroundings_m: 12")
        run = runs.run(f"planner_{name}", f"""
vinerow: 1
name: planner
duration_s: 1.5
physics: {{step_s: 0.001}}
{world.replace("{type: vineyard", f"{{type: vineyard, origin_latitude_deg: {latitude}, origin_longitude_deg: {longitude}")}
vehicles:
  v:
    {PLAIN[vehicle]}
    spawn: {start}
    planner: {planner}
    {extra}
    controller: {{type: {controllers[vehicle]}}}
""", files={"mission.waypoints": "\n".join(lines) + "\n"})
        plan = runs.plan(run, "v")
        occupied, extent = runs.grid(run)
        ax.imshow(np.where(occupied, 0.82, 1.0), extent=extent, origin="lower", cmap="gray", vmin=0, vmax=1, interpolation="nearest")
        if name in ("rrt_star", "rrt_quartile"):
            tree = runs.arrays(run, "/v/plan_tree")
            x, y = tree["points.x"], tree["points.y"]
            ax.plot(np.stack([x[0::2], x[1::2], np.full(len(x) // 2, np.nan)], 1).ravel(),
                    np.stack([y[0::2], y[1::2], np.full(len(y) // 2, np.nan)], 1).ravel(), color=COLOURS[2], lw=0.35, alpha=0.7)
        ax.plot(plan[:, 0], plan[:, 1], color=COLOURS[0], lw=1.3)
        ax.plot(*plan[0, :2], "o", color=COLOURS[1], ms=4)
        ax.plot(*plan[-1, :2], "s", color=COLOURS[4], ms=3.5)
        margin = 12 if name == "survey" else 1.5
        low, high = np.minimum(plan.min(0)[:2], [extent[0], extent[2]]), np.maximum(plan.max(0)[:2], [extent[1], extent[3]])
        ax.set(title=name, aspect="equal", xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))
        ax.tick_params(labelsize=7)
        ax.grid(False)
    runs.save(figure, "planners")


def draw_guidance(runs: Runs) -> None:
    figure, (avoid, law, height) = panels(1, 3, width=9.6, height=2.9, width_ratios=[1, 1, 1.1])
    run = runs.run("guidance_dwa", "vineyard_4ws_obstacle", "duration_s=60", "pictures=null", "criteria=[]")
    times, place = runs.positions(run, "/rover/truth")
    plan = runs.plan(run, "rover")
    ahead = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(plan[:, :2], axis=0).T))])
    direction = plan[np.searchsorted(ahead, 30)] - plan[np.searchsorted(ahead, 20)]
    direction = direction[:2] / np.hypot(*direction[:2])
    across = np.array([-direction[1], direction[0]])
    origin = plan[np.searchsorted(ahead, 3.0), :2]  # first row's end: the spawn is 2 m before it
    s, e = (place[:, :2] - origin) @ direction, (place[:, :2] - origin) @ across
    avoid.plot(s, e, color=COLOURS[0], label="driven")
    avoid.axhline(0, color=GREY, ls="--", lw=0.9, label="plan")
    avoid.set(title="dwa: around a crate", xlabel="along the alley, m", ylabel="to the left, m", xlim=(28, 50), ylim=(-1.25, 1.25))
    avoid.add_patch(Rectangle((39.7, 0.58), 0.6, 0.4, color=COLOURS[1], lw=0))
    avoid.text(40.6, 0.72, "crate", fontsize=8, color=COLOURS[1])
    avoid.legend(loc="lower right")

    run = runs.run("guidance_trajectory", "vineyard_quadrotor_two_rows", "pictures=null", "criteria=[]")
    reference, odometry = runs.arrays(run, "/drone/reference/exact"), runs.arrays(run, "/drone/truth")
    times, place = runs.positions(run, "/drone/truth")
    speed = np.linalg.norm(np.stack([odometry[f"twist.twist.linear.{axis}"] for axis in "xyz"], 1), axis=1)
    law.plot(times, speed, color=COLOURS[0], lw=1.0, label="flown")
    fields = [f"points.velocity.{axis}" for axis in "xyz"]
    first = reference["element"] == 0
    wanted = np.linalg.norm(np.stack([reference[name][first] for name in fields], 1), axis=1)
    law.plot(reference["time_s"][first], wanted, color=COLOURS[1], lw=0.9, ls="--", label="reference")
    law.set(title="trajectory: two rows, home", xlabel="time, s", ylabel="speed, m/s", xlim=(0, times[-1]), ylim=(0, 4.2))
    law.legend(loc="upper right", ncols=2)

    run = runs.run("guidance_wing", "survey_still", "pictures=null", "criteria=[]")
    reference = runs.arrays(run, "/plane/reference")
    times, place = runs.positions(run, "/plane/truth")
    altitude = next(name for name in reference if name in ("height", "altitude", "position.z") or name.endswith("height"))
    height.plot(times, place[:, 2], color=COLOURS[0], lw=1.0, label="flown")
    height.plot(reference["time_s"], reference[altitude], color=COLOURS[1], lw=0.9, ls="--", label="reference")
    height.set(title="waypoint_guidance: a survey", xlabel="time, s", ylabel="z, m", xlim=(0, times[-1]))
    height.legend(loc="lower center")
    runs.save(figure, "guidance")


def draw_controllers(runs: Runs) -> None:
    figure, (ground, rotors, wings) = panels(3, 1, width=8.6, height=2.1)
    for (name, vehicle), colour in zip((("pure_pursuit", "rover"), ("path_follower", "rover"), ("four_wheel_steering", "steered")), COLOURS):
        run = runs.run(f"controller_{name}", f"""
vinerow: 1
name: controller
duration_s: 200
world: {{type: vineyard, row_count: 4, row_length_m: 24, row_bearing_deg: 90, relief_m: 3, surroundings_m: 12}}
vehicles:
  v:
    {PLAIN[vehicle]}
    spawn: {{alley: 0, offset_m: 3}}
    planner: {{type: coverage, headland_m: 3, turn: dubins, turn_radius_m: 1.95}}
    controller: {{type: {name}, speed_mps: 1.0}}
""")
        follower = runs.arrays(run, "/v/follower")
        ground.plot(follower["distance"], 1000 * follower["lateral_error"], color=colour, lw=1.0, label=name)
    ground.set(title="Rovers: three alleys and two turns on a slope", xlabel="distance along the plan, m", ylabel="lateral error, mm", xlim=(0, None),
               ylim=(-500, 500))
    for name, colour in zip(("quadrotor_pid", "quadrotor_lqr", "quadrotor_mpc"), COLOURS):
        rate = {"quadrotor_pid": 250, "quadrotor_lqr": 50, "quadrotor_mpc": 20}[name]
        run = runs.run(f"controller_{name}", "vineyard_quadrotor_two_rows", f"drone.controller={{type: {name}, rate_Hz: {rate}}}", "pictures=null",
                       "criteria=[]")
        follower = runs.arrays(run, "/drone/follower")
        rotors.plot(follower["time_s"], 1000 * follower["lateral_error"], color=colour, lw=0.8, label=name)
    rotors.set(title="Quadrotor: two rows and home in gusty wind", xlabel="time, s", ylabel="lateral error, mm", xlim=(0, 110), ylim=(-80, 80))
    for name, colour in zip(("fixed_wing_pid", "fixed_wing_lqr", "mpc_nominal", "trmpc"), COLOURS):
        extra = ", horizon: 60" if name in ("trmpc", "mpc_nominal") else ""
        run = runs.run(f"controller_{name}", "trmpc_stress", f"plane.controller={{type: {name}, rate_Hz: 20{extra}}}", "pictures=null", "criteria=[]")
        times, place = runs.positions(run, "/plane/truth")
        wings.plot(times, place[:, 2] - 153.86, color=colour, lw=1.0, label=name)
    wings.set(title="Fixed wing: start 14 m too low and 24° off, in wind", xlabel="time, s", ylabel="height error, m", xlim=(0, 30))
    for ax in (ground, rotors, wings):
        ax.legend(loc="lower right" if ax is wings else "upper right", ncols=4)
    runs.save(figure, "controllers")
