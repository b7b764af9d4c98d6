/// Rovers in a gale: the force against closed forms, side drift by soil, and who does not feel it.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/vehicles/small_worlds.h"
#include "tests/vehicles/wind/wind_rig.h"
#include "vehicles/diff_drive_rover/diff_drive_rover.h"

namespace vinerow::vehicles::windblown_rover_test {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kGravity = 9.80665;
constexpr Duration kStep{1'000'000};

/// Paper B's rover with its drag areas (assets/vehicles/rover_paper_b.yaml).
DiffDriveRoverParams windy_rover(const char* name = "rover") {
  DiffDriveRoverParams params;
  params.name = name;
  params.air = {0.73, 1.2, 0.52};
  return params;
}

struct Rig {
  Rig(const Wind& wind, const DiffDriveRoverParams& params, const Soil& soil = {})
      : model(make_flat_world()), params_(params) {
    model.wind = wind;
    model.soil = soil;
    world = std::make_unique<physics::PhysicsWorld>(settings_with_step(kStep.ns), model);
    add(params, 0.0);
  }
  void add(const DiffDriveRoverParams& params, double y) {
    rovers.push_back(std::make_unique<DiffDriveRover>(params));
    rovers.back()->feel_wind(RandomStream(1, params.name, "wind"));
    rovers.back()->spawn(*world, pose_on_ground(model, 0, y, 0, params.com_height_m));
  }
  void run(double time_s) {
    for (auto steps = std::llround(time_s / kStep.s()); steps > 0; --steps) {
      for (auto& rover : rovers) rover->before_physics(now, kStep);
      world->step(kStep);
      now = now + kStep;
      for (auto& rover : rovers) rover->after_physics(now, kStep);
    }
  }
  /// Drives straight ahead.
  void drive(double v_mps) {
    const std::vector<double> spin(4, v_mps / params_.wheel_radius_m);
    for (auto& rover : rovers) rover->actuate(spin);
  }
  Odometry truth(std::size_t i = 0) const {
    Odometry odometry;
    rovers[i]->read_truth(odometry);
    return odometry;
  }

  WorldModel model;
  std::unique_ptr<physics::PhysicsWorld> world;
  std::vector<std::unique_ptr<DiffDriveRover>> rovers;
  Time now;

 private:
  DiffDriveRoverParams params_;
};

Wind south_wind(double speed_mps) {
  Wind wind = west_wind(speed_mps);
  wind.from_azimuth_rad = kPi;
  return wind;
}

TEST(AirDrag, IsTheSquareLawByAxes) {
  const AirDragParams air{0.73, 1.2, 0.52};
  // 3-4-5: 1/2 1.2 5 (0.73 3, 1.2 (-4)).
  EXPECT_NEAR((calc_air_drag_B(air, 1.2, {3, -4, 7}) - Vector3d(6.57, -14.4, 0)).norm(), 0.0,
              1e-12);
}

TEST(AirDrag, RefusesNegativeAreas) {
  DiffDriveRoverParams params = windy_rover();
  params.air.drag_area_m2 = -1.0;
  try {
    DiffDriveRover rover(params);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "rover: drag_area_m2 = -1 m2, must be >= 0 m2 and <= 1000 m2");
  }
}

TEST(WindblownRover, TellsItsVelocityThroughTheAir) {
  Rig rig(south_wind(20.0), windy_rover());
  rig.run(1.0);
  // It stands and looks east: the wind comes from its right.
  EXPECT_NEAR((rig.rovers[0]->air_velocity_B() - Vector3d(0, -20, 0)).norm(), 0.0, 0.4);
}

TEST(WindblownRover, StandsAgainstTheWindByItsTyres) {
  const double speed_mps = 20.0;
  Rig rig(south_wind(speed_mps), windy_rover());
  rig.run(3.0);
  // From the right: 1/2 rho A v^2 = 294 N, a sixth of the weight; the tyres hold it.
  const double force_N = 0.5 * 1.225 * 1.2 * speed_mps * speed_mps;
  double side_N = 0.0, left_N = 0.0, right_N = 0.0;
  const auto outputs = rig.rovers[0]->platform().outputs();
  for (std::size_t i = 0; i < 4; ++i) {
    side_N += outputs[i].force_W.y();
    (i % 2 == 0 ? left_N : right_N) += outputs[i].load_N;
  }
  // The hull rolls by half a degree, which takes 1e-4 of the force.
  EXPECT_NEAR(side_N, -force_N, 2e-4 * force_N);
  // About the ground: the wind at 0.52 m and the weight that the roll brings over (positive to the
  // right, so here negative) against the wheels' loads, half a track from the middle.
  const double roll_rad = rpy_from_quaternion(rig.truth().X_WB.q).roll_rad;
  EXPECT_LT(roll_rad, -0.005);
  const double moment_Nm = force_N * 0.52 - 180.0 * kGravity * 0.38 * roll_rad;
  EXPECT_NEAR((left_N - right_N) * 0.5, moment_Nm, 0.005 * moment_Nm);
  EXPECT_NEAR(rig.truth().v_WB_B.norm(), 0.0, 1e-6);
}

TEST(WindblownRover, DriftsAcrossWhileDrivingAndMoreOnWetSoil) {
  const Soil dry{"dry_grass", 0.75, 0.65, 15.0, 10.0, 0.06};
  const Soil wet{"wet_soil", 0.50, 0.40, 9.0, 6.0, 0.11};
  const double force_N = 0.5 * 1.225 * 1.2 * 400.0;
  const auto drift = [&](const Soil& soil) {
    Rig rig(south_wind(20.0), windy_rover(), soil);
    rig.drive(1.0);
    rig.run(10.0);
    const Eigen::Vector3d v_B = rig.truth().v_WB_B;
    // The drift angle at which the tyres give the force.
    const double share = force_N / (soil.peak_friction * 180.0 * kGravity);
    const double sigma =
        -soil.peak_friction / soil.cornering_stiffness_per_rad * std::log(1.0 - share);
    EXPECT_NEAR(v_B.y() / v_B.x(), sigma, 0.03 * sigma) << soil.name;
    return v_B.y();
  };
  EXPECT_GT(drift(wet), 1.7 * drift(dry));
}

TEST(WindblownRover, HeadWindCostsEnergy) {
  const auto energy_J = [](double from_deg) {
    Wind wind = west_wind(10.0);
    wind.from_azimuth_rad = rad_from_deg(from_deg);
    Rig rig(wind, windy_rover());
    rig.drive(1.0);
    rig.run(20.0);
    return rig.rovers[0]->platform().state().battery.energy_used_J;
  };
  // Against 11 m/s and with 9 m/s: 54 N and 36 N over about 20 m, at an efficiency of 0.85.
  const double difference_J = energy_J(90.0) - energy_J(270.0);
  EXPECT_NEAR(difference_J, (54.1 + 36.2) * 19.5 / 0.85, 0.1 * 2100.0);
}

TEST(WindblownRover, CalmAndSmallRoversFeelNothing) {
  Rig calm(Wind{}, windy_rover());
  EXPECT_EQ(calm.rovers[0]->platform().wind(), nullptr);
  Rig thin(south_wind(20.0), DiffDriveRoverParams{});  // no drag area
  EXPECT_EQ(thin.rovers[0]->platform().wind(), nullptr);
}

TEST(WindblownRover, KinematicRoverFeelsNothing) {
  const auto drive = [](const Wind& wind) {
    WorldModel model = make_flat_world();
    model.wind = wind;
    physics::PhysicsWorld world(settings_with_step(kStep.ns), model);
    ParameterSet parameters(diff_drive_rover_spec().parameters, "diff_drive_rover");
    parameters.set("fidelity", "kinematic");
    parameters.set("drag_area_m2", 0.73);
    parameters.set("side_drag_area_m2", 1.2);
    const auto rover = make_diff_drive_rover(parameters, {});
    rover->spawn(world, pose_on_ground(model, 0, 0, 0, 0.38));
    rover->actuate(std::vector<double>(4, 5.0));
    for (int i = 0; i < 2000; ++i) {
      rover->before_physics({}, kStep);
      world.step(kStep);
      rover->after_physics({}, kStep);
    }
    Odometry truth;
    rover->read_truth(truth);
    return truth;
  };
  const Odometry gale = drive(south_wind(20.0));
  EXPECT_EQ(gale.X_WB.p, drive(Wind{}).X_WB.p);
  EXPECT_NEAR(gale.X_WB.p.x(), 2.0, 1e-9);  // 2 s at 5 rad/s of wheels of 0.2 m
}

TEST(WindblownRover, CalmWorldKeepsEveryBit) {
  Rig with(Wind{}, windy_rover()), without(Wind{}, DiffDriveRoverParams{});
  for (Rig* rig : {&with, &without}) {
    rig->drive(1.5);
    rig->run(2.0);
  }
  EXPECT_EQ(with.truth().X_WB.p, without.truth().X_WB.p);
  EXPECT_EQ(with.truth().v_WB_B, without.truth().v_WB_B);
}

TEST(WindblownRover, AnotherRoverChangesNoGustOfTheFirst) {
  Wind wind = south_wind(8.0);
  wind.turbulence = 1.0;
  wind.random_gusts = GustStatistics{.interval_s = 3.0};
  Rig alone(wind, windy_rover("first")), two(wind, windy_rover("first"));
  two.add(windy_rover("second"), 20.0);
  for (int i = 0; i < 40; ++i) {
    alone.run(0.1);
    two.run(0.1);
    ASSERT_EQ(alone.rovers[0]->platform().wind()->turbulence_W(),
              two.rovers[0]->platform().wind()->turbulence_W());
    ASSERT_EQ(alone.truth(0).X_WB.p, two.truth(0).X_WB.p);
    ASSERT_NE(two.rovers[0]->platform().wind()->turbulence_W(),
              two.rovers[1]->platform().wind()->turbulence_W());
    ASSERT_EQ(two.rovers[0]->platform().wind()->gust_W(),
              two.rovers[1]->platform().wind()->gust_W());
  }
}

}  // namespace
}  // namespace vinerow::vehicles::windblown_rover_test
