/// What a replay is made of: coarser meshes, lines, text of bytes, phases, glTF.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/core/error.h"
#include "tests/tools/replay_page.h"
#include "tools/replay/page_text.h"
#include "tools/replay/replay_decimate.h"
#include "tools/replay/replay_glb.h"
#include "tools/replay/replay_ground.h"
#include "tools/replay/replay_run.h"
#include "tools/replay/simplify_line.h"

namespace vinerow::tools::replay_parts_test {
namespace {

TEST(Base64, GivesTheVectorsOfTheStandard) {
  // RFC 4648, section 10.
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) {
    EXPECT_EQ(base64(bytes), text);
    EXPECT_EQ(test::decode_base64(text), bytes);
  }
  EXPECT_EQ(base64(std::string("\xff\xfe\x00\x80", 4)), "//4AgA==");
}

/// A square of n by n cells of 1 m in the plane z = 0.5.
TriangleMesh sheet(std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      mesh.vertices.emplace_back(static_cast<float>(i), static_cast<float>(j), 0.5f);
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i;
      mesh.triangles.push_back({a, a + 1, a + n + 2});
      mesh.triangles.push_back({a, a + n + 2, a + n + 1});
    }
  }
  return mesh;
}

double area_m2(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[t[0]];
    sum += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
  }
  return sum;
}

TEST(ClusterVertices, LeavesAFlatSheetFlatAndOfTheSameOrientation) {
  const TriangleMesh fine = sheet(40), coarse = cluster_vertices(fine, 4.0);
  EXPECT_EQ(coarse.vertices.size(), 11u * 11u);
  EXPECT_EQ(coarse.triangles.size(), 2u * 10u * 10u);
  for (const Eigen::Vector3f& v : coarse.vertices) EXPECT_EQ(v.z(), 0.5f);
  // Corner cells hold 4 x 4 or fewer vertices; their means lie 1.5 m inside at the low end, and the
  // last cell holds the one vertex at 40 m.
  EXPECT_NEAR(area_m2(coarse), 38.5 * 38.5, 1e-3);
  for (const auto& t : coarse.triangles) {
    const Eigen::Vector3f a = coarse.vertices[t[0]];
    EXPECT_GT((coarse.vertices[t[1]] - a).cross(coarse.vertices[t[2]] - a).z(), 0.0f);
  }
}

TEST(ClusterVertices, KeepsWhatIsLargerThanACell) {
  const TriangleMesh mesh = sheet(5), same = cluster_vertices(mesh, 0.5);
  EXPECT_EQ(same.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(same.triangles.size(), mesh.triangles.size());
  EXPECT_DOUBLE_EQ(area_m2(same), 25.0);
}

TEST(ClusterVertices, DropsTrianglesOfVerticesThatAreNotThere) {
  TriangleMesh mesh = sheet(1);
  mesh.triangles.push_back({0, 1, 77});
  EXPECT_EQ(cluster_vertices(mesh, 0.1).triangles.size(), 2u);
}

TEST(ThinCards, KeepsTheAreaOfAllLeaves) {
  TriangleMesh cards;
  for (std::uint32_t k = 0; k < 12; ++k) {
    const float x = static_cast<float>(k), half = 0.1f;
    for (const auto& [dx, dz] :
         {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}}) {
      cards.vertices.emplace_back(x + dx, 2.0f, 1.0f + dz);
      cards.uvs.emplace_back(dx > 0.0f ? 1.0f : 0.0f, dz > 0.0f ? 1.0f : 0.0f);
      cards.colours.emplace_back(0.1f * static_cast<float>(k), 0.0f, 0.0f);
    }
    cards.triangles.push_back({4 * k, 4 * k + 1, 4 * k + 2});
    cards.triangles.push_back({4 * k, 4 * k + 2, 4 * k + 3});
  }
  const TriangleMesh thin = thin_cards(cards, 3);
  ASSERT_EQ(thin.triangles.size(), 8u);
  ASSERT_EQ(thin.vertices.size(), 16u);
  EXPECT_NEAR(area_m2(thin), area_m2(cards), 1e-5);
  for (std::size_t k = 0; k < 4; ++k) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (std::size_t i = 0; i < 4; ++i) middle += 0.25f * thin.vertices[4 * k + i];
    EXPECT_LT((middle - Eigen::Vector3f(3.0f * static_cast<float>(k), 2.0f, 1.0f)).norm(), 1e-5f);
    EXPECT_FLOAT_EQ(thin.colours[4 * k].x(), 0.3f * static_cast<float>(k));
    EXPECT_EQ(thin.uvs[4 * k + 2], Eigen::Vector2f(1.0f, 1.0f));
  }
  EXPECT_EQ(thin_cards(cards, 1).triangles, cards.triangles);
}

HeightField plane_field(int columns, int rows) {
  HeightField field;
  field.columns = columns;
  field.rows = rows;
  field.cell_m = 0.5;
  field.corner_W = {-3.0, 7.0};
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      field.heights_m.push_back(0.25f * static_cast<float>(i) - 0.125f * static_cast<float>(j));
    }
  }
  return field;
}

TEST(ThinHeightField, KeepsHeightsWhereItsSamplesAre) {
  const HeightField field = plane_field(101, 61);
  const HeightField thin = thin_height_field(field, stride_for(field, 500));
  EXPECT_LE(thin.columns * thin.rows, 500);
  EXPECT_GT(thin.columns * thin.rows, 250);
  EXPECT_GE(thin.width_m(), field.width_m());
  EXPECT_GE(thin.depth_m(), field.depth_m());
  // Short of the last cell, which repeats samples where the stride does not divide the field.
  for (double x = -3.0; x <= -3.0 + 46.0; x += 3.1) {
    for (double y = 7.0; y <= 7.0 + 26.0; y += 2.3) {
      EXPECT_NEAR(thin.height_m(x, y), field.height_m(x, y), 1e-5);
    }
  }
  EXPECT_EQ(stride_for(field, 101 * 61), 1);
}

TEST(ThinTerrain, IsFineWhereVehiclesWorkAndCoversAllOnce) {
  const HeightField field = plane_field(401, 301);
  const Eigen::AlignedBox2d focus(Eigen::Vector2d(40.0, 30.0), Eigen::Vector2d(90.0, 60.0));
  const ReplayTerrain terrain = thin_terrain(field, focus, 9'000);
  ASSERT_TRUE(terrain.fine);
  EXPECT_LE(
      terrain.coarse.columns * terrain.coarse.rows + terrain.fine->columns * terrain.fine->rows,
      9'000);
  EXPECT_LT(terrain.fine->cell_m, terrain.coarse.cell_m);
  EXPECT_TRUE(terrain.fine->contains(40.0, 30.0));
  EXPECT_TRUE(terrain.fine->contains(90.0, 60.0));
  const auto size_m = [&](int c) {
    return terrain.coarse.cell_m * (terrain.hole.last - terrain.hole.first)[c];
  };
  EXPECT_NEAR(terrain.fine->width_m(), size_m(0), 1e-9);
  EXPECT_NEAR(terrain.fine->depth_m(), size_m(1), 1e-9);
  const Eigen::Vector2d corner_W =
      terrain.coarse.corner_W + terrain.coarse.cell_m * terrain.hole.first.cast<double>();
  EXPECT_LT((terrain.fine->corner_W - corner_W).norm(), 1e-9);
  for (double x = 41.0; x < 90.0; x += 3.7) {
    EXPECT_NEAR(terrain.fine->height_m(x, 44.0), field.height_m(x, 44.0), 1e-4);
  }
  // All samples where they are few; no fine part without a place that matters, or outside the
  // field.
  EXPECT_EQ(thin_terrain(field, focus, 401 * 301).coarse.columns, 401);
  EXPECT_FALSE(thin_terrain(field, {}, 9'000).fine);
  const Eigen::AlignedBox2d outside(Eigen::Vector2d(900.0, 900.0), Eigen::Vector2d(950.0, 950.0));
  EXPECT_FALSE(thin_terrain(field, outside, 9'000).fine);
}

TEST(TerrainMeshes, CoverTheFieldOnceAndFaceUpwards) {
  const HeightField field = plane_field(301, 220);
  double area = 0.0;
  for (const render::PreparedMesh& mesh : terrain_meshes(field)) {
    EXPECT_LE(mesh.vertices.size(), 65'535u);
    for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
      const auto at = [&](std::size_t c) {
        return Eigen::Vector3d(
            Eigen::Map<const Eigen::Vector3f>(mesh.vertices[mesh.indices[k + c]].position)
                .cast<double>());
      };
      const double up = 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).z();
      EXPECT_GE(up, -1e-9);  // the curtain at the border stands upright
      area += up;
    }
  }
  EXPECT_NEAR(area, field.width_m() * field.depth_m(), 1e-3);
}

TEST(SimplifyLine, KeepsCornersAndStaysWithinTheTolerance) {
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i <= 50; ++i) line.emplace_back(0.2 * i, 0.0, 1.0);
  for (int i = 1; i <= 90; ++i) {
    const double angle = std::numbers::pi * i / 90.0;
    line.emplace_back(10.0 + 2.0 * std::sin(angle), 2.0 - 2.0 * std::cos(angle), 1.0);
  }
  const std::vector<Eigen::Vector3d> simple = simplify_line(line, 0.03);
  EXPECT_EQ(simple.front(), line.front());
  EXPECT_EQ(simple.back(), line.back());
  // A chord over the angle a leaves an arc of radius r by r (1 - cos(a / 2)): 0.03 m in 2 m is
  // a = 20 deg, so 180 deg need at least 9 chords.
  EXPECT_GE(simple.size(), 11u);
  EXPECT_LE(simple.size(), 24u);
  for (const Eigen::Vector3d& p : line) {
    double nearest_m = 1e9;
    for (std::size_t i = 0; i + 1 < simple.size(); ++i) {
      const Eigen::Vector3d along = simple[i + 1] - simple[i];
      const double t = std::clamp((p - simple[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest_m = std::min(nearest_m, (p - simple[i] - t * along).norm());
    }
    EXPECT_LE(nearest_m, 0.03 + 1e-12);
  }
  EXPECT_EQ(simplify_line(std::vector{line[0], line[1]}, 0.03).size(), 2u);
}

TEST(PhasesOfSummary, AreThoseThatBegan) {
  const auto phases = phases_of_summary(
      R"({"phases": [{"name": "survey", "state": "succeeded", "begin_s": 0, "end_s": 61.5},
                     {"name": "spray", "state": "stopped", "begin_s": 61.5, "end_s": null},
                     {"name": "scout", "state": "blocked", "begin_s": null}]})",
      "summary.json", 90.0);
  ASSERT_EQ(phases.size(), 2u);
  EXPECT_EQ(phases[0].name, "survey");
  EXPECT_EQ(phases[0].end_s, 61.5);
  EXPECT_EQ(phases[1].state, "stopped");
  EXPECT_EQ(phases[1].end_s, 90.0);
  EXPECT_TRUE(phases_of_summary("{}", "summary.json", 1.0).empty());
}

TEST(PhasesOfSummary, NameTheFileThatIsNoJson) {
  try {
    phases_of_summary("{\"phases\": [", "run/summary.json", 1.0);
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("run/summary.json: its phases cannot be read: ", 0),
              0u)
        << error.what();
  }
}

TEST(GlbScene, PlacesVerticesToAHalfStepOfTheLongestSide) {
  render::PreparedMesh mesh;
  const Eigen::Vector3f places[] = {
      {812.0f, 433.5f, -17.75f}, {813.0f, 435.5f, -14.75f}, {812.3f, 433.6f, -16.0f}};
  for (const Eigen::Vector3f& p : places) {
    render::GpuVertex v{};
    for (int c = 0; c < 3; ++c) v.position[c] = p[c];
    v.normal[2] = 127;
    mesh.vertices.push_back(v);
  }
  mesh.indices = {0, 1, 2};
  GlbScene scene;
  const int material = scene.add_material({}, false);
  EXPECT_EQ(scene.add_material({}, false), material);
  const Pose X_WM{Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ())),
                  {1.0, -2.0, 0.5}};
  scene.add_node("m", scene.add_mesh("m", mesh, material, false, false), X_WM, {{"part", "world"}});
  const std::string glb = scene.bytes();
  const nlohmann::json gltf = test::gltf_of(glb);
  const nlohmann::json& node = gltf["nodes"][1];
  EXPECT_EQ(node["extras"]["part"], "world");
  const std::size_t begin = 20 + [&] {
    std::uint32_t length;
    std::memcpy(&length, glb.data() + 12, 4);
    return length;
  }() + 8;
  const auto vector_of = [](const nlohmann::json& a) {
    return Eigen::Vector3d(a[0].get<double>(), a[1].get<double>(), a[2].get<double>());
  };
  const nlohmann::json& r = node["rotation"];
  const Eigen::Quaterniond q(r[3].get<double>(), r[0].get<double>(), r[1].get<double>(),
                             r[2].get<double>());
  // Half a step of the longest side (3 m), and the micrometre of the node's own place.
  const double tolerance_m = 0.5 * 3.0 / 65'534.0 * std::sqrt(3.0) + 2e-6 + 812.0 * 1e-8;
  for (std::size_t i = 0; i < 3; ++i) {
    std::int16_t steps[3];
    std::memcpy(steps, glb.data() + begin + 8 * i, sizeof(steps));
    const Eigen::Vector3d p =
        vector_of(node["translation"]) +
        q * vector_of(node["scale"]).cwiseProduct(Eigen::Vector3d(steps[0], steps[1], steps[2]));
    EXPECT_LE((p - X_WM * places[i].cast<double>()).norm(), tolerance_m);
  }
}

}  // namespace
}  // namespace vinerow::tools::replay_parts_test
