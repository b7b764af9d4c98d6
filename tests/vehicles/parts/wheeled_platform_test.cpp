/// The wheel against physics: closed forms on level ground, slopes, valleys and steps.

#include "vehicles/parts/wheeled_platform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/vehicles/small_worlds.h"
#include "vehicles/diff_drive_rover/diff_drive_rover.h"
#include "vehicles/parts/effective_track.h"

namespace vinerow::vehicles::wheeled_platform_test {
namespace {

using namespace test;

constexpr double kGravity = 9.80665;

/// A rover's platform in a world of its own.
struct Rig {
  Rig(WorldModel model, const WheeledPlatformParams& params, double x = 0.0, double y = 0.0,
      double yaw_rad = 0.0, std::int64_t step_ns = 1'000'000)
      : world_model(std::move(model)),
        world(settings_with_step(step_ns), world_model),
        platform(params),
        dt{step_ns} {
    const double height = DiffDriveRoverParams{}.com_height_m;
    platform.spawn(world, pose_on_ground(world_model, x, y, yaw_rad, height));
  }

  void step() {
    platform.before_physics(dt);
    world.step(dt);
    platform.after_physics(dt);
  }
  void run(double time_s) {
    const auto steps = std::llround(time_s / dt.s());
    for (long long i = 0; i < steps; ++i) step();
  }
  void command(double left_radps, double right_radps) {
    for (const std::size_t i : {0u, 2u}) platform.command_speed(i, left_radps);
    for (const std::size_t i : {1u, 3u}) platform.command_speed(i, right_radps);
  }
  const physics::BodyState& body() const { return platform.state().body; }
  double total_load_N() const {
    double sum = 0.0;
    for (const WheelOutput& out : platform.outputs()) sum += out.load_N;
    return sum;
  }
  double yaw_rate_radps() const { return body().w_WB_W.z(); }

  WorldModel world_model;
  physics::PhysicsWorld world;
  WheeledPlatform platform;
  Duration dt;
};

WheeledPlatformParams rover_params() {
  return chassis_platform_params(DiffDriveRoverParams{}, kGravity);
}

WheeledPlatformParams free_wheeling_params() {
  WheeledPlatformParams params = rover_params();
  for (WheelParams& wheel : params.wheels) {
    wheel.motor.max_torque_Nm = 0.0;
    wheel.motor.brake_torque_Nm = 0.0;
  }
  return params;
}

/// Share by which the wheels' spin adds to the mass: sum I / (m R^2).
double rotating_share(const WheeledPlatformParams& params) {
  double sum = 0.0;
  for (const WheelParams& wheel : params.wheels) {
    sum += wheel.spin_inertia_kgm2 / (wheel.radius_m * wheel.radius_m);
  }
  return sum / params.mass_kg;
}

TEST(WheeledPlatform, StandsAsDrawnWithItsWeightOnTheWheels) {
  Rig rig(make_flat_world(), rover_params());
  rig.run(2.0);
  EXPECT_NEAR(rig.total_load_N(), 180.0 * kGravity, 1e-6 * 180.0 * kGravity);
  EXPECT_NEAR(rig.body().X_WB.p.z(), 0.38, 1e-9);
  EXPECT_NEAR(rig.body().v_WB_W.norm(), 0.0, 1e-9);
  // What an accelerometer shows at rest.
  EXPECT_NEAR((rig.platform.state().specific_force_B - Eigen::Vector3d(0, 0, kGravity)).norm(), 0.0,
              1e-6);
}

TEST(WheeledPlatform, DroppedItSettlesWithoutBouncingAway) {
  Rig rig(make_flat_world(), rover_params());
  physics::BodyState state = rig.body();
  state.X_WB.p.z() += 0.3;
  rig.world.set_state(rig.platform.body(), state);
  rig.platform.after_physics(rig.dt);
  double highest = 0.0;
  for (int i = 0; i < 3000; ++i) {
    rig.step();
    if (i > 400) highest = std::max(highest, rig.body().X_WB.p.z());
  }
  EXPECT_LT(highest, 0.38 + 0.1);
  EXPECT_NEAR(rig.body().X_WB.p.z(), 0.38, 1e-5);
}

TEST(WheeledPlatform, RollsOutAsFarAsRollingResistanceLets) {
  const WheeledPlatformParams params = free_wheeling_params();
  Rig rig(make_flat_world(), params);
  rig.run(0.5);
  const double v = 2.0, start = rig.body().X_WB.p.x();
  rig.platform.set_forward_speed(v);
  rig.run(6.0);
  EXPECT_NEAR(rig.body().v_WB_W.norm(), 0.0, 1e-6);
  // Energy of body and wheels against c_rr m g d; the tyre's slip of 0.4 % while braking and the
  // pitching of the body take a little more.
  const double expected = v * v * (1.0 + rotating_share(params)) / (2.0 * 0.06 * kGravity);
  EXPECT_NEAR(rig.body().X_WB.p.x() - start, expected, 0.01 * expected);
}

TEST(WheeledPlatform, FreeRollingThroughAValleyGainsNoEnergy) {
  WorldModel world = make_world(60.0, 0.5, [](double x, double) { return 0.02 * x * x; });
  world.soil.rolling_resistance = 0.0;
  const WheeledPlatformParams params = free_wheeling_params();
  Rig rig(std::move(world), params, -10.0);
  const auto energy = [&] {
    const physics::BodyState& body = rig.body();
    const Eigen::Vector3d w_B = body.X_WB.q.conjugate() * body.w_WB_W;
    double sum = 0.5 * params.mass_kg * body.v_WB_W.squaredNorm() +
                 0.5 * w_B.dot(params.inertia_B * w_B) +
                 params.mass_kg * kGravity * body.X_WB.p.z();
    for (std::size_t i = 0; i < 4; ++i) {
      const WheelState& wheel = rig.platform.state().wheels[i];
      const SuspensionParams& spring = params.wheels[i].suspension;
      const double load = spring.design_load_N + spring.stiffness_N_per_m * wheel.travel_m;
      sum += 0.5 * params.wheels[i].spin_inertia_kgm2 * wheel.spin_radps * wheel.spin_radps;
      if (load > 0.0) sum += 0.5 * load * load / spring.stiffness_N_per_m;
    }
    return sum;
  };
  rig.step();
  const double start = energy();
  const double turnover = params.mass_kg * kGravity * 0.02 * 100.0;  // J, top to bottom
  double largest = start, last_top = -10.0, x_max = -10.0;
  for (int i = 0; i < 20000; ++i) {
    rig.step();
    largest = std::max(largest, energy());
    x_max = std::max(x_max, rig.body().X_WB.p.x());
    last_top = rig.body().X_WB.p.x();
  }
  // Semi-implicit integration of the stiff springs lets the sum swing by parts in a thousand.
  EXPECT_LE(largest - start, 2e-3 * turnover);
  EXPECT_GT(x_max, 8.5);   // and it does swing to the other side: little is lost
  EXPECT_LE(x_max, 10.0);  // not beyond the height it came from
  EXPECT_TRUE(std::isfinite(last_top));
}

TEST(WheeledPlatform, LoadsOnASlopeFollowStatics) {
  const double angle = rad_from_deg(15.0);
  Rig rig(make_slope_world(angle), rover_params());
  rig.run(4.0);
  const double weight = 180.0 * kGravity;
  EXPECT_NEAR(rig.total_load_N(), weight * std::cos(angle), 1e-3 * weight);
  // Moment about the contacts: the axle loads differ by 2 m g sin(a) h / wheel base.
  const auto out = rig.platform.outputs();
  const double front = out[0].load_N + out[1].load_N, rear = out[2].load_N + out[3].load_N;
  const double expected = 2.0 * weight * std::sin(angle) * 0.38 / 1.5;
  EXPECT_NEAR(rear - front, expected, 0.02 * expected);  // the springs move the body by some mm
  double along = 0.0;
  for (const WheelOutput& wheel : out) along += wheel.force_x_N;
  EXPECT_NEAR(along, weight * std::sin(angle), 1e-3 * weight);
}

TEST(WheeledPlatform, RestsWhereItIsSetDownOnASlope) {
  for (const double angle_deg : {8.0, 20.0, 33.0}) {
    for (const double yaw_deg : {0.0, 35.0, 90.0, 180.0, 200.0}) {
      const double angle = rad_from_deg(angle_deg), yaw = rad_from_deg(yaw_deg);
      Rig rig(make_slope_world(angle), rover_params(), 0.0, 0.0, yaw);
      const Eigen::Vector3d start_W = rig.body().X_WB.p;
      rig.step();
      // Statics of the whole at once: weight along the slope's normal, moments about the contacts.
      const double weight = 180.0 * kGravity;
      const auto out = rig.platform.outputs();
      EXPECT_NEAR(rig.total_load_N(), weight * std::cos(angle), 1e-3 * weight);
      const double ends = out[2].load_N + out[3].load_N - out[0].load_N - out[1].load_N;
      const double sides = out[1].load_N + out[3].load_N - out[0].load_N - out[2].load_N;
      // The body leans downhill on its struts, which adds W cos(a) h to the moment per radian.
      const double moment_N = 2.0 * weight * std::sin(angle) * 0.38;
      const auto leaning = [&](double half_m) {
        return 1.0 / (1.0 - weight * std::cos(angle) * 0.38 / (4.0 * 20000.0 * half_m * half_m));
      };
      if (std::fmod(yaw_deg, 90.0) == 0.0) {
        EXPECT_NEAR(ends, moment_N * std::cos(yaw) / 1.5 * leaning(0.75), 0.015 * moment_N);
        EXPECT_NEAR(sides, moment_N * -std::sin(yaw) / 1.0 * leaning(0.5), 0.015 * moment_N);
      }
      double moved = 0.0;
      for (int i = 0; i < 1000; ++i) {
        rig.step();
        moved = std::max(moved, (rig.body().X_WB.p - start_W).norm());
      }
      EXPECT_LT(moved, 2e-5) << angle_deg << " deg, yaw " << yaw_deg;
    }
  }
}

TEST(WheeledPlatform, RefusesAStepThatItsWheelsAreNotMadeFor) {
  WheeledPlatform platform(rover_params());
  WorldModel model = make_flat_world();
  physics::PhysicsWorld world(settings_with_step(25'000'000), model);
  try {
    platform.spawn(world, pose_on_ground(model, 0.0, 0.0, 0.0, 0.38));
    FAIL() << "25 ms is taken";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover: physics.step_s = 0.025 s is too long for its wheels, which are valid to "
                 "0.0025 s");
  }
}

/// Why the platform cannot stand on flat ground with steps of 1 ms; empty: it can.
std::string fault_of_spawn(const WheeledPlatformParams& params) {
  WheeledPlatform platform(params);
  WorldModel model = make_flat_world();
  physics::PhysicsWorld world(settings_with_step(1'000'000), model);
  try {
    platform.spawn(world, pose_on_ground(model, 0.0, 0.0, 0.0, 0.38));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(WheeledPlatform, RefusesStrutsThatAreTooStiffForTheStep) {
  const auto fault_of = [](double heave_radps, double damping_per_s) {
    WheeledPlatformParams params = rover_params();
    params.mass_kg = 100.0;
    params.inertia_B = 1e4 * Eigen::Matrix3d::Identity();  // heave is the fastest of its motions
    for (WheelParams& wheel : params.wheels) {
      wheel.suspension.stiffness_N_per_m = heave_radps * heave_radps * params.mass_kg / 4.0;
      wheel.suspension.damping_Ns_per_m = damping_per_s * params.mass_kg / 4.0;
    }
    return fault_of_spawn(params);
  };
  EXPECT_EQ(fault_of(490.0, 900.0), "");
  EXPECT_EQ(fault_of(510.0, 900.0),
            "rover: physics.step_s = 0.001 s is too long for the struts under 100 kg: they swing "
            "0.51 rad and damp by 0.9 in a step, must be at most 0.5 rad and 1");
  EXPECT_NE(fault_of(490.0, 1100.0).find("damp by 1.1 in a step"), std::string::npos);
}

/// Roll: four springs at half the track B give k B^2, here with B = 1 m; the weight tips by m g h.
TEST(WheeledPlatform, RefusesSpringsThatCannotKeepItUpright) {
  const double limit_N_per_m = 180.0 * kGravity * 0.38;
  const auto fault_of = [](double stiffness_N_per_m) {
    WheeledPlatformParams params = rover_params();
    for (WheelParams& wheel : params.wheels) {
      wheel.suspension.stiffness_N_per_m = stiffness_N_per_m;
    }
    return fault_of_spawn(params);
  };
  EXPECT_EQ(fault_of(1.001 * limit_N_per_m), "");
  EXPECT_NE(fault_of(0.999 * limit_N_per_m).find("rover: its springs cannot keep it upright"),
            std::string::npos);
  EXPECT_EQ(
      fault_of(10.0),
      "rover: its springs cannot keep it upright: they resist a tilt by 10 Nm/rad, and 180 kg "
      "with the centre of mass 0.38 m above the ground tip it by 671 Nm/rad; take springs "
      "(suspension_stiffness_N_per_m) more than 67.08 times as stiff");
}

TEST(WheeledPlatform, BrakingMovesLoadToTheFront) {
  Rig rig(make_flat_world(), rover_params());
  rig.command(5.0, 5.0);
  rig.run(3.0);
  // A speed ramp of -1 m/s2 for half a second, then look at the middle of it.
  double difference = 0.0, deceleration = 0.0;
  for (int i = 0; i < 600; ++i) {
    const double speed = 5.0 - 5.0 * i * 1e-3;
    rig.command(speed, speed);
    rig.step();
    if (i < 400) continue;
    const auto out = rig.platform.outputs();
    difference += (out[0].load_N + out[1].load_N - out[2].load_N - out[3].load_N) / 200.0;
    deceleration += -rig.platform.state().specific_force_B.x() / 200.0;
  }
  EXPECT_NEAR(deceleration, 1.0, 0.1);
  // Forces act at the ground; the wheels' spin adds sum(I) a / R about the axles, and rolling
  // resistance, a load ahead of the axle, takes c W R off.
  const double spin_moment = 4 * 0.28 * deceleration / 0.2;
  const double rolling_moment = 0.06 * 180.0 * kGravity * 0.2;
  const double expected = 2.0 * (180.0 * deceleration * 0.38 + spin_moment - rolling_moment) / 1.5;
  EXPECT_NEAR(difference, expected, 0.04 * expected);  // the body still pitches a little
}

TEST(WheeledPlatform, ClimbsUpToTheFrictionLimitAndNotBeyond) {
  // All wheels drive: traction is mu times all load, so tan(slope) < mu can be climbed.
  for (const double tangent : {0.68, 0.78}) {
    Rig rig(make_slope_world(std::atan(tangent)), rover_params());
    rig.command(2.0, 2.0);
    const double start = rig.body().X_WB.p.x();
    rig.run(6.0);
    const double moved = rig.body().X_WB.p.x() - start;
    if (tangent < 0.75) {
      EXPECT_GT(moved, 1.0) << tangent;
    } else {
      EXPECT_LT(moved, 0.0) << tangent;
    }
  }
}

TEST(WheeledPlatform, WideTurnFollowsTheSmallSlipTrack) {
  // yaw rate = R (w_r - w_l) / (B (1 + (c_y / c_x)(L / B)^2)), vehicles/parts/README.md.
  WorldModel world = make_flat_world();
  const double stiffness_ratio = world.soil.cornering_stiffness_per_rad / world.soil.slip_stiffness;
  const double track = 1.0 * (1.0 + stiffness_ratio * (1.5 / 1.0) * (1.5 / 1.0));
  EXPECT_NEAR(track, 2.5, 1e-12);
  Rig rig(std::move(world), rover_params());
  rig.command(4.98, 5.02);
  rig.run(6.0);
  const double expected = 0.2 * 0.04 / track;
  // Slip angles of 0.2 degrees: the tyre's curve is straight to 3 %.
  EXPECT_NEAR(rig.yaw_rate_radps(), expected, 0.03 * expected);
  EXPECT_LT(rig.yaw_rate_radps(), 0.5 * 0.2 * 0.04 / 1.0);  // far below the kinematic rate
}

TEST(WheeledPlatform, TightTurnsFollowTheEffectiveTrack) {
  // Full sliding, friction the same in all directions: no net moment means that each tyre slides
  // along its lever, R w = yaw rate (b + a^2 / b) with half track b and half wheel base a.
  const double track = calc_effective_track_m(1.0, 1.5);
  EXPECT_NEAR(track, 2.0 * (0.5 + 0.75 * 0.75 / 0.5), 1e-12);
  {
    Rig rig(make_flat_world(), rover_params());
    rig.command(-4.0, 4.0);
    rig.run(4.0);
    const double expected = 0.2 * 8.0 / track;
    // The tyre's curve has reached the limit to 1e-4; the wheels' speed controllers to 1e-3.
    EXPECT_NEAR(rig.yaw_rate_radps(), expected, 0.01 * expected);
    EXPECT_NEAR(rig.body().X_WB.p.head<2>().norm(), 0.0, 0.01);  // on the spot
  }
  for (const double radius : {1.25, 3.0, 10.0}) {
    Rig rig(make_flat_world(), rover_params());
    const double v = 1.2, w = v / radius;
    rig.command((v - 0.5 * w * track) / 0.2, (v + 0.5 * w * track) / 0.2);
    rig.run(4.0);
    EXPECT_NEAR(rig.yaw_rate_radps(), w, 0.08 * w) << radius;
  }
}

TEST(WheeledPlatform, NeverExceedsTheFrictionEllipse) {
  Rig rig(make_slope_world(0.2), rover_params());
  double largest = 0.0;
  for (int i = 0; i < 8000; ++i) {
    const double t = i * 1e-3;
    rig.command(12.0 * std::sin(3.0 * t), 12.0 * std::cos(5.0 * t));
    rig.step();
    for (const WheelOutput& out : rig.platform.outputs()) {
      if (out.load_N > 0.0) {
        largest = std::max(largest, std::hypot(out.force_x_N, out.force_y_N) / out.load_N);
      }
    }
  }
  EXPECT_LE(largest, 0.75 * (1.0 + 1e-12));
  EXPECT_GT(largest, 0.7);
}

TEST(WheeledPlatform, ClimbsAStepOfAMesh) {
  WorldModel world = make_flat_world();
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{2, -5, 0.06f}, {12, -5, 0.06f}, {12, 5, 0.06f},
                    {2, 5, 0.06f},  {2, -5, -0.1f},  {2, 5, -0.1f}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}, {4, 0, 3}, {4, 3, 5}};
  MeshInstance step;
  step.name = "step";
  step.mesh = mesh;
  step.surface = SurfaceClass::kTerrain;
  world.meshes.push_back(step);
  Rig rig(std::move(world), rover_params());
  rig.command(3.0, 3.0);
  double fastest_rise = 0.0;
  for (int i = 0; i < 9000; ++i) {
    rig.step();
    fastest_rise = std::max(fastest_rise, rig.body().v_WB_W.z());
  }
  EXPECT_GT(rig.body().X_WB.p.x(), 3.5);
  EXPECT_NEAR(rig.body().X_WB.p.z(), 0.38 + 0.06, 1e-3);
  EXPECT_LT(fastest_rise, 1.0);  // lifted, not thrown
  EXPECT_NEAR(rig.body().X_WB.p.y(), 0.0, 0.01);
}

TEST(WheeledPlatform, ErrorShrinksWithTheStep) {
  // A start, a turn and a stop; the end position against a step 16 times finer than the default.
  // Without brakes: a brake opens at the end of a step, which is no smooth function of its length.
  const auto end = [](std::int64_t step_ns) {
    WheeledPlatformParams params = rover_params();
    for (WheelParams& wheel : params.wheels) wheel.motor.brake_torque_Nm = 0.0;
    Rig rig(make_flat_world(), params, 0.0, 0.0, 0.0, step_ns);
    rig.command(4.0, 4.0);
    rig.run(1.0);
    rig.command(3.0, 6.0);
    rig.run(1.0);
    return rig.body().X_WB.p;
  };
  const Eigen::Vector3d fine = end(62'500);
  const double e2 = (end(2'000'000) - fine).norm(), e1 = (end(1'000'000) - fine).norm(),
               e05 = (end(500'000) - fine).norm();
  EXPECT_LT(e1, 5e-3);
  // First order: halving the step halves the error (to within the next order's share).
  EXPECT_NEAR(e2 / e1, 2.0, 0.5);
  EXPECT_NEAR(e1 / e05, 2.0, 0.5);
}

TEST(WheeledPlatform, EnergyIsTheMotorsElectricPower) {
  const WheeledPlatformParams params = rover_params();
  Rig rig(make_flat_world(), params);
  rig.command(5.0, 5.0);
  rig.run(3.0);
  const double before = rig.platform.state().battery.energy_used_J;
  rig.run(2.0);
  const double power = 0.5 * (rig.platform.state().battery.energy_used_J - before);
  // Steady driving on the level: rolling resistance torque c N R per wheel at 5 rad/s, through the
  // efficiency, with copper loss and electronics.
  const double torque = 0.06 * 180.0 * kGravity / 4 * 0.2;
  const MotorParams& motor = params.wheels[0].motor;
  const double expected =
      4 * (torque * 5.0 / motor.efficiency + motor.loss_W_per_Nm2 * torque * torque) +
      params.battery.electronics_W;
  EXPECT_NEAR(power, expected, 0.01 * expected);
}

TEST(WheeledPlatform, AnEmptyBatteryStopsTheMotorsAndClosesTheBrakes) {
  WheeledPlatformParams params = rover_params();
  params.battery.initial_charge = 3e-4;  // 1080 J
  Rig rig(make_flat_world(), params);
  rig.command(5.0, 5.0);
  while (rig.platform.state().battery.charge > 0.0) rig.step();
  const double v_mps = rig.body().v_WB_W.x(), start_m = rig.body().X_WB.p.x();
  EXPECT_NEAR(v_mps, 1.0, 0.05);
  double farthest_m = 0.0;  // then the tyres spring back
  for (int i = 0; i < 5000; ++i) {
    rig.step();
    farthest_m = std::max(farthest_m, rig.body().X_WB.p.x() - start_m);
  }
  // The brakes' 150 Nm a wheel exceed the 66 Nm that the ground gives, so it slides to a stop: by
  // v^2 / 2 mu g, and up to the relaxation length more, over which the tyres' force builds up.
  const Soil& soil = rig.world_model.soil;
  const double v2_2g_m = v_mps * v_mps / (2.0 * kGravity);
  EXPECT_GT(farthest_m, v2_2g_m / soil.peak_friction);
  EXPECT_LT(farthest_m, v2_2g_m / soil.sliding_friction + 0.12);
  EXPECT_NEAR(rig.body().v_WB_W.norm(), 0.0, 1e-6);
  for (const WheelState& wheel : rig.platform.state().wheels) EXPECT_EQ(wheel.spin_radps, 0.0);
  // It has drawn what was in it, but for the step in which it ran out: 1 ms at less than 2 kW.
  EXPECT_NEAR(rig.platform.state().battery.energy_used_J, 3e-4 * 1000.0 * 3600.0, 2.0);
  EXPECT_EQ(rig.platform.state().battery.power_W, 0.0);
}

TEST(WheeledPlatform, WithoutBrakesAnEmptyBatteryLetsItRoll) {
  WheeledPlatformParams params = rover_params();
  for (WheelParams& wheel : params.wheels) wheel.motor.brake_torque_Nm = 0.0;
  const auto roll = [](const WheeledPlatformParams& p, bool commanded) {
    Rig rig(make_flat_world(), p);
    rig.platform.set_forward_speed(1.0);
    if (commanded) rig.command(5.0, 5.0);
    rig.run(1.0);
    return rig.body().X_WB.p.x();
  };
  params.battery.initial_charge = 0.0;
  EXPECT_NEAR(roll(params, true), roll(free_wheeling_params(), false), 1e-9);
}

TEST(StaticLoads, BalanceForceAndMoment) {
  const std::vector<Eigen::Vector3d> hubs = {
      {0.3, 0.28, 0}, {0.3, -0.28, 0}, {-0.2, 0.29, 0}, {-0.2, -0.27, 0}};
  const std::vector<double> loads = calc_static_loads(hubs, 432.0);
  ASSERT_EQ(loads.size(), 4u);
  double sum = 0.0, mx = 0.0, my = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += loads[i];
    mx += loads[i] * hubs[i].y();
    my += loads[i] * hubs[i].x();
  }
  EXPECT_NEAR(sum, 432.0, 1e-9);
  EXPECT_NEAR(mx, 0.0, 1e-9);
  EXPECT_NEAR(my, 0.0, 1e-9);
  const std::vector<Eigen::Vector3d> ahead = {{0.3, 0.28, 0}, {0.3, -0.28, 0}, {0.1, 0.28, 0}};
  EXPECT_TRUE(calc_static_loads(ahead, 432.0).empty());
}

TEST(WheeledPlatformParams, RejectsBadMass) {
  WheeledPlatformParams params = rover_params();
  params.mass_kg = -3.0;
  try {
    params.validate();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "rover: mass_kg = -3 kg, must be > 0 kg");
  }
}

}  // namespace
}  // namespace vinerow::vehicles::wheeled_platform_test
