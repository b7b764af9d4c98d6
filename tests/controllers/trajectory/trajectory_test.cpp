// Guidance `trajectory`: the reference over whole flights.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/trajectory/flight_world.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::trajectory_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Vec3 = Eigen::Vector3d;

constexpr double kRadius_m = 1.77;

/// Two rows of Parcel F's length on a slope with bumps, home over the rows of a third alley.
const PlannedPath& slope_plan() {
  static const PlannedPath plan = [] {
    FlightBench bench({.alleys = 3}, make_bumpy_slope());
    bench.values = {{"turns", std::string("dubins")}};
    return bench.plan(1.25, -6.0).value();
  }();
  return plan;
}

/// The same on flat ground, two rows only.
const PlannedPath& flat_plan() {
  static const PlannedPath plan = [] {
    FlightBench bench;
    bench.values = {{"turns", std::string("dubins")}};
    return bench.plan(1.25, -6.0).value();
  }();
  return plan;
}

struct Tick {
  double time_s;
  TrajectoryPoint at;
  Phase phase;
  double distance_m;
};

/// Every tick of a flight of a vehicle that keeps up.
std::vector<Tick> fly(const PlannedPath& plan, const Values& values = {},
                      double floor_above_end_m = 0.0) {
  GuideBench bench(values);
  bench.give_plan(plan);
  std::vector<Tick> ticks;
  bench.fly(plan.points.front().p_W, 1000.0, plan.points.back().p_W.z() + floor_above_end_m,
            [&](double time_s, const ReferenceTrajectory& reference) {
              ticks.push_back({time_s, reference.points[0], reference.phase, reference.distance_m});
            });
  return ticks;
}

std::vector<Phase> phases_of(const std::vector<Tick>& ticks) {
  std::vector<Phase> phases;
  for (const Tick& tick : ticks) {
    if (phases.empty() || phases.back() != tick.phase) phases.push_back(tick.phase);
  }
  return phases;
}

TEST(Trajectory, GoesThroughThePhasesInOrder) {
  EXPECT_THAT(phases_of(fly(slope_plan())),
              ElementsAre(Phase::kTakeOff, Phase::kTransit, Phase::kRow, Phase::kTurn, Phase::kRow,
                          Phase::kTurn, Phase::kRow, Phase::kReturn, Phase::kLand, Phase::kDone));
}

/// Positions, velocities and accelerations belong together: over every millisecond of the horizon
/// the integrals of one are the differences of the other.
TEST(Trajectory, VelocityAndAccelerationAreThoseOfThePosition) {
  constexpr double kStep_s = 0.001;
  GuideBench bench({{"sample_s", kStep_s}, {"horizon", std::int64_t{50}}});
  bench.give_plan(slope_plan());
  double worst_v = 0.0, worst_p = 0.0, worst_yaw = 0.0, worst_jump = 0.0, worst_tangent = 0.0;
  Odometry estimate;
  estimate.X_WB.p = slope_plan().points.front().p_W;
  for (;;) {
    const ReferenceTrajectory& reference = bench.step(estimate);
    if (reference.phase == Phase::kLand || bench.time_s() > 1000.0) break;
    for (std::size_t i = 0; i + 1 < reference.points.size(); ++i) {
      const TrajectoryPoint &a = reference.points[i], &b = reference.points[i + 1];
      const Vec3 dv = b.v_W - a.v_W - 0.5 * kStep_s * (a.a_W + b.a_W);
      const Vec3 dp = b.p_W - a.p_W - 0.5 * kStep_s * (a.v_W + b.v_W) +
                      kStep_s * kStep_s / 12.0 * (b.a_W - a.a_W);
      const double dyaw =
          b.yaw_rad - a.yaw_rad - 0.5 * kStep_s * (a.yaw_rate_radps + b.yaw_rate_radps);
      worst_v = std::max(worst_v, dv.norm() / kStep_s);
      worst_p = std::max(worst_p, dp.norm() / kStep_s);
      worst_yaw = std::max(worst_yaw, std::abs(dyaw) / kStep_s);
      worst_jump = std::max(worst_jump, (b.a_W - a.a_W).norm());
      // The yaw follows the path where the vehicle moves along it.
      if (a.v_W.head<2>().norm() > 0.05) {
        worst_tangent = std::max(
            worst_tangent, std::abs(wrap_angle(a.yaw_rad - std::atan2(a.v_W.y(), a.v_W.x()))));
      }
    }
    estimate.X_WB.p = reference.points[50].p_W;
  }
  EXPECT_LT(worst_v, 1e-3);    // m/s2
  EXPECT_LT(worst_p, 1e-6);    // m/s
  EXPECT_LT(worst_yaw, 1e-4);  // rad/s
  EXPECT_LT(worst_tangent, 1e-9);
  EXPECT_LT(worst_jump, 0.012);  // m/s2 in 1 ms: the acceleration changes by 12 m/s3 at most
}

TEST(Trajectory, KeepsAllLimits) {
  for (const PlannedPath* plan : {&slope_plan(), &flat_plan()}) {
    const std::vector<Tick> ticks = fly(*plan, {{"sample_s", 0.05}});
    double speed = 0.0, across = 0.0, along = 0.0, up = 0.0, down = 0.0, rate = 0.0, yaw_a = 0.0;
    double last_rate = 0.0, lowest_speed = 0.0;
    for (const Tick& tick : ticks) {
      if (tick.phase == Phase::kDone) break;
      const TrajectoryPoint& at = tick.at;
      const double v = at.v_W.norm();
      speed = std::max(speed, v);
      up = std::max(up, at.v_W.z());
      down = std::max(down, -at.v_W.z());
      rate = std::max(rate, std::abs(at.yaw_rate_radps));
      yaw_a = std::max(yaw_a, std::abs(at.yaw_rate_radps - last_rate) / 0.05);
      last_rate = at.yaw_rate_radps;
      if (v > 1e-3) {
        const Vec3 t = at.v_W / v;
        along = std::max(along, std::abs(at.a_W.dot(t)));
        across = std::max(across, (at.a_W - at.a_W.dot(t) * t).norm());
      }
      if (tick.phase == Phase::kLand && at.p_W.z() < plan->points.back().p_W.z() + 0.5) {
        lowest_speed = std::max(lowest_speed, v);
      }
    }
    EXPECT_LE(speed, 3.0 + 1e-4);
    EXPECT_GE(speed, 2.999);
    EXPECT_LE(across, 1.5);
    EXPECT_GE(across, 1.3);
    EXPECT_LE(along, 1.0);
    EXPECT_GE(along, 0.9);
    EXPECT_LE(up, 1.5 + 1e-4);
    EXPECT_LE(down, 1.0 + 1e-4);
    EXPECT_LE(rate, 1.5);
    EXPECT_LE(yaw_a, 2.5);
    EXPECT_LE(lowest_speed, 0.3 + 1e-9);
  }
}

TEST(Trajectory, FliesRowsAtThreeMetresPerSecondAndTurnsSlowly) {
  const std::vector<Tick> ticks = fly(flat_plan());
  double row_m = 0.0, fast_m = 0.0, turn_m = 0.0, turn_s = 0.0, turn_fastest = 0.0;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const double step_m = (ticks[i].at.p_W - ticks[i - 1].at.p_W).norm();
    const double v = ticks[i].at.v_W.norm();
    if (ticks[i].phase == Phase::kRow) {
      row_m += step_m;
      if (v > 2.97) fast_m += step_m;
    }
    if (ticks[i].phase == Phase::kTurn) {
      turn_m += step_m;
      turn_s += ticks[i].time_s - ticks[i - 1].time_s;
      turn_fastest = std::max(turn_fastest, v);
    }
  }
  EXPECT_GT(row_m, 2 * 117.5);
  EXPECT_GE(fast_m / row_m, 0.9);
  // sqrt(1.5 * 1.77) = 1.63 m/s; slower where the curvature changes sign.
  EXPECT_GT(turn_m / turn_s, 1.45);
  EXPECT_LT(turn_fastest, 1.75);
}

/// Rounding moves an arc of radius R inwards by L^2 (1 + 1/4) / (24 R), its ends by half of that.
TEST(Trajectory, StaysOnThePlannedCurve) {
  const double inwards_m = 0.8 * 0.8 * 1.25 / (24.0 * kRadius_m);
  for (const PlannedPath* plan : {&slope_plan(), &flat_plan()}) {
    const std::vector<PlanSample> samples = sample_plan(*plan, 0.02);
    std::size_t near = 0;  // the flight goes along the plan
    double row_m = 0.0, turn_m = 0.0, other_m = 0.0, height_m = 0.0;
    for (const Tick& tick : fly(*plan)) {
      if (tick.phase == Phase::kLand) break;
      Vec3 off = Vec3::Constant(1e9), along = Vec3::Zero();
      const std::size_t from = near;
      for (std::size_t i = from; i < std::min(from + 60, samples.size() - 1); ++i) {
        const Vec3 chord = samples[i + 1].p_W - samples[i].p_W,
                   offset = tick.at.p_W - samples[i].p_W;
        const double length2 = std::max(chord.squaredNorm(), 1e-18);
        const Vec3 away = offset - std::clamp(offset.dot(chord) / length2, 0.0, 1.0) * chord;
        if (away.norm() >= off.norm()) continue;
        off = away;
        along = chord;
        near = i;
      }
      const double plane_m = std::max(along.head<2>().norm(), 1e-9);
      const double aside_m = std::abs(along.x() * off.y() - along.y() * off.x()) / plane_m;
      double& worst_m = tick.phase == Phase::kRow    ? row_m
                        : tick.phase == Phase::kTurn ? turn_m
                                                     : other_m;
      worst_m = std::max(worst_m, aside_m);
      height_m = std::max(height_m, std::abs(off.z()));
    }
    EXPECT_LT(row_m, 0.5 * inwards_m + 2e-3);  // a row's phase may last 5 cm into the turn
    EXPECT_GT(turn_m, inwards_m - 1e-3);
    EXPECT_LT(turn_m, inwards_m + 1e-3);
    EXPECT_LT(other_m, 1e-3);
    // The way home rises by 2 m within 6 m, curvature 0.22 / m at most, and follows bumps of
    // 0.04 / m; the plan itself has chords of 0.25 m there.
    EXPECT_LT(height_m, 0.26 * (0.8 * 0.8 * 1.25 / 24.0 + 0.25 * 0.25 / 8.0));
  }
}

TEST(Trajectory, TurnsToTheFirstRowWhileItClimbs) {
  const std::vector<Tick> ticks = fly(flat_plan());  // stands at yaw 0, the row leads to +y
  double before = 0.0;
  bool turned_in_the_air = false;
  for (const Tick& tick : ticks) {
    ASSERT_LT(std::abs(tick.at.yaw_rad - before), 0.08);  // continuous, also past half a turn
    before = tick.at.yaw_rad;
    if (tick.phase != Phase::kTakeOff) continue;
    if (tick.at.p_W.z() < 0.45) {
      ASSERT_NEAR(tick.at.yaw_rad, 0.0, 1e-12);
    }
    turned_in_the_air = turned_in_the_air || (tick.at.yaw_rad > 0.5 && tick.at.p_W.z() < 1.49);
  }
  EXPECT_TRUE(turned_in_the_air);
  const auto row = std::find_if(ticks.begin(), ticks.end(),
                                [](const Tick& t) { return t.phase == Phase::kRow; });
  EXPECT_NEAR(row->at.yaw_rad, 0.5 * kPi, 1e-9);
}

TEST(Trajectory, LandsWhereTheGroundIsNotWhereTheMapSays) {
  // It sinks on beyond its reserve of 1 m: a vehicle in the air is not on the ground.
  for (const double floor_m : {-3.0, -0.4, 0.0, 0.4}) {
    const std::vector<Tick> ticks = fly(flat_plan(), {}, floor_m);
    ASSERT_EQ(ticks.back().phase, Phase::kDone);
    const double end_m = flat_plan().points.back().p_W.z();
    EXPECT_NEAR(ticks.back().at.p_W.z(), end_m + floor_m, 1e-9);
    EXPECT_EQ(ticks.back().at.v_W.norm(), 0.0);
    // Not before it has stood for half a second: 0.15 m further down at 0.3 m/s.
    const Tick& before = ticks[ticks.size() - 2];
    EXPECT_LT(before.at.p_W.z(), end_m + floor_m - 0.1);
    EXPECT_GT(before.at.p_W.z(), end_m + floor_m - 0.3);
  }
}

TEST(Trajectory, DoesNotTakeALateStartOfTheDescentForTheGround) {
  // A vehicle that hangs three metres up for a second is not on the ground.
  GuideBench bench;
  bench.give_plan(flat_plan());
  Odometry estimate;
  estimate.X_WB.p = flat_plan().points.front().p_W;
  double lands_s = 0.0;
  Phase phase = Phase::kWait;
  for (int i = 0; i < 4000 && lands_s < 1.5; ++i) {
    const ReferenceTrajectory& reference = bench.step(estimate);
    phase = reference.phase;
    ASSERT_NE(phase, Phase::kDone);
    if (phase == Phase::kLand) {
      lands_s += 0.05;
    } else {
      estimate.X_WB.p = reference.points[1].p_W;
    }
  }
  EXPECT_EQ(phase, Phase::kLand);
}

TEST(Trajectory, IsTheSameTrajectoryOneTickLater) {
  GuideBench bench;
  bench.give_plan(slope_plan());
  ReferenceTrajectory before;
  // Ground below the landing's reserve.
  bench.fly(slope_plan().points.front().p_W, 1000.0, slope_plan().points.back().p_W.z() - 1.5,
            [&](double, const ReferenceTrajectory& now) {
              ASSERT_EQ(now.points.size(), 21u);
              if (!before.points.empty() && now.phase != Phase::kDone) {
                for (std::size_t i = 0; i + 1 < now.points.size(); ++i) {
                  const TrajectoryPoint &a = before.points[i + 1], &b = now.points[i];
                  ASSERT_NEAR((a.p_W - b.p_W).norm(), 0.0, 1e-9);
                  ASSERT_NEAR((a.v_W - b.v_W).norm(), 0.0, 1e-9);
                  ASSERT_NEAR((a.a_W - b.a_W).norm(), 0.0, 1e-6);
                  ASSERT_NEAR(a.yaw_rad, b.yaw_rad, 1e-9);
                }
              }
              before = now;
            });
  EXPECT_EQ(before.phase, Phase::kDone);
}

TEST(Trajectory, WaitsForAVehicleThatFallsBehind) {
  GuideBench bench;
  bench.give_plan(flat_plan());
  Odometry estimate;
  estimate.X_WB.p = flat_plan().points.front().p_W;
  const ReferenceTrajectory* reference = nullptr;
  for (int i = 0; i < 600; ++i) {  // 30 s: in the first row
    reference = &bench.step(estimate);
    estimate.X_WB.p = reference->points[1].p_W;
  }
  ASSERT_EQ(reference->phase, Phase::kRow);
  ASSERT_NEAR(reference->points[0].v_W.norm(), 3.0, 1e-6);
  const Vec3 held = estimate.X_WB.p;  // a gust holds it here
  const std::size_t event_count = bench.events().size();
  double deepest = 0.0;
  for (int i = 0; i < 300; ++i) {
    reference = &bench.step(estimate);
    const TrajectoryPoint &a = reference->points[0], &b = reference->points[1];
    // Also while it slows down the points belong together.
    ASSERT_NEAR((b.p_W - a.p_W - 0.025 * (a.v_W + b.v_W)).norm(), 0.0, 1e-3);
    deepest = std::max(deepest, -a.a_W.dot(a.v_W) / std::max(a.v_W.norm(), 1e-9));
  }
  EXPECT_NEAR(reference->points[0].v_W.norm(), 0.0, 1e-9);
  EXPECT_LT(deepest, 1.21);
  const double ahead_m = (reference->points[0].p_W - held).norm();
  EXPECT_GT(ahead_m, 1.0);
  EXPECT_LT(ahead_m, 6.0);
  ASSERT_EQ(bench.events().size(), event_count + 1);
  EXPECT_THAT(bench.events().back().text, HasSubstr("waits for it"));
  EXPECT_EQ(bench.events().back().level, Event::Level::kWarning);
  for (int i = 0; i < 200; ++i) {  // it comes back at 6 m/s
    const Vec3 to_go = reference->points[0].p_W - estimate.X_WB.p;
    if (to_go.norm() > 0.3) estimate.X_WB.p += 0.3 * to_go.normalized();
    if (to_go.norm() <= 0.3) estimate.X_WB.p = reference->points[1].p_W;
    reference = &bench.step(estimate);
  }
  EXPECT_NEAR(reference->points[0].v_W.norm(), 3.0, 1e-6);
  EXPECT_EQ(bench.events().size(), event_count + 1);
}

TEST(Trajectory, WritesTheSameBitsTwice) {
  const std::vector<Tick> a = fly(slope_plan()), b = fly(slope_plan());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].at.p_W, b[i].at.p_W);
    ASSERT_EQ(a[i].at.v_W, b[i].at.v_W);
    ASSERT_EQ(a[i].at.a_W, b[i].at.a_W);
    ASSERT_EQ(a[i].at.yaw_rad, b[i].at.yaw_rad);
  }
}

TEST(Trajectory, AllocatesOnlyToTakeThePlanAndToTell) {
  GuideBench bench;
  bench.give_plan(flat_plan());
  Odometry estimate;
  estimate.X_WB.p = flat_plan().points.front().p_W;
  bench.step(estimate);
  std::size_t allocations = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::size_t event_count = bench.events().size();
    AllocationCounter counter;
    const ReferenceTrajectory& reference = bench.step(estimate);
    if (bench.events().size() == event_count) allocations += counter.count();
    estimate.X_WB.p = reference.points[1].p_W;
    estimate.v_WB_B = reference.points[1].v_W;
    const double ground_m = flat_plan().points.back().p_W.z();
    if (estimate.X_WB.p.z() < ground_m) {
      estimate.X_WB.p.z() = ground_m;
      estimate.v_WB_B.setZero();
    }
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_THAT(bench.events().back().text, HasSubstr("landed at (1.25, -6.00)"));
}

TEST(Trajectory, StandsAtItsPlaceUntilThereIsAPlan) {
  GuideBench bench;
  EXPECT_EQ(bench.step().phase, Phase::kWait);
  Odometry estimate;
  estimate.X_WB = {quaternion_from_rpy({0, 0, 1.0}), {3, 4, 5}};
  for (const int points : {0, 1}) {
    PlannedPath plan;
    plan.points.resize(static_cast<std::size_t>(points));
    bench.give_plan(plan);
    const ReferenceTrajectory& reference = bench.step(estimate);
    EXPECT_EQ(reference.phase, Phase::kWait);
    EXPECT_EQ(reference.dt_s, 0.05);
    ASSERT_EQ(reference.points.size(), 21u);
    for (const TrajectoryPoint& point : reference.points) {
      EXPECT_EQ(point.p_W, Vec3(3, 4, 5));
      EXPECT_NEAR(point.yaw_rad, 1.0, 1e-12);
      EXPECT_EQ(point.v_W, Vec3::Zero());
    }
  }
  bench.give_plan(flat_plan());
  EXPECT_EQ(bench.step(estimate).phase, Phase::kTakeOff);
}

TEST(Trajectory, LeavesTheRotorsTimeToSpinUp) {
  const std::vector<Tick> ticks = fly(flat_plan(), {{"spin_up_s", 2.0}});
  for (const Tick& tick : ticks) {
    if (tick.time_s > 2.0) break;
    EXPECT_EQ(tick.phase, Phase::kTakeOff);
    EXPECT_NEAR((tick.at.p_W - flat_plan().points.front().p_W).norm(), 0.0, 1e-12);
  }
}

/// An L of straights on the ground, as planner `waypoints` makes them.
PlannedPath make_corner() {
  PlannedPath plan;
  for (const Vec3& p : {Vec3(5, 0, 1), Vec3(15, 0, 1), Vec3(15, 10, 1)}) {
    PathPoint point;
    point.p_W = p;
    point.kind = PathKind::kLeg;
    plan.points.push_back(point);
  }
  return plan;
}

TEST(Trajectory, FliesGroundPlansInTheAirAndStopsAtCorners) {
  GuideBench bench({{"height_m", 2.0}});
  bench.give_plan(make_corner());
  double min_mps = 1e9, at_corner_m = 1e9, highest_m = 0.0;
  Vec3 end = Vec3::Zero();
  bench.fly({0, 0, 1.2}, 200.0, 1.2, [&](double, const ReferenceTrajectory& reference) {
    const TrajectoryPoint& at = reference.points[0];
    highest_m = std::max(highest_m, at.p_W.z());
    if (reference.phase == Phase::kRow && at.p_W.x() > 14.0 && at.p_W.y() < 1.0) {
      min_mps = std::min(min_mps, at.v_W.norm());
      at_corner_m = std::min(at_corner_m, (at.p_W - Vec3(15, 0, 3)).norm());
    }
    end = at.p_W;
  });
  EXPECT_NEAR(highest_m, 3.0, 1e-9);
  EXPECT_NEAR(min_mps, 0.0, 1e-9);
  EXPECT_NEAR(at_corner_m, 0.0, 1e-9);
  EXPECT_NEAR((end - Vec3(15, 10, 1.2)).norm(), 0.0, 1e-6);
}

TEST(Trajectory, RoundsGentleBendsWithoutStopping) {
  PlannedPath plan = make_corner();
  plan.points[2].p_W = Vec3(15 + 10 * std::cos(0.2), 10 * std::sin(0.2), 1);
  GuideBench bench;
  bench.give_plan(plan);
  double min_mps = 1e9, across = 0.0;
  bench.fly({5, 0, 1.2}, 200.0, 1.2, [&](double, const ReferenceTrajectory& reference) {
    const TrajectoryPoint& at = reference.points[0];
    if (at.p_W.x() < 12.0 || at.p_W.x() > 18.0) return;
    min_mps = std::min(min_mps, at.v_W.norm());
    across = std::max(across, std::abs(at.v_W.x() * at.a_W.y() - at.v_W.y() * at.a_W.x()) /
                                  std::max(at.v_W.norm(), 1e-9));
  });
  // The bend becomes a triangle of curvature, 0.8 m by 0.4 m: the yaw acceleration limits.
  const double limited_mps = std::sqrt(2.5 * 0.8 * 0.4 / 0.2);
  EXPECT_LE(min_mps, limited_mps);
  EXPECT_GT(min_mps, 0.95 * limited_mps);
  EXPECT_LE(across, 1.5);
}

TEST(Trajectory, TakesWantedSpeedsOfThePlan) {
  PlannedPath plan = make_corner();
  plan.points[0].speed_mps = 1.0;
  GuideBench bench;
  bench.give_plan(plan);
  double first = 0.0, second = 0.0;
  bench.fly({5, 0, 1.2}, 200.0, 1.2, [&](double, const ReferenceTrajectory& reference) {
    const TrajectoryPoint& at = reference.points[0];
    first = std::max(first, std::abs(at.v_W.x()));
    second = std::max(second, std::abs(at.v_W.y()));
  });
  EXPECT_NEAR(first, 1.0, 1e-6);
  EXPECT_NEAR(second, 2.97, 0.04);  // 10 m from rest to rest at 1 m/s2
}

TEST(Trajectory, WarnsOfAPlanWithoutALanding) {
  PlannedPath plan = make_corner();
  for (PathPoint& point : plan.points) point.p_W.z() = 8.0;
  plan.points.insert(plan.points.begin(), plan.points.front());
  plan.points.front().p_W.z() = 1.2;
  plan.points.front().kind = PathKind::kVertical;
  for (const bool lands : {false, true}) {
    PlannedPath flown = plan;
    if (lands) {
      flown.points.back().kind = PathKind::kVertical;
      flown.points.push_back(flown.points.back());
      flown.points.back().p_W.z() = 1.2;
    }
    GuideBench bench;
    bench.give_plan(flown);
    Phase last = Phase::kWait;
    bench.fly({5, 0, 1.2}, 200.0, 1.2,
              [&](double, const ReferenceTrajectory& reference) { last = reference.phase; });
    EXPECT_EQ(last, lands ? Phase::kDone : Phase::kHover);
    EXPECT_EQ(bench.events().front().level, lands ? Event::Level::kInfo : Event::Level::kWarning);
    const std::string warning =
        "; its plan has no landing: it hovers at the end and does not finish";
    EXPECT_EQ(bench.events().front().text.ends_with(warning), !lands)
        << bench.events().front().text;
  }
}

TEST(Trajectory, HoldsAPlaceWithoutAPlan) {
  const Values values = {
      {"hover_m", std::vector<double>{4.0, 3.0, 2.0}}, {"hover_yaw_deg", 90.0}, {"hover_s", 5.0}};
  GuideBench bench(values);
  std::vector<Phase> phases;
  double held_s = 0.0;
  TrajectoryPoint end;
  bench.fly({0, 0, 10.2}, 100.0, 10.2, [&](double, const ReferenceTrajectory& reference) {
    const TrajectoryPoint& at = reference.points[0];
    if (phases.empty() || phases.back() != reference.phase) phases.push_back(reference.phase);
    if (reference.phase == Phase::kHover && std::abs(at.yaw_rad - 0.5 * kPi) < 1e-9) {
      held_s += 0.05;
      EXPECT_NEAR((at.p_W - Vec3(4, 3, 12)).norm(), 0.0, 1e-9);
    }
    end = at;
  });
  EXPECT_THAT(phases, ElementsAre(Phase::kTakeOff, Phase::kTransit, Phase::kHover, Phase::kLand,
                                  Phase::kDone));
  EXPECT_NEAR(held_s, 5.0, 0.1);
  EXPECT_NEAR((end.p_W - Vec3(4, 3, 10.2)).norm(), 0.0, 1e-6);
  EXPECT_THAT(bench.events().front().text, testing::ContainsRegex("for 8\\.6 m in [0-9.]+ s$"));
  // Hovers endlessly.
  GuideBench still({{"hover_m", std::vector<double>{0.0, 0.0, 2.0}}});
  Phase last = Phase::kWait;
  still.fly({0, 0, 0.2}, 300.0, 0.2,
            [&](double, const ReferenceTrajectory& reference) { last = reference.phase; });
  EXPECT_EQ(last, Phase::kHover);
  EXPECT_EQ(still.events().front().text, "takes off for 3.6 m");
}

TEST(Trajectory, ToldToHoverItSaysThatItIgnoresAPlan) {
  GuideBench bench({{"hover_m", std::vector<double>{0.0, 0.0, 2.0}}});
  bench.give_plan(make_corner());
  bench.fly({0, 0, 0.2}, 1.0, 0.2, [](double, const ReferenceTrajectory&) {});
  const auto warnings =
      std::count_if(bench.events().begin(), bench.events().end(), [](const Event& event) {
        return event.level == Event::Level::kWarning &&
               event.text == "ignores the plan, since hover_m is given";
      });
  EXPECT_EQ(warnings, 1);
}

TEST(Trajectory, NamesTheLimitOfEachStretchThatAPlanWantsFaster) {
  const auto told = [](double row_mps, double return_mps) {
    PlannedPath plan = flat_plan();
    for (PathPoint& point : plan.points) {
      if (point.kind == PathKind::kLeg) point.speed_mps = row_mps;
      if (point.kind == PathKind::kReturn) point.speed_mps = return_mps;
    }
    GuideBench bench({{"row_speed_mps", 3.0}, {"return_speed_mps", 6.0}});
    bench.give_plan(plan);
    bench.fly(plan.points.front().p_W, 1.0, 0.0, [](double, const ReferenceTrajectory&) {});
    return bench.events().front().text;
  };
  EXPECT_THAT(told(3.0, 6.0), testing::Not(HasSubstr("wants")));
  EXPECT_THAT(told(4.0, 6.0),
              HasSubstr("; the plan wants up to 4 m/s, the limit is 3 m/s (row_speed_mps)"));
  EXPECT_THAT(told(3.0, 7.0),
              HasSubstr("; the plan wants up to 7 m/s, the limit is 6 m/s (return_speed_mps)"));
}

TEST(Trajectory, RefusesAPlanToTheEdgeOfSpace) {
  PlannedPath plan = flat_plan();
  for (PathPoint& point : plan.points) point.p_W.z() += 1.5e5;
  plan.points.front().p_W.z() = 0.2;
  GuideBench bench;
  bench.give_plan(plan);
  try {
    bench.step({});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("of the plan is too long for a flight, must be at most "
                                        "100 km: lower its heights, or bring its places nearer"));
  }
}

std::string refusal_of(const Values& values,
                       VehicleDescription vehicle = make_quadrotor_description()) {
  try {
    GuideBench bench(values, "trajectory", std::move(vehicle));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Trajectory, TellsWhatIsWrongWithItsParameters) {
  EXPECT_EQ(refusal_of({{"row_speed_mps", 12.0}}),
            "drone.guidance (trajectory): row_speed_mps = 12.00 m/s is more than the 10.00 m/s "
            "that vehicle type 'quadrotor' can fly");
  EXPECT_EQ(refusal_of({{"landing_speed_mps", 1.0}}),
            "drone.guidance (trajectory): landing_speed_mps = 1.00 m/s, must be less than the 1.00 "
            "m/s at which touching the ground is a crash for vehicle type 'quadrotor'");
  EXPECT_EQ(
      refusal_of({{"hover_s", 5.0}}),
      "drone.guidance (trajectory): hover_yaw_deg and hover_s describe how to hold a place: add "
      "hover_m");
  EXPECT_EQ(refusal_of({{"hover_m", std::vector<double>{0.0, 0.0, 0.1}}}),
            "drone.guidance (trajectory): hover_m holds a height of 0.10 m, which is not above the "
            "0.20 m at which the centre of mass of vehicle type 'quadrotor' is on the ground");
  EXPECT_EQ(refusal_of({{"height_m", 0.1}}),
            "drone.guidance (trajectory): height_m = 0.10 m is not above the 0.20 m at which the "
            "centre of mass of vehicle type 'quadrotor' is on the ground");
  EXPECT_THAT(refusal_of({{"acceleration_mps2", 0.0}}), HasSubstr("must be >= 0.001 m/s2"));
  VehicleDescription rover = make_four_wheel_description();
  EXPECT_EQ(refusal_of({}, rover),
            "drone.guidance (trajectory) needs a vehicle with rotors; vehicle type "
            "'four_wheel_steering_rover' has wheels");
}

}  // namespace
}  // namespace vinerow::test::trajectory_test
