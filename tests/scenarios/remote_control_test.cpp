/// Controllers that take commands from outside, and their scenario keys.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/sim/vehicle_runtime.h"
#include "tests/scenarios/session_support.h"
#include "vinerow/testing.h"

namespace vinerow::remote_control_test {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;

/// The rover of session_support.h with a controller, and more keys.
Session open_rover(const std::string& controller, const std::string& more = "") {
  return open_session_text(
      std::string(test::kFreeRover) + "    controller: {" + controller + "}\n" + more, ".");
}

std::string warnings_of(Session& session) {
  std::string text;
  for (const SessionEvent& event : session.take_events()) {
    if (event.event.level == Event::Level::kWarning) text += event.event.text + "\n";
  }
  return text;
}

std::string error_of(const std::string& controller, const std::string& more) {
  try {
    open_rover(controller, more);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(RemoteVelocity, DrivesTheCommandedTurn) {
  Session session = open_rover("type: remote_velocity, timeout_s: 0");
  const auto actuators = session.signal<NamedValues>("rover/actuators");
  const auto truth = session.signal<Odometry>("rover/truth");
  session.command("rover/cmd_vel", Time{}, VelocityCommand{0.5, 0.2});
  session.advance(Time{2000 * kMs});
  // Paper B, eq. 1-2 with half the track: (v +- w l / 2) / r.
  const auto& wheels = *session.simulation().vehicles().front()->vehicle().description().wheeled;
  const NamedValues& all = actuators.value();
  for (std::size_t i = 0; i < all.names.size(); ++i) {
    const double side = all.names[i].find("r_speed") != std::string::npos ? 1.0 : -1.0;
    EXPECT_NEAR(all.values[i], (0.5 + side * 0.2 * wheels.track_m / 2) / wheels.wheel_radius_m,
                1e-12)
        << all.names[i];
  }
  // The wheels scrub in a turn, so the body turns less than they do.
  EXPECT_NEAR(truth.value().v_WB_B.x(), 0.5, 0.05);
  EXPECT_GT(truth.value().w_WB_B.z(), 0.03);
  EXPECT_EQ(warnings_of(session), "");
}

TEST(RemoteVelocity, StopsWhenNoCommandComes) {
  Session session = open_rover("type: remote_velocity, timeout_s: 0.3");
  const auto command = session.signal<VelocityCommand>("rover/command");
  session.command("rover/cmd_vel", Time{100 * kMs}, VelocityCommand{0.5, 0.0});
  session.advance(Time{400 * kMs});
  EXPECT_EQ(command.value().v_mps, 0.5);
  EXPECT_EQ(warnings_of(session), "");
  session.advance(Time{420 * kMs});
  EXPECT_EQ(command.value().v_mps, 0.0);
  EXPECT_EQ(warnings_of(session), "no cmd_vel for 0.3 s: the vehicle stops\n");
  session.command("rover/cmd_vel", Time{600 * kMs}, VelocityCommand{0.25, 0.0});
  session.advance(Time{620 * kMs});
  EXPECT_EQ(command.value().v_mps, 0.25);
}

TEST(RemoteVelocity, StandsUntilTheFirstCommand) {
  Session session = open_rover("type: remote_velocity");
  session.advance(Time{1000 * kMs});
  EXPECT_EQ(session.signal<VelocityCommand>("rover/command").value().v_mps, 0.0);
  EXPECT_EQ(warnings_of(session), "") << "nobody has fallen silent";
  EXPECT_EQ(session.any_signal("rover/cmd_vel").writer(), "outside");
}

TEST(RemoteVelocity, LimitsSpeedAndItsChange) {
  Session session = open_rover(
      "type: remote_velocity, timeout_s: 0, max_speed_mps: 0.4, max_yaw_rate_radps: 0.1, "
      "acceleration_mps2: 0.5, yaw_acceleration_radps2: 1");
  const auto command = session.signal<VelocityCommand>("rover/command");
  session.command("rover/cmd_vel", Time{}, VelocityCommand{2.0, -3.0});
  // At 50 Hz, the k-th cycle reaches k times 0.5 m/s2 x 0.02 s.
  session.advance(Time{200 * kMs});
  EXPECT_NEAR(command.value().v_mps, 11 * 0.01, 1e-12);
  EXPECT_NEAR(command.value().yaw_rate_radps, -0.1, 1e-12);
  session.advance(Time{2000 * kMs});
  EXPECT_NEAR(command.value().v_mps, 0.4, 1e-12);
}

TEST(RemoteActuators, PassesOnWhatIsNamed) {
  Session session = open_rover("type: remote_actuators, timeout_s: 0.2");
  const auto actuators = session.signal<NamedValues>("rover/actuators");
  session.command("rover/actuator_command", Time{}, NamedValues{{"wheel_fl_speed_radps"}, {3.0}});
  session.command("rover/actuator_command", Time{100 * kMs},
                  NamedValues{{"wheel_rr_speed_radps"}, {-2.0}});
  session.advance(Time{110 * kMs});
  const auto value = [&](const std::string& name) {
    const NamedValues& all = actuators.value();
    const auto found = std::find(all.names.begin(), all.names.end(), name);
    return found == all.names.end() ? 99.0 : all.values[found - all.names.begin()];
  };
  EXPECT_EQ(value("wheel_fl_speed_radps"), 3.0) << "the others keep their values";
  EXPECT_EQ(value("wheel_rr_speed_radps"), -2.0);
  EXPECT_EQ(value("wheel_fr_speed_radps"), 0.0);
  session.advance(Time{400 * kMs});
  EXPECT_EQ(value("wheel_fl_speed_radps"), 0.0);
  EXPECT_EQ(warnings_of(session), "no actuator_command for 0.2 s: the vehicle stops\n");
  EXPECT_THROW(session.command("rover/actuator_command", session.now(),
                               NamedValues{{"wheel_x_speed_radps"}, {1.0}}),
               ConfigError);
}

TEST(RemoteControl, TwinsAndResetsKeepTheirPort) {
  Session session = open_rover("type: remote_velocity, timeout_s: 0");
  const auto drive = [](Session& each) {
    each.command("rover/cmd_vel", Time{}, VelocityCommand{0.4, 0.1});
    each.advance(Time{1000 * kMs});
    return each.digest();
  };
  Session twin = session.twin();
  const std::string digest = drive(session);
  EXPECT_EQ(drive(twin), digest);
  session.reset();
  EXPECT_EQ(drive(session), digest);
}

TEST(Lockstep, NamesWhatIsWrong) {
  const std::string remote = "type: remote_velocity";
  EXPECT_THAT(error_of(remote, "lockstep: {topic: rover/cmd_val}\n"),
              HasSubstr("lockstep.topic = 'rover/cmd_val': no part takes commands from outside as "
                        "that; did you mean 'rover/cmd_vel'? (there are: rover/cmd_vel)"));
  EXPECT_THAT(error_of("type: pure_pursuit", "lockstep: {topic: rover/cmd_vel}\n"),
              HasSubstr("the vehicle has no planner"));
  EXPECT_THAT(error_of(remote, "lockstep: {rate_Hz: 20}\n"), HasSubstr("lockstep.topic must be"));
  EXPECT_THAT(error_of(remote, "lockstep: {topic: rover/cmd_vel, rate_Hz: 30}\n"),
              HasSubstr("lockstep.rate_Hz = 30"));
  EXPECT_THAT(error_of(remote, "lockstep: {topic: rover/cmd_vel, on_timeout: wait}\n"),
              HasSubstr("lockstep.on_timeout = 'wait'"));
  EXPECT_EQ(error_of(remote, "lockstep: {topic: /rover/cmd_vel}\n"), "") << "a session is the peer";
}

/// A rover that drives to goals, in four rows of 20 m.
Session open_goal_rover(const std::string& estimator = "") {
  std::string text = test::kFreeRover;
  text.replace(text.find("row_count: 2"), 12, "row_count: 4");
  text.replace(text.find("duration_s: 3"), 13, "duration_s: 200");
  return open_session_text("stop_when_finished: false\n" + text + estimator +
                               "    guidance: {type: remote_goal}\n"
                               "    controller: {type: path_follower}\n",
                           ".");
}

PoseTarget goal_at(double x_m, double y_m, double yaw_rad) {
  return {{quaternion_from_rpy({0, 0, yaw_rad}), {x_m, y_m, 0}}};
}

std::string events_of(Session& session) {
  std::string text;
  for (const SessionEvent& event : session.take_events()) text += event.event.text + "\n";
  return text;
}

/// A point of an alley's middle line, and its direction.
PoseTarget goal_in_alley(const Session& session, std::size_t alley, double share) {
  const auto& line = session.simulation().world().rows->alleys[alley].line_W;
  const Eigen::Vector2d along = (line.back() - line.front()).head<2>();
  const Eigen::Vector2d p = line.front().head<2>() + share * along;
  return goal_at(p.x(), p.y(), std::atan2(along.y(), along.x()));
}

TEST(RemoteGoal, DrivesToOneGoalAfterAnother) {
  Session session = open_goal_rover();
  const auto truth = session.signal<Odometry>("rover/truth");
  session.advance(Time{1000 * kMs});
  EXPECT_LT(truth.value().v_WB_B.norm(), 0.01) << "without a goal it stands";
  // The second goal is behind a row: the way leads around it.
  for (const PoseTarget& goal : {goal_in_alley(session, 0, 0.7), goal_in_alley(session, 1, 0.5)}) {
    session.command("rover/goal_pose", session.now(), goal);
    session.advance(session.now() + Duration{90'000 * kMs});
    const Pose& pose = truth.value().X_WB;
    EXPECT_LT((pose.p - goal.X_WB.p).head<2>().norm(), 0.3);
    const double error_rad =
        wrap_angle(yaw_from_quaternion(pose.q) - yaw_from_quaternion(goal.X_WB.q));
    EXPECT_LT(std::abs(error_rad), 0.15);
    EXPECT_LT(truth.value().v_WB_B.norm(), 0.01) << "and stands there";
  }
  EXPECT_EQ(session.metrics().at("rover").at("contact_count"), 0.0);
}

TEST(RemoteGoal, RefusesAGoalInARowAndKeepsItsPlan) {
  Session session = open_goal_rover();
  const auto plan = session.signal<PlannedPath>("rover/plan");
  session.command("rover/goal_pose", Time{}, goal_in_alley(session, 0, 0.7));
  session.advance(Time{1000 * kMs});
  EXPECT_THAT(events_of(session), HasSubstr("planned 14.00 m with"));
  const std::uint64_t plans = plan.sequence();
  EXPECT_EQ(plans, 1);
  const auto& row = session.simulation().world().rows->rows[1].line_W;
  const Eigen::Vector2d middle = 0.5 * (row.front() + row.back()).head<2>();
  session.command("rover/goal_pose", session.now(), goal_at(middle.x(), middle.y(), 0.0));
  session.advance(Time{2000 * kMs});
  EXPECT_THAT(warnings_of(session), HasSubstr("the vehicle keeps its plan"));
  EXPECT_EQ(plan.sequence(), plans);
}

}  // namespace
}  // namespace vinerow::remote_control_test
