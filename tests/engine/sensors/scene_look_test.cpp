/// Light of clear and cloudy days in the channels of cameras.

#include "engine/sensors/camera/scene_look.h"

#include <gtest/gtest.h>

#include "engine/api/world_model.h"

namespace vinerow::sensors::scene_look_test {
namespace {

WorldModel day(double cloud_cover) {
  WorldModel world;
  world.daylight.cloud_cover = cloud_cover;
  return world;
}

SeenSurface white_wall() {
  SeenSurface wall;
  wall.normal_W = Eigen::Vector3f(-1.0f, 0.0f, 0.0f);
  wall.albedo.setOnes();
  return wall;
}

TEST(SceneLook, CloudsSendAllBandsAlike) {
  // Air scatters less infrared than red; clouds scatter both.
  const auto sky = [](double cover, Channel channel) {
    const WorldModel world = day(cover);
    return SceneLook(world, channel).far_radiance(Eigen::Vector3d::UnitZ()).x();
  };
  EXPECT_NEAR(sky(0.0, Channel::kNir) / sky(0.0, Channel::kRed), 0.40, 1e-4);
  EXPECT_NEAR(sky(1.0, Channel::kNir) / sky(1.0, Channel::kRed), 1.0, 1e-4);
  const WorldModel overcast = day(1.0);
  EXPECT_NEAR(SceneLook(overcast, Channel::kNir).white().x() /
                  SceneLook(overcast, Channel::kRed).white().x(),
              1.0, 1e-4);
}

TEST(SceneLook, AnOvercastSkyCastsNoShadows) {
  const WorldModel overcast = day(1.0), clear = day(0.0);
  const auto lit_over_shaded = [](const WorldModel& world) {
    const SceneLook look(world, Channel::kMono);
    SeenSurface wall = white_wall();
    wall.normal_W = look.sun_direction_W().cast<float>();
    return look.radiance(wall, 1.0f).x() / look.radiance(wall, 0.0f).x();
  };
  EXPECT_EQ(lit_over_shaded(overcast), 1.0f);
  EXPECT_GT(lit_over_shaded(clear), 3.0f);
}

TEST(SceneLook, AnOvercastNoonHasAQuarterOfTheLight) {
  const WorldModel overcast = day(1.0), clear = day(0.0);
  EXPECT_NEAR(SceneLook(overcast, Channel::kMono).white().x() /
                  SceneLook(clear, Channel::kMono).white().x(),
              0.25, 1e-4);
}

}  // namespace
}  // namespace vinerow::sensors::scene_look_test
