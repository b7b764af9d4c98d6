#include "controllers/parts/rotorcraft/rotorcraft.h"

#include <gtest/gtest.h>

#include <cmath>

#include "controllers/parts/rotorcraft/rotor_mixer.h"
#include "engine/core/error.h"
#include "tests/controllers/support/quadrotor_sim.h"

namespace vinerow::controllers::rotorcraft_test {
namespace {

using test::QuadrotorNumbers;
using test::QuadrotorSim;

RotorcraftModel make_craft(const QuadrotorNumbers& numbers) {
  return read_rotorcraft(test::describe(numbers), numbers.gravity_mps2, "drone.controller");
}

TEST(Rotorcraft, HoversAtTheRateOfTheReference) {
  const RotorcraftModel craft = make_craft(test::make_q4t());
  EXPECT_NEAR(craft.hover_rotor_radps(), 286.0, 0.5);  // reference, section 5
  EXPECT_NEAR(craft.max_thrust_N(), 4 * 24.5, 0.1);    // paper A: 24.5 N per motor
  EXPECT_NEAR(make_craft(test::make_m100()).hover_rotor_radps(), 580.0, 1e-9);  // paper C, table 1
}

void expect_refused(const VehicleDescription& description, const std::string& sentence) {
  try {
    read_rotorcraft(description, 9.80665, "drone.controller");
    FAIL() << "must be refused: " << sentence;
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, sentence.size()), sentence);
  }
}

TEST(Rotorcraft, RefusesWhatCannotFlyBySentences) {
  VehicleDescription rover;
  rover.type = "diff_drive_rover";
  expect_refused(rover,
                 "drone.controller needs a vehicle with rotors; vehicle type 'diff_drive_rover' "
                 "has neither wheels nor rotors nor wings");
  QuadrotorNumbers numbers = test::make_q4t();
  numbers.max_radps = 250.0;
  expect_refused(test::describe(numbers),
                 "drone.controller cannot hover: the rotors of vehicle type 'quadrotor' lift 14.95 "
                 "N at most, its weight is 19.61 N");
  numbers = test::make_q4t();
  numbers.min_radps = 300.0;
  expect_refused(
      test::describe(numbers),
      "drone.controller cannot hover: the rotors of vehicle type 'quadrotor' turn at 300 "
      "rad/s or more, hovering needs 286.3 rad/s");
  numbers = test::make_q4t();
  numbers.inertia_kgm2.y() = 0.0;
  expect_refused(test::describe(numbers),
                 "drone.controller needs 'inertia_kgm2.y' > 0, but vehicle type 'quadrotor' has "
                 "0");
  numbers = test::make_q4t();
  numbers.lag_s = 0.0;
  const RotorcraftModel craft = make_craft(numbers);
  EXPECT_EQ(make_hover_model(craft, false).A.rows(), 12);
  EXPECT_THROW(make_hover_model(craft, true), ConfigError);
}

/// The simulated vehicle after dt as position, velocity, roll, pitch, yaw and rates in the frame
/// that is turned by yaw_rad, with the thrust and torques that act as far as n goes.
Eigen::VectorXd observe(const QuadrotorSim& sim, double yaw_rad, int n) {
  const auto turn = Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitZ());
  Eigen::VectorXd x(16);
  const test::QuadrotorState& s = sim.state();
  const Eigen::Matrix3d R = (turn * s.q_WB).toRotationMatrix();
  x.head<3>() = turn * s.p_W;
  x.segment<3>(3) = turn * s.v_W;
  x.segment<3>(6) << std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)),
      std::atan2(R(1, 0), R(0, 0));
  x.segment<3>(9) = s.w_B;
  x.tail<4>().setZero();
  for (int i = 0; i < 4; ++i) {
    const test::SimRotor& rotor = sim.numbers().rotors[static_cast<std::size_t>(i)];
    const double square = s.rotors_radps(i) * s.rotors_radps(i);
    const double lift = sim.numbers().thrust_coefficient * square;
    x(12) += lift;
    x(13) += rotor.y_m * lift;
    x(14) -= rotor.x_m * lift;
    x(15) += rotor.torque_sign * sim.numbers().torque_coefficient * square;
  }
  x(12) -= sim.numbers().mass_kg * sim.numbers().gravity_mps2;
  return x.head(n);
}

/// Puts the vehicle where observe() gives x.
void put(QuadrotorSim& sim, double yaw_rad, const Eigen::VectorXd& x, RotorMixer& mixer) {
  const auto turn = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
  test::QuadrotorState& s = sim.state();
  s.p_W = turn * Eigen::Vector3d(x.head<3>());
  s.v_W = turn * Eigen::Vector3d(x.segment<3>(3));
  s.q_WB = turn * Eigen::AngleAxisd(x(8), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(x(7), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(x(6), Eigen::Vector3d::UnitX());
  s.w_B = x.segment<3>(9);
  const double weight = sim.numbers().mass_kg * sim.numbers().gravity_mps2;
  std::vector<double> speeds(4);
  mixer.mix({weight + x(12), x.segment<3>(13)}, speeds);
  s.rotors_radps = Eigen::Map<const Eigen::VectorXd>(speeds.data(), 4);
}

// The derivative of the nonlinear vehicle by each state and input, by central differences of short
// flights, against the model's matrices. At a heading: the frame is the yaw frame.
TEST(HoverModel, IsTheDerivativeOfTheNonlinearVehicle) {
  for (QuadrotorNumbers numbers : {test::make_q4t(), test::with_plus_layout(test::make_m100())}) {
    numbers.body_drag_area_m2 = 0.0;  // quadratic drag has no derivative but zero at rest
    const RotorcraftModel craft = make_craft(numbers);
    RotorMixer mixer(craft, "test");
    const HoverModel model = make_hover_model(craft, true);
    ASSERT_EQ(model.A.rows(), 16);
    ASSERT_EQ(model.B.cols(), 4);
    const double weight = numbers.mass_kg * numbers.gravity_mps2, yaw = 2.1;
    constexpr double kStep = 1e-4, kDt = 1e-6;
    const auto rate = [&](const Eigen::VectorXd& x, const Eigen::Vector4d& u) {
      QuadrotorSim sim(numbers);
      put(sim, yaw, x, mixer);
      std::vector<double> speeds(4);
      mixer.mix({weight + u(0), u.tail<3>()}, speeds);
      const Eigen::VectorXd before = observe(sim, yaw, 16);
      sim.step(speeds, kDt);
      return Eigen::VectorXd((observe(sim, yaw, 16) - before) / kDt);
    };
    for (int i = 0; i < 20; ++i) {
      Eigen::VectorXd x = Eigen::VectorXd::Zero(16), dx = x;
      Eigen::Vector4d u = Eigen::Vector4d::Zero(), du = u;
      (i < 16 ? dx(i) : du(i - 16)) = kStep;
      const Eigen::VectorXd slope = (rate(x + dx, u + du) - rate(x - dx, u - du)) / (2.0 * kStep);
      const Eigen::VectorXd expected = i < 16 ? model.A.col(i) : model.B.col(i - 16);
      // Rounding over a step of 1 us, and its length times the next derivative.
      EXPECT_LT((slope - expected).cwiseAbs().maxCoeff(), 1e-3 * (1.0 + expected.norm())) << i;
    }
  }
}

TEST(HoverModel, WithoutLagHasTheWrenchAsInput) {
  const RotorcraftModel craft = make_craft(test::make_m100());
  const HoverModel lagged = make_hover_model(craft, true), direct = make_hover_model(craft, false);
  EXPECT_EQ(direct.A, lagged.A.topLeftCorner(12, 12));
  // In the long run, when the lagged wrench is the wanted one, with what spinning up gives at once.
  EXPECT_LT(
      (direct.B - lagged.A.topRightCorner(12, 4) - lagged.B.topRows(12)).cwiseAbs().maxCoeff(),
      1e-9 * direct.B.norm());
}

}  // namespace
}  // namespace vinerow::controllers::rotorcraft_test
