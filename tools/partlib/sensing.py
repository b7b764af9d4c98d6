"""Sensors and estimators: readings against the truth of the same instant."""

import csv
import json
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from PIL import Image

from .runs import ASSETS, Runs
from .style import COLOURS, GREY, bare, panels

SENSORS = ASSETS / "sensors"
SMALL = "world: {type: vineyard, row_count: 4, row_length_m: 40, relief_m: 4}"


def allan(samples: np.ndarray, rate_Hz: float) -> tuple[np.ndarray, np.ndarray]:
    """Overlapping Allan deviation."""
    angle = np.concatenate([[0.0], np.cumsum(samples) / rate_Hz])
    lengths = np.unique(np.geomspace(1, len(samples) // 9, 60).astype(int))
    deviations = [np.sqrt(np.mean((angle[2 * m:] - 2 * angle[m:-m] + angle[:-2 * m])**2) / 2) * rate_Hz / m for m in lengths]
    return lengths / rate_Hz, np.array(deviations)


def draw_imu(runs: Runs) -> None:
    rate = 20.0
    run = runs.run("imu", f"""
vinerow: 1
name: imu
duration_s: 7200
physics: {{step_s: 0.0025}}
world: {{type: orchard, waves_m: 0, plant_rows: 2, row_length_m: 10, field_width_m: 60, field_length_m: 60}}
vehicles:
  rover:
    include: {ASSETS}/vehicles/rover_paper_b.yaml
    wheel_probes: 1
    spawn: {{x_m: -3, y_m: -3, yaw_deg: 0}}
    sensors:
      vn200: {{include: {SENSORS}/vn200_imu.yaml, rate_Hz: {rate}}}
      mti10: {{include: {SENSORS}/mti10_imu.yaml, rate_Hz: {rate}}}
record: {{truth_rate_Hz: 1}}
""")
    figure, (gyro, accelerometer) = panels(1, 2, height=3.4)
    sheets = {"vn200": ("VN-200", 0.0035, 6.0 / 3600, 0.001372931, 0.000392266), "mti10": ("MTi-10", 0.03, 18.0 / 3600, 0.000588399, 0.0001471)}
    for (name, (label, noise, bias, force_noise, force_bias)), colour in zip(sheets.items(), COLOURS):
        readings, truth = runs.arrays(run, f"/rover/{name}"), runs.arrays(run, f"/rover/{name}_truth")
        for axes, field, factor, n, b in ((gyro, "angular_velocity", np.degrees(1.0), noise, bias),
                                          (accelerometer, "linear_acceleration", 1.0, force_noise, force_bias)):
            for k, axis in enumerate("xyz"):
                tau, deviation = allan(factor * (readings[f"{field}.{axis}"] - truth[f"{field}.{axis}"]), rate)
                axes.loglog(tau, deviation, color=colour, lw=0.9, alpha=0.9, label=f"{label}, x, y, z" if k == 0 else None)
            axes.loglog(tau, n / np.sqrt(tau), "--", color=colour, lw=0.8)
            axes.axhline(0.664 * b, ls=":", color=colour, lw=0.9)
    gyro.set(title="Rate gyro", xlabel="averaging time, s", ylabel="Allan deviation, deg/s", xlim=(0.05, 800), ylim=(2e-4, 0.2))
    accelerometer.set(title="Accelerometer", xlabel="averaging time, s", ylabel="Allan deviation, m/s²", xlim=(0.05, 800), ylim=(3e-5, 1e-2))
    gyro.legend(loc="upper right", title="dashed: white noise; dotted: 0.664 B")
    runs.save(figure, "imu")


def drive(runs: Runs) -> object:
    """A rover with every positioning sensor drives three alleys of a small vineyard."""
    return runs.run("sensors", f"""
vinerow: 1
name: sensors
duration_s: 300
{SMALL}
vehicles:
  rover:
    include: {ASSETS}/vehicles/rover_paper_b.yaml
    spawn: {{alley: 0, offset_m: 12}}
    sensors:
      zed: {{include: {SENSORS}/zed_f9p_rtk.yaml, position_m: [0.2, 0, 0.9]}}
      neo: {{include: {SENSORS}/neo_m8n.yaml, position_m: [0.2, 0, 0.9]}}
      plain: {{type: gps, horizontal_std_m: 0.5, walk_std_m: 0.5}}
      ins: {{include: {SENSORS}/vn200_ins.yaml, rate_Hz: 20}}
      antennas: {{include: {SENSORS}/zed_f9p_moving_base.yaml, position_m: [-0.5, 0, 0.9]}}
      compass: {{include: {SENSORS}/rm3100.yaml, rate_Hz: 20}}
      pressure: {{include: {SENSORS}/bmp388.yaml, rate_Hz: 20}}
      turns: {{type: encoders, rate_Hz: 20}}
      gyro: {{include: {SENSORS}/mti10_imu.yaml, rate_Hz: 20}}
    planner: {{type: coverage, waypoint_pitch_m: 0.25, headland_m: 4}}
    controller: {{type: path_follower, rate_Hz: 40, speed_mps: 1.0, turn_rate_radps: 0.4}}
""")


def draw_positions(runs: Runs) -> None:
    run = drive(runs)
    figure, axes = panels(2, 2, height=2.1, sharex=True)
    for ax, (name, label) in zip(axes, (("zed", "gnss, ZED-F9P with corrections"), ("neo", "gnss, NEO-M8N"), ("plain", "gps, white and slow part 0.5 m each"),
                                        ("ins", "ins, VN-200"))):
        if name == "ins":
            times, place = runs.positions(run, "/rover/ins")
            _, truth = runs.positions(run, "/rover/ins_truth")
        else:
            readings, exact = (runs.arrays(run, f"/rover/{name}{end}/exact") for end in ("", "_truth"))
            times, *both = np.intersect1d(readings["time_s"], exact["time_s"], return_indices=True)
            place, truth = (np.stack([table[f"position.{axis}"][k] for axis in "xyz"], axis=1) for table, k in zip((readings, exact), both))
        for k, axis in enumerate(("east", "north", "up")):
            ax.plot(times, place[:, k] - truth[:, k], color=COLOURS[k], lw=0.8, label=axis)
        ax.set(title=label, ylabel="error, m")
    axes[0].legend(ncols=3, loc="upper left", fontsize=7.5)
    for ax in axes[2:]:
        ax.set_xlabel("time, s")
    runs.save(figure, "positions")


def draw_sensor_errors(runs: Runs) -> None:
    run = drive(runs)
    flight = runs.run("guidance_wing", "survey_still", "pictures=null", "criteria=[]")
    figure, axes = panels(2, 3, height=2.0)

    def pair(name, *fields, run=run, vehicle="rover"):
        readings, truth = runs.arrays(run, f"/{vehicle}/{name}"), runs.arrays(run, f"/{vehicle}/{name}_truth")
        times, one, other = np.intersect1d(readings["time_s"], truth["time_s"], return_indices=True)
        return times, [(readings[field][one], truth[field][other]) for field in fields]

    times, ((heading, true_heading),) = pair("antennas", "heading")
    axes[0].plot(times, np.degrees((heading - true_heading + np.pi) % (2 * np.pi) - np.pi), lw=0.8)
    axes[0].set(title="gnss_heading", ylabel="heading error, deg")
    times, fields = pair("compass", "magnetic_field.x", "magnetic_field.y")
    turned = [np.arctan2(y, x) for x, y in zip(*fields)]
    axes[1].plot(times, np.degrees((turned[1] - turned[0] + np.pi) % (2 * np.pi) - np.pi), lw=0.5)
    axes[1].set(title="magnetometer", ylabel="heading error, deg")
    times, ((pressure, true_pressure),) = pair("pressure", "fluid_pressure")
    axes[2].plot(times, -(pressure - true_pressure) / 12.0, lw=0.5)
    axes[2].set(title="barometer", ylabel="height error, m")
    times, ((spin, true_spin),) = pair("turns", "wheel_fl_speed_radps")
    axes[3].plot(times, spin - true_spin, lw=0.4)
    axes[3].set(title="encoders", ylabel="wheel speed error, rad/s", xlabel="time, s")
    times, ((speed, true_speed),) = pair("pitot", "vector.x", run=flight, vehicle="plane")
    axes[4].plot(times, speed - true_speed, lw=0.5)
    axes[4].set(title="air_data, fixed wing in flight", ylabel="airspeed error, m/s", xlabel="time, s")
    times, ((rate, true_rate),) = pair("gyro", "angular_velocity.z")
    axes[5].plot(times, np.degrees(rate - true_rate), lw=0.4)
    axes[5].set(title="imu, MTi-10", ylabel="yaw rate error, deg/s", xlabel="time, s")
    runs.save(figure, "sensor_errors")


def draw_ranges(runs: Runs) -> None:
    run = runs.run("ranges", f"""
vinerow: 1
name: ranges
duration_s: 20
world: {{type: vineyard, row_count: 4, row_length_m: 30, relief_m: 0, occupancy_cell_m: 0.05, row_bearing_deg: 90,
  obstacles: [{{name: crate, alley: 1, distance_m: 13.5, lateral_m: 0.2, size_m: [0.6, 0.4, 0.6], mapped: true}}]}}
vehicles:
  rover:
    include: {ASSETS}/vehicles/rover_paper_b.yaml
    spawn: {{alley: 1, offset_m: -10}}
    sensors:
      lidar: {{include: {SENSORS}/sick_tim571.yaml, rate_Hz: 10, position_m: [0.5, 0, 0.5]}}
      front: {{include: {SENSORS}/hc_sr04.yaml, position_m: [0.8, 0, 0.25]}}
      left: {{include: {SENSORS}/hc_sr04.yaml, position_m: [0, 0.3, 0.5], rotation_deg: [0, 0, 90]}}
      right: {{include: {SENSORS}/hc_sr04.yaml, position_m: [0, -0.3, 0.5], rotation_deg: [0, 0, -90]}}
""")
    figure, (plane, series) = panels(1, 2, height=3.3, width_ratios=[1.5, 1])
    scan = runs.arrays(run, "/rover/lidar")
    k = 10
    angle = scan["angle_min"][k] + scan["angle_increment"][k] * np.arange(scan["ranges"].shape[1])
    _, place = runs.positions(run, "/rover/truth")
    odometry = runs.arrays(run, "/rover/truth")
    yaw = 2 * np.arctan2(odometry["pose.pose.orientation.z"][-1], odometry["pose.pose.orientation.w"][-1])

    def local(points):
        """World to the sensor's place, x ahead."""
        turned = points @ np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        return turned

    occupied, (x0, x1, y0, y1) = runs.grid(run)
    rows, columns = np.nonzero(occupied)
    cell = (x1 - x0) / occupied.shape[1]
    cells = local(np.stack([x0 + (columns + 0.5) * cell, y0 + (rows + 0.5) * cell], axis=1) - place[-1, :2]) - [0.5, 0]
    plane.plot(cells[:, 0], cells[:, 1], "s", color="0.85", ms=1.6, mew=0, label="map: canopy, crate, boundary")
    hit = np.isfinite(scan["ranges"][k])
    r = scan["ranges"][k][hit]
    plane.plot(r * np.cos(angle[hit]), r * np.sin(angle[hit]), ".", color=COLOURS[0], ms=2.5, label="lidar, one scan")
    for name, (x, y), turn, colour in (("front", (0.3, 0), 0, COLOURS[1]), ("left", (-0.5, 0.3), np.pi / 2, COLOURS[2]),
                                       ("right", (-0.5, -0.3), -np.pi / 2, COLOURS[3])):
        table = runs.arrays(run, f"/rover/{name}")
        echo = np.nanmedian(np.where(np.isfinite(table["range"]), table["range"], np.nan))
        wide = np.linspace(-np.radians(7.5), np.radians(7.5), 15)
        if np.isfinite(echo):
            plane.fill(np.concatenate([[x], x + echo * np.cos(turn + wide)]), np.concatenate([[y], y + echo * np.sin(turn + wide)]), color=colour,
                       alpha=0.35, lw=0)
        series.plot(table["time_s"], table["range"], ".", color=colour, ms=2.5, label=f"ultrasound, {name}")
    plane.plot([0.3, -1.3, -1.3, 0.3, 0.3], [0.4, 0.4, -0.4, -0.4, 0.4], color="k", lw=1.0)
    plane.set(title="Seen by a rover in an alley", xlabel="ahead of the lidar, m", ylabel="to the left, m", xlim=(-7, 8), ylim=(-5, 5), aspect="equal")
    plane.legend(loc="upper left", fontsize=7)
    series.set(title="Echoes of a standing rover", xlabel="time, s", ylabel="range, m", xlim=(0, 20), ylim=(0, None))
    series.legend(loc="center right", fontsize=7.5)
    runs.save(figure, "ranges")


RANGERS = "\n".join(f"      us_{name}: {{include: {SENSORS}/hc_sr04.yaml, position_m: [{x}, {y}, 0.75], rotation_deg: [0, 0, {turn}]}}"
                    for name, x, y, turn in (("fl", 0.4, 0.2, 45), ("fr", 0.4, -0.2, -45), ("rl", -0.4, 0.2, 135), ("rr", -0.4, -0.2, -135)))


def draw_clouds(runs: Runs) -> None:
    """A frame of a VLP-16 in an alley before flowering and in summer: the row on its left."""
    figure, axes = panels(2, 1, width=9.0, height=1.7)
    for ax, (stage, title) in zip(axes, {57: "before flowering (57)", 75: "pea-sized berries (75)"}.items()):
        run = runs.run(f"cloud_{stage}", f"""
vinerow: 1
name: cloud_{stage}
duration_s: 0.3
world: {{type: vineyard, row_count: 4, row_length_m: 30, relief_m: 0, row_bearing_deg: 90, vines: {{include: {ASSETS}/vines/nebbiolo.yaml,
  bbch: {stage}}}}}
vehicles:
  rover:
    include: {ASSETS}/vehicles/rover_paper_b.yaml
    spawn: {{alley: 1, offset_m: -15}}
    sensors: {{lidar: {{include: {SENSORS}/vlp16.yaml, position_m: [0.3, 0, 0.9]}}}}
""")
        cloud = runs.arrays(run, "/rover/lidar")
        last = cloud["time_s"] == cloud["time_s"][-1]
        x, y, z, intensity = (cloud[name][last] for name in ("x", "y", "z", "intensity"))
        shown = (y > 0.6) & (y < 2.0) & (np.abs(x) < 7)
        points = ax.scatter(x[shown], z[shown], c=intensity[shown], s=1.5, cmap="viridis", vmin=0, vmax=45, linewidths=0)
        ax.set_aspect("equal")
        ax.set_title(title)
        ax.set_ylabel("above the scanner, m")
    axes[-1].set_xlabel("along the row, m")
    figure.colorbar(points, ax=list(axes), label="intensity, %", fraction=0.02, pad=0.01)
    runs.save(figure, "clouds")


# sky, ground, leaf, wood, bunch, fruit, post, wire, obstacle, vehicle, person, weed
LABEL_COLOURS = np.array([[150, 190, 235], [176, 146, 102], [70, 150, 60], [102, 66, 40], [122, 44, 140], [214, 90, 48], [190, 192, 196],
                          [240, 220, 70], [220, 40, 40], [30, 90, 200], [240, 90, 190], [150, 220, 60]], np.uint8)  # fmt: skip


def draw_camera(runs: Runs) -> None:
    """One picture of a camera in an alley: colours, depth, labels and things."""
    run = runs.run("camera", "vineyard_camera", "duration_s=2.5", "vehicles.rover.sensors.front.width_px=640",
                   "vehicles.rover.sensors.front.height_px=480", "vehicles.rover.sensors.front.fx_px=607.3",
                   "vehicles.rover.sensors.front.fy_px=607.6", "vehicles.rover.sensors.front.cx_px=320.6",
                   "vehicles.rover.sensors.front.cy_px=241.2", "vehicles.rover.sensors.front.samples=4")  # fmt: skip
    folder = run.parent / "pictures"
    layers = {"front": "colours", "front_depth": "depth", "front_semantic": "labels", "front_instance": "things"}
    for layer in layers:
        runs.call("export", run, "--topic", f"/rover/{layer}", "-o", folder)
    figure, axes = panels(2, 2, width=8.6, height=3.25)
    for ax, (layer, title) in zip(axes, layers.items()):
        picture = np.array(Image.open(sorted((folder / f"rover_{layer}").glob("*.png"))[-1]))
        bare(ax)
        ax.set_title(title)
        if layer == "front_depth":
            depth = np.where(picture == 0, np.nan, picture / 1000.0)
            shown = ax.imshow(depth, cmap="viridis_r", vmin=0, vmax=15)
            figure.colorbar(shown, ax=ax, label="m", fraction=0.035, pad=0.01)
        elif layer == "front_semantic":
            ax.imshow(LABEL_COLOURS[picture])
        elif layer == "front_instance":
            number = picture.astype(np.uint32) @ np.array([1, 256, 65536], np.uint32)
            mixed = number * np.uint32(2654435761)
            ax.imshow(np.where(number[..., None] < 2, 40, np.stack([mixed >> 24, mixed >> 16 & 255, mixed >> 8 & 255], axis=-1)).astype(np.uint8))
        else:
            ax.imshow(picture)
    runs.save(figure, "camera")


def draw_net(runs: Runs) -> None:
    """What the net of vineyard_row_net sees and finds, in winter and in summer, beside the exact labels."""
    layers = {"front": "colours", "net_labels": "labels of the net", "front_semantic": "exact labels"}
    figure, axes = panels(2, 3, width=8.6, height=2.2)
    axes = iter(axes)
    for season, bbch in (("winter", 0), ("ripening", 85)):
        run = runs.run(f"net_{bbch}", "vineyard_row_net", "duration_s=6", f"world.vines.bbch={bbch}",
                       "vehicles.rover.sensors.front.semantic=true")  # fmt: skip
        for layer, title in layers.items():
            runs.call("export", run, "--topic", f"/rover/{layer}", "-o", run.parent / "pictures")
            picture = np.array(Image.open(sorted((run.parent / "pictures" / f"rover_{layer}").glob("*.png"))[-1]))
            ax = next(axes)
            bare(ax)
            ax.set_title(f"{season}: {title}")
            ax.imshow(picture if layer == "front" else LABEL_COLOURS[picture], interpolation="nearest")
    runs.save(figure, "net")


def make_dataset(runs: Runs, name: str) -> tuple[Path, list[dict[str, str]]]:
    """Folder of a shipped data set, and its pictures for training."""
    study = ASSETS / "studies" / f"{name}.yaml"
    out = runs.once(name, study.read_text(encoding="utf-8"), lambda folder: runs.call(
        "dataset", study, "--out", folder / "out", "--quiet")) / "out"
    with (out / "pictures.csv").open(encoding="utf-8", newline="") as file:
        return out, [row for row in csv.DictReader(file) if row["part"] == "train"]


def show_labelled(ax: Axes, out: Path, picture_name: str, colours: dict[int, tuple[int, int, int]]) -> None:
    """A picture with the masks and boxes of what is listed in it. colours: of each category's number."""
    notes = json.loads((out / "annotations" / "instances_train.json").read_text(encoding="utf-8"))
    picture = np.array(Image.open(out / "images" / "train" / picture_name)).astype(float)
    things = np.array(Image.open(out / "instances" / "train" / picture_name)).astype(np.uint32) @ np.array([1, 256, 65536], np.uint32)
    bare(ax)
    for a in notes["annotations"]:
        if a["image_id"] != int(picture_name[:6]):
            continue
        colour = np.array(colours[a["category_id"]])
        inside = things == a["thing"]
        picture[inside] = 0.5 * picture[inside] + 0.5 * colour
        x, y, w, h = a["bbox"]
        ax.add_patch(Rectangle((x - 0.5, y - 0.5), w, h, fill=False, edgecolor=colour / 255, linewidth=0.6))
    ax.imshow(picture.astype(np.uint8))


def draw_dataset(runs: Runs) -> None:
    """Pictures of the shipped data set with what is listed in them."""
    out, rows = make_dataset(runs, "vineyard_dataset")
    keypoints = json.loads((out / "annotations" / "keypoints_train.json").read_text(encoding="utf-8"))
    figure, axes = panels(1, 2, width=8.6, height=3.4)
    for ax, season in zip(axes, ("harvest", "flowering")):
        picture = [row for row in rows if row["season"] == season][2]["picture"]
        show_labelled(ax, out, picture, {1: (150, 40, 235), 2: (255, 150, 0), 3: (0, 205, 245)})
        ax.set_title(season)
        for a in keypoints["annotations"]:
            points = np.array(a["keypoints"]).reshape(-1, 3)
            for u, v, seen in points[points[:, 2] > 0] if a["image_id"] == int(picture[:6]) else ():
                ax.plot(u, v, "o", markersize=3, color="#20d040" if seen == 2 else "#e02020", markeredgecolor="black", markeredgewidth=0.4)
    runs.save(figure, "dataset", colours=160)


def draw_weeds(runs: Runs) -> None:
    """Weeds of the shipped data set with their masks and boxes."""
    out, rows = make_dataset(runs, "weed_dataset")
    figure, axes = panels(1, 2, width=8.6, height=3.4)
    for ax, season in zip(axes, ("five leaves", "ripening")):
        picture = [row for row in rows if row["season"] == season and row["weeds"] == "many"][2]["picture"]
        show_labelled(ax, out, picture, {1: (255, 40, 40), 2: (255, 150, 0)})
        ax.set_title(f"{season}, 16 plants per m²")
    runs.save(figure, "weeds", colours=160)


def draw_estimators(runs: Runs) -> None:
    run = runs.run("estimators", f"""
vinerow: 1
name: estimators
duration_s: 200
world: {{type: vineyard, row_count: 4, row_length_m: 40, row_bearing_deg: 90, relief_m: 2, canopy_variation: 0.25}}
vehicles:
  rover:
    include: {ASSETS}/vehicles/rover_paper_a.yaml
    spawn: {{alley: 0, offset_m: 1}}
    map: {{type: row_mesh, section_spacing_m: [0.4, 0.5], stated_surface_std_m: 0.03}}
    sensors:
      ins: {{include: {SENSORS}/vn200_ins.yaml, rate_Hz: 100}}
      imu: {{include: {SENSORS}/vn200_imu.yaml, rate_Hz: 100}}
      encoders: {{type: encoders, rate_Hz: 50}}
      gps: {{type: gps, rate_Hz: 5, horizontal_std_m: 1.0, vertical_std_m: 1.5}}
{RANGERS}
    observers:
      gps_pose: {{type: gps_pose, rate_Hz: 20}}
      odometry: {{type: odometry_filter, rate_Hz: 20, gps_std_m: 1.0}}
      inertial: {{type: error_state_kalman, rate_Hz: 100, wheels: encoders}}
      distance: {{type: distance_filter, rate_Hz: 100, ranges: [us_fl, us_fr, us_rl, us_rr]}}
      bank: {{type: map_localisation, rate_Hz: 100, ranges: [us_fl, us_fr, us_rl, us_rr]}}
    planner: {{type: coverage, alleys: [0, 1], turn: dubins, headland_m: 2}}
    controller: {{type: four_wheel_steering, rate_Hz: 50, speed_mps: 1.0, turn_speed_mps: 0.8}}
""")
    figure, axes = panels(5, 1, width=8.6, height=1.25, sharex=True)
    for ax, (name, label) in zip(axes, (("gps_pose", "gps_pose"), ("odometry", "odometry_filter"), ("inertial", "error_state_kalman"),
                                        ("distance", "distance_filter"), ("bank", "map_localisation"))):
        times, place = runs.positions(run, f"/rover/{name}")
        true_times, truth = runs.positions(run, "/rover/truth")
        error = place[:, 1] - np.interp(times, true_times, truth[:, 1])  # rows run east
        sigma = np.sqrt(runs.arrays(run, f"/rover/{name}")["pose.covariance"][:, 7])
        ax.fill_between(times, -2 * sigma, 2 * sigma, color=COLOURS[0], alpha=0.2, lw=0, label="±2σ stated")
        ax.plot(times, error, color=COLOURS[0], lw=0.9, label="error")
        ax.set(title=label, ylabel="m")
        ax.set_ylim((-2.5, 2.5) if name == "gps_pose" else (-1, 1) if name in ("odometry", "inertial") else (-0.25, 0.25))
        end = truth[:, 0]
        out = np.interp(times, true_times, ((end < np.percentile(end, 8)) | (end > np.percentile(end, 92))).astype(float)) > 0.5
        ax.fill_between(times, -3, 3, where=out, color="0.93", lw=0, zorder=0)
    axes[0].legend(ncols=2, loc="upper right")
    axes[-1].set_xlabel("time, s")
    runs.save(figure, "estimators")


def draw_localisation(runs: Runs) -> None:
    figure, axes = panels(1, 1, width=6.6, height=3.4)
    edges = np.concatenate([np.arange(-14, 6.1, 1.0)])
    names = {"no_map": "fixes and inertial unit alone", "range_ekf": "distance_filter", "map_localisation": "map_localisation"}
    samples = {name: ([], []) for name in names}
    for seed in range(1, 4):
        run = runs.run(f"lane_{seed}", "localisation_m100", "world.row_length_m=30", "world.relief_m=6", "drone.planner.alleys=[0, 1]",
                       "drone.planner.turns=dubins", "drone.planner.beyond_m=4", "drone.observers.paper_c=null", "drone.observers.paper_c_no_map=null", "pictures=null",
                       "criteria=[]", "world.occupancy_cell_m=0", seed=seed)
        true_times, truth = runs.positions(run, "/drone/truth")
        # Rows at a bearing of 120 deg: along them s, 0 at their far end.
        along = truth[:, :2] @ np.array([np.sin(np.radians(120)), np.cos(np.radians(120))])
        far = along.max() - 4 - 1.77
        for name, (distances, errors) in samples.items():
            times, place = runs.positions(run, f"/drone/{name}")
            s = np.interp(times, true_times, along) - far
            error = np.hypot(*(place[:, k] - np.interp(times, true_times, truth[:, k]) for k in range(2)))
            # From the first alley's second half on, until the second alley's first half ends.
            turn = np.argmax(np.interp(times, true_times, along))
            near = (s > -14) & (np.arange(len(s)) > 0.2 * turn)
            distances.append(s[near])
            errors.append(error[near])
    for (name, label), colour in zip(names.items(), ("0.5", COLOURS[1], COLOURS[0])):
        s, e = (np.concatenate(part) for part in samples[name])
        which = np.digitize(s, edges)
        rows = np.array([(s[which == k].mean(), *np.percentile(e[which == k], [50, 90])) for k in range(1, len(edges)) if np.any(which == k)])
        axes[0].plot(rows[:, 0], rows[:, 1], color=colour, label=label)
        axes[0].fill_between(rows[:, 0], rows[:, 1], rows[:, 2], color=colour, alpha=0.18, lw=0)
    axes[0].axvline(0, color=GREY, lw=0.8, ls=":")
    axes[0].set(title="Horizontal error at a row's end", xlabel="distance beyond the end of the rows, m", ylabel="error, m", xlim=(-14, 6), ylim=(0, 1.0))
    axes[0].text(0.15, 0.95, "headland", color=GREY, fontsize=8)
    axes[0].text(-0.15, 0.95, "alley", color=GREY, fontsize=8, ha="right")
    axes[0].legend(loc="upper left")
    runs.save(figure, "localisation")
