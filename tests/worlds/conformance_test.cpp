/// Requirements for every registered world, built in or from a plugin.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/api/height_field.h"
#include "engine/api/map.h"
#include "engine/api/messages/grid.h"
#include "engine/api/world_model.h"
#include "tests/worlds/world_fixture.h"
#include "worlds/parts/mesh_store.h"

namespace vinerow::conformance_test {
namespace {

// Worlds with plants organ by organ, beside those of each type.
constexpr const char* kVines = "vineyard_with_vines";
constexpr const char* kTreeLeaves = "orchard_with_leaves";

std::string type_of(const std::string& world) {
  return world == kVines ? "vineyard" : world == kTreeLeaves ? "orchard" : world;
}

/// Parameters that make a small world of each kind.
ParameterSet small_parameters(const std::string& world) {
  const std::string type = type_of(world);
  ParameterSet parameters = test::world_parameters(type);
  if (world == kVines) {
    ParameterSet vines = parameters.make_group("vines");
    vines.set("bbch", 85.0).set("young_vine_share", 0.1);
    parameters.set("vines", std::vector<ParameterSet>{vines}).set("plant_variants", 2.0);
  } else if (world == kTreeLeaves) {
    ParameterSet leaves = parameters.make_group("leaves");
    leaves.set("leaf_area_per_m3", 1.0);
    parameters.set("leaves", std::vector<ParameterSet>{leaves});
  }
  if (type == "vineyard") {
    parameters.set("row_count", 4.0).set("row_length_m", 30.0).set("relief_m", 5.0);
    parameters.set("missing_vine_share", 0.05).set("clods_m", 0.01);
  } else if (type == "surveyed") {
    parameters.set("survey_file", test::riseholme_file());
  } else if (type == "mesh") {
    ParameterSet item = parameters.make_group("items");
    item.set("file", test::temporary_file("cube.obj", test::cube_obj()));
    parameters.set("items", std::vector<ParameterSet>{item});
  }
  return parameters;
}

/// Another run's world of the same parameters.
std::unique_ptr<WorldModel> make_with_seed(const std::string& world, std::uint64_t seed) {
  WorldContext context;
  context.part = "world";
  context.seed = seed;
  ParameterSet parameters = small_parameters(world);
  ParameterSet wind = parameters.make_group("wind");
  ParameterSet gusts = wind.make_group("random_gusts");
  gusts.set("interval_s", 5.0);
  wind.set("random_gusts", std::vector<ParameterSet>{gusts});
  parameters.set("wind", std::vector<ParameterSet>{wind});
  return test::world_registry().make_world(type_of(world), parameters, context);
}

std::string digest_of(const WorldModel& world) {
  Hasher hasher;
  hasher.add(world.name);
  hasher.add(world.origin.latitude_rad), hasher.add(world.origin.longitude_rad);
  if (world.terrain) {
    const auto& heights = world.terrain->heights_m;
    hasher.add_bytes(heights.data(), heights.size() * sizeof(float));
  }
  for (const MeshInstance& instance : world.meshes) {
    hasher.add(instance.name);
    hasher.add(worlds::mesh_digest(*instance.mesh));
    for (int k = 0; k < 3; ++k) hasher.add(instance.X_WM.p[k]);
    for (int k = 0; k < 4; ++k) hasher.add(instance.X_WM.q.coeffs()[k]);
  }
  for (const PlantRow& row : world.rows->rows) {
    for (const Eigen::Vector3d& p : row.line_W)
      hasher.add(p.x()), hasher.add(p.y()), hasher.add(p.z());
  }
  for (const Alley& alley : world.rows->alleys) {
    for (const Eigen::Vector3d& p : alley.line_W)
      hasher.add(p.x()), hasher.add(p.y()), hasher.add(p.z());
  }
  return hasher.hex();
}

class WorldConformance : public ::testing::TestWithParam<std::string> {
 protected:
  WorldConformance()
      : world_(test::make_world(type_of(GetParam()), small_parameters(GetParam()))) {}
  double ground_m(double x, double y) const {
    return world_->terrain ? world_->terrain->height_m(x, y) : 0.0;
  }
  std::unique_ptr<WorldModel> world_;
};

TEST_P(WorldConformance, SameParametersGiveTheSameBits) {
  const auto again = test::make_world(type_of(GetParam()), small_parameters(GetParam()));
  EXPECT_EQ(digest_of(*world_), digest_of(*again));
}

/// A session keeps such a world for another seed and sets the gusts' seed alone.
TEST_P(WorldConformance, AWorldThatSaysSoIsTheSameForEverySeed) {
  const auto first = make_with_seed(GetParam(), 1), second = make_with_seed(GetParam(), 2);
  ASSERT_FALSE(first->depends_on_seed) << "no built-in world does";
  EXPECT_EQ(digest_of(*first), digest_of(*second));
  EXPECT_EQ(first->rows->occupancy.cells, second->rows->occupancy.cells);
  EXPECT_EQ(first->notes, second->notes);
  EXPECT_EQ(first->soil.name, second->soil.name);
  EXPECT_EQ(first->spawn_points.size(), second->spawn_points.size());
  EXPECT_EQ(first->wind.random_gusts->seed, 1u);
  EXPECT_EQ(second->wind.random_gusts->seed, 2u);
}

TEST_P(WorldConformance, TerrainIsFiniteAndWholeWhereThereIsOne) {
  if (!world_->terrain) {
    const auto is_ground = [](const MeshInstance& m) {
      return m.surface == SurfaceClass::kTerrain;
    };
    EXPECT_TRUE(std::any_of(world_->meshes.begin(), world_->meshes.end(), is_ground));
    return;
  }
  const HeightField& field = *world_->terrain;
  EXPECT_GE(field.columns, 2);
  EXPECT_GE(field.rows, 2);
  ASSERT_EQ(field.heights_m.size(), static_cast<std::size_t>(field.columns) * field.rows);
  for (const float h : field.heights_m) ASSERT_TRUE(std::isfinite(h));
}

TEST_P(WorldConformance, MeshesAreWellFormed) {
  std::set<std::string> names;
  for (const MeshInstance& instance : world_->meshes) {
    SCOPED_TRACE(instance.name);
    EXPECT_FALSE(instance.name.empty());
    EXPECT_TRUE(names.insert(instance.name).second) << "name stands twice";
    ASSERT_TRUE(instance.mesh);
    const TriangleMesh& mesh = *instance.mesh;
    ASSERT_FALSE(mesh.triangles.empty());
    for (const Eigen::Vector3f& v : mesh.vertices) ASSERT_TRUE(v.allFinite());
    for (const Eigen::Vector3f& n : mesh.normals) ASSERT_NEAR(n.norm(), 1.0f, 1e-3f);
    for (const auto& t : mesh.triangles) {
      for (const std::uint32_t v : t) ASSERT_LT(v, mesh.vertices.size());
    }
    for (const auto* list : {&mesh.normals, &mesh.colours}) {
      ASSERT_TRUE(list->empty() || list->size() == mesh.vertices.size());
    }
    ASSERT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.vertices.size());
    EXPECT_NEAR(instance.X_WM.q.norm(), 1.0, 1e-12);
    EXPECT_TRUE(instance.collides || instance.visible) << "nobody meets nor sees it";
  }
}

TEST_P(WorldConformance, LevelsOfDetailStandInTheSamePlaceAndShrink) {
  for (const MeshInstance& near : world_->meshes) {
    const std::size_t at = near.name.find("#lod0");
    if (at == std::string::npos) continue;
    const std::string coarser = near.name.substr(0, at) + "#lod1";
    const auto far = std::find_if(world_->meshes.begin(), world_->meshes.end(),
                                  [&](const MeshInstance& m) { return m.name == coarser; });
    ASSERT_NE(far, world_->meshes.end()) << near.name;
    EXPECT_EQ(far->X_WM.p, near.X_WM.p);
    EXPECT_LT(far->mesh->triangles.size(), near.mesh->triangles.size() / 3);
    EXPECT_FALSE(far->collides);
  }
}

TEST_P(WorldConformance, RowsAndAlleysStandOnTheGroundInsideTheTerrain) {
  if (!world_->terrain) return;
  const auto check = [&](const std::vector<Eigen::Vector3d>& line) {
    ASSERT_GE(line.size(), 2u);
    for (const Eigen::Vector3d& p : line) {
      EXPECT_TRUE(world_->terrain->contains(p.x(), p.y()));
      EXPECT_NEAR(p.z(), ground_m(p.x(), p.y()), 1e-9);
    }
  };
  for (const PlantRow& row : world_->rows->rows) check(row.line_W);
  for (const Alley& alley : world_->rows->alleys) check(alley.line_W);
  for (const SpawnPoint& point : world_->spawn_points) {
    EXPECT_TRUE(world_->terrain->contains(point.p_W.x(), point.p_W.y())) << point.name;
  }
}

TEST_P(WorldConformance, AlleysRunTheSameWayInOrderAcrossTheBlock) {
  const auto& alleys = world_->rows->alleys;
  for (std::size_t i = 0; i + 1 < alleys.size(); ++i) {
    const auto chord = [](const Alley& a) {
      return Eigen::Vector2d((a.line_W.back() - a.line_W.front()).head<2>().normalized());
    };
    EXPECT_GT(chord(alleys[i]).dot(chord(alleys[i + 1])), 0.9);
    const double apart_m =
        (alleys[i + 1].line_W.front() - alleys[i].line_W.front()).head<2>().norm();
    EXPECT_LT(apart_m, 1.5 * std::max(alleys[i].width_m, alleys[i + 1].width_m));
    EXPECT_EQ(alleys[i].id, static_cast<int>(i));
  }
}

double distance_to_line_m(const Eigen::Vector3d& p, const std::vector<Eigen::Vector3d>& line) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d a = line[i].head<2>(), d = (line[i + 1] - line[i]).head<2>();
    const double s = std::clamp((p.head<2>() - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (p.head<2>() - a - s * d).norm());
  }
  return best;
}

TEST_P(WorldConformance, AlleysAreClearOfEverythingThatCollides) {
  // A rover of 1.2 m width with a hand's breadth to each side drives every alley.
  constexpr double kHalfWidth_m = 0.7;
  for (const Alley& alley : world_->rows->alleys) {
    for (const MeshInstance& instance : world_->meshes) {
      if (!instance.collides || instance.surface == SurfaceClass::kTerrain) continue;
      for (const Eigen::Vector3f& v : instance.mesh->vertices) {
        const Eigen::Vector3d p = instance.X_WM * v.cast<double>();
        if (p.z() < ground_m(p.x(), p.y()) || p.z() > ground_m(p.x(), p.y()) + 1.5) continue;
        ASSERT_GT(distance_to_line_m(p, alley.line_W), kHalfWidth_m)
            << instance.name << " reaches into alley " << alley.id;
      }
    }
  }
}

TEST_P(WorldConformance, AlleysAreFreeOnTheMap) {
  const OccupancyGrid& grid = world_->rows->occupancy;
  if (world_->rows->rows.empty()) return;
  ASSERT_FALSE(grid.empty());
  ASSERT_EQ(grid.cells.size(), static_cast<std::size_t>(grid.columns) * grid.rows);
  for (const Alley& alley : world_->rows->alleys) {
    for (const Eigen::Vector3d& p : alley.line_W) {
      const Eigen::Vector2d cell = (p.head<2>() - grid.corner_W) / grid.cell_m;
      const int i = static_cast<int>(std::floor(cell.x()));
      const int j = static_cast<int>(std::floor(cell.y()));
      ASSERT_TRUE(i >= 0 && j >= 0 && i < grid.columns && j < grid.rows);
      EXPECT_FALSE(grid.occupied(i, j)) << "alley " << alley.id;
    }
  }
}

TEST_P(WorldConformance, CanopyHullsAreClosedAndOutward) {
  for (const MeshInstance& instance : world_->meshes) {
    if (instance.surface != SurfaceClass::kCanopy || !instance.collides) continue;
    SCOPED_TRACE(instance.name);
    // Closed: each edge is walked once in each direction. Outward: positive volume.
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    double volume = 0.0;
    const TriangleMesh& mesh = *instance.mesh;
    const Eigen::Vector3d o = mesh.vertices[0].cast<double>();
    for (const auto& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(edges.insert({t[k], t[(k + 1) % 3]}).second);
      const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>() - o;
      const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>() - o;
      const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>() - o;
      volume += a.dot(b.cross(c)) / 6.0;
    }
    for (const auto& [a, b] : edges) ASSERT_TRUE(edges.count({b, a})) << "open edge";
    EXPECT_GT(volume, 0.1);
  }
}

std::vector<std::string> all_worlds() {
  std::vector<std::string> names = test::world_registry().names(PartKind::kWorld);
  names.insert(names.end(), {kVines, kTreeLeaves});
  return names;
}

/// What light meets of an object is one of its levels of detail, or what stands for all of them.
TEST_P(WorldConformance, LightMeetsNoObjectTwice) {
  for (const MeshInstance& instance : world_->meshes) {
    const bool is_coarse = instance.name.find("#lod") != std::string::npos &&
                           instance.name.find("#lod0") == std::string::npos;
    if (is_coarse || instance.material.leaf_cards) {
      EXPECT_EQ(instance.light, Light::kPasses) << instance.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllWorlds, WorldConformance, ::testing::ValuesIn(all_worlds()),
                         [](const auto& test_info) { return test_info.param; });

}  // namespace
}  // namespace vinerow::conformance_test
