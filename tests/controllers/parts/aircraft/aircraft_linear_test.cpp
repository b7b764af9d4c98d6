// The linear models of the aircraft of aircraft_sim.h against those that another program printed
// (reference of paper A, section 1), and against the nonlinear aircraft itself.

#include "controllers/parts/aircraft/aircraft_linear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/aircraft/aircraft_weights.h"
#include "controllers/parts/solvers/riccati.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/aircraft_sim.h"

namespace vinerow::test::aircraft_linear_test {
namespace {

constexpr double kPeriod_s = 0.05;

struct Linearised {
  controllers::Aircraft aircraft;
  controllers::Trim trim;
  controllers::AircraftLinear linear;
};

Linearised linearise_at(double bank_rad = 0.0) {
  const AircraftNumbers numbers = make_reference_wing();
  Linearised made{
      controllers::read_aircraft(describe(numbers), numbers.gravity_mps2, "plane"), {}, {}};
  made.trim = *controllers::find_trim(made.aircraft, {12.0, 0.0, bank_rad});
  made.linear = controllers::linearise(made.aircraft, made.trim);
  return made;
}

/// Within 1 % of each printed number, and half a digit of the last printed place.
void expect_printed(const Eigen::MatrixXd& values, const Eigen::MatrixXd& printed,
                    const char* name) {
  ASSERT_EQ(values.rows(), printed.rows());
  ASSERT_EQ(values.cols(), printed.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      EXPECT_NEAR(values(i, j), printed(i, j), 0.01 * std::abs(printed(i, j)) + 0.5e-4)
          << name << "(" << i << ", " << j << ")";
    }
  }
}

TEST(AircraftLinear, LongitudinalMatricesAreTheReferences) {
  const controllers::SampledAxis axis =
      controllers::discretise(linearise_at().linear.longitudinal, kPeriod_s);
  Eigen::MatrixXd A(5, 5), B(5, 2), E(5, 2);
  // clang-format off
  A << .9739,  .0496, -.0649, -.4818, 0,
      -.0215,  .6433,  .3848, -.0451, 0,
       .0614, -.3532,  .6485, -.0027, 0,
       .0016, -.0100,  .0416,  1,     0,
       .0073, -.0431,  .0023,  .5997, 1;
  B << .5764, .2057, -.0082, -2.0268, .0183, -5.0291, .0003, -.1361, .0021, .0138;
  E << .0261, -.0496, .0215, .3567, -.0614, .3532, -.0016, .0100, -.0009, -.0065;
  // clang-format on
  expect_printed(axis.A, A, "A");
  expect_printed(axis.B, B, "B");
  expect_printed(axis.E, E, "E");
}

TEST(AircraftLinear, LateralMatricesAreTheReferences) {
  const controllers::SampledAxis axis =
      controllers::discretise(linearise_at().linear.lateral, kPeriod_s);
  Eigen::MatrixXd A(5, 5), B(5, 1), E(5, 1);
  // clang-format off
  A << .9398,  .0756, -.5548,  .4745, 0,
      -.4098,  .5872,  .2817, -.1097, 0,
       .0564, -.0325,  .9531,  .0132, 0,
      -.0111,  .0389,  .0127,  .9981, 0,
       .0014, -.0009,  .0494,  .0002, 1;
  // clang-format on
  B << .2902, 5.2140, -.2609, .1413, -.0057;
  E << .0602, .4098, -.0564, .0111, -.0014;
  expect_printed(axis.A, A, "A");
  expect_printed(axis.B, B, "B");
  expect_printed(axis.E, E, "E");
}

TEST(AircraftLinear, ModesAreTheReferences) {
  const controllers::AircraftLinear linear = linearise_at().linear;
  const std::vector<controllers::FlightMode> lon = controllers::calc_modes(linear.longitudinal);
  ASSERT_EQ(lon.size(), 3u);  // height, phugoid, short period
  EXPECT_NEAR(lon[0].frequency_radps, 0.0, 1e-9);
  EXPECT_NEAR(lon[1].frequency_radps, 1.04, 0.01);
  EXPECT_NEAR(lon[1].damping, 0.24, 0.005);
  EXPECT_NEAR(lon[2].frequency_radps, 12.0, 0.12);
  EXPECT_NEAR(lon[2].damping, 0.49, 0.005);
  const std::vector<controllers::FlightMode> lat = controllers::calc_modes(linear.lateral);
  ASSERT_EQ(lat.size(), 4u);  // heading, spiral, dutch roll, roll
  EXPECT_NEAR(lat[0].frequency_radps, 0.0, 1e-9);
  EXPECT_NEAR(lat[1].root.real(), 0.006, 0.0005);
  EXPECT_NEAR(lat[2].frequency_radps, 5.75, 0.0575);
  EXPECT_NEAR(lat[2].damping, 0.073, 0.0008);
  EXPECT_NEAR(lat[3].root.real(), -10.2, 0.102);
}

TEST(AircraftLinear, GainsAreTheReferences) {
  const Linearised at = linearise_at();
  const controllers::AircraftLaws laws =
      controllers::make_aircraft_laws(at.aircraft, at.trim, kPeriod_s, {}, "plane");
  Eigen::MatrixXd lon(2, 5), lat(1, 5);
  lon << -.1192, -.0085, .0047, -.0048, -.0243, -.0101, -.0418, .0597, .7366, .0246;
  lat << -.0290, -.0429, -.1258, -.5042, -.4278;
  EXPECT_LT((laws.lon.K - lon).cwiseAbs().maxCoeff(), 0.6e-4) << laws.lon.K;
  EXPECT_LT((laws.lat.K - lat).cwiseAbs().maxCoeff(), 0.6e-4) << laws.lat.K;
  EXPECT_NEAR(controllers::spectral_radius(laws.lon.model.A + laws.lon.model.B * laws.lon.K), .9764,
              0.6e-4);
  EXPECT_NEAR(controllers::spectral_radius(laws.lat.model.A + laws.lat.model.B * laws.lat.K), .9463,
              0.6e-4);
}

TEST(AircraftLinear, PredictsTheNonlinearAircraftForSmallDeviations) {
  // The sampled model and the second implementation, lags switched off by starting the controls
  // where they are wanted; held input and gust.
  const AircraftNumbers numbers = make_reference_wing();
  const Linearised at = linearise_at();
  const controllers::SampledAxis lon = controllers::discretise(at.linear.longitudinal, kPeriod_s);
  const controllers::SampledAxis lat = controllers::discretise(at.linear.lateral, kPeriod_s);
  const double small = 1e-4;
  Eigen::VectorXd x_lon(5), x_lat(5), d_lon(2), d_lat(1), u_lon(2), u_lat(1);
  x_lon << 2, -3, 4, 1, 5;
  x_lat << 3, -2, 1, 2, -1;
  u_lon << 2, -1;
  u_lat << 1.5;
  d_lon << 3, -4;
  d_lat << 5;
  const controllers::Trim& t = at.trim;
  AircraftSim sim(numbers);
  sim.start(
      {0, 0, small * x_lon(4)}, small * x_lat(3), t.pitch_rad + small * x_lon(3), small * x_lat(4),
      Eigen::Vector3d(t.u_mps, 0, t.w_mps) + small * Eigen::Vector3d(x_lon(0), x_lat(0), x_lon(1)),
      small * Eigen::Vector3d(x_lat(1), x_lon(2), x_lat(2)),
      Eigen::Vector3d(t.controls.throttle, t.controls.elevator_rad, 0.0) +
          small * Eigen::Vector3d(u_lon(0), u_lon(1), u_lat(0)));
  sim.set_body_gust(small * Eigen::Vector3d(d_lon(0), d_lat(0), d_lon(1)));
  const Eigen::Vector3d held = sim.state().controls;
  for (int i = 0; i < 50; ++i) sim.step({held.x(), held.z(), held.y()}, kPeriod_s / 50);
  const Eigen::VectorXd lon_next = lon.A * x_lon + lon.B * u_lon + lon.E * d_lon;
  const Eigen::VectorXd lat_next = lat.A * x_lat + lat.B * u_lat + lat.E * d_lat;
  const AircraftState& s = sim.state();
  const Eigen::Vector3d angles = sim.angles();
  Eigen::VectorXd lon_is(5), lat_is(5);
  lon_is << s.velocity.x() - t.u_mps, s.velocity.z() - t.w_mps, s.rates.y(),
      angles(1) - t.pitch_rad, -s.p_N.z();
  lat_is << s.velocity.y(), s.rates.x(), s.rates.z(), angles(0), angles(2);
  EXPECT_LT((lon_is / small - lon_next).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT((lat_is / small - lat_next).cwiseAbs().maxCoeff(), 0.02);
}

}  // namespace
}  // namespace vinerow::test::aircraft_linear_test
