// The LQR beside what every controller of vehicles on wings keeps (aircraft_conformance_test.cpp).

#include <gtest/gtest.h>

#include "controllers/parts/aircraft/aircraft_weights.h"
#include "engine/math/angles.h"
#include "tests/controllers/parts/solvers/random_sets.h"
#include "tests/controllers/support/aircraft_loop.h"

namespace vinerow::test::fixed_wing_lqr_test {
namespace {

AircraftSetup make_setup() {
  AircraftSetup setup;
  setup.controller.type = "fixed_wing_lqr";
  setup.numbers = make_reference_wing();
  return setup;
}

TEST(FixedWingLqr, AppliesTheReferencesGains) {
  // u = K x with K of the reference of paper A, section 1, on what it says its deviations are.
  Eigen::MatrixXd lon(2, 5), lat(1, 5);
  lon << -.1192, -.0085, .0047, -.0048, -.0243, -.0101, -.0418, .0597, .7366, .0246;
  lat << -.0290, -.0429, -.1258, -.5042, -.4278;
  AircraftSetup setup = make_setup();
  setup.higher_m = -1.0;
  setup.turned_rad = 0.1;
  setup.roll_rad = -0.05;
  AircraftLoop loop(setup);
  int ticks = 0;
  loop.run_until(3.0, [&] {
    Eigen::VectorXd x(5), y(5);
    x << loop.deviation("u_mps"), loop.deviation("w_mps"), loop.deviation("q_radps"),
        loop.deviation("theta_rad"), loop.deviation("h_m");
    y << loop.deviation("v_mps"), loop.deviation("p_radps"), loop.deviation("r_radps"),
        loop.deviation("phi_rad"), loop.deviation("psi_rad");
    const Eigen::VectorXd u = lon * x, v = lat * y;
    EXPECT_NEAR(loop.deviation("throttle"), u(0), 5e-4);
    EXPECT_NEAR(loop.deviation("elevator_rad"), u(1), 5e-4);
    EXPECT_NEAR(loop.deviation("aileron_rad"), v(0), 5e-4);
    ++ticks;
  });
  EXPECT_EQ(ticks, 60);
}

TEST(FixedWingLqr, WeightsAreHeard) {
  const auto height_after = [](double height_weight_m) {
    AircraftSetup setup = make_setup();
    setup.higher_m = 2.0;
    const PartSpec& spec = parts().spec(PartKind::kController, "fixed_wing_lqr");
    ParameterSet weights = ParameterSet(spec.parameters, "").make_group("weights");
    weights.set("h_m", height_weight_m);
    setup.controller.values = {{"weights", std::vector<ParameterSet>{weights}}};
    AircraftLoop loop(setup);
    loop.run_until(1.5);
    return loop.deviation("h_m");
  };
  EXPECT_LT(height_after(0.5), height_after(2.0) - 0.2);
  EXPECT_LT(height_after(2.0), height_after(8.0) - 0.2);
}

TEST(FixedWingLqr, StaysWithItsModelForSmallOffsets) {
  // Without the lags that the model leaves out, the nonlinear aircraft goes as x+ = (A + B K) x.
  AircraftSetup setup = make_setup();
  setup.assumed = setup.numbers;
  setup.numbers.throttle_lag_s = setup.numbers.elevon_lag_s = 6e-3;
  setup.higher_m = 0.02;
  setup.faster_mps = 0.01;
  setup.turned_rad = 0.002;
  setup.roll_rad = 0.001;
  AircraftLoop loop(setup);
  const controllers::Aircraft aircraft =
      controllers::read_aircraft(describe(setup.numbers), 9.81, "test");
  const controllers::Trim trim = *controllers::find_trim(aircraft, {12.0, 0.0, 0.0});
  const controllers::AircraftLaws laws =
      controllers::make_aircraft_laws(aircraft, trim, 0.05, {}, "test");
  Eigen::VectorXd x(5), y(5);
  int tick = 0;
  loop.run_until(2.0, [&] {
    Eigen::VectorXd x_is(5), y_is(5);
    x_is << loop.deviation("u_mps"), loop.deviation("w_mps"), loop.deviation("q_radps"),
        loop.deviation("theta_rad"), loop.deviation("h_m");
    y_is << loop.deviation("v_mps"), loop.deviation("p_radps"), loop.deviation("r_radps"),
        loop.deviation("phi_rad"), loop.deviation("psi_rad");
    if (tick++ == 0) x = x_is, y = y_is;
    EXPECT_LT((x - x_is).cwiseAbs().maxCoeff(), 2e-3) << tick;
    EXPECT_LT((y - y_is).cwiseAbs().maxCoeff(), 2e-3) << tick;
    x = (laws.lon.model.A + laws.lon.model.B * laws.lon.K) * x;
    y = (laws.lat.model.A + laws.lat.model.B * laws.lat.K) * y;
  });
}

}  // namespace
}  // namespace vinerow::test::fixed_wing_lqr_test
