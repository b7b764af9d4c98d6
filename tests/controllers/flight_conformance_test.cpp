// How well every registered controller of a rotorcraft flies, that is one that writes "wrench".
// What else it keeps: flight_contract_test.cpp. Ground vehicles: conformance_test.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/angles.h"
#include "tests/controllers/support/quadrotor_loop.h"

namespace vinerow::test::flight_conformance_test {
namespace {

constexpr double kTiltLimit_rad = 25.0 * kPi / 180.0;
/// What the tilt may swing beyond the wanted one.
constexpr double kTiltSwing_rad = 2.5 * kPi / 180.0;

class EveryFlightController : public ::testing::TestWithParam<std::string> {
 protected:
  QuadrotorSetup make_setup(const QuadrotorNumbers& numbers = make_q4t()) const {
    QuadrotorSetup setup;
    setup.numbers = numbers;
    setup.controller.type = GetParam();
    setup.start.p = {0, 0, 2};
    return setup;
  }
  void record(const std::string& what, double value) {
    RecordProperty(what, std::to_string(value));
  }
};

std::vector<QuadrotorNumbers> all_vehicles() {
  return {make_q4t(), make_m100(), with_plus_layout(make_q4t())};
}

void expect_within_limits(const QuadrotorLoop& loop) {
  const QuadrotorState& state = loop.sim().state();
  ASSERT_TRUE(state.p_W.allFinite() && state.w_B.allFinite()) << loop.time_s();
  const QuadrotorNumbers& numbers = loop.sim().numbers();
  for (const double speed : loop.actuators()) {
    ASSERT_TRUE(speed >= numbers.min_radps && speed <= numbers.max_radps) << speed;
  }
}

TEST_P(EveryFlightController, HoversWithinAMillimetre) {
  for (const QuadrotorNumbers& numbers : all_vehicles()) {
    QuadrotorSetup setup = make_setup(numbers);
    setup.path = hover_at({0.2, -0.3, 2.2}, 0.4);
    QuadrotorLoop loop(setup);
    loop.run_until(10.0, [&] { expect_within_limits(loop); });
    EXPECT_LT(loop.path_error().norm(), 1e-3);
    EXPECT_LT(std::abs(loop.follower().heading_error_rad), 1e-3);
    EXPECT_LT(loop.sim().state().v_W.norm(), 1e-3);
  }
}

TEST_P(EveryFlightController, StepsAMetreToAnySideWithoutLeavingLimits) {
  for (const QuadrotorNumbers& numbers : all_vehicles()) {
    for (const Eigen::Vector3d& step : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                                        Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1)}) {
      QuadrotorSetup setup = make_setup(numbers);
      const Eigen::Vector3d goal = setup.start.p + step;
      setup.path = hover_at(goal);
      QuadrotorLoop loop(setup);
      double tilt = 0.0, beyond = 0.0, aside = 0.0;
      loop.run_until(6.0, [&] {
        expect_within_limits(loop);
        const Eigen::Vector3d e = loop.sim().state().p_W - goal;
        tilt = std::max(tilt, loop.sim().tilt_rad());
        beyond = std::max(beyond, e.dot(step));
        aside = std::max(aside, (e - e.dot(step) * step).norm());
      });
      EXPECT_LT(tilt, kTiltLimit_rad + kTiltSwing_rad) << step.transpose();
      EXPECT_LT(beyond, 0.15) << step.transpose();
      EXPECT_LT(aside, 0.1) << step.transpose();
      EXPECT_LT((loop.sim().state().p_W - goal).norm(), 0.02) << step.transpose();
    }
  }
}

TEST_P(EveryFlightController, TiltsNoMoreThanItsVehicleMay) {
  const auto calc_tilt_rad = [&](double max_rad) {
    QuadrotorNumbers numbers = make_q4t();
    numbers.max_tilt_rad = max_rad;
    QuadrotorSetup setup = make_setup(numbers);
    setup.path = hover_at(setup.start.p + Eigen::Vector3d(3, 0, 0));
    QuadrotorLoop loop(setup);
    double tilt_rad = 0.0;
    loop.run_until(6.0, [&] { tilt_rad = std::max(tilt_rad, loop.sim().tilt_rad()); });
    return tilt_rad;
  };
  const double low_rad = rad_from_deg(8.0);
  EXPECT_LT(calc_tilt_rad(low_rad), low_rad + kTiltSwing_rad);
  EXPECT_GT(calc_tilt_rad(kTiltLimit_rad), low_rad + 2.0 * kTiltSwing_rad);
}

TEST_P(EveryFlightController, TurnsOnTheSpot) {
  for (const QuadrotorNumbers& numbers : all_vehicles()) {
    for (const double yaw : {0.5 * kPi, -0.5 * kPi}) {
      QuadrotorSetup setup = make_setup(numbers);
      setup.path = hover_at(setup.start.p, yaw);
      QuadrotorLoop loop(setup);
      double away_m = 0.0;
      loop.run_until(6.0, [&] {
        expect_within_limits(loop);
        away_m = std::max(away_m, loop.path_error().norm());
      });
      EXPECT_LT(away_m, 0.05);
      EXPECT_NEAR(loop.follower().heading_error_rad, 0.0, 0.02);
    }
  }
}

TEST_P(EveryFlightController, FollowsAStraightAndATurnInCalmAir) {
  for (const QuadrotorNumbers& numbers : all_vehicles()) {
    QuadrotorSetup setup = make_setup(numbers);
    setup.path = row_and_turn(setup.start.p, 0.3, 3.0, 1e9);
    setup.start.q = quaternion_from_rpy({0, 0, 0.3});
    QuadrotorLoop row(setup);
    double row_m = 0.0, turn_m = 0.0;
    row.run_until(
        8.0, [&] { row_m = std::max(row_m, row.path_error().tail<2>().cwiseAbs().maxCoeff()); });
    EXPECT_LT(row_m, 0.02);
    EXPECT_LT(row.path_error().norm(), 0.02);
    // The turn of the reference, section 5: 1.77 m at 1.63 m/s.
    setup.path = row_and_turn(setup.start.p, 0.3, 1.63, 4.0, 1.77, kPi);
    QuadrotorLoop turn(setup);
    turn.run_until(10.0, [&] {
      turn_m = std::max(turn_m, turn.path_error().tail<2>().cwiseAbs().maxCoeff());
    });
    EXPECT_LT(turn_m, 0.05);
    EXPECT_LT(std::abs(turn.path_error().y()), 0.01);
    record("straight_max_m", row_m);
    record("turn_max_m", turn_m);
  }
}

TEST_P(EveryFlightController, LeavesNoErrorInASteadyWind) {
  QuadrotorSetup setup = make_setup();
  setup.path = row_and_turn(setup.start.p, 0.0, 3.0, 1e9);
  setup.wind = [](double, const Eigen::Vector3d&) { return Eigen::Vector3d(0, 3, 0); };
  QuadrotorLoop loop(setup);
  double largest_m = 0.0;
  // The wind sets in at once: the worst gust there is.
  loop.run_until(15.0, [&] { largest_m = std::max(largest_m, std::abs(loop.path_error().y())); });
  EXPECT_LT(largest_m, 0.15);
  EXPECT_LT(loop.path_error().norm(), 0.01);
}

TEST_P(EveryFlightController, KeepsTheRowInGusts) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    QuadrotorSetup setup = make_setup();
    setup.path = row_and_turn(setup.start.p, 0.0, 3.0, 1e9);
    setup.wind = gusty_wind({0, 3, 0}, 1.0, 2.0, 45.0, seed);
    QuadrotorLoop loop(setup);
    double side_m = 0.0, height_m = 0.0, square_m2 = 0.0;
    std::int64_t samples = 0;
    loop.run_until(40.0, [&] {
      if (loop.time_s() < 5.0) return;  // the wind began at once
      const Eigen::Vector3d e = loop.path_error();
      side_m = std::max(side_m, std::abs(e.y()));
      height_m = std::max(height_m, std::abs(e.z()));
      square_m2 += e.y() * e.y();
      ++samples;
    });
    // Issue: 0.10 m aside in 3 m/s with gusts of 1 m/s. Altitude 10 % of 1.5 m.
    EXPECT_LT(side_m, 0.10) << seed;
    EXPECT_LT(height_m, 0.15) << seed;
    record("gusts_max_m", side_m);
    record("gusts_rms_m", std::sqrt(square_m2 / static_cast<double>(samples)));
  }
}

TEST_P(EveryFlightController, StandsInTheWindWhereItsAuthorityEndsAndGoesOn) {
  QuadrotorSetup setup = make_setup();
  setup.guidance = {"trajectory", {}};
  const auto add = [&](double x, double z, PathKind kind) {
    PathPoint point;
    point.p_W = {x, 0.0, z};
    point.kind = kind;
    setup.plan.points.push_back(point);
  };
  add(0.0, 0.2, PathKind::kVertical);
  add(0.0, 2.2, PathKind::kLeg);
  add(40.0, 2.2, PathKind::kVertical);
  add(40.0, 0.2, PathKind::kVertical);
  setup.start.p = {0, 0, 0.2};
  setup.rotors_on = false;
  setup.floor_m = 0.2;
  for (const Eigen::Vector3d& wind_W :
       {Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(-3, 0, 0), Eigen::Vector3d(0, 3, 0)}) {
    setup.wind = gusty_wind(wind_W, 1.0, 2.0, 80.0, 1);
    // In the middle of the leg, 2 m of climb before it.
    setup.stop_at_m = [](double time_s) {
      return time_s < 30.0 ? 22.0 : std::numeric_limits<double>::infinity();
    };
    QuadrotorLoop loop(setup);
    double farthest_m = 0.0, nearest_m = 1e9, aside_m = 0.0;
    loop.run_until(30.0, [&] {
      expect_within_limits(loop);
      const Eigen::Vector3d& p_W = loop.sim().state().p_W;
      farthest_m = std::max(farthest_m, p_W.x());
      if (loop.time_s() < 20.0) return;
      nearest_m = std::min(nearest_m, p_W.x());
      aside_m = std::max(aside_m, std::abs(p_W.y()));
    });
    EXPECT_LT(farthest_m, 20.1) << wind_W.transpose();
    EXPECT_GT(nearest_m, 19.7) << wind_W.transpose();
    EXPECT_LT(aside_m, 0.10) << wind_W.transpose();
    EXPECT_FALSE(loop.finished());
    loop.run_until(80.0);
    EXPECT_TRUE(loop.finished()) << wind_W.transpose();
    EXPECT_NEAR(loop.sim().state().p_W.x(), 40.0, 0.3);
    record("beyond_max_m", farthest_m - 20.0);
  }
}

TEST_P(EveryFlightController, ComesBackFromFarAndFromALargeTilt) {
  QuadrotorSetup setup = make_setup();
  setup.path = hover_at({5, -5, 5}, -2.0);
  QuadrotorLoop far(setup);
  double tilt = 0.0;
  far.run_until(15.0, [&] {
    expect_within_limits(far);
    tilt = std::max(tilt, far.sim().tilt_rad());
  });
  EXPECT_LT(tilt, kTiltLimit_rad + 2.0 * kTiltSwing_rad);
  EXPECT_LT(far.path_error().norm(), 0.02);

  setup.path = hover_at(setup.start.p);
  setup.start.q = quaternion_from_rpy({rad_from_deg(50.0), rad_from_deg(-20.0), 0.0});
  QuadrotorLoop tilted(setup);
  tilted.run_until(10.0, [&] { expect_within_limits(tilted); });
  EXPECT_LT(tilted.path_error().norm(), 0.02);
}

TEST_P(EveryFlightController, HoversWithALoadThatItIsNotToldOf) {
  QuadrotorSetup setup = make_setup();
  setup.assumed = setup.numbers;
  setup.numbers.mass_kg *= 1.1;
  setup.numbers.thrust_coefficient *= 0.95;
  for (SimRotor& rotor : setup.numbers.rotors) rotor.x_m += 0.01;  // centre of mass 10 mm behind
  setup.path = hover_at(setup.start.p, 1.0);
  QuadrotorLoop loop(setup);
  loop.run_until(15.0, [&] { expect_within_limits(loop); });
  EXPECT_LT(loop.path_error().norm(), 0.01);
}

TEST_P(EveryFlightController, DoesNotCareForDirections) {
  std::vector<Eigen::Vector3d> first;
  for (const double yaw : {0.0, 0.5 * kPi, kPi, -2.0, 7.0}) {
    const Eigen::AngleAxisd turn(yaw, Eigen::Vector3d::UnitZ());
    QuadrotorSetup setup = make_setup();
    setup.start = {Eigen::Quaterniond(turn), {10, 20, 2}};
    const FlightPath step = row_and_turn({0, 0, 0}, 0.0, 2.0, 3.0, 2.5, 1.5);
    setup.path = [=, origin = setup.start.p](double time_s) {
      TrajectoryPoint at = step(time_s);
      at.p_W = origin + turn * at.p_W;
      at.v_W = turn * at.v_W;
      at.a_W = turn * at.a_W;
      at.yaw_rad += yaw;
      return at;
    };
    setup.wind = [=](double time_s, const Eigen::Vector3d&) {
      return Eigen::Vector3d(turn * Eigen::Vector3d(1.0, 2.0 * std::sin(time_s), 0.3));
    };
    QuadrotorLoop loop(setup);
    std::vector<Eigen::Vector3d> errors;
    loop.run_until(8.0, [&] { errors.push_back(loop.path_error()); });
    if (first.empty()) first = errors;
    double largest_m = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      largest_m = std::max(largest_m, (errors[i] - first[i]).norm());
    }
    EXPECT_LT(largest_m, 1e-8) << yaw;  // rounding, not amplified by a stable loop
  }
}

INSTANTIATE_TEST_SUITE_P(Controllers, EveryFlightController,
                         ::testing::ValuesIn(parts_that_write(PartKind::kController, "wrench")),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vinerow::test::flight_conformance_test
