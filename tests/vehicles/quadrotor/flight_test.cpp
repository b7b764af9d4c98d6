/// Flight in free air against closed forms, a second implementation and the linear model.

#include <gtest/gtest.h>

#include "tests/support/no_alloc.h"
#include "tests/vehicles/quadrotor/reference_flight.h"
#include "tests/vehicles/quadrotor/rig.h"

namespace vinerow::vehicles {
namespace {

using namespace test;
using Eigen::Vector3d;

physics::BodyState at_height(double z) {
  physics::BodyState state;
  state.X_WB.p.z() = z;
  state.v_WB_W.setZero();
  state.w_WB_W.setZero();
  return state;
}

TEST(QuadrotorFlight, FallsFreelyWithoutAir) {
  QuadrotorRig rig(without_air());
  rig.fly(100.0, 0.0);
  rig.run(3.0);
  EXPECT_NEAR(rig.body().X_WB.p.z(), 100.0 - 0.5 * kGravity * 9.0, 1e-9);
  EXPECT_NEAR(rig.body().v_WB_W.z(), -3.0 * kGravity, 1e-9);
  EXPECT_LT(rig.drone.specific_force_B().norm(), 1e-9);
}

TEST(QuadrotorFlight, FallsAsDragAllowsToItsTerminalSpeed) {
  QuadrotorRig rig;
  rig.fly(1000.0, 0.0);
  // v = v_t tanh(g t / v_t) for quadratic drag; rotors that stand still add none.
  const double terminal = std::sqrt(2.0 * 2.0 * kGravity / (1.225 * 0.04));
  rig.run(2.0);
  EXPECT_NEAR(rig.body().v_WB_W.z(), -terminal * std::tanh(kGravity * 2.0 / terminal), 1e-5);
  EXPECT_NEAR(
      rig.body().X_WB.p.z(),
      1000.0 - terminal * terminal / kGravity * std::log(std::cosh(kGravity * 2.0 / terminal)),
      1e-5);
  rig.run(18.0);
  EXPECT_NEAR(rig.body().v_WB_W.z(), -terminal, 1e-4);
}

TEST(QuadrotorFlight, HoversWhereThrustEqualsWeight) {
  QuadrotorRig rig;
  const double hover = std::sqrt(2.0 * kGravity / (4.0 * 5.98e-5));
  EXPECT_NEAR(hover, 286.35, 0.01);  // reference: 286 rad/s
  rig.fly(20.0, hover);
  rig.actuate(hover);
  rig.run(5.0);
  EXPECT_NEAR(rig.body().X_WB.p.z(), 20.0, 1e-9);
  EXPECT_LT(rig.body().v_WB_W.norm(), 1e-9);
  EXPECT_LT(rig.rates_B().norm(), 1e-9);
  EXPECT_NEAR(rig.drone.specific_force_B().z(), kGravity, 1e-9);
}

/// All rotors at full speed: climbs with (T - m g) / m; twice the throttle lag late.
TEST(QuadrotorFlight, ThrustFollowsTheRotorsLagInClosedForm) {
  QuadrotorRig rig(without_air());
  rig.fly(20.0, 200.0);
  rig.actuate(500.0);
  const double t = 0.12, tau = 0.05, u = 500.0, d = 200.0 - 500.0;
  rig.run(t);
  EXPECT_NEAR(rig.drone.rotors()[0].speed_radps, u + d * std::exp(-t / tau), 1e-9);
  const double integral_w2 = u * u * t + 2.0 * u * d * tau * (1.0 - std::exp(-t / tau)) +
                             d * d * tau / 2.0 * (1.0 - std::exp(-2.0 * t / tau));
  EXPECT_NEAR(rig.body().v_WB_W.z(), 4.0 * 5.98e-5 * integral_w2 / 2.0 - kGravity * t, 1e-9);
  EXPECT_NEAR(rig.drone.actuator_states()[2], rig.drone.rotors()[2].speed_radps, 0.0);
}

/// Constant unequal speeds: the rate about each axis grows by torque / inertia.
TEST(QuadrotorFlight, SpinsAboutEachAxisByTorqueOverInertia) {
  const QuadrotorParams params = without_air();
  const double hi = 300.0, lo = 270.0, kF = 5.98e-5, kM = 1.32e-6;
  const double arm = 0.31 / std::sqrt(2.0), difference = hi * hi - lo * lo, t = 0.3;
  struct Case {
    std::array<double, kRotors> speeds;
    Vector3d rates;
  };
  const Case cases[] = {
      {{hi, hi, lo, lo}, {2.0 * arm * kF * difference * t / 0.050, 0, 0}},
      {{lo, hi, hi, lo}, {0, 2.0 * arm * kF * difference * t / 0.050, 0}},
      {{lo, hi, lo, hi}, {0, 0, 2.0 * kM * difference * t / 0.0977}},
  };
  for (const Case& c : cases) {
    QuadrotorRig rig(params);
    rig.fly(at_height(50.0), c.speeds);
    rig.run(t);
    EXPECT_LT((rig.rates_B() - c.rates).norm(), 1e-9 * c.rates.norm()) << c.rates.transpose();
  }
}

/// Yaw from a step of the rotors' speeds: drag torque and the reaction of spinning up.
TEST(QuadrotorFlight, SpinningUpTurnsTheBodyTheOtherWay) {
  const QuadrotorParams params = without_air();
  QuadrotorRig rig(params);
  rig.fly(50.0, 280.0);
  const double up = 320.0, down = 240.0, t = 0.15, tau = 0.05;
  rig.actuate({down, up, down, up});  // rotors 2 and 4 turn clockwise: the body goes left
  rig.run(t);
  const auto integral_w2 = [&](double u) {
    const double d = 280.0 - u;
    return u * u * t + 2.0 * u * d * tau * (1.0 - std::exp(-t / tau)) +
           d * d * tau / 2.0 * (1.0 - std::exp(-2.0 * t / tau));
  };
  const double drag = 1.32e-6 * 2.0 * (integral_w2(up) - integral_w2(down));
  const double reaction = 3.6e-4 * 2.0 * (up - down) * (1.0 - std::exp(-t / tau));
  EXPECT_GT(reaction, 2.0 * drag);  // the reaction is the faster half of yaw
  EXPECT_NEAR(rig.rates_B().z(), (drag + reaction) / 0.0977, 1e-9);
}

/// No torque from outside (no drag torque, thrusts in balance): the momentum of body and rotors
/// stays, while the rotors take up and give back three times what the body had.
TEST(QuadrotorFlight, KeepsAngularMomentumOfBodyAndRotors) {
  QuadrotorParams params = without_air();
  params.rotor.torque_coefficient_Nms2 = 0.0;
  params.rotor.inertia_kgm2 = 1e-3;
  QuadrotorRig rig(params);
  physics::BodyState state = at_height(500.0);
  state.w_WB_W = {2.0, -1.0, 3.0};
  rig.fly(state, {0.0, 0.0, 0.0, 0.0});
  const Vector3d before = rig.drone.angular_momentum_W();
  double most_rotors = 0.0, worst = 0.0;
  for (int i = 0; i < 8; ++i) {
    const double odd = i % 2 == 0 ? 600.0 : 100.0, even = i % 3 == 0 ? 200.0 : 0.0;
    rig.actuate({odd, even, odd, even});
    for (int k = 0; k < 250; ++k) {
      rig.step();
      most_rotors = std::max(most_rotors, std::abs(rig.drone.rotor_momentum_Nms()));
      worst = std::max(worst, (rig.drone.angular_momentum_W() - before).norm());
    }
  }
  EXPECT_GT(most_rotors, 3.0 * before.norm());
  EXPECT_LT(worst, 1e-5 * before.norm());
}

/// A net momentum of the rotors makes a turning body precess at h / I.
TEST(QuadrotorFlight, PrecessesAsAGyroscope) {
  QuadrotorParams params = without_air();
  params.rotor.torque_coefficient_Nms2 = 0.0;
  QuadrotorRig rig(params);
  const double h = 3.6e-4 * 2.0 * (500.0 - 200.0), rate = h / 0.050;
  physics::BodyState state = at_height(50.0);
  state.w_WB_W = {0.5, 0.0, 0.0};
  rig.fly(state, {500.0, 200.0, 500.0, 200.0});
  const double t = 0.5;
  rig.run(t);
  EXPECT_GT(rate * t, 2.0);
  const Vector3d expected(0.5 * std::cos(rate * t), 0.5 * std::sin(rate * t), 0.0);
  EXPECT_LT((rig.rates_B() - expected).norm(), 2e-6);
}

/// Rotor drag alone: level flight at hover thrust slows down with the time constant m / d.
TEST(QuadrotorFlight, RotorDragSlowsLevelFlightExponentially) {
  QuadrotorParams params = without_air();
  params.rotor_drag_Ns_per_m = 0.30;
  params.rotor_height_m = 0.0;  // no moment
  QuadrotorRig rig(params);
  physics::BodyState state = at_height(50.0);
  state.v_WB_W = {3.0, 0.0, 0.0};
  const double hover = params.hover_radps();
  rig.fly(state, {hover, hover, hover, hover});
  rig.run(4.0);
  EXPECT_NEAR(rig.body().v_WB_W.x(), 3.0 * std::exp(-0.30 / 2.0 * 4.0), 1e-6);
  EXPECT_LT(std::abs(rig.body().v_WB_W.z()), 1e-9);
}

/// Inflow: a climb at v loses k v of thrust, and a roll is damped by k l^2 / 2 of the hubs' motion.
TEST(QuadrotorFlight, InflowDampsClimbAndRoll) {
  QuadrotorParams params = without_air();
  params.inflow_drag_Ns_per_m = 1.1;
  QuadrotorRig rig(params);
  physics::BodyState state = at_height(50.0);
  state.v_WB_W = {0.0, 0.0, 1.0};
  const double hover = params.hover_radps();
  rig.fly(state, {hover, hover, hover, hover});
  rig.run(1.0);
  EXPECT_NEAR(rig.body().v_WB_W.z(), std::exp(-1.1 / 2.0), 1e-6);
  state = at_height(50.0);
  state.w_WB_W = {0.3, 0.0, 0.0};
  rig.fly(state, {hover, hover, hover, hover});
  rig.run(0.5);
  EXPECT_NEAR(rig.rates_B().x(), 0.3 * std::exp(-1.1 * 0.31 * 0.31 / 2.0 / 0.050 * 0.5), 1e-4);
}

TEST(QuadrotorFlight, DriftsWithTheWind) {
  WorldModel world = make_flat_world();
  world.wind.mean_speed_mps = 4.0;
  world.wind.height_law = WindHeightLaw::kUniform;
  world.wind.from_azimuth_rad = rad_from_deg(90.0);  // from the east: blows to -x
  QuadrotorParams params;
  params.rotor_height_m = 0.0;
  QuadrotorRig rig(params, std::move(world));
  const double hover = params.hover_radps();
  rig.fly(50.0, hover);
  rig.actuate(hover);
  rig.run(0.01);
  const double force = 0.30 * 4.0 + 0.5 * 1.225 * 0.04 * 16.0;
  EXPECT_NEAR(rig.body().v_WB_W.x(), -force / 2.0 * 0.01, 2e-5);
  rig.run(30.0);
  EXPECT_NEAR(rig.body().v_WB_W.x(), -4.0, 0.05);
}

TEST(QuadrotorFlight, ThinAirCarriesLess) {
  WorldModel world = make_flat_world();
  world.wind.air_density_kgm3 = 0.98;  // 0.8 of what the coefficients hold for
  QuadrotorRig rig(without_air(), std::move(world));
  rig.fly(50.0, rig.params.hover_radps());
  rig.actuate(rig.params.hover_radps());
  rig.run(1.0);
  EXPECT_NEAR(rig.body().v_WB_W.z(), -0.2 * kGravity, 1e-9);
}

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
  EXPECT_NEAR(rig.drone.rotors()[0].thrust_ratio, ratio(1.05), 1e-9);
  EXPECT_NEAR(rig.drone.rotors()[0].thrust_N, ratio(1.05) * 5.98e-5 * 280.0 * 280.0, 1e-9);
  // Rolled by 20 deg to the right: the right rotors are lower and feel more.
  physics::BodyState state = at_height(0.8);
  state.X_WB.q = quaternion_from_rpy({rad_from_deg(20.0), 0.0, 0.0});
  rig.fly(state, {280.0, 280.0, 280.0, 280.0});
  rig.step();
  EXPECT_GT(rig.drone.rotors()[2].thrust_ratio, rig.drone.rotors()[1].thrust_ratio + 0.009);
  rig.fly(4.0, 280.0);
  rig.step();
  EXPECT_EQ(rig.drone.rotors()[0].thrust_ratio, 1.0);
}

TEST(QuadrotorFlight, DrawsTheShaftPowerOverTheEfficiency) {
  QuadrotorRig rig;
  const double hover = rig.params.hover_radps();
  rig.fly(50.0, hover);
  rig.actuate(hover);
  rig.run(1.0);
  const double power = 4.0 * 1.32e-6 * hover * hover * hover / 0.75 + 15.0;
  EXPECT_NEAR(rig.drone.battery().power_W, power, 1e-6);
  EXPECT_NEAR(rig.drone.battery().energy_used_J, power, 1e-3);
  EXPECT_NEAR(rig.drone.battery().charge, 1.0 - power / (111.0 * 3600.0), 1e-9);
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
}  // namespace vinerow::vehicles
