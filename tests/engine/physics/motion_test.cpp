/// Bodies in free flight against closed forms, an own reference solution and NASA's check cases.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "engine/physics/free_motion.h"
#include "tests/engine/physics/small_worlds.h"
#include "tests/support/data.h"

namespace vinerow::physics::motion_test {
namespace {

using Eigen::Vector3d;

constexpr double kFoot_m = 0.3048;
constexpr double kSlug_kg = 14.593902937;
constexpr double kSlugFt2_kgm2 = kSlug_kg * kFoot_m * kFoot_m;

PhysicsSettings with_step(double step_s) {
  PhysicsSettings settings;
  settings.step = duration_from_s(step_s);
  return settings;
}

/// Classical Runge-Kutta of any small system, with steps far below the ones under test.
template <int N>
Eigen::Matrix<double, N, 1> solve_rk4(
    Eigen::Matrix<double, N, 1> y, double duration_s, int steps,
    const std::function<Eigen::Matrix<double, N, 1>(const Eigen::Matrix<double, N, 1>&)>& rate) {
  using State = Eigen::Matrix<double, N, 1>;
  const double h = duration_s / steps;
  for (int k = 0; k < steps; ++k) {
    const State k1 = rate(y);
    const State k2 = rate(y + 0.5 * h * k1);
    const State k3 = rate(y + 0.5 * h * k2);
    const State k4 = rate(y + h * k3);
    y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return y;
}

TEST(FreeMotion, FreeFallAndProjectileAreExact) {
  const WorldModel model;
  PhysicsWorld world(with_step(0.001), model);
  BodySpec spec = test::make_sphere(0.1, 2.0, {1.0, 2.0, 100.0});
  spec.v_WB_W = {12.0, -3.0, 20.0};
  const BodyId body = world.add_body(spec);
  test::run(world, 4.0);
  const BodyState state = world.state(body);
  const Vector3d p_exact = spec.X_WB.p + 4.0 * spec.v_WB_W - Vector3d(0, 0, 0.5 * 9.80665 * 16.0);
  // 4000 steps of rounding at 100 m: a few 1e-12.
  EXPECT_LT((state.X_WB.p - p_exact).norm(), 1e-10);
  EXPECT_LT((state.v_WB_W - (spec.v_WB_W - Vector3d(0, 0, 9.80665 * 4.0))).norm(), 1e-11);
}

TEST(FreeMotion, ConstantForceIsExactInBothSamplings) {
  for (const ForceSampling sampling : {ForceSampling::kSmooth, ForceSampling::kHeld}) {
    const WorldModel model;
    PhysicsWorld world(with_step(0.01), model);
    BodySpec spec = test::make_sphere(0.1, 2.0, Vector3d::Zero());
    spec.force_sampling = sampling;
    const BodyId body = world.add_body(spec);
    for (int k = 0; k < 100; ++k) {
      world.add_central_force_W(body, {3.0, 0.0, 2.0 * 9.80665});
      world.step(duration_from_s(0.01));
    }
    EXPECT_NEAR(world.state(body).X_WB.p.x(), 0.5 * 1.5 * 1.0, 1e-12);
    EXPECT_NEAR(world.state(body).v_WB_W.x(), 1.5, 1e-12);
    EXPECT_NEAR(world.state(body).X_WB.p.z(), 0.0, 1e-12);
    EXPECT_NEAR(world.acceleration_W(body).x(), 1.5, 1e-12);
  }
}

TEST(FreeMotion, ForceOffTheCentreTurnsTheBody) {
  const WorldModel model;
  PhysicsWorld world(with_step(0.001), model);
  const BodyId body = world.add_body(test::make_sphere(0.5, 10.0, Vector3d::Zero()));
  // One torque of 2 N m about z for 0.5 s on 1 kg m2.
  for (int k = 0; k < 500; ++k) {
    const Vector3d p = world.state(body).X_WB.p;
    world.add_force_W(body, {0, 2.0, 0}, p + Vector3d(0.5, 0, 0));
    world.add_force_W(body, {0, -2.0, 0}, p - Vector3d(0.5, 0, 0));
    world.step(duration_from_s(0.001));
  }
  EXPECT_NEAR(world.state(body).w_WB_W.z(), 2.0 * 0.5 / 1.0, 1e-12);
  EXPECT_NEAR(yaw_from_quaternion(world.state(body).X_WB.q), 0.5 * 2.0 * 0.25, 1e-9);
}

// A torsion spring: phi'' = -k phi / I with k / I = 4, so phi = phi_0 cos 2t, whose error shrinks
// with the square of the step. Torques that were held over each step would leave a first order.
TEST(FreeMotion, ASpringThatTurnsABodyIsOfSecondOrder) {
  const WorldModel model;
  double error[2];
  for (const int half : {0, 1}) {
    const double dt_s = half == 0 ? 0.01 : 0.005;
    PhysicsWorld world(with_step(dt_s), model);
    BodySpec spec = test::make_sphere(0.5, 10.0, Vector3d::Zero());  // 1 kg m2
    spec.X_WB.q = quaternion_from_rpy({0, 0, 0.3});
    const BodyId body = world.add_body(spec);
    const int steps = static_cast<int>(std::lround(10.0 / dt_s));
    error[half] = 0.0;
    for (int k = 1; k <= steps; ++k) {
      const double phi = yaw_from_quaternion(world.state(body).X_WB.q);
      world.add_torque_W(body, {0, 0, -4.0 * phi});
      world.step(duration_from_s(dt_s));
      const double exact = 0.3 * std::cos(2.0 * k * dt_s);
      error[half] =
          std::max(error[half], std::abs(yaw_from_quaternion(world.state(body).X_WB.q) - exact));
    }
  }
  // Verlet's phase runs ahead by (w dt)^2 / 24 of itself: 0.3 * 20 rad * 0.02^2 / 24 = 1e-4.
  EXPECT_NEAR(error[0], 1e-4, 3e-5);
  EXPECT_NEAR(error[0] / error[1], 4.0, 0.2);
}

struct Brick {
  Vector3d inertia_kgm2 = Vector3d(0.00189422, 0.006211019, 0.007194665) * kSlugFt2_kgm2;
  Vector3d w0_B = Vector3d(rad_from_deg(10), rad_from_deg(20), rad_from_deg(30));

  BodySpec spec() const {
    BodySpec result;
    result.name = "brick";
    result.mass_kg = 0.155404754 * kSlug_kg;
    result.inertia_B = inertia_kgm2.asDiagonal();
    result.w_WB_W = w0_B;
    return result;
  }
  /// Body rates by Euler's equations, to about 1e-13.
  Vector3d exact_rates(double t_s) const {
    return solve_rk4<3>(w0_B, t_s, static_cast<int>(t_s * 2000) + 1, [&](const Vector3d& w) {
      return Vector3d(-w.cross(inertia_kgm2.cwiseProduct(w)).cwiseQuotient(inertia_kgm2));
    });
  }
};

Vector3d body_rates(const PhysicsWorld& world, BodyId body) {
  const BodyState state = world.state(body);
  return state.X_WB.q.conjugate() * state.w_WB_W;
}

TEST(FreeMotion, TumblingBrickFollowsEulersEquations) {
  const Brick brick;
  const WorldModel model;
  PhysicsWorld world(with_step(0.001), model);
  const BodyId body = world.add_body(brick.spec());
  double worst_deg = 0.0;
  for (int second = 1; second <= 30; ++second) {
    test::run(world, 1.0);
    const Vector3d error = body_rates(world, body) - brick.exact_rates(second);
    worst_deg = std::max(worst_deg, deg_from_rad(error.cwiseAbs().maxCoeff()));
  }
  // Fourth order at 1 kHz leaves rounding; plain Bullet is at 0.044 deg/s.
  EXPECT_LT(worst_deg, 1e-9);
  RecordProperty("worst_fdeg_per_s", std::to_string(worst_deg * 1e15));
}

TEST(FreeMotion, RotationErrorShrinksWithTheFourthPowerOfTheStep) {
  const Brick brick;
  const WorldModel model;
  const Vector3d exact = brick.exact_rates(10.0);
  double error[3];
  const double steps_s[3] = {0.2, 0.1, 0.05};
  for (int k = 0; k < 3; ++k) {
    PhysicsWorld world(with_step(steps_s[k]), model);
    const BodyId body = world.add_body(brick.spec());
    test::run(world, 10.0);
    error[k] = (body_rates(world, body) - exact).norm();
  }
  // 2^4 = 16 per halving, or better: the next order helps at these large steps.
  EXPECT_GT(error[0] / error[1], 14.0);
  EXPECT_GT(error[1] / error[2], 14.0);
}

TEST(FreeMotion, SpinningBodyKeepsMomentumAndEnergy) {
  // A full inertia matrix spun about its unstable middle axis (it keeps flipping), 100 s.
  BodySpec spec;
  spec.name = "wingnut";
  spec.inertia_B << 0.3, 0.02, -0.01, 0.02, 0.5, 0.03, -0.01, 0.03, 0.7;
  spec.w_WB_W = {0.1, 6.0, 0.05};
  const WorldModel model;
  PhysicsWorld world(with_step(0.001), model);
  const BodyId body = world.add_body(spec);
  const auto momentum_W = [&] {
    const BodyState s = world.state(body);
    return Vector3d(s.X_WB.q * (spec.inertia_B * (s.X_WB.q.conjugate() * s.w_WB_W)));
  };
  const Vector3d h0 = momentum_W();
  const double energy0 = 0.5 * h0.dot(spec.w_WB_W);
  test::run(world, 100.0);
  // Momentum changes by rounding alone (1e5 steps of a few 1e-16); energy by fourth-order error of
  // the attitude.
  EXPECT_LT((momentum_W() - h0).norm() / h0.norm(), 2e-10);
  const double energy = 0.5 * momentum_W().dot(world.state(body).w_WB_W);
  EXPECT_NEAR(energy / energy0, 1.0, 1e-9);
}

/// Columns of a CSV file by name, one row per line.
std::vector<std::vector<double>> read_columns(const std::filesystem::path& path,
                                              const std::vector<std::string>& names) {
  std::ifstream file(path);
  std::string line, cell;
  std::getline(file, line);
  std::istringstream header(line);
  std::vector<int> wanted(names.size(), -1);
  for (int column = 0; std::getline(header, cell, ','); ++column) {
    for (std::size_t n = 0; n < names.size(); ++n) {
      if (cell == names[n]) wanted[n] = column;
    }
  }
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    std::vector<double> values;
    std::istringstream cells(line);
    while (std::getline(cells, cell, ',')) values.push_back(std::stod(cell));
    std::vector<double> row;
    for (const int column : wanted) row.push_back(values.at(column));
    rows.push_back(row);
  }
  return rows;
}

TEST(FreeMotion, NescCase02AgreesWithTheSimulatorsOfNasa) {
  VINEROW_OUTSIDE_DATA(path,
                       "nesc/NESC_data/Atmospheric_checkcases/Atmos_02_TumblingBrickNoDamping/"
                       "Atmos_02_sim_04.csv");
  const auto rows =
      read_columns(path, {"time", "bodyAngularRateWrtEi_deg_s_Roll",
                          "bodyAngularRateWrtEi_deg_s_Pitch", "bodyAngularRateWrtEi_deg_s_Yaw"});
  ASSERT_EQ(rows.size(), 301u);
  const Brick brick;
  const WorldModel model;
  PhysicsWorld world(with_step(0.001), model);
  // The files are in x forward, y right, z down: a half turn about x, under which Euler's equations
  // keep their form when all components are read in those axes.
  const BodyId body = world.add_body(brick.spec());
  double worst_deg = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k > 0) test::run(world, 0.1);
    const Vector3d w = body_rates(world, body);
    for (int axis = 0; axis < 3; ++axis) {
      worst_deg = std::max(worst_deg, std::abs(deg_from_rad(w[axis]) - rows[k][axis + 1]));
    }
  }
  // Simulator 04 prints 12 digits and integrates to about 3e-10 deg/s; the six spread by 0.005.
  EXPECT_LT(worst_deg, 1e-8);
  RecordProperty("worst_fdeg_per_s", std::to_string(worst_deg * 1e15));
}

/// US Standard Atmosphere 1976 below 11 km: density, kg/m3. Source: NOAA-S/T 76-1562, Eqs. 33a, 42.
double density_us76_kgpm3(double altitude_m) {
  constexpr double kEarthRadius_m = 6356766.0;
  const double h = kEarthRadius_m * altitude_m / (kEarthRadius_m + altitude_m);
  const double temperature_K = 288.15 - 0.0065 * h;
  const double pressure_Pa =
      101325.0 * std::pow(temperature_K / 288.15, 9.80665 / (287.05287 * 0.0065));
  return pressure_Pa / (287.05287 * temperature_K);
}

/// NESC case 04: a sphere dropped from 30,000 ft on a round Earth that does not turn.
struct DroppedSphere {
  static constexpr double kMass_kg = 1.0 * kSlug_kg;
  static constexpr double kArea_m2 = 0.1963495 * kFoot_m * kFoot_m;
  static constexpr double kDragCoefficient = 0.1;
  static constexpr double kStart_m = 30000.0 * kFoot_m;
  // 32.1263 ft/s2 at 30,000 ft, and the radius there, from the case's first row.
  static constexpr double kStartRadius_m = 2.09322545305e7 * kFoot_m;
  static constexpr double kStartGravity_mps2 = 32.1263120705 * kFoot_m;

  static double gravity(double z) {
    const double radius = kStartRadius_m + (z - kStart_m);
    return kStartGravity_mps2 * (kStartRadius_m / radius) * (kStartRadius_m / radius);
  }
  static double drag_N(double z, double v_z) {
    return -0.5 * density_us76_kgpm3(z) * v_z * std::abs(v_z) * kDragCoefficient * kArea_m2;
  }
  static Eigen::Vector2d exact(double t_s) {
    return solve_rk4<2>({kStart_m, 0.0}, t_s, 30000, [](const Eigen::Vector2d& y) {
      return Eigen::Vector2d(y[1], drag_N(y[0], y[1]) / kMass_kg - gravity(y[0]));
    });
  }
  /// Height and speed after each `every_s` until `t_s`.
  static std::vector<Eigen::Vector2d> simulate(double step_s, double t_s, double every_s,
                                               ForceSampling sampling) {
    const WorldModel model;
    PhysicsSettings settings = with_step(step_s);
    settings.gravity_mps2 = 0.0;
    PhysicsWorld world(settings, model);
    BodySpec spec;
    spec.name = "sphere";
    spec.mass_kg = kMass_kg;
    spec.X_WB.p = {0, 0, kStart_m};
    spec.force_sampling = sampling;
    const BodyId body = world.add_body(spec);
    std::vector<Eigen::Vector2d> course;
    const int steps = static_cast<int>(std::lround(t_s / step_s));
    const int every = static_cast<int>(std::lround(every_s / step_s));
    for (int k = 1; k <= steps; ++k) {
      const BodyState s = world.state(body);
      const double z = s.X_WB.p.z();
      world.add_central_force_W(body, {0, 0, drag_N(z, s.v_WB_W.z()) - kMass_kg * gravity(z)});
      world.step(settings.step);
      if (k % every == 0) {
        course.emplace_back(world.state(body).X_WB.p.z(), world.state(body).v_WB_W.z());
      }
    }
    return course;
  }
};

TEST(FreeMotion, DroppedSphereFollowsTheExactFall) {
  const Eigen::Vector2d exact = DroppedSphere::exact(30.0);
  const Eigen::Vector2d end =
      DroppedSphere::simulate(0.001, 30.0, 30.0, ForceSampling::kSmooth).back();
  // Second order: 1 kHz leaves about 1e-5 m after 4197 m; plain Bullet is at 0.14 m.
  RecordProperty("error_um", std::to_string((end[0] - exact[0]) * 1e6));
  EXPECT_NEAR(end[0], exact[0], 1e-4);
  EXPECT_NEAR(end[1], exact[1], 1e-5);
  const Eigen::Vector2d held =
      DroppedSphere::simulate(0.001, 30.0, 30.0, ForceSampling::kHeld).back();
  RecordProperty("held_error_um", std::to_string((held[0] - exact[0]) * 1e6));
  EXPECT_NEAR(held[0], exact[0], 0.02);
}

TEST(FreeMotion, SampledForcesGiveSecondOrderHeldOnesFirst) {
  const Eigen::Vector2d exact = DroppedSphere::exact(10.0);
  const auto error = [&](double step_s, ForceSampling sampling) {
    return std::abs(DroppedSphere::simulate(step_s, 10.0, 10.0, sampling).back()[0] - exact[0]);
  };
  const double smooth = error(0.1, ForceSampling::kSmooth) / error(0.05, ForceSampling::kSmooth);
  EXPECT_NEAR(smooth, 4.0, 0.4);
  const double held = error(0.1, ForceSampling::kHeld) / error(0.05, ForceSampling::kHeld);
  EXPECT_NEAR(held, 2.0, 0.2);
}

TEST(FreeMotion, NescCase04AgreesWithTheSimulatorsOfNasa) {
  VINEROW_OUTSIDE_DATA(path,
                       "nesc/NESC_data/Atmospheric_checkcases/"
                       "Atmos_04_DroppedSphereRoundNonRotation/Atmos_04_sim_04.csv");
  const auto rows = read_columns(path, {"time", "altitudeMsl_ft", "feVelocity_ft_s_Z"});
  ASSERT_EQ(rows.size(), 301u);
  const auto course = DroppedSphere::simulate(0.001, 30.0, 0.1, ForceSampling::kSmooth);
  double worst_m = 0.0, worst_mps = 0.0;
  for (std::size_t k = 0; k < course.size(); ++k) {
    worst_m = std::max(worst_m, std::abs(course[k][0] - rows[k + 1][1] * kFoot_m));
    worst_mps = std::max(worst_mps, std::abs(course[k][1] + rows[k + 1][2] * kFoot_m));
  }
  RecordProperty("worst_um", std::to_string(worst_m * 1e6));
  EXPECT_LT(worst_m, 0.01);
  EXPECT_LT(worst_mps, 0.001);
}

TEST(FreeMotion, SpringKeepsItsEnergy) {
  // 1 kg on 400 N/m (w = 20 rad/s), 100 s = 318 swings at 1 ms.
  const WorldModel model;
  PhysicsSettings settings;
  settings.gravity_mps2 = 0.0;
  PhysicsWorld world(settings, model);
  BodySpec spec = test::make_sphere(0.1, 1.0, {0.1, 0, 0});
  const BodyId body = world.add_body(spec);
  double min_m = 1.0, max_m = 0.0;  // amplitude, from energy
  for (int k = 0; k < 100'000; ++k) {
    world.add_central_force_W(body, {-400.0 * world.state(body).X_WB.p.x(), 0, 0});
    world.step(settings.step);
    const BodyState s = world.state(body);
    const double amplitude = std::hypot(s.X_WB.p.x(), s.v_WB_W.x() / 20.0);
    min_m = std::min(min_m, amplitude);
    max_m = std::max(max_m, amplitude);
  }
  // The velocity read between steps is first order in the acceleration's change: +-w dt / 2 = 1 %.
  EXPECT_GT(min_m, 0.0985);
  EXPECT_LT(max_m, 0.1015);
}

TEST(FreeMotion, PrincipalAxesOfAFullMatrixGiveItBack) {
  Eigen::Matrix3d inertia_B;
  inertia_B << 0.3, 0.02, -0.01, 0.02, 0.5, 0.03, -0.01, 0.03, 0.7;
  const PrincipalInertia p = PrincipalInertia::from_matrix(2.0, inertia_B);
  const Eigen::Matrix3d R_BP = p.q_BP.toRotationMatrix();
  EXPECT_LT((R_BP * p.moments_kgm2.asDiagonal() * R_BP.transpose() - inertia_B).norm(), 1e-14);
}

}  // namespace
}  // namespace vinerow::physics::motion_test
