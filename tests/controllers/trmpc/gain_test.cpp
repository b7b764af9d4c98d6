/// The LQR's gain and the LMI gain on aircraft whose derivatives are off: 8 vertices of each axis,
/// after the reference of paper A, section 1 (worst spectral radius there: 0.983).

#include <gtest/gtest.h>

#include "controllers/parts/aircraft/aircraft_weights.h"
#include "controllers/parts/aircraft/flight_trim.h"
#include "controllers/parts/solvers/riccati.h"
#include "tests/controllers/parts/aircraft/wing_models.h"
#include "tests/controllers/support/aircraft_sim.h"

namespace vinerow::test::gain_test {
namespace {

controllers::AircraftLaws laws_of(const AircraftNumbers& numbers) {
  const controllers::Aircraft aircraft =
      controllers::read_aircraft(describe(numbers), numbers.gravity_mps2, "test");
  const Result<controllers::Trim> trim = controllers::find_trim(aircraft, {12.0, 0.0, 0.0});
  EXPECT_TRUE(trim) << trim.reason();
  return controllers::make_aircraft_laws(aircraft, *trim, 0.05, {}, "test");
}

/// The largest spectral radius of A + B K over all vertices.
template <class Change>
double worst_radius(bool longitudinal, const Eigen::MatrixXd& K, Change&& change) {
  double worst = 0.0;
  for (int vertex = 0; vertex < 8; ++vertex) {
    const auto sign = [&](int bit) { return (vertex >> bit) & 1 ? 1.0 : -1.0; };
    AircraftNumbers numbers = make_reference_wing();
    change(numbers, sign(0), sign(1), sign(2));
    const controllers::AircraftLaws laws = laws_of(numbers);
    const controllers::SampledAxis& axis = longitudinal ? laws.lon.model : laws.lat.model;
    worst = std::max(worst, controllers::spectral_radius(axis.A + axis.B * K));
  }
  return worst;
}

TEST(TubeGains, BothAreSchurAtEveryVertex) {
  const controllers::AircraftLaws nominal = laws_of(make_reference_wing());
  const auto lon = [](AircraftNumbers& n, double a, double b, double c) {
    n.Cma *= 1.0 + 0.2 * a;
    n.Cmde *= 1.0 + 0.2 * b;
    n.CLa *= 1.0 + 0.1 * c;
  };
  const auto lat = [](AircraftNumbers& n, double a, double b, double c) {
    n.Clb *= 1.0 + 0.2 * a;
    n.Clda *= 1.0 + 0.2 * b;
    n.Cnb *= 1.0 + 0.2 * c;
  };
  double worst = 0.0;
  for (const Eigen::MatrixXd& K : {nominal.lon.K, longitudinal_wing().K_lmi}) {
    worst = std::max(worst, worst_radius(true, K, lon));
  }
  for (const Eigen::MatrixXd& K : {nominal.lat.K, lateral_wing().K_lmi}) {
    worst = std::max(worst, worst_radius(false, K, lat));
  }
  EXPECT_NEAR(worst, 0.983, 0.002);
}

TEST(TubeGains, LqrGainsAreThePrototypes) {
  const controllers::AircraftLaws laws = laws_of(make_reference_wing());
  const Eigen::MatrixXd lon = longitudinal_wing().K, lat = lateral_wing().K;
  EXPECT_LT((laws.lon.K - lon).cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_LT((laws.lat.K - lat).cwiseAbs().maxCoeff(), 2e-3);
}

}  // namespace
}  // namespace vinerow::test::gain_test
