// node check_samples.mjs WRITER FOLDER
// Has the sample program write logs of every kind and checks them with the official readers: whole
// ones to the last message and some values, those of killed runs up to the last flushed chunk.
// Exit status 77 (skipped) where `npm ci` has not been run here.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

if (!existsSync(join(dirname(fileURLToPath(import.meta.url)), "node_modules", "@mcap"))) {
  console.log("skipped: node_modules is absent; run `npm ci` in tests/npm");
  process.exit(77);
}
const { readLog } = await import("./mcap_log.mjs");
const [writer, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
execFileSync(writer, [folder], { stdio: "inherit" });

// 10 s of the mission in tests/engine/record/mission_signals.h.
const wantedCounts = {
  "/rover/truth": 200, "/rover/links": 200, "/rover/wheels": 200,
  "/rover/battery": 200, "/rover/battery/exact": 200, "/rover/contacts": 200,
  "/rover/gps": 50, "/rover/gps/exact": 50, "/rover/imu": 1000,
  "/rover/ultrasound_front": 200, "/rover/ultrasound_front/exact": 200,
  "/rover/ultrasound_back": 200, "/rover/ultrasound_back/exact": 200,
  "/rover/ultrasound_left": 200, "/rover/ultrasound_left/exact": 200,
  "/rover/ultrasound_right": 200, "/rover/ultrasound_right/exact": 200,
  "/rover/command": 400, "/rover/actuators": 400, "/rover/follower": 400,
  "/rover/plan": 1, "/rover/plan/exact": 1, "/run/events": 1,
  "/rover/plan_tree": 1, "/rover/local_command": 50, "/rover/reference": 50, "/rover/reference/exact": 50,
  "/run/map": 1, "/run/map/exact": 1,
};
const wantedTypes = {
  "/rover/truth": "nav_msgs/msg/Odometry", "/rover/links": "tf2_msgs/msg/TFMessage",
  "/rover/wheels": "vinerow_msgs/msg/NamedValues",
  "/rover/battery": "sensor_msgs/msg/BatteryState",
  "/rover/gps": "sensor_msgs/msg/NavSatFix", "/rover/imu": "sensor_msgs/msg/Imu",
  "/rover/ultrasound_front": "sensor_msgs/msg/Range",
  "/rover/ultrasound_front/exact": "vinerow_msgs/msg/RangeRay",
  "/rover/command": "geometry_msgs/msg/TwistStamped",
  "/rover/follower": "vinerow_msgs/msg/FollowerState",
  "/rover/plan": "nav_msgs/msg/Path", "/rover/plan/exact": "vinerow_msgs/msg/PlannedPath",
  "/run/events": "rcl_interfaces/msg/Log",
  "/rover/plan_tree": "visualization_msgs/msg/Marker",
  "/rover/local_command": "vinerow_msgs/msg/LocalCommand",
  "/rover/reference": "trajectory_msgs/msg/MultiDOFJointTrajectory",
  "/rover/reference/exact": "vinerow_msgs/msg/ReferenceTrajectory",
  "/run/map": "nav_msgs/msg/OccupancyGrid", "/run/map/exact": "vinerow_msgs/msg/OccupancyGrid",
};

function checkValues({ first, last }) {
  const truth = last["/rover/truth"];
  assert.equal(truth.header.frame_id, "map");
  assert.equal(truth.child_frame_id, "rover/base_link");
  const q = truth.pose.pose.orientation;
  assert.ok(Math.abs(Math.hypot(q.x, q.y, q.z, q.w) - 1) < 1e-12);
  // The tree that a 3D panel draws: map -> rover/base_link -> links.
  const frames = last["/rover/links"].transforms.map((t) => [t.header.frame_id, t.child_frame_id]);
  assert.deepEqual(frames[0], ["map", "rover/base_link"]);
  assert.deepEqual(frames[4], ["rover/base_link", "rover/wheel_rl"]);
  const imu = last["/rover/imu"];
  assert.equal(imu.orientation_covariance[0], -1);
  assert.ok(Math.abs(imu.linear_acceleration.z - 9.81) < 5);
  const fix = last["/rover/gps"];
  assert.equal(fix.status.status, 0);
  assert.ok(fix.latitude > 53 && fix.latitude < 54 && fix.longitude > -1 && fix.longitude < 0);
  const exactFix = last["/rover/gps/exact"];
  assert.ok(Math.abs(exactFix.latitude * 180 / Math.PI - fix.latitude) < 1e-12);
  const range = last["/rover/ultrasound_left"];
  assert.equal(range.max_range, 4);
  assert.equal(range.field_of_view, Math.fround(Math.PI / 6));
  const ray = last["/rover/ultrasound_left/exact"];
  assert.equal(range.range, Math.fround(ray.range));
  assert.deepEqual(ray.body, truth.pose.pose);
  const wheels = last["/rover/wheels"];
  assert.equal(wheels.name.length, 32);
  assert.equal(wheels.value.length, 32);
  assert.equal(wheels.name[0], "wheel_fl_speed_radps");
  const plan = first["/rover/plan"];
  assert.equal(plan.poses.length, 100);
  assert.equal(plan.poses[10].pose.position.x, 5);
  assert.equal(first["/rover/plan/exact"].points[95].kind, 0);
  assert.equal(first["/rover/plan/exact"].length, 50);
  const tree = first["/rover/plan_tree"];
  assert.deepEqual([tree.ns, tree.type, tree.action, tree.points.length], ["rover/plan_tree", 5, 0, 200]);
  assert.deepEqual([tree.points[20].x, tree.points[21].x], [5, 5.4]);
  const map = first["/run/map"];
  assert.equal(map.header.frame_id, "map");
  assert.deepEqual([map.info.width, map.info.height, map.data.length], [1100, 200, 220000]);
  assert.equal(map.info.resolution, Math.fround(0.1));
  assert.deepEqual([map.info.origin.position.x, map.info.origin.position.y], [-5, -10]);
  // Cell (50, 0) is the first of a row, (49, 0) lies before it, (50, 6) beside it.
  assert.deepEqual([map.data[50], map.data[49], map.data[6 * 1100 + 50]], [100, 0, 0]);
  assert.equal(first["/run/map/exact"].cell, 0.1);
  assert.equal(first["/run/map/exact"].cells[50], 1);
  const local = last["/rover/local_command"];
  assert.deepEqual([local.mode, local.speed, local.front_axle, local.rear_axle, local.clearance],
    [1, 0.8, 0.1, -0.1, 0.35]);
  const reference = last["/rover/reference"];
  assert.deepEqual([reference.header.frame_id, reference.joint_names, reference.points.length],
    ["map", ["base_link"], 21]);
  const point = reference.points[20];
  assert.deepEqual([point.transforms.length, point.velocities.length, point.accelerations.length], [1, 1, 1]);
  assert.deepEqual(point.time_from_start, { sec: 1, nsec: 0 });
  assert.ok(Math.abs(point.transforms[0].translation.x - 3) < 1e-12);
  assert.ok(Math.abs(Math.abs(point.transforms[0].rotation.z) - Math.SQRT1_2) < 1e-12);
  assert.deepEqual([point.velocities[0].linear.x, point.velocities[0].angular.z, point.accelerations[0].linear.z],
    [3, 0.25, 0.5]);
  const exactReference = last["/rover/reference/exact"];
  assert.deepEqual([exactReference.phase, exactReference.distance, exactReference.remaining, exactReference.step],
    [3, 12.5, 37.5, 0.05]);
  assert.equal(exactReference.points[20].yaw, 0.5 * Math.PI + 2 * Math.PI);
  const event = first["/run/events"];
  assert.deepEqual([event.level, event.name, event.msg], [20, "rover.mission", "leg begins"]);
}

for (const compression of ["zstd", "lz4", "none"]) {
  const whole = await readLog(join(folder, `${compression}.mcap`));
  assert.equal(whole.complete, true);
  assert.equal(whole.profile, "ros2");
  assert.match(whole.library, /^vinerow \d/);
  assert.deepEqual(whole.counts, wantedCounts);
  for (const [topic, type] of Object.entries(wantedTypes)) assert.equal(whole.types[topic], type);
  assert.equal(whole.metadata.vinerow.scenario, "mission.yaml");
  assert.equal(whole.attachments["scenario.resolved.yaml"], 14);
  checkValues(whole);

  const killed = await readLog(join(folder, `${compression}_killed.mcap`), { allowTruncated: true });
  assert.equal(killed.complete, false);
  assert.ok(killed.counts["/rover/truth"] > 50, "a killed run keeps its flushed chunks");
  checkValues(killed);
  await assert.rejects(readLog(join(folder, `${compression}_killed.mcap`)), /cut off/);
  console.log(`${compression}: ${Object.values(whole.counts).reduce((a, b) => a + b)} messages; ` +
    `killed run: ${Object.values(killed.counts).reduce((a, b) => a + b)} messages`);
}
