/// Worlds with vines that grow organ by organ: what light meets, the hull, bad input.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/api/foliage.h"
#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/math/polyline.h"
#include "engine/physics/static_scene.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::worlds::vine_world_test {
namespace {

ParameterSet parameters_at(double bbch) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", 3.0).set("row_length_m", 22.0).set("relief_m", 0.0);
  parameters.set("waves_m", 0.0).set("missing_vine_share", 0.0).set("plant_variants", 2.0);
  ParameterSet vines = parameters.make_group("vines");
  vines.set("bbch", bbch);
  parameters.set("vines", std::vector<ParameterSet>{vines});
  return parameters;
}

std::shared_ptr<const WorldModel> world_at(double bbch) {
  return test::make_world("vineyard", parameters_at(bbch));
}

int count_named(const WorldModel& world, const std::string& begin) {
  return static_cast<int>(std::count_if(
      world.meshes.begin(), world.meshes.end(),
      [&](const MeshInstance& instance) { return instance.name.rfind(begin, 0) == 0; }));
}

/// Shares of horizontal rays across the middle row that meet nothing, on its hull and in its
/// leaves.
struct Gaps {
  double hull, light;
};
Gaps find_gaps(const std::shared_ptr<const WorldModel>& world) {
  const physics::StaticScene scene(world);
  const auto& line = world->rows->rows[1].line_W;
  const Eigen::Vector3d along = (line.back() - line.front()).normalized();
  const Eigen::Vector3d across(-along.y(), along.x(), 0.0);
  int rays = 0, hull = 0, light = 0;
  for (double s_m = 3.0; s_m < 19.0; s_m += 0.053) {
    for (double z_m = 0.95; z_m < 1.85; z_m += 0.047) {
      Eigen::Vector3d p_W = line.front() + s_m * along - across;
      p_W.z() += z_m;
      ++rays;
      hull += scene.queries().cast_ray(p_W, across, 2.0, mask_of(SurfaceClass::kCanopy)) ? 0 : 1;
      light += scene.light().cast_ray(p_W, across, 2.0, mask_of(SurfaceClass::kCanopy)) ? 0 : 1;
    }
  }
  return {static_cast<double>(hull) / rays, static_cast<double>(light) / rays};
}

TEST(VineWorld, LightPassesBetweenLeavesWhereTheHullIsClosed) {
  const Gaps summer = find_gaps(world_at(75));
  EXPECT_EQ(summer.hull, 0.0);
  EXPECT_GT(summer.light, 0.15);
  EXPECT_LT(summer.light, 0.45);
  std::printf("BBCH 75: %.0f %% of rays pass\n", 100 * summer.light);
  const Gaps spring = find_gaps(world_at(57));
  EXPECT_GT(spring.light, summer.light);
  const Gaps winter = find_gaps(world_at(0));
  EXPECT_EQ(winter.hull, 1.0);
  EXPECT_EQ(winter.light, 1.0);
}

TEST(VineWorld, GapsFollowFromTheHullsLeafArea) {
  // Beer's law with the density that sprays and satellite signals use: exp(-k l) along a chord l,
  // k half the density. Shoots and the rows of leaves along them make the difference.
  for (const double bbch : {57.0, 75.0, 81.0}) {
    const auto world = world_at(bbch);
    const physics::StaticScene scene(world);
    const LeafAreaDensity leaves(*world);
    const auto& line = world->rows->rows[1].line_W;
    const Eigen::Vector3d along = (line.back() - line.front()).normalized();
    const Eigen::Vector3d across(-along.y(), along.x(), 0.0);
    const SurfaceMask canopy = mask_of(SurfaceClass::kCanopy);
    double expected = 0.0, rays = 0.0, passed = 0.0, density = 0.0;
    for (double s_m = 3.0; s_m < 19.0; s_m += 0.053) {
      for (double z_m = 0.95; z_m < 1.85; z_m += 0.047) {
        Eigen::Vector3d p_W = line.front() + s_m * along - across;
        p_W.z() += z_m;
        const auto entry = scene.queries().cast_ray(p_W, across, 2.0, canopy);
        if (!entry) continue;
        const Eigen::Vector3d inside_W = p_W + (entry->distance_m + 1e-4) * across;
        const auto exit = scene.queries().cast_ray(inside_W, across, 2.0, canopy);
        ASSERT_TRUE(exit);
        expected += std::exp(-0.5 * leaves.of(entry->mesh) * exit->distance_m);
        passed += scene.light().cast_ray(p_W, across, 2.0, canopy) ? 0.0 : 1.0;
        density = leaves.of(entry->mesh);
        rays += 1.0;
      }
    }
    std::printf("BBCH %.0f: %.1f m2/m3, %.0f %% of rays pass, %.0f %% by Beer's law\n", bbch,
                density, 100 * passed / rays, 100 * expected / rays);
    EXPECT_NEAR(passed / rays, expected / rays, 0.06) << bbch;
  }
}

TEST(VineWorld, APergolaHasARoof) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", 2.0).set("row_length_m", 22.0).set("relief_m", 0.0);
  parameters.set("waves_m", 0.0).set("canopy_width_m", 2.4).set("arm_height_m", 1.6);
  ParameterSet vines = parameters.make_group("vines");
  vines.set("bbch", 0.0).set("pruning", std::string("pergola"));
  parameters.set("vines", std::vector<ParameterSet>{vines});
  const auto world = test::make_world("vineyard", parameters);
  EXPECT_EQ(count_named(*world, "roof_wire/"), 2);
  EXPECT_EQ(count_named(*world, "roof_beam/"), 2);
  for (const MeshInstance& instance : world->meshes) {
    if (!instance.name.starts_with("roof_")) continue;
    const bool is_wire = instance.surface == SurfaceClass::kWire;
    EXPECT_EQ(is_wire, instance.name.starts_with("roof_wire/"));
    const bool is_first = instance.name.ends_with("row_00");
    const auto& line = world->rows->rows[is_first ? 0 : 1].line_W;
    const Eigen::Vector3d along = (line.back() - line.front()).normalized();
    double left_m = 0.0, right_m = 0.0, top_m = 0.0;
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      const Eigen::Vector3d p = v.cast<double>() - line.front();
      const double to_left_m = along.x() * p.y() - along.y() * p.x();
      left_m = std::max(left_m, to_left_m);
      right_m = std::min(right_m, to_left_m);
      top_m = std::max(top_m, p.z());
    }
    // 0.25 m below the canopy's top at 2 m, beams below the wires; half of the width to each side.
    EXPECT_NEAR(top_m, is_wire ? 1.7525 : 1.7475, 5e-3);
    EXPECT_NEAR(left_m, 1.2, 0.01);
    EXPECT_NEAR(right_m, -1.2, 0.01);
  }
  EXPECT_EQ(count_named(*world_at(0), "roof_"), 0);
}

/// Distance to the nearest triangle that light meets, each tested alone (Moeller and Trumbore
/// 1997).
double nearest_m(const WorldModel& world, const Eigen::Vector3d& p_W,
                 const Eigen::Vector3d& dir_W) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const MeshInstance& instance : world.meshes) {
    const bool is_met =
        instance.light == Light::kMeets || (instance.light == Light::kAsDrawn && instance.visible);
    if (!is_met) continue;
    const Eigen::Vector3d p = instance.X_WM.q.conjugate() * (p_W - instance.X_WM.p);
    const Eigen::Vector3d dir = instance.X_WM.q.conjugate() * dir_W;
    for (const auto& t : instance.mesh->triangles) {
      const auto corner = [&](int k) {
        return Eigen::Vector3d(instance.mesh->vertices[t[k]].cast<double>());
      };
      const Eigen::Vector3d a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
      const Eigen::Vector3d h = dir.cross(ac), s = p - a, q = s.cross(ab);
      const double det = ab.dot(h);
      if (det == 0.0) continue;
      const double u = s.dot(h) / det, v = dir.dot(q) / det, distance = ac.dot(q) / det;
      if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= 0.0) {
        nearest = std::min(nearest, distance);
      }
    }
  }
  return nearest;
}

TEST(VineWorld, RaysAgreeWithACastOfTheirOwn) {
  const auto world = world_at(18);
  const physics::StaticScene scene(world);
  const auto& line = world->rows->rows[1].line_W;
  RandomStream random(1, "", "rays");
  std::vector<SceneRay> rays;
  for (int i = 0; i < 200; ++i) {
    SceneRay ray;
    ray.p_W = line.front() + random.uniform() * (line.back() - line.front());
    ray.p_W += Eigen::Vector3d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.9);
    ray.dir_W =
        Eigen::Vector3d(random.normal(), random.normal(), 0.1 * random.normal()).normalized();
    ray.max_distance_m = 40.0;
    rays.push_back(ray);
  }
  std::vector<std::optional<RayHit>> hits(rays.size());
  const SurfaceMask meshes = kAllSurfaces & ~mask_of(SurfaceClass::kTerrain);
  scene.light().cast_rays(rays, hits, meshes);
  int met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double expected_m = nearest_m(*world, rays[i].p_W, rays[i].dir_W);
    ASSERT_EQ(hits[i].has_value(), expected_m <= 40.0) << i;
    if (!hits[i]) continue;
    EXPECT_NEAR(hits[i]->distance_m, expected_m, 1e-6) << i;
    ++met;
  }
  EXPECT_GT(met, 80);
}

TEST(VineWorld, HullHasTheExtentOfTheLeaves) {
  double last_top_m = 0.0;
  for (const double bbch : {15.0, 57.0, 75.0}) {
    const auto world = world_at(bbch);
    const PlantRow& row = world->rows->rows[1];
    EXPECT_GT(row.canopy_top_m, last_top_m) << bbch;
    EXPECT_LT(row.canopy_top_m, 2.3);
    EXPECT_GT(row.canopy_base_m, 0.5);
    last_top_m = row.canopy_top_m;
    EXPECT_EQ(count_named(*world, "canopy_hull/"), 3);
    EXPECT_GT(count_named(*world, "shoots/"), 0);
  }
  const auto winter = world_at(0);
  EXPECT_EQ(count_named(*winter, "canopy"), 0);
  EXPECT_GT(count_named(*winter, "trunk/"), 0);
  EXPECT_NEAR(winter->rows->rows[1].canopy_width_m, 0.1, 1e-9);
}

TEST(VineWorld, AnOrganHasOneMeshForLight) {
  const auto world = world_at(85);
  for (const char* organ : {"canopy/", "shoots/", "bunches/"}) {
    int met = 0, levels = 0;
    for (const MeshInstance& instance : world->meshes) {
      if (instance.name.rfind(organ, 0) != 0) continue;
      EXPECT_FALSE(instance.collides) << "vehicles meet the hull";
      EXPECT_TRUE(instance.visible);
      met += instance.light == Light::kAsDrawn ? 1 : 0;
      ++levels;
    }
    EXPECT_EQ(levels, 3 * met) << organ;
    EXPECT_GT(met, 0) << organ;
  }
}

TEST(VineWorld, ArmsAboveTheTrimmingAreRefused) {
  ParameterSet parameters = parameters_at(75);
  parameters.set("arm_height_m", 2.5);
  EXPECT_EQ(test::config_error_of([&] { test::make_world("vineyard", parameters); }),
            "arm_height_m = 2.5 m, must be < canopy_top_m = 2 m for growing vines");
}

ParameterSet pergola_at(double bbch) {
  ParameterSet parameters = parameters_at(bbch);
  ParameterSet vines = parameters.make_group("vines");
  vines.set("bbch", bbch).set("pruning", std::string("pergola"));
  parameters.set("vines", std::vector<ParameterSet>{vines});
  return parameters;
}

/// A pergola without further values: shoots, leaves and bunches lie on the roof, 0.25 m below the
/// canopy's top at 2 m, on both sides; a vehicle drives below.
TEST(VineWorld, APergolaCarriesItsShootsOnTheRoof) {
  const auto world = test::make_world("vineyard", pergola_at(75));
  for (const std::string organ : {"shoots/row_01", "canopy/row_01", "bunches/row_01"}) {
    std::vector<double> heights;
    double left_m = 0.0, right_m = 0.0;
    const auto& line = world->rows->rows[1].line_W;
    const Eigen::Vector3d along = (line.back() - line.front()).normalized();
    for (const MeshInstance& instance : world->meshes) {
      if (!instance.name.starts_with(organ) || !instance.name.ends_with("#lod0")) continue;
      for (const Eigen::Vector3f& v : instance.mesh->vertices) {
        const Eigen::Vector3d p = instance.X_WM * v.cast<double>() - line.front();
        heights.push_back(p.z());
        left_m = std::max(left_m, along.x() * p.y() - along.y() * p.x());
        right_m = std::min(right_m, along.x() * p.y() - along.y() * p.x());
      }
    }
    ASSERT_FALSE(heights.empty()) << organ;
    std::sort(heights.begin(), heights.end());
    EXPECT_GT(heights[heights.size() / 50], 1.4) << organ;
    EXPECT_NEAR(heights[heights.size() / 2], 1.75, 0.2) << organ;
    if (organ.starts_with("bunches")) continue;  // on the third node
    EXPECT_GT(left_m, 0.8) << organ;
    EXPECT_LT(right_m, -0.8) << organ;
  }
}

/// Of 1e-9 m they have no area in 32-bit coordinates, and the world would refuse a mesh.
TEST(VineWorld, StemsAreThinToAMillimetre) {
  ParameterSet parameters = parameters_at(75);
  EXPECT_EQ(test::config_error_of([&] { parameters.set("trunk_radius_m", 1e-9); }),
            "trunk_radius_m = 1e-09 m, must be >= 0.001 m and <= 0.5 m");
  parameters.set("trunk_radius_m", 1e-3);
  EXPECT_FALSE(test::make_world("vineyard", parameters)->meshes.empty());
}

TEST(VineWorld, TrunksOfAPergolaEndJustBelowItsRoof) {
  const auto world = test::make_world("vineyard", pergola_at(75));
  double top_m = 0.0;
  for (const MeshInstance& instance : world->meshes) {
    if (!instance.name.starts_with("trunk/row_01") || !instance.name.ends_with("#lod0")) continue;
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      const Eigen::Vector3d p = instance.X_WM * v.cast<double>();
      top_m = std::max(top_m, p.z() - world->rows->rows[1].line_W.front().z());
    }
  }
  EXPECT_NEAR(top_m, 1.65, 0.08);  // the arms are 3 cm thick and not quite straight
}

TEST(VineWorld, APergolaThatContradictsItselfIsRefused) {
  const auto fault = [](const char* key, double value) {
    ParameterSet parameters = pergola_at(75);
    parameters.set(key, value);
    return test::config_error_of([&] { test::make_world("vineyard", parameters); });
  };
  const std::string roof = "the height of a pergola's roof, 0.25 m below canopy_top_m = 2 m";
  EXPECT_EQ(fault("arm_height_m", 1.9), "arm_height_m = 1.9 m, must be <= 1.75 m, " + roof);
  EXPECT_EQ(fault("post_height_m", 1.0), "post_height_m = 1 m, must be >= 1.75 m, " + roof);
  EXPECT_EQ(fault("canopy_width_m", 3.0),
            "canopy_width_m = 3 m, must be <= pitch_m = 2.5 m for a pergola");
  EXPECT_EQ(fault("pitch_m", 1.5),
            "canopy_width_m = 2 m, must be <= pitch_m = 1.5 m for a pergola");
  ParameterSet low = pergola_at(75);
  low.set("canopy_base_m", 0.1).set("canopy_top_m", 0.3);
  EXPECT_EQ(test::config_error_of([&] { test::make_world("vineyard", low); }),
            "canopy_top_m = 0.3 m, must be > 0.35 m for a pergola");
}

/// One vine alone, whose place in the row is longer than the row: arms and foliage end with it.
TEST(VineWorld, FoliageEndsWithTheRow) {
  ParameterSet parameters = parameters_at(75);
  parameters.set("vine_spacing_m", 50.0);
  const auto world = test::make_world("vineyard", parameters);
  for (const MeshInstance& instance : world->meshes) {
    const bool is_plant = instance.name.starts_with("canopy") ||
                          instance.name.starts_with("trunk") || instance.name.starts_with("shoots");
    if (!is_plant) continue;
    const std::size_t at = instance.name.find("row_");
    const auto& line = world->rows->rows[std::stoul(instance.name.substr(at + 4, 2))].line_W;
    const Eigen::Vector3d along = (line.back() - line.front()).normalized();
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      const double s_m = along.dot(instance.X_WM * v.cast<double>() - line.front());
      // Shoots lean.
      ASSERT_GT(s_m, -1.0) << instance.name;
      ASSERT_LT(s_m, 22.0 + 1.0) << instance.name;
    }
  }
}

/// Leaves of a bent row grow on both sides of its line all along it. Chunks of 7.2 m would leave a
/// circle of this radius by 7.2^2 / (8 21) = 0.31 m in their middle.
TEST(VineWorld, LeavesFollowABentRow) {
  ParameterSet parameters = parameters_at(75);
  parameters.set("row_bend_deg", 60.0);
  const auto world = test::make_world("vineyard", parameters);
  std::vector<Eigen::Vector2d> line;
  for (const Eigen::Vector3d& p : world->rows->rows[1].line_W) line.push_back(p.head<2>());
  const Polyline row(line);
  std::map<int, std::pair<double, int>> sums;  // by metre of the row
  for (const MeshInstance& instance : world->meshes) {
    if (!instance.name.starts_with("canopy/row_01") || !instance.name.ends_with("#lod0")) continue;
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      const auto nearest =
          row.nearest(Eigen::Vector2d((instance.X_WM * v.cast<double>()).head<2>()));
      auto& [sum_m, count] = sums[static_cast<int>(row.s_m(nearest))];
      sum_m += nearest.signed_distance_m;
      ++count;
    }
  }
  ASSERT_GE(sums.size(), 20u);
  for (const auto& [metre, sum] : sums) {
    if (sum.second < 1000) continue;  // beyond the ends
    EXPECT_NEAR(sum.first / sum.second, 0.0, 0.08) << metre;
  }
}

TEST(VineWorld, StagesThatDoNotExistAreRefused) {
  const auto message_at = [](double bbch) -> std::string {
    try {
      world_at(bbch);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message_at(30.0).find("bbch = 30: grapevines have no stages between 19"),
            std::string::npos)
      << message_at(30.0);
  EXPECT_NE(message_at(120.0).find("bbch"), std::string::npos) << message_at(120.0);
}

}  // namespace
}  // namespace vinerow::worlds::vine_world_test
