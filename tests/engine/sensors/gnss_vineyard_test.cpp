/// A satellite receiver in the parametric vineyard: between its rows and above them.

#include <gtest/gtest.h>

#include "engine/api/map.h"
#include "engine/physics/world_scene.h"
#include "tests/engine/sensors/gnss_bench.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::sensors::gnss_vineyard_test {
namespace {

using test::GnssBench;

struct Quality {
  double satellites = 0.0;
  double std_m = 0.0;
  int fixed = 0;
  int ticks = 0;
};

/// 40 s along an alley, at three times of day.
Quality drive(const WorldModel& world, const SceneQuery& scene, double height_m,
              double leaves_dB_per_m) {
  const auto& line = world.rows->alleys.at(world.rows->alleys.size() / 2).line_W;
  const Eigen::Vector3d direction = (line.back() - line.front()).normalized();
  Quality quality;
  for (const char* epoch : {"2024-06-15T02:00:00", "2024-06-15T10:00:00", "2024-06-15T18:00:00"}) {
    GnssBench bench(scene, GnssBench::parameters({{"epoch_utc", std::string(epoch)},
                                                  {"leaves_dB_per_m", leaves_dB_per_m}}));
    for (int i = 0; i < 200; ++i) {
      Eigen::Vector3d p_W = line.front() + (5.0 + 0.2 * i) * direction;
      p_W.z() = scene.ground_height_m(p_W.x(), p_W.y(), 1e4).value() + height_m;
      bench.place(p_W);
      const GnssFix& fix = bench.step();
      quality.satellites += fix.satellites / 600.0;
      quality.std_m += fix.std_m.norm() / 600.0;
      quality.fixed += fix.mode == GnssFix::Mode::kFixed;
      ++quality.ticks;
    }
  }
  return quality;
}

TEST(GnssVineyard, NearTheGroundBetweenRowsFixAndErrorAreWorse) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_length_m", 60.0);
  const auto world = test::make_world("vineyard", parameters);
  const physics::WorldScene scene(*world);
  const Quality above = drive(*world, scene, 3.5, 6.0);
  const Quality between = drive(*world, scene, 0.6, 6.0);
  const Quality wet = drive(*world, scene, 0.6, 12.0);
  EXPECT_EQ(above.fixed, above.ticks);
  EXPECT_LT(between.satellites, above.satellites - 1.5);
  EXPECT_GT(between.std_m, 1.3 * above.std_m);
  EXPECT_LT(wet.satellites, between.satellites - 0.5);
  EXPECT_LT(wet.fixed, wet.ticks);
  RecordProperty("above_std_m", std::to_string(above.std_m));
  RecordProperty("between_std_m", std::to_string(between.std_m));
  RecordProperty("wet_std_m", std::to_string(wet.std_m));
}

}  // namespace
}  // namespace vinerow::sensors::gnss_vineyard_test
