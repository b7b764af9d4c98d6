/// Flight in free air against closed forms.

#include <gtest/gtest.h>

#include "tests/vehicles/quadrotor/rig.h"

namespace vinerow::vehicles::quadrotor_flight_test {
namespace {

using namespace test;
using Eigen::Vector3d;

TEST(QuadrotorFlight, FallsFreelyWithoutAir) {
  QuadrotorRig rig(without_air());
  rig.fly(100.0, 0.0);
  rig.run(3.0);
  EXPECT_NEAR(rig.body().X_WB.p.z(), 100.0 - 0.5 * kGravity * 9.0, 1e-9);
  EXPECT_NEAR(rig.body().v_WB_W.z(), -3.0 * kGravity, 1e-9);
  EXPECT_LT(rig.vehicle.specific_force_B().norm(), 1e-9);
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
  EXPECT_NEAR(rig.vehicle.specific_force_B().z(), kGravity, 1e-9);
}

/// All rotors at full speed: climbs with (T - m g) / m; twice the throttle lag late.
TEST(QuadrotorFlight, ThrustFollowsTheRotorsLagInClosedForm) {
  QuadrotorRig rig(without_air());
  rig.fly(20.0, 200.0);
  rig.actuate(500.0);
  const double t = 0.12, tau = 0.05, u = 500.0, d = 200.0 - 500.0;
  rig.run(t);
  EXPECT_NEAR(rig.vehicle.rotors()[0].speed_radps, u + d * std::exp(-t / tau), 1e-9);
  const double integral_w2 = u * u * t + 2.0 * u * d * tau * (1.0 - std::exp(-t / tau)) +
                             d * d * tau / 2.0 * (1.0 - std::exp(-2.0 * t / tau));
  EXPECT_NEAR(rig.body().v_WB_W.z(), 4.0 * 5.98e-5 * integral_w2 / 2.0 - kGravity * t, 1e-9);
  EXPECT_NEAR(rig.vehicle.actuator_states()[2], rig.vehicle.rotors()[2].speed_radps, 0.0);
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
  const Vector3d before = rig.vehicle.angular_momentum_W();
  double max_rotors_Nms = 0.0, worst = 0.0;
  for (int i = 0; i < 8; ++i) {
    const double odd = i % 2 == 0 ? 600.0 : 100.0, even = i % 3 == 0 ? 200.0 : 0.0;
    rig.actuate({odd, even, odd, even});
    for (int k = 0; k < 250; ++k) {
      rig.step();
      max_rotors_Nms = std::max(max_rotors_Nms, std::abs(rig.vehicle.rotor_momentum_Nms()));
      worst = std::max(worst, (rig.vehicle.angular_momentum_W() - before).norm());
    }
  }
  EXPECT_GT(max_rotors_Nms, 3.0 * before.norm());
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
  // Air data sensors feel the wind, not the ground's speed.
  EXPECT_NEAR(rig.vehicle.air_velocity_B().x(), 4.0, 0.01);
  rig.run(30.0);
  EXPECT_NEAR(rig.body().v_WB_W.x(), -4.0, 0.05);
}

TEST(QuadrotorFlight, TellsTheThrustThatItsRotorsHaveWhereItStarts) {
  WorldModel world = make_flat_world();
  world.wind.air_density_kgm3 = 0.98;  // 0.8 of what the coefficients hold for
  QuadrotorRig rig(without_air(), std::move(world));
  const Rotorcraft& craft = *rig.vehicle.description().rotorcraft;
  EXPECT_DOUBLE_EQ(craft.thrust_coefficient_Ns2, 0.8 * rig.params.rotor.thrust_coefficient_Ns2);
  EXPECT_DOUBLE_EQ(craft.torque_coefficient_Nms2, 0.8 * rig.params.rotor.torque_coefficient_Nms2);
  // What a controller takes for hovering by that hovers.
  const double hover_radps =
      std::sqrt(rig.params.mass_kg * kGravity / 4.0 / craft.thrust_coefficient_Ns2);
  rig.fly(50.0, hover_radps);
  rig.actuate(hover_radps);
  rig.run(1.0);
  EXPECT_NEAR(rig.body().v_WB_W.z(), 0.0, 1e-9);
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

}  // namespace
}  // namespace vinerow::vehicles::quadrotor_flight_test
