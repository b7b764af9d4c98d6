"""Keeps a rover in the middle of an alley by two ultrasonic rangers: docs/examples/plugin in Python."""

import math

from vinerow import parts


@parts.controller("alley_centring_py", rate_Hz=20, reads=["sonar_left", "sonar_right"], writes=["actuators"])
class AlleyCentring(parts.Controller):
    """Keeps the middle of an alley by two ultrasonic rangers"""

    speed_mps = parts.Number(0.8, "m/s", "forward speed", more_than=0)
    gain_radps_per_m = parts.Number(0.8, "rad/s/m", "turn per offset", more_than=0)
    damping_rad_per_m = parts.Number(1.5, "rad/m", "turn per speed of the offset", more_than=0)

    def __init__(self):
        self.offset_m = 0.0

    def connect(self, ports):
        self.left = ports.read("sonar_left", "RangeSample")
        self.right = ports.read("sonar_right", "RangeSample")
        self.actuators = ports.write("actuators")

    def step(self, now_s):
        self.actuators.write(self.wheel_speeds(self.yaw_rate()))

    def yaw_rate(self):
        if not (self.left.has_value and self.right.has_value):
            return 0.0
        left_m, right_m = self.left["range"], self.right["range"]
        if not (math.isfinite(left_m) and math.isfinite(right_m)):
            return 0.0
        # Foliage is ragged: a slow mean of the offset, and a still slower view of its rate.
        before_m = self.offset_m
        self.offset_m += 0.1 * (0.5 * (right_m - left_m) - self.offset_m)
        rate_mps = (self.offset_m - before_m) / self.context.period_s
        return min(max(-self.gain_radps_per_m * self.offset_m - self.damping_rad_per_m * rate_mps, -0.5), 0.5)

    def wheel_speeds(self, yaw_rate_radps):
        wheels = self.context.vehicle.wheels
        speeds = {}
        for actuator in self.context.vehicle.actuators:
            side = -0.5 if actuator.name.startswith(("wheel_fl", "wheel_rl")) else 0.5
            speeds[actuator.name] = (self.speed_mps + side * wheels.track_m * yaw_rate_radps) / wheels.wheel_radius_m
        return speeds
