#!/usr/bin/env python3
"""Drives a rover along its plan in lock-step, as a ROS 2 node would do it, over DDS and without ROS.

    vinerow run follow_path.yaml --ros2
    follow_path.py [--domain 0]

The law is that of Nav2's Regulated Pure Pursuit controller (Macenski, Singh, Martin, Gines, "Regulated Pure Pursuit for Robot
Path Tracking", Autonomous Robots 47, 2023) without its check of obstacles. Needs the package cyclonedds, version 11.
"""

import argparse
import contextlib
import math
import os
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float64, int32, sequence, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time
    frame_id: str


@dataclass
class Vector3(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
class Quaternion(IdlStruct, typename="geometry_msgs::msg::dds_::Quaternion_"):
    x: float64
    y: float64
    z: float64
    w: float64


@dataclass
class Pose(IdlStruct, typename="geometry_msgs::msg::dds_::Pose_"):
    position: Vector3
    orientation: Quaternion


@dataclass
class PoseStamped(IdlStruct, typename="geometry_msgs::msg::dds_::PoseStamped_"):
    header: Header
    pose: Pose


@dataclass
class Path(IdlStruct, typename="nav_msgs::msg::dds_::Path_"):
    header: Header
    poses: sequence[PoseStamped]


@dataclass
class Twist(IdlStruct, typename="geometry_msgs::msg::dds_::Twist_"):
    linear: Vector3
    angular: Vector3


@dataclass
class TwistStamped(IdlStruct, typename="geometry_msgs::msg::dds_::TwistStamped_"):
    header: Header
    twist: Twist


@dataclass
class PoseWithCovariance(IdlStruct, typename="geometry_msgs::msg::dds_::PoseWithCovariance_"):
    pose: Pose
    covariance: array[float64, 36]


@dataclass
class TwistWithCovariance(IdlStruct, typename="geometry_msgs::msg::dds_::TwistWithCovariance_"):
    twist: Twist
    covariance: array[float64, 36]


@dataclass
class Odometry(IdlStruct, typename="nav_msgs::msg::dds_::Odometry_"):
    header: Header
    child_frame_id: str
    pose: PoseWithCovariance
    twist: TwistWithCovariance


PERIOD_ns = 50_000_000  # of commands: `lockstep` in the scenario
# Peers on this machine, without multicast: what ROS 2 chooses for ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST.
LOCALHOST = """<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast>
<Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
<Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>"""


class RegulatedPurePursuit:
    """Leads a vehicle along a path."""

    SPEED_mps = 1.0
    SLOWEST_mps = 0.25
    LOOKAHEAD_s, LOOKAHEAD_MIN_m, LOOKAHEAD_MAX_m = 0.8, 0.3, 1.2
    SLOW_RADIUS_m = 2.0  # slower in curves of a smaller radius
    APPROACH_m = 1.0  # slower within this distance of the end
    TOLERANCE_m = 0.05
    SEARCH_m = 2.0  # limit of the search for the nearest point along the path: the next alley is near too

    def __init__(self, points: list[tuple[float, float]]):
        self.segments = []  # first point, direction, length, distance from the start of the path
        self.length_m = self.passed_m = 0.0
        for (ax, ay), (bx, by) in zip(points, points[1:]):
            if (length_m := math.hypot(bx - ax, by - ay)) > 0.0:
                self.segments.append((ax, ay, (bx - ax) / length_m, (by - ay) / length_m, length_m, self.length_m))
                self.length_m += length_m

    @property
    def left_m(self) -> float:
        return self.length_m - self.passed_m

    def command(self, x: float, y: float, yaw: float, speed_mps: float) -> tuple[float, float]:
        """Speed in m/s and yaw rate in rad/s."""
        self.passed_m = self.nearest_m(x, y)
        if self.left_m < self.TOLERANCE_m:
            return 0.0, 0.0
        lookahead_m = min(max(self.LOOKAHEAD_s * speed_mps, self.LOOKAHEAD_MIN_m), self.LOOKAHEAD_MAX_m)
        target_x, target_y = self.point_at(self.passed_m + lookahead_m)
        aside_m = (target_y - y) * math.cos(yaw) - (target_x - x) * math.sin(yaw)
        # Of the arc from the vehicle, tangential to its heading, to the target.
        curvature = 2.0 * aside_m / max((target_x - x) ** 2 + (target_y - y) ** 2, 1e-6)
        wanted_mps = self.SPEED_mps / max(abs(curvature) * self.SLOW_RADIUS_m, 1.0)
        wanted_mps = min(wanted_mps, self.SPEED_mps * self.left_m / self.APPROACH_m)
        wanted_mps = max(wanted_mps, self.SLOWEST_mps)
        return wanted_mps, wanted_mps * curvature

    def nearest_m(self, x: float, y: float) -> float:
        """Distance along the path of the point that is nearest to (x, y), not before the last one."""
        found = []
        for ax, ay, dx, dy, length_m, start_m in self.segments:
            if self.passed_m < start_m + length_m and start_m < self.passed_m + self.SEARCH_m:
                along_m = min(max((x - ax) * dx + (y - ay) * dy, 0.0), length_m)
                found.append((math.hypot(ax + along_m * dx - x, ay + along_m * dy - y), start_m + along_m))
        return max(min(found)[1], self.passed_m) if found else self.passed_m

    def point_at(self, distance_m: float) -> tuple[float, float]:
        """Point of the path, or of its last straight beyond its end."""
        ax, ay, dx, dy, _, start_m = [each for each in self.segments if each[5] <= distance_m][-1]
        return ax + (distance_m - start_m) * dx, ay + (distance_m - start_m) * dy


def messages_of(reader: DataReader):
    """Messages until their publisher leaves; waits for it first."""
    has_begun = False
    while not has_begun or reader.get_matched_publications():
        for message in reader.take_iter(timeout=duration(milliseconds=200)):
            has_begun = True
            yield message


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--domain", type=int, default=int(os.environ.get("ROS_DOMAIN_ID", 0)))
    number = parser.parse_args().domain
    domain = Domain(number, os.environ.get("CYCLONEDDS_URI") or LOCALHOST)  # closed with this variable
    participant = DomainParticipant(number)
    reliable = Policy.Reliability.Reliable(duration(seconds=1))
    odometry = DataReader(participant, Topic(participant, "rt/rover/truth", Odometry), Qos(reliable, Policy.History.KeepLast(10)))
    plans = DataReader(participant, Topic(participant, "rt/rover/plan", Path), Qos(reliable, Policy.Durability.TransientLocal))
    commands = DataWriter(participant, Topic(participant, "rt/rover/cmd_vel", TwistStamped),
                          Qos(reliable, Policy.DataRepresentation(use_cdrv0_representation=True)))

    print(f"waiting for a run in ROS 2 domain {number}", flush=True)
    law = None
    for message in messages_of(odometry):
        if law is None:  # simulated time waits for the first command
            plan = next(messages_of(plans))
            law = RegulatedPurePursuit([(each.pose.position.x, each.pose.position.y) for each in plan.poses])
            while not commands.get_matched_subscriptions():
                time.sleep(0.01)
        p, q, stamp = message.pose.pose.position, message.pose.pose.orientation, message.header.stamp
        yaw = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y**2 + q.z**2))
        speed_mps, yaw_rate_radps = law.command(p.x, p.y, yaw, message.twist.twist.linear.x)
        # The answer to the odometry of one instant is the command for the next.
        due = Time(*divmod(stamp.sec * 1_000_000_000 + stamp.nanosec + PERIOD_ns, 1_000_000_000))
        commands.write(TwistStamped(Header(due, "rover/base_link"), Twist(Vector3(x=speed_mps), Vector3(z=yaw_rate_radps))))
    print(f"the run is over: {law.passed_m:.2f} m of {law.length_m:.2f} m driven")


if __name__ == "__main__":
    with contextlib.suppress(KeyboardInterrupt):
        main()
