/// Neighbouring fields: where they are laid, and that nothing but pictures knows of them.

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "worlds/parts/neighbours.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/physics/world_scene.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::worlds::neighbours_test {
namespace {

const std::vector<Eigen::Vector2d> kParcel{{-60, -20}, {60, -20}, {60, 20}, {-60, 20}};
const std::vector<Eigen::Vector2d> kBox{{-360, -320}, {360, -320}, {360, 320}, {-360, 320}};

bool is_inside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
  bool inside = false;  // even-odd rule, another way than the code's
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) {
      inside = !inside;
    }
  }
  return inside;
}

TEST(Neighbours, FieldsCoverTheGroundOnceAndLeaveTheParcelFree) {
  const Scenery scenery = lay_neighbours(kParcel, kBox, {.count = 20, .meadow_W = {}}, 1);
  EXPECT_EQ(scenery.fields.size(), 20u);
  EXPECT_GT(scenery.tracks.size(), 4u);
  int in_fields = 0, places = 0;
  for (double y = -318; y < 320; y += 7.0) {
    for (double x = -358; x < 360; x += 7.0) {
      int fields = 0;
      for (const SceneryField& field : scenery.fields) {
        if (!is_inside(field.corners_W, {x, y})) {
          EXPECT_FALSE(is_inside(field.planted_W, {x, y}));
          continue;
        }
        ++fields;
      }
      EXPECT_LE(fields, 1) << x << ", " << y;
      if (std::abs(x) < 66 && std::abs(y) < 26) {
        EXPECT_EQ(fields, 0) << x << ", " << y;
      }
      in_fields += fields;
      ++places;
    }
  }
  // What is left: the parcel (2 %), tracks and verges.
  EXPECT_GT(static_cast<double>(in_fields) / places, 0.8);
}

TEST(Neighbours, RowsRunInManyDirections) {
  const Scenery scenery = lay_neighbours(kParcel, kBox, {.count = 30, .meadow_W = {}}, 1);
  std::vector<double> bearings;
  for (const SceneryField& field : scenery.fields) {
    if (field.pitch_m <= 0.0) continue;
    EXPECT_NEAR(field.along_W.norm(), 1.0, 1e-12);
    bearings.push_back(std::fmod(std::atan2(field.along_W.y(), field.along_W.x()) + 7.0, 3.14159));
  }
  ASSERT_GT(bearings.size(), 10u);
  const auto [low, high] = std::minmax_element(bearings.begin(), bearings.end());
  EXPECT_GT(*high - *low, 0.5);
}

TEST(Neighbours, ThePlaceForLaunchesIsAMeadowWithoutTrees) {
  const Eigen::Vector2d place(-200, -150);
  const Scenery free = lay_neighbours(kParcel, kBox, {.count = 20, .meadow_W = {place}}, 1);
  for (const SceneryField& field : free.fields) {
    if (field.pitch_m <= 0.0) continue;
    for (int k = 0; k < 64; ++k) {
      const double angle = 2.0 * 3.14159265 * k / 64;
      EXPECT_FALSE(is_inside(field.corners_W,
                             place + 59.9 * Eigen::Vector2d(std::cos(angle), std::sin(angle))));
    }
  }
  for (const SceneryTree& tree : free.trees) EXPECT_GE((tree.p_W - place).norm(), 110.0);
}

TEST(Neighbours, TheSeedAloneDecides) {
  const auto lay = [](std::uint64_t seed) { return lay_neighbours(kParcel, kBox, {}, seed); };
  const Scenery one = lay(1), again = lay(1), other = lay(2);
  ASSERT_EQ(one.fields.size(), again.fields.size());
  for (std::size_t i = 0; i < one.fields.size(); ++i) {
    EXPECT_EQ(one.fields[i].corners_W, again.fields[i].corners_W);
    EXPECT_EQ(one.fields[i].pitch_m, again.fields[i].pitch_m);
  }
  EXPECT_NE(one.fields.back().corners_W, other.fields.back().corners_W);
}

ParameterSet small_vineyard(bool with_neighbours) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", std::int64_t{3}).set("row_length_m", 12.0);
  parameters.set("surroundings_m", 150.0).set("terrain_cell_m", 2.0);
  if (with_neighbours) {
    ParameterSet group = parameters.make_group("neighbours");
    parameters.set("neighbours", std::vector<ParameterSet>{group});
  }
  return parameters;
}

TEST(Neighbours, NoRayNoClearanceNoMeshNoMapKnowsThem) {
  const auto alone = test::make_world("vineyard", small_vineyard(false));
  const auto amid = test::make_world("vineyard", small_vineyard(true));
  EXPECT_TRUE(alone->scenery.empty());
  ASSERT_FALSE(amid->scenery.empty());
  ASSERT_EQ(amid->meshes.size(), alone->meshes.size());
  for (std::size_t i = 0; i < alone->meshes.size(); ++i) {
    EXPECT_EQ(amid->meshes[i].name, alone->meshes[i].name);
    EXPECT_EQ(amid->meshes[i].mesh->vertices, alone->meshes[i].mesh->vertices);
  }
  EXPECT_EQ(amid->terrain->heights_m, alone->terrain->heights_m);
  EXPECT_EQ(amid->rows->occupancy.cells, alone->rows->occupancy.cells);
  // At the top of a neighbour's row there is nothing but the ground below.
  const physics::WorldScene scene(*amid);
  int looked_at = 0;
  for (const SceneryField& field : amid->scenery.fields) {
    if (field.pitch_m <= 0.0 || field.planted_W.size() < 3) continue;
    const Eigen::Vector2d normal(-field.along_W.y(), field.along_W.x());
    const Eigen::Vector2d corner = field.corners_W.front();
    Eigen::Vector2d middle(0, 0);
    for (const Eigen::Vector2d& p : field.planted_W)
      middle += p / static_cast<double>(field.planted_W.size());
    const double row = std::round(normal.dot(middle - corner) / field.pitch_m) * field.pitch_m;
    const Eigen::Vector2d p = middle + (row - normal.dot(middle - corner)) * normal;
    const double ground_m = amid->terrain->height_m(p.x(), p.y());
    const auto hit = scene.cast_ray({p.x(), p.y(), ground_m + 10.0}, -Eigen::Vector3d::UnitZ(),
                                    20.0, kAllSurfaces);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance_m, 10.0, 1e-3);
    EXPECT_EQ(
        scene.distance_to_box_m({Eigen::Quaterniond::Identity(), {p.x(), p.y(), ground_m + 1}},
                                {0.5, 0.5, 0.5}, 3.0, kPlantMask),
        3.0);
    ++looked_at;
  }
  EXPECT_GT(looked_at, 3);
}

TEST(Neighbours, WithoutRoomForThemTheyAreRefused) {
  ParameterSet parameters = small_vineyard(true);
  parameters.set("surroundings_m", 6.0);
  EXPECT_EQ(test::config_error_of([&] { test::make_world("vineyard", parameters); }),
            "neighbours: surroundings_m = 6 m leaves no room for fields, needs 60 m");
  parameters = small_vineyard(true);
  ParameterSet group = parameters.make_group("neighbours");
  group.set("meadow_m", std::vector<double>{1.0, 2.0, 3.0});
  parameters.set("neighbours", std::vector<ParameterSet>{group});
  EXPECT_EQ(test::config_error_of([&] { test::make_world("vineyard", parameters); }),
            "neighbours: meadow_m has 3 numbers, needs 2: x and y");
}

}  // namespace
}  // namespace vinerow::worlds::neighbours_test
