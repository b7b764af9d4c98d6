// What every registered guidance keeps: those of ground vehicles, which write "local_command" or a
// "plan", those of rotorcraft, which write a ReferenceTrajectory "reference", and those of vehicles
// on wings, which write an AirReference there.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/dwa/course.h"
#include "tests/controllers/trajectory/flight_world.h"
#include "tests/controllers/waypoint_guidance/air_bench.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::guidance_conformance_test {
namespace {

std::vector<std::string> guidances_that_write(const std::string& signal) {
  return parts_that_write(PartKind::kGuidance, signal);
}

/// Those of them whose signal is of this type.
std::vector<std::string> guidances_that_write(const std::string& signal, const std::string& type) {
  std::vector<std::string> found;
  const VehicleDescription vehicles[] = {make_quadrotor_description(), make_plane_description()};
  for (const std::string& name : guidances_that_write(signal)) {
    for (const VehicleDescription& vehicle : vehicles) {
      Loop loop({.description = vehicle, .tick = Duration{50'000'000}});
      try {
        loop.add_guidance({name, {}});
        if (loop.find(signal)->type() == type) found.push_back(name);
        break;
      } catch (const ConfigError&) {
        // Not for this kind of vehicle.
      }
    }
  }
  return found;
}

/// A guidance alone between signals, in an alley of 2.5 m.
struct Bench : Loop {
  explicit Bench(const std::string& type, VehicleDescription vehicle = make_four_wheel_rover())
      : Loop({.description = std::move(vehicle),
              .tick = Duration{100'000'000},
              .map = &alley(),
              .sensors = make_rangers()}) {
    add_guidance({type, {}});
  }
  static const RowMap& alley() {
    static const RowMap map = make_map(make_alley());
    return map;
  }
  const LocalCommand& command() const { return read<LocalCommand>("local_command"); }

  /// One tick at a pose beside the plan, with echoes from 1.5 m ahead for a while.
  void step_at(std::int64_t i) {
    Odometry odometry;
    odometry.X_WB = {
        quaternion_from_rpy({0, 0, 0.1 * std::sin(0.3 * static_cast<double>(i))}),
        {0.05 * static_cast<double>(i), 0.1 * std::sin(0.2 * static_cast<double>(i)), 0}};
    odometry.v_WB_B.x() = 0.5;
    for (const char* ranger : {"front_left", "front_right", "side_left", "side_right"}) {
      RangeSample sample;
      sample.range_m = i > 100 && i < 150 ? 1.5 : std::numeric_limits<double>::infinity();
      sample.max_range_m = 4.0;
      sample.half_angle_rad = rad_from_deg(15);
      write(ranger, sample);
    }
    step(odometry);
  }
};

class EveryGroundGuidance : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryGroundGuidance, StandsStillWithoutPlanOrEstimate) {
  Bench bench(GetParam());
  bench.step();
  EXPECT_EQ(bench.command().mode, LocalCommand::Mode::kStop);
  EXPECT_EQ(bench.command().v_mps, 0.0);
  bench.step(Odometry{});
  EXPECT_EQ(bench.command().mode, LocalCommand::Mode::kStop);
  Bench other(GetParam());
  other.give_plan(make_alley().plan);
  other.step();
  EXPECT_EQ(other.command().mode, LocalCommand::Mode::kStop);
}

TEST_P(EveryGroundGuidance, TakesPlansOfOnePointAndOfNone) {
  for (const int points : {0, 1}) {
    Bench bench(GetParam());
    PlannedPath plan;
    plan.points.resize(points);
    bench.give_plan(plan);
    bench.step(Odometry{});
    EXPECT_EQ(bench.command().mode, LocalCommand::Mode::kStop);
  }
}

TEST_P(EveryGroundGuidance, CommandsAreFiniteWithinLimitsAndTheSameTwice) {
  Bench a(GetParam()), b(GetParam());
  bool has_moved = false;
  for (Bench* bench : {&a, &b}) bench->give_plan(make_alley().plan);
  for (std::int64_t i = 0; i < 400; ++i) {
    a.step_at(i);
    b.step_at(i);
    const LocalCommand &x = a.command(), &y = b.command();
    ASSERT_TRUE(std::isfinite(x.v_mps) && std::isfinite(x.front_axle_rad) &&
                std::isfinite(x.rear_axle_rad) && std::isfinite(x.clearance_m));
    ASSERT_LE(std::abs(x.v_mps), 1.6);
    ASSERT_LE(std::abs(x.front_axle_rad), rad_from_deg(23) + 1e-12);
    ASSERT_LE(std::abs(x.rear_axle_rad), rad_from_deg(23) + 1e-12);
    if (x.mode == LocalCommand::Mode::kStop) {
      ASSERT_EQ(x.v_mps, 0.0);
    }
    has_moved = has_moved || x.v_mps > 0.1;
    ASSERT_TRUE(x.mode == y.mode && x.v_mps == y.v_mps && x.front_axle_rad == y.front_axle_rad &&
                x.rear_axle_rad == y.rear_axle_rad && x.clearance_m == y.clearance_m)
        << i;
  }
  EXPECT_TRUE(has_moved);
}

TEST_P(EveryGroundGuidance, AllocatesOnlyToTellAnEvent) {
  Bench bench(GetParam());
  bench.give_plan(make_alley().plan);
  bench.step_at(0);
  std::size_t allocations = 0;
  for (std::int64_t i = 1; i < 400; ++i) {
    const std::size_t previous = bench.events().size();
    AllocationCounter counter;
    bench.step_at(i);
    if (bench.events().size() == previous) allocations += counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

TEST_P(EveryGroundGuidance, RefusesVehiclesItDoesNotKnowHowToDrive) {
  VehicleDescription description;
  description.type = "quadrotor";
  description.rotorcraft.emplace();
  try {
    Bench bench(GetParam(), description);
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find("rover.guidance (" + GetParam() + ") needs a vehicle with "), 0u) << text;
    EXPECT_NE(text.find("; vehicle type 'quadrotor' has rotors"), std::string::npos) << text;
  }
}

INSTANTIATE_TEST_SUITE_P(Guidances, EveryGroundGuidance,
                         ::testing::ValuesIn(guidances_that_write("local_command")),
                         [](const auto& test) { return test.param; });

/// A guidance of flying vehicles and a straight plan of 20 m in the air.
class EveryFlightGuidance : public ::testing::TestWithParam<std::string> {
 protected:
  static PlannedPath make_flight() {
    PlannedPath plan;
    const auto add = [&plan](double x, double z, PathKind kind) {
      PathPoint point;
      point.p_W = {x, 0.0, z};
      point.kind = kind;
      plan.points.push_back(point);
    };
    add(0.0, 0.2, PathKind::kVertical);
    add(0.0, 1.5, PathKind::kLeg);
    add(20.0, 1.5, PathKind::kVertical);
    add(20.0, 0.2, PathKind::kVertical);
    return plan;
  }
  static Odometry at(const Eigen::Vector3d& p_W) {
    Odometry odometry;
    odometry.X_WB.p = p_W;
    return odometry;
  }
  /// A vehicle that is pushed about.
  static Odometry shaken(const TrajectoryPoint& point, int i) {
    Odometry odometry = at(point.p_W);
    odometry.X_WB.p += Eigen::Vector3d(0.3 * std::sin(0.3 * i), 0.2 * std::cos(0.2 * i), 0.0);
    odometry.X_WB.q = quaternion_from_rpy({0.1 * std::sin(0.5 * i), 0.0, point.yaw_rad});
    odometry.X_WB.p.z() = std::max(odometry.X_WB.p.z(), 0.2);
    return odometry;
  }
};

TEST_P(EveryFlightGuidance, WaitsAtItsPlaceWithoutPlanOrEstimate) {
  GuideBench bench({}, GetParam());
  const ReferenceTrajectory blind = bench.step();
  EXPECT_EQ(blind.phase, Phase::kWait);
  const ReferenceTrajectory seeing = bench.step(at({1, 2, 3}));
  EXPECT_EQ(seeing.phase, Phase::kWait);
  ASSERT_FALSE(seeing.points.empty());
  EXPECT_EQ(blind.points.size(), seeing.points.size());
  for (const TrajectoryPoint& point : seeing.points) {
    EXPECT_EQ(point.p_W, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(point.v_W, Eigen::Vector3d::Zero());
  }
  GuideBench other({}, GetParam());
  other.give_plan(make_flight());
  EXPECT_EQ(other.step().phase, Phase::kWait);
}

TEST_P(EveryFlightGuidance, TakesPlansOfOnePointAndOfNone) {
  for (const int points : {0, 1}) {
    GuideBench bench({}, GetParam());
    PlannedPath plan;
    plan.points.resize(static_cast<std::size_t>(points));
    bench.give_plan(plan);
    EXPECT_EQ(bench.step(at({0, 0, 0.2})).phase, Phase::kWait);
  }
}

TEST_P(EveryFlightGuidance, ReferencesAreFiniteComeToAnEndAndAreTheSameTwice) {
  GuideBench a({}, GetParam()), b({}, GetParam());
  for (GuideBench* bench : {&a, &b}) bench->give_plan(make_flight());
  Odometry estimate = at({0, 0, 0.2});
  std::size_t points = 0;
  Phase phase = Phase::kWait;
  double fastest = 0.0;
  for (int i = 0; i < 1200 && phase != Phase::kDone; ++i) {
    const ReferenceTrajectory& x = a.step(estimate);
    const ReferenceTrajectory& y = b.step(estimate);
    if (points == 0) points = x.points.size();
    ASSERT_EQ(x.points.size(), points);
    ASSERT_GT(x.dt_s, 0.0);
    for (std::size_t k = 0; k < points; ++k) {
      const TrajectoryPoint& p = x.points[k];
      ASSERT_TRUE(p.p_W.allFinite() && p.v_W.allFinite() && p.a_W.allFinite());
      ASSERT_TRUE(std::isfinite(p.yaw_rad) && std::isfinite(p.yaw_rate_radps));
      ASSERT_TRUE(p.p_W == y.points[k].p_W && p.v_W == y.points[k].v_W &&
                  p.a_W == y.points[k].a_W && p.yaw_rad == y.points[k].yaw_rad);
      fastest = std::max(fastest, p.v_W.norm());
    }
    ASSERT_TRUE(x.phase == y.phase && x.distance_m == y.distance_m);
    ASSERT_GE(x.remaining_m, 0.0);
    phase = x.phase;
    estimate = shaken(x.points[1], i);
  }
  EXPECT_EQ(phase, Phase::kDone);
  EXPECT_GT(fastest, 1.0);
}

TEST_P(EveryFlightGuidance, HoldsWhereItsAuthorityEndsAndGoesOnFromThere) {
  GuideBench bench({}, GetParam());
  bench.give_plan(make_flight());
  constexpr double kMiddle_m = 1.3 + 10.0;  // up, and half the leg
  bench.give_authority(kMiddle_m);
  std::vector<ReferenceTrajectory> seen;
  bool is_released = false;
  const auto each = [&](double time_s, const ReferenceTrajectory& reference) {
    seen.push_back(reference);
    ASSERT_LT(reference.points[0].a_W.norm(), 2.0) << time_s;
    if (is_released) return;
    ASSERT_LE(reference.distance_m, kMiddle_m + 0.1) << time_s;
    if (time_s >= 30.0) {
      EXPECT_GE(reference.distance_m, kMiddle_m - 0.3);
      EXPECT_EQ(reference.points[0].v_W, Eigen::Vector3d::Zero());
      EXPECT_NE(reference.phase, Phase::kDone);
      bench.give_authority(std::numeric_limits<double>::infinity());
      is_released = true;
    }
  };
  bench.fly({0, 0, 0.2}, 100.0, 0.2, each);
  EXPECT_TRUE(is_released);
  EXPECT_EQ(seen.back().phase, Phase::kDone);
  // The preview is what comes, and positions, speeds and accelerations belong together.
  for (std::size_t i = 1; i + 1 < seen.size() && seen[i + 1].phase != Phase::kLand; ++i) {
    const double dt_s = seen[i].dt_s;
    const TrajectoryPoint &before = seen[i - 1].points[0], &now = seen[i].points[0],
                          &next = seen[i + 1].points[0];
    const bool is_new_event = i >= 599 && i <= 602;  // the release
    ASSERT_LT((next.p_W - before.p_W - 2.0 * dt_s * now.v_W).norm(), 2e-3) << i;
    if (is_new_event) continue;
    for (std::size_t k = 0; k < 5 && i + k < 599; ++k) {
      ASSERT_LT((seen[i + k].points[0].p_W - seen[i].points[k].p_W).norm(), 1e-9) << i << " " << k;
      ASSERT_LT((seen[i + k].points[0].v_W - seen[i].points[k].v_W).norm(), 1e-9) << i << " " << k;
    }
  }
}

TEST_P(EveryFlightGuidance, StaysOnTheGroundWithoutAuthority) {
  GuideBench bench({}, GetParam());
  bench.give_plan(make_flight());
  bench.give_authority(-2.0);
  bench.fly({0, 0, 0.2}, 20.0, 0.2, [&](double, const ReferenceTrajectory& reference) {
    for (const TrajectoryPoint& point : reference.points) {
      ASSERT_LT((point.p_W - Eigen::Vector3d(0, 0, 0.2)).norm(), 1e-9);
    }
  });
  bench.give_authority(std::numeric_limits<double>::infinity());
  Phase phase = Phase::kWait;
  bench.fly({0, 0, 0.2}, 100.0, 0.2,
            [&](double, const ReferenceTrajectory& reference) { phase = reference.phase; });
  EXPECT_EQ(phase, Phase::kDone);
}

TEST_P(EveryFlightGuidance, IsTheSameWithEndlessAuthorityAsWithout) {
  GuideBench a({}, GetParam()), b({}, GetParam());
  for (GuideBench* bench : {&a, &b}) bench->give_plan(make_flight());
  b.give_authority(std::numeric_limits<double>::infinity());
  Odometry estimate = at({0, 0, 0.2});
  for (int i = 0; i < 600; ++i) {
    const ReferenceTrajectory& x = a.step(estimate);
    const ReferenceTrajectory& y = b.step(estimate);
    for (std::size_t k = 0; k < x.points.size(); ++k) {
      ASSERT_TRUE(x.points[k].p_W == y.points[k].p_W && x.points[k].a_W == y.points[k].a_W);
    }
    estimate = shaken(x.points[1], i);
  }
}

TEST_P(EveryFlightGuidance, AllocatesOnlyToTellAnEvent) {
  GuideBench bench({}, GetParam());
  bench.give_plan(make_flight());
  Odometry estimate = at({0, 0, 0.2});
  bench.step(estimate);
  std::size_t allocations = 0;
  for (int i = 0; i < 800; ++i) {
    const std::size_t previous = bench.events().size();
    AllocationCounter counter;
    const ReferenceTrajectory& reference = bench.step(estimate);
    if (bench.events().size() == previous) allocations += counter.count();
    estimate = shaken(reference.points[1], i);
  }
  EXPECT_EQ(allocations, 0u);
}

TEST_P(EveryFlightGuidance, RefusesVehiclesThatDoNotFly) {
  try {
    GuideBench bench({}, GetParam(), make_four_wheel_rover());
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text, "drone.guidance (" + GetParam() +
                        ") needs a vehicle with rotors; vehicle type 'four_wheel_steering_rover' "
                        "has wheels and two steered axles");
  }
}

INSTANTIATE_TEST_SUITE_P(Guidances, EveryFlightGuidance,
                         ::testing::ValuesIn(guidances_that_write("reference",
                                                                  "ReferenceTrajectory")),
                         [](const auto& test) { return test.param; });

/// A guidance of vehicles on wings, a square in the air and a launcher beside it.
class EveryAirGuidance : public ::testing::TestWithParam<std::string> {
 protected:
  static PlannedPath make_flight() {
    return make_waypoints({{100, 0, 40}, {300, 0, 40}, {300, 200, 45}, {100, 200, 40}});
  }
  static PlaneOptions on_launcher() {
    PlaneOptions options;
    options.is_flying = false;
    options.wind = {1.0, -1.5};
    return options;
  }
  static bool is_finite(const AirReference& r) {
    return std::isfinite(r.airspeed_mps) && std::isfinite(r.course_rad) &&
           std::isfinite(r.heading_rad) && std::isfinite(r.heading_rate_radps) &&
           std::isfinite(r.bank_rad) && std::isfinite(r.height_m) &&
           std::isfinite(r.climb_angle_rad) && r.wind_W.allFinite() &&
           std::isfinite(r.cross_track_m) && std::isfinite(r.distance_m) &&
           std::isfinite(r.remaining_m);
  }
};

TEST_P(EveryAirGuidance, WaitsWithoutPlanOrEstimate) {
  AirBench bench({}, on_launcher(), GetParam());
  const AirReference blind = bench.step();
  EXPECT_EQ(blind.phase, AirReference::Phase::kWait);
  EXPECT_FALSE(blind.power);
  EXPECT_TRUE(is_finite(blind));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(bench.tick().phase, AirReference::Phase::kWait);
  AirBench other({}, on_launcher(), GetParam());
  other.give_plan(make_flight());
  EXPECT_EQ(other.step().phase, AirReference::Phase::kWait);
  EXPECT_FALSE(other.step().power);
}

TEST_P(EveryAirGuidance, TakesPlansOfOnePointAndOfNone) {
  for (const int points : {0, 1}) {
    AirBench bench({}, on_launcher(), GetParam());
    PlannedPath plan;
    plan.points.resize(static_cast<std::size_t>(points));
    bench.give_plan(plan);
    for (int i = 0; i < 60; ++i) EXPECT_EQ(bench.tick().phase, AirReference::Phase::kWait);
  }
}

TEST_P(EveryAirGuidance, ReferencesAreFiniteComeToAnEndAndAreTheSameTwice) {
  AirBench a({}, on_launcher(), GetParam()), b({}, on_launcher(), GetParam());
  for (AirBench* bench : {&a, &b}) bench->give_plan(make_flight());
  AirReference::Phase phase = AirReference::Phase::kWait;
  double farthest_m = 0.0;
  for (int i = 0; i < 12000 && phase != AirReference::Phase::kDone; ++i) {
    const AirReference& x = a.tick();
    const AirReference& y = b.tick();
    ASSERT_TRUE(is_finite(x));
    ASSERT_TRUE(x.phase == y.phase && x.power == y.power && x.heading_rad == y.heading_rad &&
                x.bank_rad == y.bank_rad && x.height_m == y.height_m &&
                x.climb_angle_rad == y.climb_angle_rad && x.wind_W == y.wind_W &&
                x.cross_track_m == y.cross_track_m && x.distance_m == y.distance_m);
    ASSERT_GE(x.remaining_m, 0.0);
    phase = x.phase;
    farthest_m = std::max(farthest_m, x.distance_m);
  }
  EXPECT_EQ(phase, AirReference::Phase::kDone);
  EXPECT_NEAR(farthest_m, 600.0, 1.0);
}

TEST_P(EveryAirGuidance, AllocatesOnlyToTellAnEvent) {
  AirBench bench({}, on_launcher(), GetParam());
  bench.give_plan(make_flight());
  bench.tick();
  std::size_t allocations = 0;
  for (int i = 0; i < 12000; ++i) {
    const std::size_t previous = bench.events().size();
    AllocationCounter counter;
    const AirReference& reference = bench.tick();
    if (bench.events().size() == previous) allocations += counter.count();
    if (reference.phase == AirReference::Phase::kDone) break;
  }
  EXPECT_EQ(allocations, 0u);
}

TEST_P(EveryAirGuidance, RefusesVehiclesWithoutWings) {
  try {
    AirBench bench({}, on_launcher(), GetParam(), make_four_wheel_rover());
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text, "plane.guidance (" + GetParam() +
                        ") needs a vehicle with wings; vehicle type 'four_wheel_steering_rover' "
                        "has wheels and two steered axles");
  }
}

INSTANTIATE_TEST_SUITE_P(Guidances, EveryAirGuidance,
                         ::testing::ValuesIn(guidances_that_write("reference", "AirReference")),
                         [](const auto& test) { return test.param; });

/// Guidances that plan by themselves, to goals from outside the run.
class EveryGoalGuidance : public ::testing::TestWithParam<std::string> {};

/// Plans to a goal straight ahead, in three ticks. @param plans  number of plans that were written
PlannedPath plan_to_goal(const std::string& type, std::uint64_t& plans) {
  const VehicleDescription vehicle = make_four_wheel_rover();
  SignalBus bus;
  ControllerContext context;
  context.vehicle = "rover";
  context.part = "rover.guidance";
  context.period = Duration{100'000'000};
  context.vehicle_description = &vehicle;
  context.map = &Bench::alley();
  const auto guidance = parts().make_guidance(
      type, make_parameters(PartKind::kGuidance, PartChoice{type, {}}), context);
  Ports test(bus, "rover", "test"), ports(bus, "rover", "rover.guidance");
  test.write<Odometry>("estimate").write(Time{}, Odometry{});
  guidance->connect(ports);
  const PoseTarget goal{{Eigen::Quaterniond::Identity(), {5.0, 0.0, 0.0}}};
  static_cast<Signal<PoseTarget>*>(bus.find("rover/goal_pose"))->write(Time{}, goal);
  const SignalReader<PlannedPath> plan = test.read<PlannedPath>("plan");
  for (int i = 0; i < 3; ++i) guidance->step(Time{i * context.period.ns});
  plans = plan.sequence();
  return plan.value();
}

TEST_P(EveryGoalGuidance, PlansToEachGoalOnceAndTheSameTwice) {
  std::uint64_t plans = 0;
  const PlannedPath path = plan_to_goal(GetParam(), plans);
  EXPECT_EQ(plans, 1u);
  ASSERT_GT(path.points.size(), 2u);
  EXPECT_NEAR(path.length_m, 5.0, 1e-6) << "straight on";
  const PlannedPath again = plan_to_goal(GetParam(), plans);
  ASSERT_EQ(again.points.size(), path.points.size());
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    EXPECT_EQ(again.points[i].p_W, path.points[i].p_W);
  }
}

TEST_P(EveryGoalGuidance, RefusesVehiclesThatFly) {
  try {
    Bench bench(GetParam(), make_quadrotor_description());
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("needs a vehicle with wheels"), std::string::npos)
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Guidances, EveryGoalGuidance,
                         ::testing::ValuesIn(guidances_that_write("plan")),
                         [](const auto& test) { return test.param; });

class EveryGuidance : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryGuidance, DocumentsItsParametersAndSignals) {
  const PartSpec& spec = parts().spec(PartKind::kGuidance, GetParam());
  EXPECT_GT(spec.default_rate_Hz, 0.0);
  EXPECT_FALSE(spec.reads.empty() || spec.writes.empty());
  for (const ParameterSpec& parameter : spec.parameters) {
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
  }
}

TEST_P(EveryGuidance, IsOfOneOfTheKindsTestedHere) {
  const auto ground = guidances_that_write("local_command");
  const auto flight = guidances_that_write("reference", "ReferenceTrajectory");
  const auto air = guidances_that_write("reference", "AirReference");
  const auto goals = guidances_that_write("plan");
  EXPECT_EQ(std::count(ground.begin(), ground.end(), GetParam()) +
                std::count(flight.begin(), flight.end(), GetParam()) +
                std::count(air.begin(), air.end(), GetParam()) +
                std::count(goals.begin(), goals.end(), GetParam()),
            1);
}

INSTANTIATE_TEST_SUITE_P(Guidances, EveryGuidance,
                         ::testing::ValuesIn(parts().names(PartKind::kGuidance)),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vinerow::test::guidance_conformance_test
