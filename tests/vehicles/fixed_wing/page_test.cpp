/// The reference of paper A, section 1, prints trim, modes and sampled matrices of its aircraft.
/// They must come out of the flight model that the vehicle uses and gives to its controllers.
/// Central differences and series of the matrix exponential are this test's own.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <complex>

#include "tests/vehicles/fixed_wing/rig.h"

namespace vinerow::vehicles::page_test {
namespace {

using namespace test;
using Eigen::Vector3d;

/// u v w p q r phi theta psi h, in the signs of aviation.
using State = Eigen::Matrix<double, 10, 1>;
/// throttle, elevator, aileron, gusts u_g v_g w_g.
using Input = Eigen::Matrix<double, 6, 1>;

class Motion {
 public:
  explicit Motion(const FlightModel& model) : model_(model) {
    const Eigen::Matrix3d I = model.inertia_B();
    J_ = I;
    J_(0, 2) = J_(2, 0) = -I(0, 2);  // z down
  }
  State rate(const State& x, const Input& in) const {
    const Vector3d v = x.head<3>(), w = x.segment<3>(3), air = v - in.tail<3>();
    const std::array<double, 3> actuators = {in[0], in[1] + in[2], in[1] - in[2]};
    AirPoint point;
    point.v_air_B = {air.x(), -air.y(), -air.z()};
    point.w_WB_B = {w.x(), -w.y(), -w.z()};
    const AirLoad load = model_.load(point, actuators);
    const Vector3d force(load.force_B.x(), -load.force_B.y(), -load.force_B.z());
    const Vector3d moment(load.torque_B.x(), -load.torque_B.y(), -load.torque_B.z());
    const double sp = std::sin(x[6]), cp = std::cos(x[6]), st = std::sin(x[7]), ct = std::cos(x[7]);
    State d;
    d.head<3>() =
        force / model_.mass_kg() + kGravity * Vector3d(-st, ct * sp, ct * cp) - w.cross(v);
    d.segment<3>(3) = J_.inverse() * (moment - w.cross(J_ * w));
    d[6] = w.x() + st / ct * (w.y() * sp + w.z() * cp);
    d[7] = w.y() * cp - w.z() * sp;
    d[8] = (w.y() * sp + w.z() * cp) / ct;
    d[9] = v.x() * st - v.y() * sp * ct - v.z() * cp * ct;
    return d;
  }

 private:
  const FlightModel& model_;
  Eigen::Matrix3d J_;
};

struct PageModel {
  PageModel() : model(plain_params()), motion(model) {
    Vector3d z(0.1, 0.6, 0.0);  // alpha, throttle, elevator
    for (int k = 0; k < 20; ++k) {
      Eigen::Matrix3d slope;
      for (int i = 0; i < 3; ++i) {
        const Vector3d h = 1e-5 * Vector3d::Unit(i);
        slope.col(i) = (residual(z + h) - residual(z - h)) / 2e-5;
      }
      z -= slope.inverse() * residual(z);
    }
    trim = z;
    const State x0 = state(z);
    const Input u0 = input(z);
    const double h = 1e-5;
    for (int i = 0; i < 10; ++i) {
      const State dx = h * State::Unit(i);
      A.col(i) = (motion.rate(x0 + dx, u0) - motion.rate(x0 - dx, u0)) / (2.0 * h);
    }
    for (int i = 0; i < 6; ++i) {
      const Input du = h * Input::Unit(i);
      B.col(i) = (motion.rate(x0, u0 + du) - motion.rate(x0, u0 - du)) / (2.0 * h);
    }
  }
  static State state(const Vector3d& z) {
    State x = State::Zero();
    x[0] = 12.0 * std::cos(z[0]), x[2] = 12.0 * std::sin(z[0]), x[7] = z[0];
    return x;
  }
  static Input input(const Vector3d& z) {
    Input in = Input::Zero();
    in[0] = z[1], in[1] = z[2];
    return in;
  }
  Vector3d residual(const Vector3d& z) const {
    const State d = motion.rate(state(z), input(z));
    return {d[0], d[2], d[4]};
  }
  /// Rows and columns of one axis, sampled by a zero-order hold of 0.05 s: [A | B] and its inputs.
  Eigen::MatrixXd sampled(const std::vector<int>& states, const std::vector<int>& inputs) const {
    const auto n = static_cast<Eigen::Index>(states.size());
    const auto m = static_cast<Eigen::Index>(inputs.size());
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + m, n + m);
    all.topLeftCorner(n, n) = A(states, states);
    all.topRightCorner(n, m) = B(states, inputs);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(n + m, n + m), term = sum;
    for (int k = 1; k < 40; ++k) {
      term = term * all * 0.05 / k;
      sum += term;
    }
    return sum.topRows(n);
  }
  std::vector<std::complex<double>> roots(const std::vector<int>& states) const {
    const Eigen::VectorXcd values = Eigen::MatrixXd(A(states, states)).eigenvalues();
    std::vector<std::complex<double>> roots(values.begin(), values.end());
    std::sort(roots.begin(), roots.end(),
              [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); });
    return roots;
  }

  FixedWingModel model;
  Motion motion;
  Vector3d trim;
  Eigen::Matrix<double, 10, 10> A;
  Eigen::Matrix<double, 10, 6> B;
};

const std::vector<int> kLon = {0, 2, 4, 7, 9}, kLat = {1, 3, 5, 6, 8};

TEST(FixedWingPage, TrimComesOut) {
  const PageModel page;
  EXPECT_NEAR(deg_from_rad(page.trim[0]), 7.35, 0.01 * 7.35);
  EXPECT_NEAR(page.trim[1], 0.5828, 0.01 * 0.5828);
  EXPECT_NEAR(deg_from_rad(page.trim[2]), -0.830, 0.01 * 0.830);
  const LiftDrag c =
      calc_lift_drag(plain_params().wing, page.trim[0], {page.trim[2], page.trim[2]});
  EXPECT_NEAR(c.lift, 0.487, 0.01 * 0.487);
  EXPECT_NEAR(c.drag, 0.0547, 0.01 * 0.0547);
  EXPECT_NEAR(c.lift / c.drag, 8.9, 0.01 * 8.9);
  const double square = page.trim[1] * page.trim[1];
  EXPECT_NEAR(calc_thrust_N(plain_params().propeller, 1.225, 12.0, square), 1.31, 0.01 * 1.31);
}

/// What the vehicle starts with in the air, by bisection, is the same.
TEST(FixedWingPage, BisectionFindsTheSameTrim) {
  const PageModel page;
  const auto flight = find_level_flight(plain_params(), 12.0, kGravity, 1.225);
  ASSERT_TRUE(flight);
  EXPECT_NEAR(flight->alpha_rad, page.trim[0], 1e-9);
  EXPECT_NEAR(flight->throttle, page.trim[1], 1e-9);
  EXPECT_NEAR(flight->elevator_rad, page.trim[2], 1e-9);
}

TEST(FixedWingPage, ModesComeOut) {
  const PageModel page;
  const auto lon = page.roots(kLon), lat = page.roots(kLat);
  const auto damping = [](const std::complex<double>& s) { return -s.real() / std::abs(s); };
  // Half a unit of the last digit printed beside the 1 %.
  EXPECT_NEAR(std::abs(lon[1]), 1.04, 0.01 * 1.04 + 0.005);  // phugoid
  EXPECT_NEAR(damping(lon[1]), 0.24, 0.01 * 0.24 + 0.005);
  EXPECT_NEAR(std::abs(lon[4]), 12.0, 0.01 * 12.0 + 0.05);  // short period
  EXPECT_NEAR(damping(lon[4]), 0.49, 0.01 * 0.49 + 0.005);
  EXPECT_NEAR(lat[1].real(), 0.006, 0.0005);                 // spiral
  EXPECT_NEAR(std::abs(lat[2]), 5.75, 0.01 * 5.75 + 0.005);  // dutch roll
  EXPECT_NEAR(damping(lat[2]), 0.073, 0.01 * 0.073 + 0.0005);
  EXPECT_NEAR(lat[4].real(), -10.2, 0.01 * 10.2 + 0.05);  // roll
}

void expect_page(const Eigen::MatrixXd& mine, const Eigen::MatrixXd& page, const char* what) {
  ASSERT_EQ(mine.cols(), page.cols());
  for (Eigen::Index i = 0; i < page.rows(); ++i) {
    for (Eigen::Index j = 0; j < page.cols(); ++j) {
      EXPECT_NEAR(mine(i, j), page(i, j), 0.01 * std::abs(page(i, j)) + 0.5e-4)
          << what << "(" << i << ", " << j << ")";
    }
  }
}

TEST(FixedWingPage, LongitudinalMatricesComeOut) {
  const PageModel page;
  // [u w q theta h] and [d_t d_e | u_g w_g].
  Eigen::MatrixXd printed(5, 9);
  printed << .9739, .0496, -.0649, -.4818, 0, .5764, .2057, .0261, -.0496,  //
      -.0215, .6433, .3848, -.0451, 0, -.0082, -2.0268, .0215, .3567,       //
      .0614, -.3532, .6485, -.0027, 0, .0183, -5.0291, -.0614, .3532,       //
      .0016, -.0100, .0416, 1, 0, .0003, -.1361, -.0016, .0100,             //
      .0073, -.0431, .0023, .5997, 1, .0021, .0138, -.0009, -.0065;
  expect_page(page.sampled(kLon, {0, 1, 3, 5}), printed, "longitudinal");
}

TEST(FixedWingPage, LateralMatricesComeOut) {
  const PageModel page;
  // [v p r phi psi] and [d_a | v_g].
  Eigen::MatrixXd printed(5, 7);
  printed << .9398, .0756, -.5548, .4745, 0, .2902, .0602,  //
      -.4098, .5872, .2817, -.1097, 0, 5.2140, .4098,       //
      .0564, -.0325, .9531, .0132, 0, -.2609, -.0564,       //
      -.0111, .0389, .0127, .9981, 0, .1413, .0111,         //
      .0014, -.0009, .0494, .0002, 1, -.0057, -.0014;
  expect_page(page.sampled(kLat, {2, 4}), printed, "lateral");
}

}  // namespace
}  // namespace vinerow::vehicles::page_test
