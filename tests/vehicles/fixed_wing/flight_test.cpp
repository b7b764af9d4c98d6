/// Whole flights: against a second implementation, the reference's trim and modes, closed forms.

#include <gtest/gtest.h>

#include "tests/support/no_alloc.h"
#include "tests/vehicles/fixed_wing/reference_aircraft.h"
#include "tests/vehicles/fixed_wing/rig.h"

namespace vinerow::vehicles::fixed_wing_flight_test {
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
  EXPECT_NEAR(rig.vehicle.actuator_states()[0], x[12], 1e-9);
  EXPECT_NEAR(rig.vehicle.actuator_states()[1], x[13], 1e-9);
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

/// In level flight at 12 m/s, with what the bisection finds.
struct Trimmed {
  explicit Trimmed(const FixedWingParams& params = plain_params(), double height_m = 80.0)
      : flight(*find_level_flight(params, 12.0, kGravity, 1.225)),
        rig(params),
        start(WingRig::level(height_m, 12.0, flight.alpha_rad)) {
    fly(start);
  }
  void fly(const physics::BodyState& state) {
    rig.fly(state, {flight.throttle, flight.elevator_rad, flight.elevator_rad});
  }
  LevelFlight flight;
  WingRig rig;
  physics::BodyState start;
};

TEST(FixedWingFlight, TrimHoldsItsHeight) {
  Trimmed trimmed;
  trimmed.rig.run(20.0);
  EXPECT_NEAR(trimmed.rig.body().X_WB.p.z(), 80.0, 1e-6);
  EXPECT_NEAR(trimmed.rig.body().X_WB.p.x(), 240.0, 1e-6);
  EXPECT_LT(std::abs(trimmed.rig.body().X_WB.p.y()), 1e-12);
}

/// The numbers as printed, to three digits and for g = 9.81 m/s2.
TEST(FixedWingFlight, TrimOfTheReferenceHoldsToItsDigits) {
  WingRig rig;
  const PageTrim trim;
  rig.fly(WingRig::level(80.0, 12.0, trim.alpha_rad),
          {trim.throttle, trim.elevator_rad, trim.elevator_rad});
  rig.run(20.0);
  RecordProperty("drift_mm", std::to_string(1e3 * (rig.body().X_WB.p.z() - 80.0)));
  EXPECT_NEAR(rig.body().X_WB.p.z(), 80.0, 0.2);
  EXPECT_NEAR(rig.body().v_WB_W.norm(), 12.0, 0.02);
}

/// Times at which a signal crosses zero, by straight lines between samples of 1 ms.
template <class Signal>
std::vector<double> zero_crossings(WingRig& rig, double time_s, const Signal& signal) {
  std::vector<double> times;
  double before = signal();
  for (int i = 1; i <= std::lround(time_s * 1e3); ++i) {
    rig.step();
    const double now = signal();
    if ((before < 0.0) != (now < 0.0)) times.push_back(1e-3 * (i - now / (now - before)));
    before = now;
  }
  return times;
}

TEST(FixedWingFlight, PhugoidSwingsAsThePageSays) {
  Trimmed trimmed;
  physics::BodyState state = trimmed.start;
  state.v_WB_W.x() += 0.1;
  trimmed.fly(state);
  trimmed.rig.run(1.0);  // the short period has died away
  const auto times =
      zero_crossings(trimmed.rig, 12.0, [&] { return trimmed.rig.body().v_WB_W.z(); });
  ASSERT_GE(times.size(), 3u);
  const double period_s = 2.0 * kPi / (1.04 * std::sqrt(1.0 - 0.24 * 0.24));
  EXPECT_NEAR(times[2] - times[0], period_s, 0.015 * period_s);  // 1.04 itself is +-0.5 %
}

TEST(FixedWingFlight, DutchRollSwingsAndDiesAwayAsThePageSays) {
  Trimmed trimmed;
  physics::BodyState state = trimmed.start;
  state.v_WB_W.y() = 0.05;
  trimmed.fly(state);
  trimmed.rig.run(1.0);  // the roll has died away
  std::vector<double> peaks;
  double peak = 0.0, before = 0.0;
  const auto times = zero_crossings(trimmed.rig, 5.0, [&] {
    const double rate = trimmed.rig.rates_B().z();
    if ((rate < 0.0) != (before < 0.0)) peaks.push_back(peak), peak = 0.0;
    peak = std::max(peak, std::abs(rate));
    before = rate;
    return rate;
  });
  ASSERT_GE(times.size(), 7u);
  const double period_s = (times[6] - times[0]) / 3.0;
  const double expected_s = 2.0 * kPi / (5.75 * std::sqrt(1.0 - 0.073 * 0.073));
  EXPECT_NEAR(period_s, expected_s, 0.01 * expected_s);
  const double decrement = std::log(peaks[2] / peaks[6]) / 2.0;  // per period
  EXPECT_NEAR(decrement, 0.073 * 5.75 * expected_s, 0.02);
}

/// Without propeller it goes down by the ratio of drag to lift.
TEST(FixedWingFlight, GlidesByItsGlideRatio) {
  FixedWingParams params = plain_params();
  params.propeller.windmill = 0.0;
  Trimmed trimmed(params, 400.0);
  trimmed.rig.actuate(0.0, trimmed.flight.elevator_rad, trimmed.flight.elevator_rad);
  trimmed.rig.run(150.0);  // the phugoid, without the propeller's damping, has died away
  const Vector3d v = trimmed.rig.body().v_WB_W;
  const double glide_rad = std::atan2(-v.z(), v.x());
  const double alpha = trimmed.rig.pitch_rad() + glide_rad;
  const double CL = 0.05 + 3.5 * alpha + 0.806 * trimmed.flight.elevator_rad;
  const double CD = 0.025 + CL * CL / (kPi * 0.85 * 3.0) +
                    0.15 * trimmed.flight.elevator_rad * trimmed.flight.elevator_rad;
  EXPECT_NEAR(std::tan(glide_rad), CD / CL, 2e-5);
  const double pressure = 0.5 * 1.225 * v.squaredNorm() * 0.27;
  EXPECT_NEAR(pressure * std::hypot(CL, CD), 1.2 * kGravity, 1e-2);
  EXPECT_GT(1.0 / std::tan(glide_rad), 8.5);
}

/// Nose up with too little speed: it falls out of the sky, pitches down and flies on.
TEST(FixedWingFlight, RecoversFromAStall) {
  Trimmed trimmed;
  physics::BodyState state = trimmed.start;
  state.X_WB.q = quaternion_from_rpy({0.0, rad_from_deg(-50.0), 0.0});
  state.v_WB_W = {4.0, 0.0, 3.0};
  trimmed.fly(state);
  double alpha_max = 0.0, lost_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    trimmed.rig.run(0.05);
    const Vector3d v = trimmed.rig.vehicle.air_velocity_B();
    alpha_max = std::max(alpha_max, std::atan2(-v.z(), v.x()));
    lost_m = std::max(lost_m, 80.0 - trimmed.rig.body().X_WB.p.z());
  }
  EXPECT_GT(alpha_max, rad_from_deg(25.0));
  EXPECT_LT(lost_m, 20.0);
  EXPECT_NEAR(trimmed.rig.body().v_WB_W.norm(), 12.0, 0.5);
}

WorldModel windy_world() {
  WorldModel world = make_flat_world();
  world.wind.mean_speed_mps = 3.0;
  world.wind.turbulence = 1.0;
  world.wind.turbulence_limit_mps = 1.0;
  world.wind.atmosphere = Atmosphere::kStandard76;
  return world;
}

TEST(FixedWingFlight, TellsWhatItIsInTheAirWhereItStarts) {
  const auto describe = [](double altitude_m) {
    WorldModel world = make_flat_world();
    world.origin.altitude_m = altitude_m;
    return *WingRig(plain_params(), std::move(world)).vehicle.description().fixed_wing;
  };
  const FixedWingAircraft low = describe(0.0), high = describe(1'000.0);
  EXPECT_EQ(low.air_density_kgm3, 1.225);
  EXPECT_NEAR(high.air_density_kgm3, 1.1117, 1e-4);  // US Standard Atmosphere 1976, table I
  EXPECT_NEAR(high.stall_speed_mps / low.stall_speed_mps, std::sqrt(1.225 / 1.1117), 1e-4);
}

TEST(FixedWingFlight, SameInputsGiveTheSameBitsInWind) {
  const auto end = [] {
    WingRig rig(plain_params(), windy_world());
    rig.fly(WingRig::level(60.0, 12.0, 0.128), {0.6, 0.0, 0.0});
    for (int i = 0; i < 40; ++i) {
      rig.actuate(0.55 + 0.01 * (i % 3), -0.01 * (i % 2), -0.01);
      rig.run(0.05);
    }
    return rig.body();
  };
  const physics::BodyState first = end(), second = end();
  EXPECT_EQ(first.X_WB.p, second.X_WB.p);
  EXPECT_EQ(first.X_WB.q.coeffs(), second.X_WB.q.coeffs());
  EXPECT_EQ(first.w_WB_W, second.w_WB_W);
}

TEST(FixedWingFlight, AStepAllocatesNothing) {
  WorldModel world = windy_world();
  world.meshes.push_back(
      make_box("row 1", {5.0f, 0.3f, 1.0f}, {0.0, 1.2, 1.0}, SurfaceClass::kCanopy));
  WingRig rig(plain_params(), std::move(world));
  for (const double height_m : {1.5, 40.0}) {
    rig.fly(WingRig::level(height_m, 12.0, 0.128), {0.58, -0.0145, -0.0145});
    rig.run(0.05);
    rig.fly(WingRig::level(height_m, 12.0, 0.128), {0.58, -0.0145, -0.0145});
    const vinerow::test::AllocationCounter counter;
    rig.run(0.1);
    EXPECT_EQ(counter.count(), 0u) << height_m;
  }
}

}  // namespace
}  // namespace vinerow::vehicles::fixed_wing_flight_test
