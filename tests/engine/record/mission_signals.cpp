#include "tests/engine/record/mission_signals.h"

#include <cmath>
#include <limits>

#include "engine/math/angles.h"

namespace vinerow::test {
namespace {

bool is_due(Time now, std::int64_t period_ms) {
  return now.ns % (period_ms * 1'000'000) == 0;
}

const Eigen::Vector3d kHub_B[4] = {
    {0.3, 0.25, 0}, {0.3, -0.25, 0}, {-0.3, 0.25, 0}, {-0.3, -0.25, 0}};
const char* const kWheel[4] = {"fl", "fr", "rl", "rr"};

}  // namespace

MissionSignals::MissionSignals(int path_points) : path_points_(path_points) {
  Ports rover(bus_, "rover", "test");
  truth_out_ = rover.write<Odometry>("truth");
  links_out_ = rover.write<LinkPoses>("links");
  wheels_out_ = rover.write<NamedValues>("wheels");
  battery_out_ = rover.write<BatteryState>("battery");
  contacts_out_ = rover.write<NamedValues>("contacts");
  gps_out_ = rover.write<GnssFix>("gps");
  imu_out_ = rover.write<ImuSample>("imu");
  for (const char* name : {"front", "back", "left", "right"}) {
    range_outs_.push_back(rover.write<RangeSample>(std::string("ultrasound_") + name));
  }
  command_out_ = rover.write<VelocityCommand>("command");
  actuators_out_ = rover.write<NamedValues>("actuators");
  follower_out_ = rover.write<FollowerState>("follower");
  plan_out_ = rover.write<PlannedPath>("plan");
  tree_out_ = rover.write<LineList>("plan_tree");
  local_command_out_ = rover.write<LocalCommand>("local_command");
  reference_out_ = rover.write<ReferenceTrajectory>("reference");
  map_out_ = Ports(bus_, "run", "test").write<OccupancyGrid>("map");
  event_out_ = Ports(bus_, "run", "test").write<Event>("events");

  reference_.phase = ReferenceTrajectory::Phase::kRow;
  reference_.distance_m = 12.5;
  reference_.remaining_m = 37.5;
  for (int i = 0; i < 21; ++i) {
    reference_.points.push_back({.p_W = {3 * 0.05 * i, 1, 1.5},
                                 .v_W = {3, 0, 0},
                                 .a_W = {0, 0, 0.5},
                                 .yaw_rad = 0.5 * kPi + 2 * kPi,
                                 .yaw_rate_radps = 0.25});
  }
  links_.names = {"body"};
  for (const char* wheel : kWheel) {
    links_.names.push_back(std::string("wheel_") + wheel);
    actuators_.names.push_back(std::string("wheel_") + wheel + "_speed_radps");
    for (const char* what : {"speed_radps", "steer_rad", "torque_Nm", "load_N", "slip",
                             "slip_angle_rad", "force_x_N", "force_y_N"}) {
      wheels_.names.push_back(std::string("wheel_") + wheel + "_" + what);
    }
  }
  links_.X_WL.resize(links_.names.size());
  actuators_.values.resize(actuators_.names.size());
  wheels_.values.resize(wheels_.names.size());
  contacts_.names = {"touches", "touching"};
  contacts_.values = {0, 0};
}

Eigen::Vector3d MissionSignals::noise(double sigma) {
  return sigma * Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
}

void MissionSignals::write_motion(Time now) {
  const double t_s = now.s();
  // Up and down rows of 100 m at 1 m/s, with the ground's roughness on every state.
  const double along_m = 50 - 50 * std::cos(t_s / 50);
  const RollPitchYaw rpy{0.02 * random_.normal(), 0.03 + 0.02 * random_.normal(),
                         0.4 + 0.01 * random_.normal()};
  truth_.X_WB.q = quaternion_from_rpy(rpy);
  truth_.X_WB.p = Eigen::Vector3d(0.92 * along_m, 0.39 * along_m, 0.05 * along_m) + noise(0.005);
  truth_.v_WB_B = Eigen::Vector3d(std::sin(t_s / 50), 0, 0) + noise(0.01);
  truth_.w_WB_B = noise(0.05);
  truth_out_.write(now, truth_);

  links_.X_WL[0] = truth_.X_WB;
  for (std::size_t i = 0; i < 4; ++i) {
    const double turn_rad = along_m / 0.2 + 0.01 * random_.normal();
    const Pose X_BL{Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY())),
                    kHub_B[i] + Eigen::Vector3d(0, 0, 0.01 * random_.normal())};
    links_.X_WL[i + 1] = truth_.X_WB * X_BL;
  }
  links_out_.write(now, links_);

  for (std::size_t i = 0; i < range_outs_.size(); ++i) {
    RangeSample sample;
    // Half of the readings see nothing, as between gaps and at row ends.
    sample.range_m = random_.uniform() < 0.5 ? std::numeric_limits<double>::infinity()
                                             : 1.1 + 0.2 * random_.normal();
    sample.min_range_m = 0.2;
    sample.max_range_m = 4.0;
    sample.half_angle_rad = rad_from_deg(15);
    sample.X_WS = truth_.X_WB *
                  Pose{quaternion_from_rpy({0, 0, 0.5 * kPi * static_cast<double>(i)}), kHub_B[i]};
    range_outs_[i].write(now, sample);
  }
}

void MissionSignals::write_wheels(Time now) {
  for (std::size_t i = 0; i < wheels_.values.size(); ++i) {
    const bool is_steer = i % 8 == 1;  // skid steering has no steering angles
    wheels_.values[i] = is_steer ? 0.0 : 5.0 + random_.normal();
  }
  wheels_out_.write(now, wheels_);
  battery_.power_W = 80 + 10 * random_.normal();
  battery_.energy_used_J += battery_.power_W * 0.05;
  battery_.charge = 1 - battery_.energy_used_J / 2e6;
  battery_out_.write(now, battery_);
  contacts_out_.write(now, contacts_);
}

void MissionSignals::write_control(Time now) {
  const VelocityCommand command{1.0 + 0.01 * random_.normal(), 0.05 * random_.normal()};
  command_out_.write(now, command);
  const double left = (command.v_mps - 0.25 * command.yaw_rate_radps) / 0.2;
  const double right = (command.v_mps + 0.25 * command.yaw_rate_radps) / 0.2;
  actuators_.values = {left, right, left, right};
  actuators_out_.write(now, actuators_);
  follower_.lateral_error_m = 0.02 * random_.normal();
  follower_.heading_error_rad = 0.01 * random_.normal();
  follower_.distance_m += 0.025 * command.v_mps;
  follower_.remaining_m = 4000 - follower_.distance_m;
  follower_.waypoint = static_cast<std::int32_t>(follower_.distance_m / 0.5);
  follower_out_.write(now, follower_);
}

void MissionSignals::write_planning(Time now) {
  // Rows of 100 m, 2.5 m apart, in a parcel of 110 m x 20 m.
  OccupancyGrid grid;
  grid.columns = 1100;
  grid.rows = 200;
  grid.cell_m = 0.1;
  grid.corner_W = {-5, -10};
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      grid.cells.push_back(i >= 50 && i < 1050 && j % 25 < 6 ? 1 : 0);
    }
  }
  map_out_.write(now, grid);

  PlannedPath path;
  LineList tree;
  for (int i = 0; i < path_points_; ++i) {
    path.points.push_back({.p_W = {0.5 * i, std::sin(0.01 * i), 0},
                           .yaw_rad = 0.02 * std::cos(0.01 * i),
                           .curvature_per_m = 0.001,
                           .speed_mps = 1.0,
                           .kind = i % 200 < 180 ? PathKind::kLeg : PathKind::kTurn,
                           .alley = i / 200});
    tree.points_W.push_back(path.points.back().p_W);
    tree.points_W.push_back(path.points.back().p_W + Eigen::Vector3d(0.4, 0.1, 0));
  }
  path.length_m = 0.5 * path_points_;
  plan_out_.write(now, path);
  tree_out_.write(now, tree);
}

void MissionSignals::write(Time now) {
  if (now.ns == 0) write_planning(now);
  if (is_due(now, 10'000)) {
    event_out_.write(now, {Event::Level::kInfo, "rover.mission", "leg begins"});
  }
  if (is_due(now, 50)) write_motion(now);
  if (is_due(now, 50)) write_wheels(now);
  if (is_due(now, 25)) write_control(now);
  if (is_due(now, 10)) {
    imu_out_.write(now,
                   {.w_WS_S = noise(0.05), .f_WS_S = Eigen::Vector3d(0, 0, 9.81) + noise(0.5)});
  }
  if (is_due(now, 200)) {
    local_command_out_.write(now, {.mode = LocalCommand::Mode::kDrive,
                                   .v_mps = 0.8,
                                   .front_axle_rad = 0.1,
                                   .rear_axle_rad = -0.1,
                                   .clearance_m = 0.35});
    reference_out_.write(now, reference_);
    GnssFix fix;
    fix.valid = true;
    fix.p_W = truth_.X_WB.p + noise(0.02);
    fix.latitude_rad = 0.93 + fix.p_W.y() / 6.4e6;
    fix.longitude_rad = -0.01 + fix.p_W.x() / 3.8e6;
    fix.altitude_m = 52 + fix.p_W.z();
    fix.v_W = truth_.v_WB_B + noise(0.05);
    fix.std_m = {0.02, 0.02, 0.04};
    gps_out_.write(now, fix);
  }
}

}  // namespace vinerow::test
