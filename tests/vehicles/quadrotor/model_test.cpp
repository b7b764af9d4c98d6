/// Whole flights: against a second implementation and the linear model; ground, battery, bits,
/// heap.

#include <gtest/gtest.h>

#include "tests/support/no_alloc.h"
#include "tests/vehicles/quadrotor/reference_flight.h"
#include "tests/vehicles/quadrotor/rig.h"

namespace vinerow::vehicles::model_test {
namespace {

using namespace test;
using Eigen::Vector3d;

/// Everything at once against the second implementation; the error falls with the square of the
/// step.
double error_at(std::int64_t step_ns, const QuadrotorParams& params) {
  QuadrotorRig rig(params, make_flat_world(), step_ns);
  physics::BodyState state = at_height(100.0);
  state.X_WB.q = quaternion_from_rpy({0.3, -0.2, 0.5});
  state.v_WB_W = {2.0, -1.0, 0.5};
  state.w_WB_W = {1.0, 0.6, -0.8};
  const std::array<double, kRotors> start = {250.0, 300.0, 280.0, 310.0};
  rig.fly(state, start);
  rig.actuate({320.0, 290.0, 240.0, 300.0});
  rig.run(0.48);
  ReferenceState x;
  x.p = state.X_WB.p, x.v = state.v_WB_W, x.q = state.X_WB.q;
  x.w = x.q.conjugate() * state.w_WB_W;
  x.rotors = {250.0, 300.0, 280.0, 310.0};
  x = ReferenceFlight(params, {320.0, 290.0, 240.0, 300.0}).run(x, 0.48, 4800);
  return (rig.body().X_WB.p - x.p).norm() + 0.1 * (rig.body().v_WB_W - x.v).norm() +
         rig.body().X_WB.q.angularDistance(x.q) + 0.1 * (rig.rates_B() - x.w).norm();
}

TEST(QuadrotorFlight, ErrorFallsWithTheSquareOfTheStep) {
  QuadrotorParams params;
  params.rotor.fall_lag_s = 0.08;
  params.rotor.inertia_kgm2 = 1e-3;
  params.inflow_drag_Ns_per_m = 1.1;
  const double e8 = error_at(8'000'000, params), e4 = error_at(4'000'000, params),
               e2 = error_at(2'000'000, params), e1 = error_at(1'000'000, params);
  RecordProperty("error_1_ms", std::to_string(e1));
  EXPECT_NEAR(std::log2(e8 / e4), 2.0, 0.2);
  EXPECT_NEAR(std::log2(e4 / e2), 2.0, 0.2);
  EXPECT_NEAR(std::log2(e2 / e1), 2.0, 0.2);
  EXPECT_LT(e1, 2e-5);
}

/// Small steps of the wrench about hover against x' = A x + B u with lag, integrated here.
TEST(QuadrotorFlight, AnswersSmallStepsAsTheLinearModel) {
  QuadrotorParams params;
  params.ground_effect = GroundEffectModel::kNone;
  params.rotor_height_m = 0.0;
  params.body_drag_area_m2 = 0.0;
  const double hover = params.hover_radps(), slope = 2.0 * 5.98e-5 * hover;
  const double lever = 0.31 / std::sqrt(2.0);
  for (const Vector3d& pattern : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
    const double dT = 1e-3;  // N per rotor: 0.02 % of hover
    QuadrotorRig rig(params);
    rig.fly(50.0, hover);
    std::array<double, kRotors> speeds;
    double thrust = 0.0, roll = 0.0, pitch = 0.0;
    for (std::size_t i = 0; i < kRotors; ++i) {
      const double left = i < 2 ? 1.0 : -1.0, behind = i == 1 || i == 2 ? 1.0 : -1.0;
      const double change = dT * (pattern[0] + left * pattern[1] + behind * pattern[2]);
      speeds[i] = hover + change / slope;
      thrust += change, roll += left * lever * change, pitch += behind * lever * change;
    }
    rig.actuate(speeds);
    // Linear: wrench lags by 0.05 s; states z, w, phi, p, vy, theta, q, vx and the wrench.
    Eigen::Matrix<double, 11, 1> x = Eigen::Matrix<double, 11, 1>::Zero();
    const auto rate = [&](const Eigen::Matrix<double, 11, 1>& s) {
      Eigen::Matrix<double, 11, 1> d;
      d << s[1], s[8] / 2.0, s[3], s[9] / 0.050, -kGravity * s[2] - 0.15 * s[4], s[6],
          s[10] / 0.050, kGravity * s[5] - 0.15 * s[7], (thrust - s[8]) / 0.05,
          (roll - s[9]) / 0.05, (pitch - s[10]) / 0.05;
      return d;
    };
    const double dt = 1e-3;
    for (int i = 0; i < 600; ++i) {
      const auto k1 = rate(x);
      const auto k2 = rate(x + 0.5 * dt * k1), k3 = rate(x + 0.5 * dt * k2), k4 = rate(x + dt * k3);
      x += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      rig.step();
    }
    const Vector3d rates = rig.rates_B(), v = rig.body().v_WB_W;
    const double tolerance = 2e-3;  // the rest is second order in the step's size
    if (pattern[0] != 0.0) {        // a tilt lowers the thrust's vertical part in second order only
      EXPECT_NEAR(rig.body().X_WB.p.z() - 50.0, x[0], tolerance * std::abs(x[0]));
      EXPECT_NEAR(v.z(), x[1], tolerance * std::abs(x[1]));
    }
    EXPECT_NEAR(rates.x(), x[3], tolerance * std::abs(x[3]) + 1e-7);
    EXPECT_NEAR(v.y(), x[4], tolerance * std::abs(x[4]) + 1e-7);
    EXPECT_NEAR(rates.y(), x[6], tolerance * std::abs(x[6]) + 1e-7);
    EXPECT_NEAR(v.x(), x[7], tolerance * std::abs(x[7]) + 1e-7);
  }
}

TEST(QuadrotorFlight, FeelsTheGroundByTheHeightOfEachRotor) {
  const QuadrotorParams params;
  QuadrotorRig rig(params);
  const auto ratio = [](double z) {  // Sanchez-Cuevas et al. 2017, K_b = 2
    const double R = 0.19, d2 = 2 * 0.31 * 0.31, b2 = 4 * 0.31 * 0.31;
    return 1.0 / (1.0 - std::pow(R / (4 * z), 2) - R * R * z / std::pow(d2 + 4 * z * z, 1.5) -
                  0.5 * R * R * z / std::pow(2 * d2 + 4 * z * z, 1.5) -
                  2.0 * R * R * z * 2.0 / std::pow(b2 + 4 * z * z, 1.5));
  };
  rig.fly(1.0, 280.0);
  rig.step();
  EXPECT_NEAR(rig.vehicle.rotors()[0].thrust_ratio, ratio(1.05), 1e-9);
  EXPECT_NEAR(rig.vehicle.rotors()[0].thrust_N, ratio(1.05) * 5.98e-5 * 280.0 * 280.0, 1e-9);
  // Rolled by 20 deg to the right: the right rotors are lower and feel more.
  physics::BodyState state = at_height(0.8);
  state.X_WB.q = quaternion_from_rpy({rad_from_deg(20.0), 0.0, 0.0});
  rig.fly(state, {280.0, 280.0, 280.0, 280.0});
  rig.step();
  EXPECT_GT(rig.vehicle.rotors()[2].thrust_ratio, rig.vehicle.rotors()[1].thrust_ratio + 0.009);
  rig.fly(4.0, 280.0);
  rig.step();
  EXPECT_EQ(rig.vehicle.rotors()[0].thrust_ratio, 1.0);
}

TEST(QuadrotorFlight, DrawsTheShaftPowerOverTheEfficiency) {
  QuadrotorRig rig;
  const double hover = rig.params.hover_radps();
  rig.fly(50.0, hover);
  rig.actuate(hover);
  rig.run(1.0);
  const double power = 4.0 * 1.32e-6 * hover * hover * hover / 0.75 + 15.0;
  EXPECT_NEAR(rig.vehicle.battery().power_W, power, 1e-6);
  EXPECT_NEAR(rig.vehicle.battery().energy_used_J, power, 1e-3);
  EXPECT_NEAR(rig.vehicle.battery().charge, 1.0 - power / (111.0 * 3600.0), 1e-9);
}

TEST(QuadrotorFlight, SameInputsGiveTheSameBitsInWind) {
  const auto end = [] {
    WorldModel world = make_flat_world();
    world.wind.mean_speed_mps = 3.0;
    world.wind.turbulence = 1.0;
    QuadrotorRig rig({}, std::move(world));
    rig.fly(10.0, 280.0);
    for (int i = 0; i < 40; ++i) {
      rig.actuate({285.0 + i % 3, 286.0, 287.0 - i % 2, 286.0});
      rig.run(0.05);
    }
    return rig.body();
  };
  const physics::BodyState first = end(), second = end();
  EXPECT_EQ(first.X_WB.p, second.X_WB.p);
  EXPECT_EQ(first.X_WB.q.coeffs(), second.X_WB.q.coeffs());
  EXPECT_EQ(first.w_WB_W, second.w_WB_W);
  EXPECT_GT(first.v_WB_W.norm(), 0.1);
}

TEST(QuadrotorFlight, AStepAllocatesNothing) {
  WorldModel world = make_flat_world();
  world.wind.mean_speed_mps = 3.0;
  world.wind.turbulence = 1.0;
  world.meshes.push_back(
      make_box("row 1", {5.0f, 0.3f, 1.0f}, {0.0, 1.5, 1.0}, SurfaceClass::kCanopy));
  QuadrotorRig rig({}, std::move(world));
  const auto take_off_at = [&rig](double height_m) {
    rig.fly(height_m, 286.0);
    rig.actuate(286.0);
    rig.run(0.25);
  };
  take_off_at(1.5), take_off_at(0.22);  // the broad phase of the physics grows its stack once
  for (const double height : {0.22, 1.5}) {
    rig.fly(height, 286.0);
    const vinerow::test::AllocationCounter counter;
    rig.run(0.2);
    EXPECT_EQ(counter.count(), 0u) << height;
  }
}

}  // namespace
}  // namespace vinerow::vehicles::model_test
