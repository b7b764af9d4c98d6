/// Whole flights: against a second implementation, the reference's trim and modes, closed forms.

#include <gtest/gtest.h>

#include "tests/support/no_alloc.h"
#include "tests/vehicles/fixed_wing/reference_aircraft.h"
#include "tests/vehicles/fixed_wing/rig.h"

namespace vinerow::vehicles {
namespace {

using namespace test;
using Eigen::Vector3d;

/// Between W (east, north, up) with B (forward, left, up) and aviation's axes.
Vector3d ned_from_enu(const Vector3d& v) {
  return {v.y(), v.x(), -v.z()};
}
Eigen::Matrix3d attitude_ned(const Eigen::Quaterniond& q_WB) {
  Eigen::Matrix3d world, body;
  world << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  body << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  return world * q_WB.toRotationMatrix() * body;
}

ReferenceAircraft::State reference_state(const physics::BodyState& body,
                                         const FixedWing::Actuators& actuators) {
  ReferenceAircraft::State x;
  const Eigen::Matrix3d R = attitude_ned(body.X_WB.q);
  x.segment<3>(0) = ned_from_enu(body.X_WB.p);
  x.segment<3>(3) = R.transpose() * ned_from_enu(body.v_WB_W);
  x[6] = std::atan2(R(2, 1), R(2, 2)), x[7] = -std::asin(R(2, 0)),
  x[8] = std::atan2(R(1, 0), R(0, 0));
  x.segment<3>(9) = R.transpose() * ned_from_enu(body.w_WB_W);
  x.segment<3>(12) = Vector3d(actuators[0], actuators[1], actuators[2]);
  return x;
}

/// A rolling pull-up in a gusty wind: difference of position (m), velocity, attitude (rad), rates.
double error_at(std::int64_t step_ns) {
  WorldModel world = make_flat_world();
  world.wind.mean_speed_mps = 4.0;
  world.wind.height_law = WindHeightLaw::kUniform;
  world.wind.from_azimuth_rad = rad_from_deg(240.0);
  WindGust gust;
  gust.start_s = 0.4, gust.duration_s = 1.6, gust.amplitude_mps = 1.5, gust.vertical_mps = 1.0;
  gust.from_azimuth_rad = rad_from_deg(300.0);
  world.wind.gusts.push_back(gust);
  WingRig rig(plain_params(), std::move(world), step_ns);
  physics::BodyState start = WingRig::level(100.0, 13.0, 0.1);
  start.X_WB.q = quaternion_from_rpy({0.2, -0.12, 0.4});
  start.v_WB_W = {15.0, 5.0, 0.6};
  start.w_WB_W = {0.3, 0.2, -0.1};
  const FixedWing::Actuators at_start = {0.5, 0.02, -0.03};
  rig.fly(start, at_start);

  const auto wind_ned = [](double t) {
    const auto blows_to = [](double from_deg) {
      const double a = rad_from_deg(from_deg);
      return Vector3d(-std::cos(a), -std::sin(a), 0.0);
    };
    const double s = (t - 0.4) / 1.6;
    const double pulse = s <= 0 || s >= 1 ? 0.0 : 0.5 * (1.0 - std::cos(2.0 * kPi * s));
    return Vector3d(4.0 * blows_to(240.0) + pulse * (1.5 * blows_to(300.0) + Vector3d(0, 0, -1.0)));
  };
  ReferenceAircraft reference(Vector3d(0.8, -0.02, -0.12), wind_ned);
  ReferenceAircraft::State x = reference_state(start, at_start);
  rig.actuate(0.8, -0.02, -0.12);  // pulls up and rolls right
  rig.run(0.96);
  x = reference.run(x, 0.0, 0.96, 1920);
  rig.actuate(0.3, -0.2, 0.05);  // and to the left, harder
  reference.wanted_ = {0.3, -0.2, 0.05};
  rig.run(1.44);
  x = reference.run(x, 0.96, 1.44, 2880);

  const ReferenceAircraft::State mine = reference_state(rig.body(), {x[12], x[13], x[14]});
  const Eigen::Matrix3d apart =
      attitude_ned(rig.body().X_WB.q).transpose() * ReferenceAircraft::rotation(x[6], x[7], x[8]);
  EXPECT_NEAR(rig.plane.actuator_states()[0], x[12], 1e-9);
  EXPECT_NEAR(rig.plane.actuator_states()[1], x[13], 1e-9);
  return (mine - x).head<3>().norm() + 0.1 * (mine - x).segment<3>(3).norm() +
         Eigen::AngleAxisd(apart).angle() + 0.1 * (mine - x).segment<3>(9).norm();
}

TEST(FixedWingFlight, ErrorFallsWithTheSquareOfTheStep) {
  const double e8 = error_at(8'000'000), e4 = error_at(4'000'000), e2 = error_at(2'000'000),
               e1 = error_at(1'000'000);
  RecordProperty("error_1_ms", std::to_string(e1));
  EXPECT_NEAR(std::log2(e8 / e4), 2.0, 0.25);
  EXPECT_NEAR(std::log2(e4 / e2), 2.0, 0.2);
  EXPECT_NEAR(std::log2(e2 / e1), 2.0, 0.2);
  EXPECT_LT(e1, 5e-4);
}

}  // namespace
}  // namespace vinerow::vehicles
