/// NASA's check cases for flight simulations (NESC, TM-2015-218675) that a flat earth can meet:
/// bodies fall through the standard atmosphere as `fixed_wing` with coefficients of their own.
/// Bodies and coefficients: nesc/NESC_data/All_models. The trajectories of these cases are not
/// among the outside data, so the exact course is integrated here by the classical Runge-Kutta rule
/// with a standard atmosphere of this test's own; cases 02 and 04 are tests of engine/physics.
/// Winds of cases 07 and 08 as in the check cases of NASA's SimuPy Flight (nasa/simupy-flight,
/// nesc_test_cases/nesc_case07.py and nesc_case08.py).

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "tests/support/data.h"
#include "tests/vehicles/fixed_wing/rig.h"

namespace vinerow::vehicles::nesc_test {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kFoot_m = 0.3048;
constexpr double kSlug_kg = 14.593902937;
constexpr double kSlugFt2_kgm2 = kSlug_kg * kFoot_m * kFoot_m;
constexpr double kHigh_m = 30000.0 * kFoot_m;

/// Below 11 km; NOAA-S/T 76-1562, eqs. 33a and 42.
double density_kgm3(double altitude_m) {
  const double h = 6356766.0 * altitude_m / (6356766.0 + altitude_m);
  const double T = 288.15 - 0.0065 * h, R = 8314.32 / 28.9644;
  return 101325.0 * std::pow(T / 288.15, 9.80665 / (R * 0.0065)) / (R * T);
}

/// Round earth of case 04: 32.1263 ft/s2 at 30,000 ft.
double gravity_mps2(double altitude_m) {
  const double start_m = 2.09322545305e7 * kFoot_m;
  const double ratio = start_m / (start_m + altitude_m - kHigh_m);
  return 32.1263120705 * kFoot_m * ratio * ratio;
}

/// Value of a variable in a DAVE-ML file.
double read_dml(const std::filesystem::path& file, const std::string& variable) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  const std::string all = text.str();
  std::smatch found;
  const std::regex pattern("varID=\"" + variable + "\"[^>]*initialValue=\"([^\"]+)\"");
  if (!std::regex_search(all, found, pattern)) ADD_FAILURE() << variable << " is not in " << file;
  return found.empty() ? NAN : std::stod(found[1]);
}

/// No wing, no propeller: drag alike from all sides.
FixedWingParams bluff_body(double drag, double area_m2, double mass_kg) {
  FixedWingParams p = plain_params();
  WingParams wing;
  for (double* c :
       {&wing.lift_0, &wing.lift_alpha, &wing.lift_rate, &wing.lift_elevator, &wing.drag_deflection,
        &wing.pitch_0, &wing.pitch_alpha, &wing.pitch_rate, &wing.pitch_elevator, &wing.side_p,
        &wing.side_r, &wing.roll_beta, &wing.roll_p, &wing.roll_r, &wing.roll_aileron,
        &wing.yaw_beta, &wing.yaw_p, &wing.yaw_r, &wing.yaw_aileron}) {
    *c = 0.0;
  }
  wing.stall = false;
  wing.area_m2 = area_m2;
  wing.drag_0 = drag;
  wing.side_beta = -drag;
  p.wing = wing;
  p.mass_kg = mass_kg;
  p.propeller.coefficient = 0.0;
  p.inertia_xz_kgm2 = 0.0;
  return p;
}

FixedWingParams cannonball() {
  FixedWingParams p = bluff_body(0.1, 0.1963495 * kFoot_m * kFoot_m, 1.0 * kSlug_kg);
  p.inertia_kgm2.setConstant(3.6 * kSlugFt2_kgm2);
  return p;
}

WorldModel standard_world() {
  WorldModel world = make_flat_world();
  world.wind.atmosphere = Atmosphere::kStandard76;
  return world;
}

/// Flies `plane` as the vehicle; gravity of the round earth is added to each step.
void run_in_round_gravity(WingRig& rig, double time_s) {
  for (auto i = std::llround(time_s / rig.dt.s()); i > 0; --i) {
    const double z = rig.body().X_WB.p.z() + 0.5 * rig.dt.s() * rig.body().v_WB_W.z();
    rig.world.add_central_force_W(rig.vehicle.body_id(),
                                  {0, 0, -rig.params.mass_kg * gravity_mps2(z)});
    rig.step();
  }
}

/// x (east), z, and their speeds of a falling sphere in a wind from the west.
Eigen::Vector4d exact_sphere(Eigen::Vector4d y, double time_s, int steps,
                             const std::function<double(double)>& wind_mps) {
  const auto rate = [&](const Eigen::Vector4d& s) {
    const double k = 0.5 * density_kgm3(s[1]) * 0.1 * 0.1963495 * kFoot_m * kFoot_m / kSlug_kg;
    const double vx = s[2] - wind_mps(s[1]), speed = std::hypot(vx, s[3]);
    return Eigen::Vector4d(s[2], s[3], -k * speed * vx, -k * speed * s[3] - gravity_mps2(s[1]));
  };
  const double h = time_s / steps;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector4d k1 = rate(y), k2 = rate(y + 0.5 * h * k1), k3 = rate(y + 0.5 * h * k2),
                          k4 = rate(y + h * k3);
    y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return y;
}

/// Distance after the flight, m.
double sphere_error_m(WorldModel world, const Eigen::Vector4d& start, double time_s,
                      const std::function<double(double)>& wind_mps) {
  WingRig rig(cannonball(), std::move(world), 1'000'000, 0.0, 0.0);
  physics::BodyState state = WingRig::level(start[1], 0.0, 0.3);
  state.v_WB_W = {start[2], 0.0, start[3]};
  rig.fly(state, {0, 0, 0});
  run_in_round_gravity(rig, time_s);
  const Eigen::Vector4d exact = exact_sphere(start, time_s, 30000, wind_mps);
  const Vector3d error = rig.body().X_WB.p - Vector3d(exact[0], 0, exact[1]);
  ::testing::Test::RecordProperty("error_um", std::to_string(1e6 * error.norm()));
  EXPECT_NEAR(rig.body().v_WB_W.x(), exact[2], 2e-6);
  EXPECT_NEAR(rig.body().v_WB_W.z(), exact[3], 2e-6);
  return error.norm();
}

TEST(FixedWingNesc, Case07SphereDroppedInSteadyWind) {
  WorldModel world = standard_world();
  world.wind.height_law = WindHeightLaw::kUniform;
  world.wind.mean_speed_mps = 20.0 * kFoot_m;
  world.wind.from_azimuth_rad = rad_from_deg(270.0);
  EXPECT_LT(sphere_error_m(std::move(world), {0, kHigh_m, 0, 0}, 30.0,
                           [](double) { return 20.0 * kFoot_m; }),
            2e-6);
}

/// 70 ft/s at 30,000 ft, evenly down to -20 ft/s at sea level: 3 ft/s each 1000 ft.
TEST(FixedWingNesc, Case08SphereDroppedInWindShear) {
  WorldModel world = standard_world();
  world.wind.height_law = WindHeightLaw::kLinear;
  world.wind.ground_speed_mps = -20.0 * kFoot_m;
  world.wind.reference_height_m = kHigh_m;
  world.wind.mean_speed_mps = 70.0 * kFoot_m;
  world.wind.from_azimuth_rad = rad_from_deg(270.0);
  EXPECT_LT(sphere_error_m(std::move(world), {0, kHigh_m, 0, 0}, 30.0,
                           [](double z) { return 0.003 * z - 20.0 * kFoot_m; }),
            2e-6);
}

/// Cases 09 and 10 without the earth's curve: launched from the ground at 45 deg with 1000 ft/s up
/// and 1000 ft/s along.
TEST(FixedWingNesc, Case09SphereLaunchedBallistically) {
  EXPECT_LT(sphere_error_m(standard_world(), {0, 1.0, 1000.0 * kFoot_m, 1000.0 * kFoot_m}, 30.0,
                           [](double) { return 0.0; }),
            5e-5);
}

/// Case 03: a brick of 5 lb falls tumbling and is damped by the air.
TEST(FixedWingNesc, Case03TumblingBrickWithDamping) {
  VINEROW_OUTSIDE_DATA(models, "nesc/NESC_data/All_models");
  const auto aero = [&](const char* name) { return read_dml(models / "brick_aero.dml", name); };
  const auto inertia = [&](const char* n) { return read_dml(models / "brick_inertia.dml", n); };
  FixedWingParams p =
      bluff_body(aero("CD"), aero("SWING") * kFoot_m * kFoot_m, inertia("XMASS") * kSlug_kg);
  p.inertia_kgm2 = Vector3d(inertia("XIXX"), inertia("XIYY"), inertia("XIZZ")) * kSlugFt2_kgm2;
  p.wing.span_m = aero("BSPAN") * kFoot_m;
  p.wing.chord_m = aero("CBAR") * kFoot_m;
  p.wing.roll_p = aero("CLP_DAMPING");
  p.wing.pitch_rate = aero("CMQ_DAMPING");
  p.wing.yaw_r = aero("CNR_DAMPING");
  EXPECT_EQ(p.wing.roll_p, -1.0);

  WingRig rig(p, standard_world(), 1'000'000, 0.0, 0.0);
  physics::BodyState state = WingRig::level(kHigh_m, 0.0, 0.0);
  state.w_WB_W = {rad_from_deg(10.0), rad_from_deg(-20.0), rad_from_deg(-30.0)};  // p, -q, -r
  rig.fly(state, {0, 0, 0});

  // z, v, p, q, r: the drag does not depend on the attitude.
  using State = Eigen::Matrix<double, 5, 1>;
  State y;
  y << kHigh_m, 0.0, rad_from_deg(10.0), rad_from_deg(20.0), rad_from_deg(30.0);
  const double S = p.wing.area_m2, b = p.wing.span_m, c = p.wing.chord_m, m = p.mass_kg;
  const Vector3d J = p.inertia_kgm2, lengths2(b * b, c * c, b * b);
  const auto rate = [&](const State& s) {
    State d;
    const double rho = density_kgm3(s[0]);
    const Vector3d w = s.tail<3>();
    const Vector3d damping = -0.25 * rho * std::abs(s[1]) * S * lengths2.cwiseProduct(w);
    d[0] = s[1];
    d[1] = -0.5 * rho * S * 0.01 * s[1] * std::abs(s[1]) / m - gravity_mps2(s[0]);
    d.tail<3>() = (damping - w.cross(J.cwiseProduct(w))).cwiseQuotient(J);
    return d;
  };
  double worst_degps = 0.0, worst_m = 0.0;
  for (int second = 0; second < 30; ++second) {
    run_in_round_gravity(rig, 1.0);
    const double h = 1e-3;
    for (int i = 0; i < 1000; ++i) {
      const State k1 = rate(y), k2 = rate(y + 0.5 * h * k1), k3 = rate(y + 0.5 * h * k2),
                  k4 = rate(y + h * k3);
      y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    const Vector3d w_B = rig.rates_B(), w(w_B.x(), -w_B.y(), -w_B.z());
    worst_degps = std::max(worst_degps, deg_from_rad((w - y.tail<3>()).cwiseAbs().maxCoeff()));
    worst_m = std::max(worst_m, std::abs(rig.body().X_WB.p.z() - y[0]));
  }
  RecordProperty("worst_udegps", std::to_string(1e6 * worst_degps));
  RecordProperty("worst_um", std::to_string(1e6 * worst_m));
  EXPECT_LT(worst_degps, 1e-5);
  EXPECT_LT(worst_m, 2e-6);
  EXPECT_LT(rig.rates_B().norm(), 0.5 * rad_from_deg(37.0));  // damped indeed
}

}  // namespace
}  // namespace vinerow::vehicles::nesc_test
