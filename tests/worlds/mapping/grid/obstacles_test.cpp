#include "worlds/parts/obstacles.h"
#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/core/whole_file.h"
#include "engine/math/angles.h"
#include "tests/support/paths.h"
#include "tests/worlds/mapping/grid_search.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::mapping::obstacles_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

ParameterSet block(const std::string& type = "vineyard") {
  ParameterSet parameters = test::world_parameters(type);
  if (type == "vineyard") {
    parameters.set("row_count", 3.0).set("row_length_m", 20.0).set("leaf_cards_per_m", 10.0);
  } else if (type == "surveyed") {
    parameters.set("survey_file", test::riseholme_file()).set("leaf_cards_per_m", 10.0);
  }
  return parameters;
}

struct Wanted {
  std::string name;
  std::vector<std::pair<std::string, double>> numbers;
  std::vector<double> size_m = {0.6, 0.4, 0.5};
  bool mapped = false;
};

ParameterSet with_obstacles(ParameterSet parameters, const std::vector<Wanted>& wanted) {
  std::vector<ParameterSet> list;
  for (const Wanted& one : wanted) {
    ParameterSet obstacle = parameters.make_group("obstacles");
    obstacle.set("name", one.name).set("size_m", one.size_m).set("mapped", one.mapped);
    for (const auto& [key, value] : one.numbers) obstacle.set(key, value);
    list.push_back(obstacle);
  }
  parameters.set("obstacles", list);
  return parameters;
}

const MeshInstance* find(const WorldModel& world, const std::string& name) {
  for (const MeshInstance& instance : world.meshes) {
    if (instance.name == name) return &instance;
  }
  return nullptr;
}

TEST(Obstacles, StandInTheAlleyOnTheGroundInEveryWorldWithRows) {
  for (const char* type : {"vineyard", "orchard", "surveyed"}) {
    SCOPED_TRACE(type);
    const auto world = test::make_world(
        type, with_obstacles(block(type),
                             {{"box", {{"alley", 1}, {"distance_m", 7}, {"lateral_m", 0.3}}}}));
    const MeshInstance* box = find(*world, "obstacle/box");
    const MeshInstance* crate = find(*world, "crate/box");
    ASSERT_TRUE(box && crate);
    EXPECT_EQ(box->surface, SurfaceClass::kObstacle);
    EXPECT_TRUE(box->collides && !box->visible && crate->visible && !crate->collides);
    const auto& line = world->rows->alleys[1].line_W;
    const Vector2d a = line[0].head<2>(), along = (line[1].head<2>() - a).normalized();
    const Vector2d expected = a + 7.0 * along + 0.3 * Vector2d(-along.y(), along.x());
    EXPECT_LT((box->X_WM.p.head<2>() - expected).norm(), 1e-9);
    EXPECT_NEAR(box->X_WM.p.z(), world->terrain->height_m(expected.x(), expected.y()), 0.02);
    // Its length lies along the alley, and it stands on the slope.
    const Vector3d x_axis = box->X_WM.q * Vector3d::UnitX(), up = box->X_WM.q * Vector3d::UnitZ();
    EXPECT_GT(x_axis.head<2>().normalized().dot(along), 1.0 - 1e-9);
    EXPECT_GT(up.dot(world->terrain->normal_W(expected.x(), expected.y())), 0.999);
    // No corner of the foot hangs over the ground; the top is 0.5 m above it.
    double top_m = 0.0;
    for (const auto& v : box->mesh->vertices) {
      const Vector3d p = box->X_WM * v.cast<double>();
      const double above_m = p.z() - world->terrain->height_m(p.x(), p.y());
      if (v.z() < 0.1f) {
        EXPECT_LT(above_m, 0.0);
      } else {
        top_m = std::max(top_m, above_m);
      }
    }
    EXPECT_NEAR(top_m, 0.5, 0.1);
    // What is drawn does not stand out of what collides.
    const Eigen::AlignedBox3d hull = box->mesh->bounds(), drawn = crate->mesh->bounds();
    EXPECT_TRUE(hull.contains(drawn));
    EXPECT_LT((hull.sizes() - drawn.sizes()).norm(), 1e-6);
  }
}

TEST(Obstacles, StandAtAPointWithTheirOwnHeading) {
  const auto world = test::make_world(
      "orchard",
      with_obstacles(block("orchard"), {{"rock", {{"x_m", 15}, {"y_m", 20}, {"yaw_deg", 90}}}}));
  const MeshInstance* box = find(*world, "obstacle/rock");
  ASSERT_TRUE(box);
  EXPECT_LT((box->X_WM.p - Vector3d(15, 20, 0)).norm(), 1e-9);
  EXPECT_LT((box->X_WM.q * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-9);
}

/// A post 1.8 m high with an arm to one side, standing on z = 0.
std::filesystem::path write_figure(const char* height = "1.8") {
  const auto folder = std::filesystem::path(VINEROW_BINARY_DIR) / "test_output";
  std::filesystem::create_directories(folder);
  const auto file = folder / "figure.obj";
  write_whole_file(
      file, std::string("v -0.2 -0.1 0\nv 0.2 -0.1 0\nv 0.2 0.1 0\nv -0.2 0.1 0\nv 0 0 ") + height +
                "\nv 0.6 0 1.2\n"
                "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 1 4 3 2\nf 5 2 6\n");
  return file;
}

TEST(Obstacles, MeshesStandUprightInABoxOfTheirSize) {
  ParameterSet parameters = block("vineyard");
  ParameterSet figure = parameters.make_group("obstacles");
  figure.set("name", std::string("picker")).set("alley", std::int64_t{1});
  figure.set("distance_m", 7.0).set("yaw_deg", 90.0).set("file", write_figure().string());
  figure.set("label", std::string("person"));
  parameters.set("obstacles", std::vector<ParameterSet>{figure});
  const auto world = test::make_world("vineyard", parameters);
  const MeshInstance* box = find(*world, "obstacle/picker");
  const MeshInstance* drawn = find(*world, "object/picker");
  ASSERT_TRUE(box && drawn);
  EXPECT_EQ(find(*world, "crate/picker"), nullptr);
  EXPECT_TRUE(box->collides && !box->visible && drawn->visible && !drawn->collides);
  EXPECT_EQ(drawn->label, Label::kPerson);
  EXPECT_LT((drawn->X_WM.q * Vector3d::UnitZ() - Vector3d::UnitZ()).norm(), 1e-12);
  const Vector3d& foot = drawn->X_WM.p;
  EXPECT_NEAR(foot.z(), world->terrain->height_m(foot.x(), foot.y()), 1e-9);
  // Its x axis is across the alley.
  const auto& line = world->rows->alleys[1].line_W;
  const Vector2d along = (line[1].head<2>() - line[0].head<2>()).normalized();
  EXPECT_NEAR((drawn->X_WM.q * Vector3d::UnitX()).head<2>().dot(along), 0.0, 1e-9);
  // All of it is inside the box, which has its size above the ground.
  Eigen::AlignedBox3d inside;
  for (const auto& v : drawn->mesh->vertices) {
    inside.extend(box->X_WM.inverse() * (drawn->X_WM * v.cast<double>()));
  }
  const Eigen::AlignedBox3d hull = box->mesh->bounds();
  EXPECT_LT((hull.max() - Vector3d(0.4, 0.1, 1.8)).norm(), 1e-6);
  EXPECT_LT((inside.max() - hull.max()).norm(), 1e-6);
  EXPECT_LT((inside.min().head<2>() - hull.min().head<2>()).norm(), 1e-6);
  for (const auto& v : box->mesh->vertices) {
    if (v.z() > 0.1f) continue;
    const Vector3d p = box->X_WM * v.cast<double>();
    EXPECT_LT(p.z(), world->terrain->height_m(p.x(), p.y()));
  }
}

TEST(Obstacles, AMeshHasItsOwnSize) {
  ParameterSet parameters = block("vineyard");
  ParameterSet figure = parameters.make_group("obstacles");
  figure.set("name", std::string("picker")).set("alley", std::int64_t{0});
  figure.set("file", write_figure().string()).set("size_m", std::vector<double>{1, 1, 1});
  parameters.set("obstacles", std::vector<ParameterSet>{figure});
  EXPECT_EQ(test::config_error_of([&] { test::make_world("vineyard", parameters); }),
            "obstacles: 'picker' has both size_m and file: a mesh has its own size");
}

TEST(Obstacles, AMeshHigherThanABuildingIsDoubted) {
  ParameterSet parameters = block("vineyard");
  ParameterSet figure = parameters.make_group("obstacles");
  const std::string file = write_figure("1800").string();
  figure.set("alley", std::int64_t{0}).set("file", file);
  parameters.set("obstacles", std::vector<ParameterSet>{figure});
  EXPECT_EQ(test::make_world("vineyard", parameters)->notes,
            std::vector<std::string>{file + " is read as 0.8 x 0.2 x 1800 m; if it is in "
                                            "millimetres, scale it by 0.001 before"});
}

TEST(Obstacles, AreOnTheMapOnlyIfMapped) {
  const Wanted unknown{"a", {{"alley", 0}, {"distance_m", 5}}, {0.6, 0.4, 0.5}, false};
  const Wanted known{"b", {{"alley", 0}, {"distance_m", 12}}, {0.6, 0.4, 0.5}, true};
  const auto world = test::make_world("vineyard", with_obstacles(block(), {unknown, known}));
  const OccupancyGrid& grid = world->rows->occupancy;
  EXPECT_FALSE(test::occupied_at(grid, find(*world, "obstacle/a")->X_WM.p.head<2>()));
  EXPECT_TRUE(test::occupied_at(grid, find(*world, "obstacle/b")->X_WM.p.head<2>()));
}

TEST(Obstacles, WrongOnesAreNamed) {
  const auto error = [](const std::vector<Wanted>& wanted) {
    return test::config_error_of(
        [&] { test::make_world("vineyard", with_obstacles(block(), wanted)); });
  };
  EXPECT_EQ(error({{"box", {{"alley", 2}}}}),
            "obstacles: 'box' is in alley 2, the world has 2 alleys (0 to 1)");
  EXPECT_EQ(error({{"", {}}}),
            "obstacles: '0' has no position, must be given x_m and y_m, or alley and distance_m");
  EXPECT_EQ(error({{"box", {{"alley", 1}, {"x_m", 3}}}}),
            "obstacles: 'box' has both x_m, y_m and alley, must be given x_m and y_m, or alley and "
            "distance_m");
  EXPECT_EQ(error({{"box", {{"x_m", 3}}}}), "obstacles: 'box' has x_m without y_m");
  EXPECT_EQ(error({{"box", {{"alley", 0}}}, {"box", {{"alley", 1}}}}),
            "obstacles: 'box' is in the list twice");
  EXPECT_EQ(error({{"box", {{"x_m", 900}, {"y_m", 3}}}}),
            "obstacles: 'box' is at (900.00, 3.00) m, outside the terrain");
  EXPECT_EQ(error({{"box", {{"alley", 0}}, {0.6, 0.4, -1.0}}}),
            "size_m[2] = -1 m, must be >= 0.02 m and <= 100 m");
  EXPECT_EQ(error({{"box", {{"alley", 0}}, {0.6, 0.4}}}), "size_m has 2 entries, must have 3");
  EXPECT_EQ(error({{"box", {{"alley", -1}}}}), "alley = -1, must be >= 0 and <= 10000");
}

}  // namespace
}  // namespace vinerow::mapping::obstacles_test
