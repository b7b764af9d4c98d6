"""Models of vehicles and wind: forces that a run has, over what causes them."""

import numpy as np

from .runs import ASSETS, Runs, resolved_number
from .style import COLOURS, GREY, panels

FLAT = "world: {type: orchard, waves_m: 0, plant_rows: 2, row_length_m: 10, field_width_m: 60, field_length_m: 60}"


def ramp(a_m: float = 100.0, length_m: float = 190.0, width_m: float = 60.0) -> str:
    """Ground z = x²/2a as an OBJ file: its slope at x is x/a. Level at negative x, y to both sides."""
    x = np.concatenate([[-20.0], np.arange(0.0, length_m + 0.1, 0.5)])
    z = np.where(x > 0, x**2 / (2 * a_m), 0.0)
    lines = [f"v {xi:.3f} {y:.1f} {zi:.6f}" for y in (-width_m, width_m) for xi, zi in zip(x, z)]
    n = len(x)
    lines += [f"f {i + 1} {i + 2} {n + i + 2}\nf {i + 1} {n + i + 2} {n + i + 1}" for i in range(n - 1)]
    return "\n".join(lines) + "\n"


def slope_run(runs: Runs, name: str, soil: str, path: str, start: str) -> dict:
    """Wheel values of a rover on the ramp."""
    scenario = f"""
vinerow: 1
name: {name}
duration_s: 260
physics: {{step_s: 0.001}}
world: {{type: mesh, items: [{{file: ramp.obj, up_axis: z, surface: terrain}}], ground: none, terrain_cell_m: 0.5, soil: {soil}}}
vehicles:
  rover:
    include: {ASSETS}/vehicles/rover_paper_b.yaml
    max_torque_Nm: 1000
    max_power_W: 20000
    spawn: {start}
    planner: {path}
    controller: {{type: path_follower, rate_Hz: 40, speed_mps: 1.0, lost_m: 50, speed_gain: 0, slip_learn_s: 0}}
record: {{truth_rate_Hz: 100}}
"""
    run = runs.run(name, scenario, files={"ramp.obj": ramp()}, allowed=(0, 1, 3))
    return runs.arrays(run, "/rover/wheels")


SOILS = {"asphalt": (0.85, 0.75, 22, 15), "dry_grass": (0.75, 0.65, 15, 10), "wet_soil": (0.50, 0.40, 9, 6)}  # docs/models/tyre.md


def draw_tyre(runs: Runs) -> None:
    figure, (along, across) = panels(1, 2, height=3.4)
    for (soil, (peak, slide, c_x, c_y)), colour in zip(SOILS.items(), COLOURS):
        up = slope_run(runs, f"tyre_{soil}_up", soil, "{type: waypoints, x_m: [0, 185], y_m: [0, 0]}", "{x_m: -6, y_m: 0, yaw_deg: 0}")
        side = slope_run(runs, f"tyre_{soil}_side", soil, "{type: waypoints, x_m: [2, 90], y_m: [-58, 58]}",
                         "{x_m: 2, y_m: -58, yaw_deg: 53}")
        slip = np.linspace(0, 1.0, 200)
        mu = slide + (peak - slide) * np.exp(-slip**2)  # v_stribeck 1 m/s, rim at 1 m/s
        along.plot(slip, mu * (1 - np.exp(-c_x * slip / mu)), color=colour, lw=1.2, label=soil)
        angle = np.radians(np.linspace(0, 5, 200))
        mu = slide + (peak - slide) * np.exp(-np.sin(angle)**2)
        across.plot(np.degrees(angle), mu * (1 - np.exp(-c_y * np.tan(angle) / mu)), color=colour, lw=1.2)
        for wheel in ("rl", "rr"):
            load = up[f"wheel_{wheel}_load_N"]
            moving = (load > 50) & (up["time_s"] > 5)
            along.plot(up[f"wheel_{wheel}_slip"][moving], (up[f"wheel_{wheel}_force_x_N"] / np.maximum(load, 1))[moving], ".", color=colour,
                       ms=2, alpha=0.5)
            load = side[f"wheel_{wheel}_load_N"]
            moving = (load > 50) & (side["time_s"] > 5) & (np.abs(side[f"wheel_{wheel}_slip"]) < 0.02)
            across.plot(np.degrees(np.abs(side[f"wheel_{wheel}_slip_angle_rad"][moving])),
                        np.abs(side[f"wheel_{wheel}_force_y_N"] / np.maximum(load, 1))[moving], ".", color=colour, ms=2, alpha=0.5)
    along.set(title="Driving force, rover on ever steeper ground", xlabel="slip, 1", ylabel="force over load, 1", xlim=(0, 1), ylim=(0, 0.9))
    across.set(title="Side force, rover across the slope", xlabel="slip angle, deg", ylabel="force over load, 1", xlim=(0, 5), ylim=(0, 0.9))
    along.legend(loc="lower right", title="curves: closed form of steady pure slip")
    runs.save(figure, "tyre")


def draw_ground_effect(runs: Runs) -> None:
    heights = [0.32, 0.36, 0.42, 0.5, 0.6, 0.75, 0.95, 1.2, 1.5, 2.0, 2.6, 6.0]
    radius, d, hub = 0.19, 0.31 * np.sqrt(2), 0.05
    figure, (axes,) = panels(1, 1, width=6.0, height=3.4)
    z = np.linspace(0.3, 3.0, 300)
    single = 1 - (radius / (4 * z))**2
    b = np.sqrt(2) * d
    four = single - radius**2 * z / (d**2 + 4 * z**2)**1.5 - radius**2 * z / (2 * (2 * d**2 + 4 * z**2)**1.5) \
        - 4 * radius**2 * z / (b**2 + 4 * z**2)**1.5
    for kind, curve, colour in (("multirotor", four, COLOURS[0]), ("single", single, COLOURS[1])):
        squares = []
        for height in heights:
            run = runs.run(f"hover_{kind}_{height}", f"""
vinerow: 1
name: hover
duration_s: 16
{FLAT}
vehicles:
  drone:
    include: {ASSETS}/vehicles/quadrotor_q4t.yaml
    ground_effect: {kind}
    spawn: {{x_m: -3, y_m: -3}}
    guidance: {{type: trajectory, rate_Hz: 20, hover_m: [-3, -3, {height}], hover_yaw_deg: 0}}
    controller: {{type: quadrotor_mpc, rate_Hz: 20}}
""")
            rotors = runs.arrays(run, "/drone/rotors")
            steady = rotors["time_s"] > 12
            squares.append(np.mean([np.mean(rotors[f"rotor_{i}_speed_radps"][steady]**2) for i in range(1, 5)]))
            _, place = runs.positions(run, "/drone/truth")
            squares[-1] = (place[-1, 2] - place[0, 2] + 0.22 + hub, squares[-1])
        places, squares = np.array(squares).T
        axes.plot(z, 1 / curve, color=colour, lw=1.2, label=f"closed form, {kind}")
        axes.plot(places[:-1], squares[-1] / squares[:-1], "o", color=colour, ms=5, label=f"hovering Q4T, {kind}")
    axes.set(title="Thrust over thrust far from the ground", xlabel="height of the rotors above the ground, m", ylabel="T / T_free", xlim=(0.3, 2.8),
             ylim=(0.99, 1.16))
    axes.legend()
    runs.save(figure, "ground_effect")


def draw_wing(runs: Runs) -> None:
    pitches = list(range(-30, 62, 4))
    planes = "\n".join(f"""  p{i}: {{include: {ASSETS}/vehicles/mh900_like.yaml, launch: air, start_height_m: 300, start_speed_mps: 14, start_pitch_deg: {p},
    propeller_windmill: 0, throttle_lag_s: 0, elevon_lag_s: 0, spawn: {{x_m: {2 + (i % 7) * 8}, y_m: {2 + (i // 7) * 8}, yaw_deg: 0}}, sensors: {{imu: {{type: imu, rate_Hz: 200}}}}}}"""
                       for i, p in enumerate(pitches))
    run = runs.run("wing", f"""
vinerow: 1
name: wing
duration_s: 0.1
physics: {{step_s: 0.001}}
{FLAT[:-1]}, wind: {{air_density_kgm3: 1.225}}}}
vehicles:
{planes}
record: {{truth_rate_Hz: 200, sensor_rate_limit_Hz: 200}}
""")
    text = {key: resolved_number(run, key) for key in ("mass_kg", "wing_area_m2", "lift_0", "lift_alpha", "drag_0", "oswald_efficiency", "wing_span_m",
                                                         "stall_angle_deg", "stall_blend", "lift_elevator", "stalled_control", "drag_deflection")}
    lift, drag, angle = [], [], []
    for i in range(len(pitches)):
        imu, air = runs.arrays(run, f"/p{i}/imu_truth"), runs.arrays(run, f"/p{i}/air")
        at = imu["time_s"][3] - 0.0025  # a reading is the mean over its period
        f_x = imu["linear_acceleration.x"][3] - np.interp(at, air["time_s"], air["thrust_N"]) / text["mass_kg"]
        f_z = imu["linear_acceleration.z"][3]
        elevon = np.interp(at, air["time_s"], (air["elevon_left_rad"] + air["elevon_right_rad"]) / 2)
        alpha = np.interp(at, air["time_s"], air["alpha_rad"])
        speed = np.interp(at, air["time_s"], air["airspeed_mps"])
        pressure = 0.5 * 1.225 * speed**2 * text["wing_area_m2"] / text["mass_kg"]
        angle.append(np.degrees(alpha))
        lift.append((f_z * np.cos(alpha) + f_x * np.sin(alpha)) / pressure)
        drag.append((f_z * np.sin(alpha) - f_x * np.cos(alpha)) / pressure)
    alpha = np.radians(np.linspace(-30, 60, 500))
    m, a0 = text["stall_blend"], np.radians(text["stall_angle_deg"])
    with np.errstate(over="ignore"):
        stalled = (1 + np.exp(-m * (alpha - a0)) + np.exp(m * (alpha + a0))) / ((1 + np.exp(-m * (alpha - a0))) * (1 + np.exp(m * (alpha + a0))))
    linear = text["lift_0"] + text["lift_alpha"] * alpha
    ratio = text["wing_span_m"]**2 / text["wing_area_m2"]
    c_l = (1 - stalled) * linear + stalled * 2 * np.sign(alpha) * np.sin(alpha)**2 * np.cos(alpha)
    c_l += (1 - stalled * (1 - text["stalled_control"])) * text["lift_elevator"] * elevon
    c_d = text["drag_0"] + (1 - stalled) * c_l**2 / (np.pi * text["oswald_efficiency"] * ratio) + stalled * 2 * np.abs(np.sin(alpha))**3 + text["drag_deflection"] * elevon**2
    figure, (left, right) = panels(1, 2, height=3.3)
    left.plot(np.degrees(alpha), c_l, color=COLOURS[0], lw=1.2, label="$C_L$, closed form")
    left.plot(np.degrees(alpha), c_d, color=COLOURS[1], lw=1.2, label="$C_D$, closed form")
    left.plot(angle, lift, "o", color=COLOURS[0], ms=3.5, label="$C_L$, accelerometers")
    left.plot(angle, drag, "o", color=COLOURS[1], ms=3.5, label="$C_D$, accelerometers")
    left.axvline(text["stall_angle_deg"], color=GREY, lw=0.8, ls=":")
    left.text(text["stall_angle_deg"] + 1, -0.9, "stall_angle_deg", color=GREY, fontsize=8)
    left.set(title="Coefficients, elevons at trim", xlabel="angle of attack, deg", ylabel="coefficient, 1", xlim=(-30, 60))
    left.legend(loc="upper left", fontsize=7.5)
    right.plot(c_d, c_l, color=COLOURS[2], lw=1.2, label="closed form")
    right.plot(drag, lift, "o", color=COLOURS[2], ms=3.5, label="accelerometers")
    right.set(title="Polar", xlabel="$C_D$, 1", ylabel="$C_L$, 1", xlim=(0, 0.6))
    right.legend(loc="lower right")
    runs.save(figure, "wing")


def spectrum(samples: np.ndarray, rate_Hz: float, window: int = 4096) -> tuple[np.ndarray, np.ndarray]:
    """One-sided power spectral density by Welch's method, half overlapped, Hann."""
    shape = np.hanning(window)
    parts = [np.abs(np.fft.rfft((p := samples[i:i + window]) * shape - p.mean() * shape))**2
             for i in range(0, len(samples) - window + 1, window // 2)]
    return np.fft.rfftfreq(window, 1 / rate_Hz)[1:], 2 * np.mean(parts, axis=0)[1:] / (rate_Hz * np.sum(shape**2))


def draw_wind(runs: Runs) -> None:
    speed, rate = 5.0, 20.0
    run = runs.run("wind", f"""
vinerow: 1
name: wind
duration_s: 3600
physics: {{step_s: 0.0025}}
world: {{type: orchard, waves_m: 0, plant_rows: 2, row_length_m: 10, field_width_m: 60, field_length_m: 60,
  wind: {{mean_speed_mps: {speed}, from_deg: 270, height_law: uniform, turbulence: 1.0}}}}
vehicles:
  drone:
    include: {ASSETS}/vehicles/quadrotor_q4t.yaml
    spawn: {{x_m: -3, y_m: -3, yaw_deg: 0}}
record: {{truth_rate_Hz: {rate}}}
""")
    air = runs.arrays(run, "/drone/rotors")
    h_ft = 10.0
    length_w = h_ft * 0.3048
    length_u = h_ft / (0.177 + 0.000823 * h_ft)**1.2 * 0.3048
    sigma_w = 0.1 * speed
    sigma_u = sigma_w / (0.177 + 0.000823 * h_ft)**0.4
    figure, (series, density) = panels(1, 2, height=3.3, width_ratios=[1, 1.15])
    part = slice(2000, 2000 + int(60 * rate))
    for axis, name, sigma, length, colour in (("x", "u, along the wind", sigma_u, length_u, COLOURS[0]),
                                                    ("y", "v, across", sigma_u, length_u, COLOURS[1]),
                                                    ("z", "w, up", sigma_w, length_w, COLOURS[2])):
        wind = air[f"wind_{axis}_mps"]
        series.plot(air["time_s"][part] - air["time_s"][part][0], wind[part], color=colour, lw=0.8, label=name)
        f, measured = spectrum(wind, rate)
        wave = 2 * np.pi * f / speed
        if axis == "x":
            form = sigma**2 * 2 * length / np.pi / (1 + (length * wave)**2)
        else:
            form = sigma**2 * length / np.pi * (1 + 3 * (length * wave)**2) / (1 + (length * wave)**2)**2
        scale = {"x": 100, "y": 10, "z": 1}[axis]
        edges = np.geomspace(f[0], f[-1], 90)
        which = np.digitize(f, edges)
        mean = np.array([(f[which == k].mean(), measured[which == k].mean()) for k in np.unique(which)])
        density.loglog(mean[:, 0], scale * mean[:, 1], ".", color=colour, ms=4, label=f"{axis.translate(str.maketrans('xyz', 'uvw'))} × {scale}")
        density.loglog(f, scale * form * 2 * np.pi / speed, color=colour, lw=1.0)
    series.set(title="A minute of wind at a parked quadrotor", xlabel="time, s", ylabel="wind, m/s", xlim=(0, 60))
    series.legend(loc="upper right", ncols=3, bbox_to_anchor=(1.0, 0.55))
    density.set(title="Spectra of an hour; lines: MIL-F-8785C", xlabel="frequency, Hz", ylabel="density, m²/s² per Hz", xlim=(f[0], 10),
                ylim=(1e-4, 3e3))
    density.legend()
    runs.save(figure, "wind")
