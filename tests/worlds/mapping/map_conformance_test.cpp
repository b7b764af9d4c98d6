/// What every registered map must keep, on each kind of world with rows.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/api/world_model.h"
#include "engine/math/polygon.h"
#include "tests/worlds/mapping/cloud_map_fixture.h"

namespace vinerow::test::map_conformance_test {
namespace {

class MapConformance : public ::testing::TestWithParam<std::pair<std::string, std::string>> {
 protected:
  std::unique_ptr<RowMap> make(std::uint64_t seed = 1) const {
    ParameterSet parameters = map_parameters(GetParam().first);
    if (is_stored()) parameters.set("folder", folder_of_world(GetParam().second));
    return world_registry().make_map(GetParam().first, parameters, world().context(seed));
  }
  /// Read from files: nothing of it is drawn.
  bool is_stored() const { return GetParam().first == "cloud_map"; }
  const SurveyedWorld& world() const { return surveyed_world(GetParam().second); }
};

bool same_bits(const RowMap& a, const RowMap& b) {
  if (a.meshes.size() != b.meshes.size()) return false;
  for (std::size_t k = 0; k < a.meshes.size(); ++k) {
    const TriangleMesh &m = a.meshes[k].mesh_W, &n = b.meshes[k].mesh_W;
    if (a.meshes[k].row != b.meshes[k].row || m.vertices != n.vertices ||
        m.triangles != n.triangles) {
      return false;
    }
  }
  return a.accuracy.surface_std_m == b.accuracy.surface_std_m;
}

TEST_P(MapConformance, SameSeedSameBitsOtherSeedOtherMap) {
  const auto map = make();
  EXPECT_TRUE(same_bits(*map, *make()));
  EXPECT_EQ(same_bits(*map, *make(2)), is_stored());
}

TEST_P(MapConformance, MeshesAreClosedAndLookOutward) {
  const auto map = make();
  ASSERT_FALSE(map->meshes.empty());
  for (const RowMesh& mesh : map->meshes) {
    EXPECT_GT(closed_volume_m3(mesh.mesh_W), 0.01) << "row " << mesh.row;
    for (const Eigen::Vector3f& v : mesh.mesh_W.vertices) EXPECT_TRUE(v.allFinite());
  }
}

TEST_P(MapConformance, EveryRowHasMeshesOfItsOwnInsideTheParcel) {
  const auto map = make();
  ASSERT_EQ(map->rows.size(), world().model->rows->rows.size());
  EXPECT_EQ(map->alleys.size(), world().model->rows->alleys.size());
  EXPECT_FALSE(map->occupancy.empty());
  std::set<int> seen;
  for (const RowMesh& mesh : map->meshes) {
    seen.insert(mesh.row);
    for (const Eigen::Vector3f& v : mesh.mesh_W.vertices) {
      const Eigen::Vector2d p(v.x(), v.y());
      EXPECT_TRUE(contains(map->boundary_W, p)) << "row " << mesh.row;
      // Nearer to its own row than to any other.
      int nearest = -1;
      double nearest_m = 1e300;
      for (const PlantRow& row : map->rows) {
        for (std::size_t k = 0; k + 1 < row.line_W.size(); ++k) {
          const Eigen::Vector2d a = row.line_W[k].head<2>();
          const Eigen::Vector2d d = row.line_W[k + 1].head<2>() - a;
          const double share = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
          const double apart_m = (a + share * d - p).norm();
          if (apart_m < nearest_m) nearest_m = apart_m, nearest = row.id;
        }
      }
      EXPECT_EQ(nearest, mesh.row);
    }
  }
  for (const PlantRow& row : map->rows) EXPECT_TRUE(seen.count(row.id)) << "row " << row.id;
}

TEST_P(MapConformance, SaysHowFarItIsFromTheCanopy) {
  const auto map = make();
  const auto samples = sample_surface(world(), *map, 20'000, RandomStream(5, "", "samples"));
  ASSERT_GT(samples.size(), 15'000u);
  const double rms_m = rms_of(samples);
  EXPECT_NEAR(map->accuracy.surface_std_m, rms_m, 0.2 * rms_m);
  EXPECT_GT(map->accuracy.correlation_length_m, 0.02);
  EXPECT_LT(map->accuracy.correlation_length_m, 3.0);
  double mean_m = 0.0;
  for (const SurfaceSample& sample : samples) {
    mean_m += sample.error_m / static_cast<double>(samples.size());
  }
  std::size_t triangles = 0, true_triangles = 0;
  for (const RowMesh& mesh : map->meshes) triangles += mesh.mesh_W.triangles.size();
  for (const MeshInstance& instance : world().model->meshes) {
    if (instance.collides && instance.surface == SurfaceClass::kCanopy) {
      true_triangles += instance.mesh->triangles.size();
    }
  }
  EXPECT_LT(triangles, true_triangles);
  std::printf(
      "%s: %zu hulls, %zu triangles, %.1f %% of the truth's; stated %.4f m over %.2f m, "
      "sampled %.4f m, mean %+.4f m\n",
      GetParam().second.c_str(), map->meshes.size(), triangles,
      100.0 * static_cast<double>(triangles) / static_cast<double>(true_triangles),
      map->accuracy.surface_std_m, map->accuracy.correlation_length_m, rms_m, mean_m);
}

std::vector<std::pair<std::string, std::string>> all_maps() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string& map : world_registry().names(PartKind::kMap)) {
    for (const char* world : {"vineyard", "orchard", "surveyed"}) all.emplace_back(map, world);
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(AllMaps, MapConformance, ::testing::ValuesIn(all_maps()),
                         [](const auto& test_info) {
                           return test_info.param.first + "_of_" + test_info.param.second;
                         });

}  // namespace
}  // namespace vinerow::test::map_conformance_test
