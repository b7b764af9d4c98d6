#include "worlds/plants/weeds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/physics/static_scene.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::worlds::weeds_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double slope(double x, double y) {
  return 0.2 * x - 0.1 * y + 3.0;
}

std::vector<Weed> weeds_of(const mapping::RowCurve& row, const WeedParams& params,
                           std::uint64_t seed) {
  return place_weeds(row, slope, 0.0, row.length_m(), params, RandomStream(seed, "", "weeds"));
}

double area_of(const TriangleMesh& mesh) {
  double area_m2 = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d ab = (mesh.vertices[b] - mesh.vertices[a]).cast<double>();
    const Vector3d ac = (mesh.vertices[c] - mesh.vertices[a]).cast<double>();
    area_m2 += 0.5 * ab.cross(ac).norm();
  }
  return area_m2;
}

TEST(Weeds, StandOnTheStripAsDenselyAsAsked) {
  const mapping::RowCurve row({Vector2d(5, -3), Vector2d(17, 6)});  // 15 m
  const Vector2d along(0.8, 0.6), left(-0.6, 0.8);
  const WeedParams params{.per_m2 = 5.3, .height_m = 0.2, .strip_width_m = 0.9};
  constexpr int kSeeds = 400;
  double count = 0.0, sum_s_m = 0.0, sum_left_m = 0.0, sum_height_m = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    for (const Weed& weed : weeds_of(row, params, static_cast<std::uint64_t>(seed))) {
      const Vector2d from_start = weed.root_W.head<2>() - Vector2d(5, -3);
      const double left_m = from_start.dot(left);
      ASSERT_LE(std::abs(left_m), 0.45 + 1e-9);
      const double s_m = from_start.dot(along);
      ASSERT_GE(s_m, -1e-9);
      ASSERT_LE(s_m, 15.0 + 1e-9);
      sum_s_m += s_m;
      ASSERT_NEAR(weed.root_W.z(), slope(weed.root_W.x(), weed.root_W.y()), 1e-12);
      ASSERT_GE(weed.height_m, 0.08);
      ASSERT_LE(weed.height_m, 0.32);
      count += 1.0;
      sum_left_m += left_m;
      sum_height_m += weed.height_m;
    }
  }
  // Of 71.55 plants a seed gives 71 or 72.
  EXPECT_NEAR(count / kSeeds, 5.3 * 0.9 * 15.0, 4.0 * 0.5 / std::sqrt(kSeeds));
  // Uniform distributions: their widths over sqrt(12).
  EXPECT_NEAR(sum_s_m / count, 7.5, 4.0 * 15.0 / std::sqrt(12.0 * count));
  EXPECT_NEAR(sum_left_m / count, 0.0, 4.0 * 0.9 / std::sqrt(12.0 * count));
  EXPECT_NEAR(sum_height_m / count, 0.2, 4.0 * 0.24 / std::sqrt(12.0 * count));
}

TEST(Weeds, EachIsAThingOfItsHeightAboveItsRoot) {
  int high = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Weed weed{{100.0, -50.0, 20.0}, 0.3, seed};
    const TriangleMesh mesh = make_weed_mesh({&weed, 1}, 0);
    ASSERT_EQ(mesh.things, std::vector<std::uint32_t>{0});
    ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
    ASSERT_EQ(mesh.colours.size(), mesh.vertices.size());
    const Eigen::AlignedBox3d box = mesh.bounds();
    EXPECT_GT(box.min().z(), 20.0 - 0.15) << "tips that bend down on the ground";
    EXPECT_LT(box.max().z(), 20.0 + 1.3 * 0.3);
    EXPECT_GT(box.max().z(), 20.0 + 0.1 * 0.3);
    EXPECT_LT((box.center() - weed.root_W).head<2>().norm(), 0.3);
    // Upper faces look up, whatever the way round of their triangles. Stems look to the side.
    float up = 0.0f;
    for (const Eigen::Vector3f& normal : mesh.normals) {
      EXPECT_NEAR(normal.norm(), 1.0f, 1e-4f);
      up += normal.z();
    }
    EXPECT_GT(up / static_cast<float>(mesh.normals.size()), 0.2f);
    high += box.max().z() > 20.0 + 0.9 * 0.3;
  }
  EXPECT_GT(high, 40) << "upright ones";
  EXPECT_LT(high, 180) << "rosettes";
}

TEST(Weeds, FarLevelsHaveAsMuchLeafOfFewerTriangles) {
  const mapping::RowCurve row({Vector2d(0, 0), Vector2d(40, 0)});
  const std::vector<Weed> weeds = weeds_of(row, {}, 3);
  const TriangleMesh near = make_weed_mesh(weeds, 0), middle = make_weed_mesh(weeds, 1),
                     far = make_weed_mesh(weeds, 2);
  EXPECT_EQ(near.things.size(), weeds.size());
  EXPECT_TRUE(far.things.empty());
  // Their number does not divide those of all leaves, and outlines are coarser.
  EXPECT_NEAR(area_of(middle) / area_of(near), 1.0, 0.15);
  EXPECT_NEAR(area_of(far) / area_of(near), 1.0, 0.3);
  EXPECT_LT(middle.triangles.size(), 0.7 * static_cast<double>(near.triangles.size()));
  EXPECT_LT(far.triangles.size(), 0.5 * static_cast<double>(middle.triangles.size()));
}

/// Largest distance from the root, seen from above.
double reach_of(const Weed& weed, int level) {
  double reach_m = 0.0;
  for (const Eigen::Vector3f& p : make_weed_mesh({&weed, 1}, level).vertices) {
    reach_m = std::max(reach_m, (p.cast<double>() - weed.root_W).head<2>().norm());
  }
  return reach_m;
}

TEST(Weeds, FarLevelsReachNoFartherThanAPlantIsHigh) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Weed weed{{100.0, -50.0, 20.0}, 0.3, seed};
    const double allowed_m = std::max(1.1 * reach_of(weed, 0), 0.3);
    EXPECT_LE(reach_of(weed, 1), allowed_m) << seed;
    EXPECT_LE(reach_of(weed, 2), allowed_m) << seed;
  }
}

TEST(Weeds, LeavesOfRosettesOnTheGroundAreNotLongerThanHalfAMetre) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Weed weed{{0.0, 0.0, 0.0}, 1.6, seed};
    // Grass and herbs of this height stand up.
    if (make_weed_mesh({&weed, 1}, 0).bounds().max().z() > 0.8) continue;
    EXPECT_LE(reach_of(weed, 0), 0.5) << seed;
  }
}

ParameterSet with_weeds(const std::string& world, double per_m2) {
  ParameterSet parameters = test::world_parameters(world);
  if (world == "vineyard") parameters.set("row_count", 2.0).set("row_length_m", 20.0);
  if (per_m2 > 0.0) {
    ParameterSet weeds = parameters.make_group("weeds");
    weeds.set("per_m2", per_m2);
    parameters.set("weeds", std::vector<ParameterSet>{weeds});
  }
  return parameters;
}

bool is_weed(const MeshInstance& instance) {
  return instance.name.starts_with("weeds/");
}

TEST(Weeds, AreSeenByLightAlone) {
  for (const std::string type : {"vineyard", "orchard"}) {
    SCOPED_TRACE(type);
    const std::shared_ptr<const WorldModel> world = test::make_world(type, with_weeds(type, 4.0));
    const physics::StaticScene scene(world);
    int seen = 0, asked = 0;
    for (const MeshInstance& instance : world->meshes) {
      if (!is_weed(instance)) continue;
      EXPECT_EQ(instance.label, Label::kWeed);
      EXPECT_FALSE(instance.collides);
      if (!instance.name.ends_with("#lod0")) {
        EXPECT_EQ(instance.light, Light::kPasses);
        continue;
      }
      for (std::size_t t = 0; t < instance.mesh->triangles.size(); t += 41) {
        const auto& [a, b, c] = instance.mesh->triangles[t];
        const auto& v = instance.mesh->vertices;
        const Vector3d p_W =
            ((v[a] + v[b] + v[c]) / 3.0f).cast<double>() + 0.005 * Vector3d::UnitZ();
        if (p_W.z() < world->terrain->height_m(p_W.x(), p_W.y()) + 0.01) continue;
        ++asked;
        const auto light = scene.light().cast_ray(p_W, -Vector3d::UnitZ(), 0.02, kAllSurfaces);
        seen += light && light->mesh >= 0 &&
                is_weed(world->meshes[static_cast<std::size_t>(light->mesh)]);
        const auto ray = scene.queries().cast_ray(p_W, -Vector3d::UnitZ(), 2.0, kAllSurfaces);
        EXPECT_FALSE(ray && ray->mesh >= 0 &&
                     is_weed(world->meshes[static_cast<std::size_t>(ray->mesh)]));
      }
    }
    EXPECT_GT(asked, 100);
    EXPECT_GT(seen, 0.9 * asked);
  }
}

TEST(Weeds, LeaveEverythingElseAsItIs) {
  const auto bare = test::make_world("vineyard", with_weeds("vineyard", 0.0));
  const auto world = test::make_world("vineyard", with_weeds("vineyard", 6.0));
  std::vector<std::string> others;
  int weeds = 0;
  for (const MeshInstance& instance : world->meshes) {
    is_weed(instance) ? static_cast<void>(++weeds) : others.push_back(instance.name);
  }
  EXPECT_EQ(weeds, 2 * 2 * 3) << "two rows of two stretches, three levels";
  ASSERT_EQ(others.size(), bare->meshes.size());
  for (std::size_t i = 0; i < others.size(); ++i) EXPECT_EQ(others[i], bare->meshes[i].name);
}

TEST(Weeds, FewLeaveStretchesBare) {
  const auto world = test::make_world("vineyard", with_weeds("vineyard", 0.01));
  EXPECT_LT(std::count_if(world->meshes.begin(), world->meshes.end(), is_weed), 12);
}

TEST(Weeds, TooManyAreRefused) {
  ParameterSet parameters = with_weeds("vineyard", 40.0);
  parameters.set("row_count", 100.0).set("row_length_m", 200.0);
  EXPECT_EQ(test::config_error_of([&] { test::make_world("vineyard", parameters); }),
            "weeds.per_m2 = 40 1/m2 gives 640000 plants in strips of 0.8 m under 20000 m of rows, "
            "must be <= 18.8 1/m2: 300000 plants");
}

}  // namespace
}  // namespace vinerow::worlds::weeds_test
