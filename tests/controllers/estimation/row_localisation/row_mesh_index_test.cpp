/// Rays on the map against brute force over all facets, against Embree, and against the plane cut.

#include "controllers/estimation/row_localisation/row_mesh_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "controllers/estimation/row_localisation/range_prediction.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/physics/physics_world.h"
#include "tests/controllers/support/row_mesh_map.h"
#include "tests/support/heap.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::row_mesh_index_test {
namespace {

using Eigen::Vector3d;

Vector3d random_direction(RandomStream& random) {
  return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

/// Triangles of all shapes and directions, strewn over a space: rows that cross, hang and touch.
RowMap make_strewn_map(RandomStream random, int count, double space_m) {
  RowMap map;
  for (int k = 0; k < count; ++k) {
    if (k % 50 == 0) map.meshes.push_back({k / 50 + 7, {}});
    TriangleMesh& mesh = map.meshes.back().mesh_W;
    const Vector3d centre =
        space_m * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.1, 0.1));
    const double size_m = std::pow(10.0, random.uniform(-1.5, 0.7));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int n = 0; n < 3; ++n) {
      mesh.vertices.push_back((centre + size_m * random_direction(random)).cast<float>());
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return map;
}

/// The same by another formula over all facets: Moeller and Trumbore, "Fast, minimum storage
/// ray/triangle intersection", 1997.
struct BruteHit {
  double distance_m = 1e300;
  int row = -1, facet = -1;
  Vector3d normal = Vector3d::Zero();
  double edge = 0.0;  ///< least barycentric coordinate, and that of the nearest miss
};

BruteHit cast_brute(const RowMap& map, const Vector3d& p, const Vector3d& u) {
  BruteHit best;
  int facet = 0;
  for (const RowMesh& mesh : map.meshes) {
    for (const auto& triangle : mesh.mesh_W.triangles) {
      const Vector3d a = mesh.mesh_W.vertices[triangle[0]].cast<double>();
      const Vector3d e1 = mesh.mesh_W.vertices[triangle[1]].cast<double>() - a;
      const Vector3d e2 = mesh.mesh_W.vertices[triangle[2]].cast<double>() - a;
      const Vector3d q = u.cross(e2);
      const double det = e1.dot(q);
      if (det > 0.0) {  // faces the ray
        const Vector3d s = p - a, r = s.cross(e1);
        const double v = s.dot(q) / det, w = u.dot(r) / det, t = e2.dot(r) / det;
        if (v >= 0.0 && w >= 0.0 && v + w <= 1.0 && t >= 0.0 && t < best.distance_m) {
          best = {t, mesh.row, facet, e1.cross(e2).normalized(), std::min({v, w, 1.0 - v - w})};
        }
      }
      ++facet;
    }
  }
  return best;
}

void expect_like_brute_force(const RowMap& map, RandomStream random, const Vector3d& middle,
                             const Vector3d& half, int rays, double cell_m) {
  const controllers::RowMeshIndex index(map, cell_m);
  double worst_m = 0.0;
  int hits = 0;
  for (int k = 0; k < rays; ++k) {
    const Vector3d p =
        middle + half.cwiseProduct(
                     Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    // Some rays run along the axes, on which a walk over squares divides by zero.
    Vector3d u = random_direction(random);
    if (k % 10 == 0) u = Vector3d::Unit(k / 10 % 3) * (k % 20 == 0 ? 1.0 : -1.0);
    const double reach_m = k % 3 == 0 ? 4.0 : 1e3;
    const BruteHit expected = cast_brute(map, p, u);
    const auto hit = index.cast_ray(p, u, reach_m);
    if (expected.edge < 1e-9 && hit.has_value() != (expected.distance_m < reach_m)) continue;
    ASSERT_EQ(hit.has_value(), expected.distance_m < reach_m) << "ray " << k;
    if (!hit) continue;
    ++hits;
    // What the distance is known to, with corners tens of metres away and grazing rays.
    const double scale = std::max(1.0, p.cwiseAbs().maxCoeff()) / std::abs(hit->normal_W.dot(u));
    worst_m = std::max(worst_m, std::abs(hit->distance_m - expected.distance_m) / scale);
    if (expected.edge < 1e-9) continue;
    EXPECT_EQ(hit->row, expected.row);
    EXPECT_EQ(hit->facet, expected.facet);
    EXPECT_LT((hit->normal_W - expected.normal).norm(), 1e-9);
    EXPECT_LT(hit->normal_W.dot(u), 0.0);
    EXPECT_NEAR(hit->plane_m, hit->normal_W.dot(p + hit->distance_m * u), 1e-11);
  }
  EXPECT_GT(hits, rays / 10);
  EXPECT_LT(worst_m, 1e-12);
  std::printf("%d of %d rays hit, worst difference %.1e m\n", hits, rays, worst_m);
}

TEST(RowMeshIndex, SeesWhatBruteForceSees) {
  const RowMap strewn = make_strewn_map(RandomStream(1, "", "strewn"), 600, 10.0);
  for (const double cell_m : {0.25, 0.5, 3.0, 100.0}) {
    expect_like_brute_force(strewn, RandomStream(2, "", "rays"), Vector3d::Zero(),
                            {14.0, 14.0, 2.0}, 2500, cell_m);
  }
}

TEST(RowMeshIndex, SeesWhatBruteForceSeesInABlock) {
  RowMeshBlock block;
  block.rows = 6;
  block.length_m = 30.0;
  const RowMap map = make_row_mesh_map(block, RandomStream(3, "", "block"));
  expect_like_brute_force(map, RandomStream(4, "", "rays"), row_mesh_ground(block, 15.0, 6.0),
                          {15.0, 12.0, 3.0}, 5000, 0.5);
}

TEST(RowMeshIndex, SeesWhatEmbreeSees) {
  RowMeshBlock block;
  block.rows = 4;
  block.length_m = 40.0;
  const RowMap map = make_row_mesh_map(block, RandomStream(5, "", "block"));
  const controllers::RowMeshIndex index(map);
  WorldModel world;
  for (const RowMesh& mesh : map.meshes) {
    MeshInstance instance;
    instance.name = "row";
    instance.mesh = std::make_shared<TriangleMesh>(mesh.mesh_W);
    instance.surface = SurfaceClass::kCanopy;
    world.meshes.push_back(std::move(instance));
  }
  const physics::PhysicsWorld physics({}, world);
  RandomStream random(6, "", "rays");
  int hits = 0, edges = 0;
  double worst_m = 0.0;
  for (int k = 0; k < 10'000; ++k) {
    const double across_m = (static_cast<int>(random.uniform(0, 3)) + 0.5) * block.pitch_m;
    const Vector3d p = row_mesh_ground(block, random.uniform(1.0, 39.0), across_m) +
                       Vector3d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1.2);
    const double angle = random.uniform(-kPi, kPi), pitch = 0.2 * random.normal();
    const Vector3d u(std::cos(angle) * std::cos(pitch), std::sin(angle) * std::cos(pitch),
                     std::sin(pitch));
    const auto expected = physics.scene().cast_ray(p, u, 4.0);
    const auto hit = index.cast_ray(p, u, 4.0);
    // Embree looks for the triangle in single precision, so at an edge it may take the other one.
    if (expected.has_value() != hit.has_value() ||
        (hit && std::abs(hit->distance_m - expected->distance_m) > 1e-9)) {
      ++edges;
      continue;
    }
    if (!hit) continue;
    ++hits;
    worst_m = std::max(worst_m, std::abs(hit->distance_m - expected->distance_m));
  }
  EXPECT_GT(hits, 6000);
  EXPECT_LT(edges, 5);
  EXPECT_LT(worst_m, 1e-12);
  std::printf("%d hits, %d at edges, worst difference %.1e m\n", hits, edges, worst_m);
}

TEST(RowMeshIndex, NoRaySlipsThroughBetweenFacets) {
  // Rays from outside to a point inside, through corners and points of shared edges, aimed as
  // exactly as numbers allow: they must enter somewhere.
  RowMeshBlock block;
  block.rows = 1;
  block.section_std_m = block.centre_std_m = 0.02;  // no hollows, so that insides are inside
  const RowMap map = make_row_mesh_map(block, RandomStream(7, "", "block"));
  const TriangleMesh& mesh = map.meshes[0].mesh_W;
  const controllers::RowMeshIndex index(map);
  RandomStream random(8, "", "rays");
  const std::size_t sides = mesh.triangles.size() - 12;  // without the ends
  for (int k = 0; k < 50'000; ++k) {
    const auto& triangle =
        mesh.triangles[static_cast<std::size_t>(random.uniform() * static_cast<double>(sides))];
    const std::uint32_t ring = std::min({triangle[0], triangle[1], triangle[2]}) / 8;
    Vector3d inside = Vector3d::Zero();
    for (std::uint32_t n = 0; n < 16; ++n) {
      inside += mesh.vertices[ring * 8 + n].cast<double>() / 16.0;
    }
    const Vector3d a = mesh.vertices[triangle[0]].cast<double>();
    const Vector3d b = mesh.vertices[triangle[1]].cast<double>();
    const Vector3d edge = k % 2 ? a : Vector3d(a + random.uniform() * (b - a));
    const Vector3d p = edge + random.uniform(1.0, 3.0) * (edge - inside).normalized();
    const auto hit = index.cast_ray(p, (edge - p).normalized(), (inside - p).norm());
    ASSERT_TRUE(hit) << "ray " << k;
  }
}

/// Rays in the plane against the segments of a cut, only those that face the ray.
double cast_in_plane(const std::vector<controllers::RowMeshIndex::Segment>& segments,
                     const Vector3d& p, const Vector3d& u, const Vector3d& n) {
  const Vector3d v = n.cross(u);
  double best = 1e300;
  for (const auto& segment : segments) {
    if (segment.normal_W.dot(u) >= 0.0) continue;
    const double y0 = v.dot(segment.from_W - p), y1 = v.dot(segment.to_W - p);
    if ((y0 > 0.0) == (y1 > 0.0)) continue;
    const double x0 = u.dot(segment.from_W - p), x1 = u.dot(segment.to_W - p);
    const double x = x0 + (x1 - x0) * y0 / (y0 - y1);
    if (x >= 0.0) best = std::min(best, x);
  }
  return best;
}

TEST(RowMeshIndex, PlaneCutAndRaysInThePlaneEqualRaysInSpace) {
  // As the reference says of paper C's eq. 5-6: 481 rays, to 4e-13 m.
  const RowMeshBlock block;
  const RowMap map = make_row_mesh_map(block, RandomStream(9, "", "block"));
  const controllers::RowMeshIndex index(map);
  RandomStream random(10, "", "poses");
  std::vector<controllers::RowMeshIndex::Segment> segments;
  int compared = 0;
  double worst_m = 0.0;
  for (int k = 0; k < 500; ++k) {
    const Vector3d p = row_mesh_ground(block, random.uniform(2.0, 116.0), 2.5 * (k % 15) + 1.25) +
                       Vector3d(0.0, 0.0, random.uniform(0.8, 1.6));
    const Eigen::Quaterniond q = quaternion_from_rpy(
        {0.1 * random.normal(), 0.1 * random.normal(), random.uniform(-kPi, kPi)});
    const Vector3d n = q * Vector3d::UnitZ();
    index.cut(p, n, 4.5, segments);
    ASSERT_FALSE(segments.empty());
    for (const double angle : {0.7853981633974483, -0.7853981633974483, 2.356194490192345, 0.3}) {
      const Vector3d u = q * Vector3d(std::cos(angle), std::sin(angle), 0.0);
      const double in_plane_m = cast_in_plane(segments, p, u, n);
      const auto hit = index.cast_ray(p, u, 4.0);
      ASSERT_EQ(hit.has_value(), in_plane_m < 4.0);
      if (!hit) continue;
      ++compared;
      worst_m = std::max(worst_m,
                         std::abs(hit->distance_m - in_plane_m) * std::abs(hit->normal_W.dot(u)));
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LT(worst_m, 1e-12);
  std::printf("%d rays, worst difference across the facet %.1e m\n", compared, worst_m);
}

TEST(RowMeshIndex, ACutIsClosedAndEveryFacetCountsOnce) {
  RowMeshBlock block;
  block.rows = 3;
  block.length_m = 20.0;
  const RowMap map = make_row_mesh_map(block, RandomStream(11, "", "block"));
  const Vector3d p = row_mesh_ground(block, 10.0, 1.25) + Vector3d(0, 0, 1.1);
  const Vector3d n = Vector3d(-0.1, 0.05, 1.0).normalized();
  const controllers::RowMeshIndex index(map, 0.3);
  std::vector<controllers::RowMeshIndex::Segment> segments;
  index.cut(p, n, 100.0, segments);

  // By hand: all facets with corners on both sides.
  int expected = 0;
  for (const RowMesh& mesh : map.meshes) {
    for (const auto& t : mesh.mesh_W.triangles) {
      int above = 0;
      for (const auto v : t) above += n.dot(mesh.mesh_W.vertices[v].cast<double>() - p) >= 0.0;
      expected += above == 1 || above == 2;
    }
  }
  EXPECT_EQ(static_cast<int>(segments.size()), expected);
  double area_m2 = 0.0;
  for (const auto& segment : segments) {
    // Each end is another segment's start, to the bit, and the plants lie to the left.
    const auto next = std::count_if(segments.begin(), segments.end(), [&](const auto& other) {
      return other.from_W == segment.to_W;
    });
    EXPECT_EQ(next, 1);
    EXPECT_NEAR(n.dot(segment.from_W - p), 0.0, 1e-12);
    const Vector3d along = segment.to_W - segment.from_W;
    EXPECT_NEAR(segment.normal_W.dot(along), 0.0, 1e-6);
    EXPECT_LE(n.cross(along).dot(segment.normal_W), 0.0);
    area_m2 += 0.5 * n.dot((segment.from_W - p).cross(segment.to_W - p));
  }
  EXPECT_GT(area_m2, 3 * 20.0 * 0.3);  // three rows, some 0.6 m wide
  EXPECT_LT(area_m2, 3 * 20.0 * 0.9);

  // A small radius keeps just the segments that come so near.
  std::vector<controllers::RowMeshIndex::Segment> near;
  index.cut(p, n, 2.0, near);
  int expected_near = 0;
  for (const auto& segment : segments) {
    double min_m = 1e9;
    for (int k = 0; k <= 1000; ++k) {
      const Vector3d at = segment.from_W + k / 1000.0 * (segment.to_W - segment.from_W);
      min_m = std::min(min_m, (at - p).head<2>().norm());
    }
    expected_near += min_m <= 2.0;
  }
  EXPECT_EQ(static_cast<int>(near.size()), expected_near);
  EXPECT_GT(expected_near, 2);
}

TEST(RowMeshIndex, ARayInsideThePlantsSeesTheNextRow) {
  RowMeshBlock block{.rows = 2, .section_std_m = 0.0, .centre_std_m = 0.0};
  block.azimuth_rad = block.grade_along = block.grade_across = 0.0;
  const controllers::RowMeshIndex index(make_row_mesh_map(block, RandomStream(12, "", "block")));
  // At 1 m the half width is 0.31 m: from the middle of row 0 to the near side of row 1.
  const auto hit = index.cast_ray({50.0, 0.0, 1.0}, Vector3d::UnitY(), 4.0);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 2.5 - 0.31, 1e-6);
  EXPECT_EQ(hit->row, 1);
  EXPECT_LT(hit->normal_W.y(), 0.0);
  EXPECT_FALSE(index.cast_ray({50.0, 2.5, 1.0}, Vector3d::UnitY(), 4.0));
  EXPECT_FALSE(index.cast_ray({50.0, 0.0, 1.0}, Vector3d::UnitY(), 2.0)) << "too far";
}

TEST(RowMeshIndex, RaysThatAreNotFiniteSeeNothing) {
  const controllers::RowMeshIndex index(
      make_row_mesh_map({.rows = 2}, RandomStream(13, "", "block")));
  const double nan = std::nan("");
  EXPECT_FALSE(index.cast_ray({nan, 0, 0}, Vector3d::UnitX(), 4.0));
  EXPECT_FALSE(index.cast_ray({0, 0, 1}, {nan, 0, 0}, 4.0));
  EXPECT_FALSE(index.cast_ray({0, 0, 1}, Vector3d::UnitY(), nan));
  EXPECT_FALSE(index.cast_ray({1e300, 0, 1}, -Vector3d::UnitX(), 4.0));
  std::vector<controllers::RowMeshIndex::Segment> segments(3);
  index.cut({nan, 0, 0}, Vector3d::UnitZ(), 4.0, segments);
  EXPECT_TRUE(segments.empty());
}

std::string error_of(const RowMap& map) {
  try {
    const controllers::RowMeshIndex index(map);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RowMeshIndex, RefusesMapsWithoutWellFormedMeshes) {
  RowMap map;
  EXPECT_EQ(error_of(map),
            "the map has no row meshes to measure distances to: give the vehicle a map with "
            "row meshes, such as map: {type: row_mesh}");
  map.meshes.push_back({4, {}});
  map.meshes[0].mesh_W.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, std::nanf("")}};
  map.meshes[0].mesh_W.triangles = {{0, 1, 2}};
  EXPECT_EQ(error_of(map), "mesh of map row 4: vertex 2 of triangle 0 is not finite (3 vertices)");
  map.meshes[0].mesh_W.triangles = {{0, 1, 9}};
  EXPECT_EQ(error_of(map), "mesh of map row 4: vertex 9 of triangle 0 is missing (3 vertices)");
}

TEST(RowMeshIndex, FourHectaresFitInFiftyMegabytes) {
  RowMeshBlock block;
  block.rows = 160;
  block.length_m = 100.0;
  const RowMap map = make_row_mesh_map(block, RandomStream(14, "", "block"));
  EXPECT_GT(test::triangle_count(map), 160u * 50u * 16u);
  const std::size_t before = test::heap_bytes();
  if (before == 0) GTEST_SKIP() << "the sanitizer's heap does not report its size";
  const controllers::RowMeshIndex index(map);
  const double megabytes = 1e-6 * static_cast<double>(test::heap_bytes() - before);
  std::printf("160 rows x 100 m: %zu facets, %.1f MB\n", test::triangle_count(map), megabytes);
  EXPECT_LE(megabytes, 50.0);
  // The corners take at least 36 bytes for each facet: the heap's figure includes the index.
  EXPECT_GE(megabytes, 36e-6 * static_cast<double>(test::triangle_count(map)));
}

/// Four sensors at X on a vehicle in the middle of an alley.
std::vector<controllers::RangeSensorModel> four_cones(double half_angle_rad, int rays) {
  std::vector<controllers::RangeSensorModel> sensors;
  for (const double angle_deg : {45.0, 135.0, -45.0, -135.0}) {
    controllers::RangeSensorModel sensor;
    const double angle = rad_from_deg(angle_deg);
    sensor.X_BS.q = quaternion_from_rpy({0.0, 0.0, angle});
    sensor.X_BS.p = {0.325 * std::cos(angle), 0.325 * std::sin(angle), 0.02};
    sensor.half_angle_rad = half_angle_rad;
    sensor.fan_rays = rays;
    sensors.push_back(sensor);
  }
  return sensors;
}

Pose random_pose(const RowMeshBlock& block, RandomStream& random) {
  const int alley = static_cast<int>(random.uniform(0, block.rows - 1));
  Pose X_WB;
  X_WB.p = row_mesh_ground(block, random.uniform(3.0, block.length_m - 3.0),
                           (alley + 0.5) * block.pitch_m + 0.1 * random.normal()) +
           Vector3d(0, 0, random.uniform(0.9, 1.5));
  X_WB.q = quaternion_from_rpy(
      {0.05 * random.normal(), 0.05 * random.normal(), block.azimuth_rad + 0.1 * random.normal()});
  return X_WB;
}

TEST(RangePrediction, IsTheFirstReturnOfItsFan) {
  const RowMeshBlock block;
  const controllers::RowMeshIndex index(make_row_mesh_map(block, RandomStream(15, "", "block")));
  RandomStream random(16, "", "poses");
  int seen = 0, off_axis = 0;
  for (int k = 0; k < 1000; ++k) {
    const Pose X_WB = random_pose(block, random);
    for (const controllers::RangeSensorModel& sensor : four_cones(rad_from_deg(15.0), 7)) {
      double min_m = 1e300;
      for (int n = -3; n <= 3; ++n) {
        const double angle = rad_from_deg(5.0 * n);
        const Vector3d u =
            X_WB.q * (sensor.X_BS.q * Vector3d(std::cos(angle), std::sin(angle), 0.0));
        const auto hit = index.cast_ray(X_WB * sensor.X_BS.p, u, 4.0);
        if (hit) min_m = std::min(min_m, hit->distance_m);
      }
      const auto prediction = controllers::predict_range(index, X_WB, sensor, 4.0);
      ASSERT_EQ(prediction.has_value(), min_m < 4.0);
      if (!prediction) continue;
      ++seen;
      EXPECT_NEAR(prediction->range_m, min_m, 1e-12);
      EXPECT_EQ(prediction->range_m, prediction->hit.distance_m);
      EXPECT_LT(prediction->slope(), 0.0);
      EXPECT_LT((prediction->origin_W - X_WB * sensor.X_BS.p).norm(), 1e-15);
      controllers::RangeSensorModel single = sensor;
      single.fan_rays = 1;
      const auto straight = controllers::predict_range(index, X_WB, single, 4.0);
      if (straight) {
        EXPECT_LE(prediction->range_m, straight->range_m);
        off_axis += prediction->range_m < straight->range_m;
      }
    }
  }
  EXPECT_GT(seen, 3900);
  EXPECT_GT(off_axis, 3500);  // a sensor at 45 deg hears the side of its cone first
}

TEST(SpreadPrediction, IsTheLineThatFitsARoughWallBest) {
  // A wall that stands back by c |x| of its nearest point, seen at a right angle: the ranges at
  // 0, +-sigma, +-2 sigma are 1 + c |x|, their weights exp(-k^2 / 2).
  constexpr double c = 0.2, sigma = 0.4;
  RowMap map;
  RowMesh wall;
  wall.mesh_W.vertices = {{-5, 1 + 5 * c, -2}, {0, 1, -2}, {5, 1 + 5 * c, -2},
                          {-5, 1 + 5 * c, 2},  {0, 1, 2},  {5, 1 + 5 * c, 2}};
  wall.mesh_W.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  map.meshes.push_back(wall);
  const controllers::RowMeshIndex index(map);
  const controllers::RangeSensorModel ahead;
  const auto spread_at = [&](double x, double std_m, bool stands) {
    const Pose X_WB{quaternion_from_rpy({0, 0, 0.5 * kPi}), {x, 0.0, 0.1}};
    const auto middle = controllers::predict_range(index, X_WB, ahead, 4.0);
    return controllers::predict_spread(index, X_WB, ahead, 4.0, *middle, Vector3d::UnitX(), std_m,
                                       0.7, stands);
  };
  const double w1 = std::exp(-0.5), w2 = std::exp(-2.0), all = 1.0 + 2.0 * w1 + 2.0 * w2;
  const double mean = c * sigma * (2.0 * w1 + 4.0 * w2) / all;
  const controllers::SpreadPrediction about = spread_at(0.0, sigma, false);
  EXPECT_NEAR(about.slope, 0.0, 1e-9) << "either way the wall stands back";
  EXPECT_NEAR(about.range_m, 1.0 + mean, 1e-9);
  EXPECT_NEAR(about.variance_m2, c * c * sigma * sigma * (2.0 * w1 + 8.0 * w2) / all - mean * mean,
              1e-9);
  // On one side of the bend the wall is plane: the fit is its tangent, nothing is left over.
  const controllers::SpreadPrediction one_side = spread_at(2.0, sigma, false);
  EXPECT_NEAR(one_side.slope, c, 1e-9);
  EXPECT_NEAR(one_side.range_m, 1.0 + 2.0 * c, 1e-9);
  EXPECT_NEAR(one_side.variance_m2, 0.0, 1e-9);
  // A place that is known takes the tangent.
  EXPECT_NEAR(spread_at(0.01, 0.0, false).slope, c, 1e-9);
  // One that stands near the bend believes the smaller slope, and that it may be wrong about it.
  const controllers::SpreadPrediction stationary = spread_at(0.1, sigma, true);
  EXPECT_GE(stationary.slope, 0.0);
  EXPECT_LT(stationary.slope, 0.5 * c);
  EXPECT_GT(stationary.variance_m2, about.variance_m2);
}

TEST(RangePrediction, GradientsAreThoseOfCentralDifferences) {
  const RowMeshBlock block;
  const controllers::RowMeshIndex index(make_row_mesh_map(block, RandomStream(17, "", "block")));
  RandomStream random(18, "", "poses");
  constexpr double kStep = 1e-6;
  int compared = 0;
  for (int k = 0; k < 500; ++k) {
    const Pose X_WB = random_pose(block, random);
    for (const controllers::RangeSensorModel& sensor : four_cones(rad_from_deg(15.0), 7)) {
      const auto at = controllers::predict_range(index, X_WB, sensor, 4.0);
      if (!at) continue;
      // Both sides must see the same facet along the same ray: at an edge there is no gradient.
      const auto difference = [&](const Pose& plus, const Pose& minus) -> std::optional<double> {
        const auto a = controllers::predict_range(index, plus, sensor, 4.0);
        const auto b = controllers::predict_range(index, minus, sensor, 4.0);
        if (!a || !b || a->hit.facet != at->hit.facet || b->hit.facet != at->hit.facet ||
            (a->dir_W - b->dir_W).norm() > 1e-4) {
          return std::nullopt;
        }
        return (a->range_m - b->range_m) / (2.0 * kStep);
      };
      for (int axis = 0; axis < 3; ++axis) {
        Pose plus = X_WB, minus = X_WB;
        plus.p[axis] += kStep;
        minus.p[axis] -= kStep;
        if (const auto d = difference(plus, minus)) {
          EXPECT_NEAR(at->gradient_p()[axis], *d, 1e-7);
          ++compared;
        }
      }
      const auto turned = [&](double angle) {
        Pose X = X_WB;
        X.q = Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * X.q;
        return X;
      };
      if (const auto d = difference(turned(kStep), turned(-kStep))) {
        EXPECT_NEAR(at->gradient_yaw(X_WB.p), *d, 1e-6);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 7500);
}

TEST(RangePrediction, VarianceAddsUpMapSensorAndHeading) {
  // A wall across x at 3 m, ray at 60 deg to its normal: N.u = -0.5, range 2 m from x = 2.
  controllers::RangePrediction prediction;
  prediction.range_m = 2.0;
  prediction.origin_W = {2.0, 0.0, 1.0};
  prediction.dir_W = {0.5, std::sqrt(0.75), 0.0};
  prediction.hit.normal_W = {-1.0, 0.0, 0.0};
  prediction.hit.plane_m = -3.0;
  EXPECT_DOUBLE_EQ(prediction.slope(), -0.5);
  EXPECT_LT((prediction.gradient_p() - Vector3d(-2.0, 0.0, 0.0)).norm(), 1e-15);
  // dh/dpsi at the sensor's own place: h tan(60 deg) = d N.(z x u) / (N.u) of the reference.
  const double turn = 2.0 * std::sqrt(3.0);
  EXPECT_NEAR(prediction.gradient_yaw(prediction.origin_W), turn, 1e-14);
  const double variance =
      controllers::range_variance(prediction, prediction.origin_W, 0.03, 10.0, 0.003, 0.01);
  EXPECT_NEAR(variance, 10.0 * 0.0009 / 0.25 + 0.000009 / 3.0 + turn * turn * 1e-4, 1e-15);
}

TEST(RangePrediction, MapErrorsThatStayAreWeighedDown) {
  // The reference's page: r = 10 at 1.5 m/s, 20 Hz, l = 0.3 m.
  EXPECT_NEAR(controllers::correlation_inflation(0.3, 1.5, 0.05), 10.0, 1e-12);
  EXPECT_NEAR(controllers::correlation_inflation(0.3, -1.5, 0.05), 10.0, 1e-12);
  EXPECT_EQ(controllers::correlation_inflation(0.3, 30.0, 0.05), 1.0);
  EXPECT_EQ(controllers::correlation_inflation(0.0, 0.0, 0.05), 1.0);
  EXPECT_EQ(controllers::correlation_inflation(0.3, 0.0, 0.05),
            controllers::kMaxCorrelationInflation);
}

TEST(RangePrediction, FourConesTakeMicrosecondsAndNoHeap) {
  const RowMeshBlock block;
  const RowMap map = make_row_mesh_map(block, RandomStream(19, "", "block"));
  const auto sensors = four_cones(rad_from_deg(15.0), 7);
  // Along an alley at 1.5 m/s, a reading every 50 ms.
  RandomStream random(20, "", "poses");
  std::vector<Pose> poses;
  for (double along_m = 3.0; along_m < 115.0; along_m += 0.075) {
    Pose X_WB = random_pose(block, random);
    X_WB.p = row_mesh_ground(block, along_m, 7.5 * block.pitch_m + 0.05 * random.normal()) +
             Vector3d(0, 0, 1.2);
    poses.push_back(X_WB);
  }
  const controllers::RowMeshIndex index(map);
  std::vector<double> times_us;
  times_us.reserve(poses.size());
  std::vector<controllers::RowMeshIndex::Segment> segments;
  segments.reserve(2000);
  double sum_m = 0.0;
  const AllocationCounter counter;
  for (const Pose& X_WB : poses) {
    const auto start = std::chrono::steady_clock::now();
    for (const controllers::RangeSensorModel& sensor : sensors) {
      if (const auto prediction = controllers::predict_range(index, X_WB, sensor, 4.0)) {
        sum_m += prediction->range_m;
      }
    }
    times_us.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
            .count());
    index.cut(X_WB.p, Vector3d::UnitZ(), 4.0, segments);
  }
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_GT(sum_m, 0.0);
  std::sort(times_us.begin(), times_us.end());
  std::printf("four cones of 7 rays on 16 rows: median %.2f us, 99 %% %.2f us\n",
              times_us[times_us.size() / 2], times_us[times_us.size() * 99 / 100]);
}

}  // namespace
}  // namespace vinerow::test::row_mesh_index_test
