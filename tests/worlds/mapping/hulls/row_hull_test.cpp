#include "worlds/mapping/hulls/row_hull.h"

#include <gtest/gtest.h>

#include <map>

#include "engine/core/error.h"
#include "tests/worlds/mapping/hulls/synthetic_canopy.h"
#include "worlds/mapping/hulls/hull_fit.h"
#include "worlds/mapping/hulls/row_sections.h"
#include "worlds/mapping/hulls/section_directions.h"

namespace vinerow::mapping::row_hull_test {
namespace {

using test::Sampling;

double flat(double, double) {
  return 0.0;
}

RowCurve straight(double length_m) {
  return RowCurve({Eigen::Vector2d(0, 0), Eigen::Vector2d(length_m, 0)});
}

RowHulls hulls_of(const RowCanopy& row, const RowHullOptions& options = {}) {
  return make_row_hulls(std::span(&row, 1), flat, options).front();
}

RowCanopy row_of(const test::SectionAt& section, double from_m, double to_m,
                 const Sampling& sampling) {
  RandomStream random(3, "test", "canopy");
  RowCanopy row{0, straight(to_m), {}};
  test::sample(test::surface_of(section, from_m, to_m, 0.1), sampling, random, row.points);
  return row;
}

/// Every edge is used once in each direction, and the volume is positive.
void expect_watertight(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_GT(mesh_volume_m3(mesh), 0.0);
  // A closed surface without handles: V - E + F = 2.
  EXPECT_EQ(mesh.vertices.size() + mesh.triangles.size(), edges.size() / 2 + 2);
}

/// Winding number by solid angles (Van Oosterom and Strackee, 1983), and the distance to the
/// nearest triangle: nothing of the sections.
bool brute_force_contains(const TriangleMesh& mesh, const Eigen::Vector3d& p, double tolerance_m,
                          double* margin_m) {
  double winding = 0.0, nearest_m = 1e9;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>() - p;
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>() - p;
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>() - p;
    winding += std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                 b.dot(c) * a.norm() + c.dot(a) * b.norm());
    // Least of |u a + v b + w c|, by halving the triangle's longest edge would do too; this is the
    // plane where the foot is inside, else the edges.
    const Eigen::Vector3d n = (b - a).cross(c - a).normalized();
    const Eigen::Vector3d foot = a.dot(n) * n;
    const bool inside = n.dot((b - a).cross(foot - a)) >= 0 &&
                        n.dot((c - b).cross(foot - b)) >= 0 && n.dot((a - c).cross(foot - c)) >= 0;
    if (inside) nearest_m = std::min(nearest_m, foot.norm());
    const Eigen::Vector3d corners[] = {a, b, c};
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d &from = corners[k], along = corners[(k + 1) % 3] - from;
      const double share = std::clamp(-from.dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest_m = std::min(nearest_m, (from + share * along).norm());
    }
  }
  const bool is_inside = winding > kPi;  // 2 pi inside, 0 outside
  *margin_m = is_inside ? nearest_m : std::abs(nearest_m - tolerance_m);
  return is_inside || nearest_m <= tolerance_m;
}

TEST(RowHull, BoxCylinderAndConeHaveTheirVolume) {
  const double length_m = 20.0;
  const auto all = [](double) { return 1.0; };
  constexpr double kPerimeter_m = 3.26;  // of the ellipse, by Ramanujan
  const auto thinner = [](double s_m) { return 1.0 - 0.03 * s_m; };
  const struct {
    const char* name;
    test::SectionAt section;
    double volume_m3;
    double surface_m2;  // without the ends
  } cases[] = {
      {"box", test::box(0.6, 0.6, 2.0), 0.6 * 1.4 * length_m, 4.0 * length_m},
      {"cylinder", test::ellipse(0.3, 0.7, 1.3, all), kPi * 0.3 * 0.7 * length_m,
       kPerimeter_m * length_m},
      // Scales from 1 to 0.4: a third of (1 + 0.4 + 0.16).
      {"cone", test::ellipse(0.3, 0.7, 1.3, thinner), kPi * 0.3 * 0.7 * length_m * 1.56 / 3.0,
       0.7 * kPerimeter_m * length_m},
  };
  for (const auto& shape : cases) {
    for (const double noise_m : {0.0, 0.01}) {
      SCOPED_TRACE(::testing::Message() << shape.name << " " << noise_m);
      const RowHulls hulls = hulls_of(row_of(shape.section, 0.0, length_m, {.noise_m = noise_m}));
      ASSERT_EQ(hulls.meshes_W.size(), 1u);
      // The octagon around an ellipse is 5.5 % larger; for 98.5 % of the points within 1 cm, faces
      // stand 2.17 sigma - 1 cm outside of the truth.
      const double shell_m = std::max(0.0, 2.17 * noise_m - 0.01);
      EXPECT_GT(hulls.figures.volume_m3, 0.95 * shape.volume_m3);
      EXPECT_LT(hulls.figures.volume_m3, 1.055 * shape.volume_m3 + shell_m * shape.surface_m2);
      EXPECT_NEAR(hulls.canopy_volume_m3 / shape.volume_m3, 1.0, 0.03);
      EXPECT_GE(hulls.figures.containment, 0.98);
      EXPECT_NEAR(hulls.figures.length_m, length_m, 0.01 + 4.0 * noise_m);
      expect_watertight(hulls.meshes_W[0]);
    }
  }
}

TEST(RowHull, SimulatedRowKeepsVolumeContainmentAndSize) {
  for (const double noise_m : {0.005, 0.01, 0.015}) {
    SCOPED_TRACE(noise_m);
    const test::VineRow row = test::vine_row(0, 118.0, {.noise_m = noise_m});
    RowHullOptions options;
    options.containment = 0.98;
    const RowHulls hulls = hulls_of(row.canopy, options);
    // The underside that is not seen, 6 % of the volume, pays for what noise swells.
    EXPECT_NEAR(hulls.figures.volume_m3 / row.volume_m3, 1.0, 0.05);
    EXPECT_GE(hulls.figures.containment, 0.98);
    EXPECT_LE(16.0 * static_cast<double>(hulls.mesh_bytes), 2.5e6);
    // What the hull says of the noise holds the canopy's lumps, too.
    EXPECT_GT(hulls.noise_m, noise_m);
    EXPECT_LT(hulls.noise_m, noise_m + 0.01);
  }
}

TEST(RowHull, NoiseSwellsTheMeshButNotTheEstimateOfTheCanopy) {
  // With 98 % of points within 1 cm, normal noise of sigma moves the faces out by 2.05 sigma - 1 cm
  // at least; the surface is 3.3 m2 per metre of a volume of 0.66 m3.
  const double length_m = 20.0, volume_m3 = kPi * 0.3 * 0.7 * length_m;
  const auto cylinder = test::ellipse(0.3, 0.7, 1.3, [](double) { return 1.0; });
  const struct { double noise_m, per_m2; } cases[] = {{0.02, 1500.0}, {0.05, 200.0}};
  for (const auto& [noise_m, per_m2] : cases) {
    SCOPED_TRACE(noise_m);
    const RowHulls hulls =
        hulls_of(row_of(cylinder, 0.0, length_m, {.per_m2 = per_m2, .noise_m = noise_m}));
    EXPECT_GE(hulls.figures.containment, 0.98);
    EXPECT_GT(hulls.figures.volume_m3, volume_m3);
    EXPECT_LT(hulls.figures.volume_m3, volume_m3 * (1.0 + 3.3 / 0.66 * 2.5 * noise_m));
    EXPECT_NEAR(hulls.canopy_volume_m3 / volume_m3, 1.0, 0.05);
    EXPECT_NEAR(hulls.noise_m, noise_m, 0.2 * noise_m);
  }
}

TEST(RowHull, ContainmentIsThatOfBruteForceOverTriangles) {
  const test::VineRow row = test::vine_row(1, 6.0, {.per_m2 = 400.0, .noise_m = 0.02});
  const RowHulls hulls = hulls_of(row.canopy);
  ASSERT_EQ(hulls.chains.size(), 1u);
  const double tolerance_m = 0.01;
  const HullContainment containment(hulls.chains, tolerance_m);
  RandomStream random(5, "test", "points");
  int inside = 0, near = 0;
  for (int i = 0; i < 20'000; ++i) {
    Eigen::Vector3d p(random.uniform(-0.1, 6.1), random.uniform(-0.45, 0.45),
                      random.uniform(0.4, 2.3));
    // Half of them close to the surface.
    if (i % 2 == 0) {
      const auto& q = row.canopy.points[static_cast<std::size_t>(i) % row.canopy.points.size()];
      p = q.cast<double>() +
          0.01 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    }
    double margin_m = 0.0;
    const bool wanted = brute_force_contains(hulls.meshes_W[0], p, tolerance_m, &margin_m);
    if (margin_m < 1e-5) continue;  // the mesh is of floats
    ASSERT_EQ(containment.contains(p), wanted) << p.transpose() << " margin " << margin_m;
    inside += wanted;
    near += !wanted && margin_m < 0.02;
  }
  EXPECT_GT(inside, 5000);
  EXPECT_GT(near, 500);
}

TEST(RowHull, RandomCanopiesAreWatertightAndTheirSectionsConvex) {
  RandomStream random(11, "test", "shapes");
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    const double half_m = random.uniform(0.1, 0.6), high_m = random.uniform(0.2, 1.2);
    const double wave_m = random.uniform(0.4, 3.0), depth = random.uniform(0.0, 0.5);
    const auto section = test::ellipse(half_m, high_m, 1.5, [=](double s_m) {
      return 1.0 - depth * (0.5 + 0.5 * std::sin(2.0 * kPi * s_m / wave_m));
    });
    RowHullOptions options;
    options.corners = 5 + i;
    const RowCanopy row = row_of(section, 0.0, 8.0,
                                 {.per_m2 = random.uniform(100.0, 1000.0),
                                  .side_share = random.uniform(0.2, 1.0),
                                  .noise_m = random.uniform(0.0, 0.05),
                                  .underside = i % 2 == 0});
    const RowHulls hulls = hulls_of(row, options);
    ASSERT_EQ(hulls.meshes_W.size(), 1u);
    expect_watertight(hulls.meshes_W[0]);
    const HullChain& chain = hulls.chains[0];
    EXPECT_EQ(chain.directions.count(), options.corners);
    for (int j = 0; j < chain.sections(); ++j) {
      for (int k = 0; k < options.corners; ++k) {
        EXPECT_GT(chain.directions.side_m(chain.section(j), k), 0.001);
      }
    }
    // A straight row on flat ground: the sections and the mesh of floats have the same volume.
    EXPECT_NEAR(volume_m3(chain), hulls.figures.volume_m3, 1e-5 * hulls.figures.volume_m3);
    EXPECT_GE(hulls.figures.containment, 0.97);
  }
}

TEST(RowHull, CurvedRowOnASlopeFollowsItsLine) {
  // A quarter of a circle of 30 m, one point per degree.
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= 90; ++i) {
    const double angle = i * kPi / 180.0;
    points.emplace_back(500.0 + 30.0 * std::sin(angle), 300.0 - 30.0 * std::cos(angle));
  }
  const auto slope = [](double x, double y) { return 0.1 * x - 0.05 * y; };
  RowCanopy row{4, RowCurve(points), {}};
  RandomStream random(3, "test", "canopy");
  const double length_m = row.line.length_m();
  test::sample(test::surface_of(test::box(0.6, 0.6, 2.0), 0.0, length_m, 0.1), {.noise_m = 0.005},
               random, row.points);
  const RowHulls hulls = make_row_hulls(std::span(&row, 1), slope, {}).front();
  ASSERT_EQ(hulls.meshes_W.size(), 1u);
  EXPECT_EQ(hulls.figures.row, 4);
  // A box around its middle line has the line's length (Pappus), on the slope the same height.
  EXPECT_NEAR(hulls.figures.volume_m3 / (0.6 * 1.4 * length_m), 1.0, 0.05);
  double margin_m = 0.0;
  int inside = 0;
  const int count = 400;
  for (int i = 0; i < count; ++i) {
    const auto& p = row.points[static_cast<std::size_t>(i) * row.points.size() / count];
    const Eigen::Vector2d d = row.line.direction_W(p.x()), on = row.line.point_W(p.x());
    const Eigen::Vector2d q = on + p.y() * Eigen::Vector2d(-d.y(), d.x());
    const Eigen::Vector3d p_W(q.x(), q.y(), slope(on.x(), on.y()) + p.z());
    // The chord of sections 2 m apart is 17 mm off the arc; options keep it to 10.
    inside += brute_force_contains(hulls.meshes_W[0], p_W, 0.02, &margin_m);
  }
  EXPECT_GE(inside, static_cast<int>(0.98 * count));
  EXPECT_NEAR(hulls.figures.bearing_deg, 45.0, 0.1);
  EXPECT_NEAR(hulls.figures.first_W.z(), slope(500.0, 270.0), 0.01);
}

TEST(RowHull, GapsSplitWhereTheyAreLongEnough) {
  RowCanopy row{0, straight(20.0), {}};
  RandomStream random(3, "test", "canopy");
  for (const auto& [from_m, to_m] :
       {std::pair(0.0, 7.0), std::pair(7.3, 12.0), std::pair(13.2, 20.0)}) {
    test::sample(test::surface_of(test::box(0.6, 0.6, 2.0), from_m, to_m, 0.1), {.noise_m = 0.01},
                 random, row.points);
  }
  const RowHulls hulls = hulls_of(row);
  ASSERT_EQ(hulls.chains.size(), 2u);
  ASSERT_EQ(hulls.figures.gaps_m.size(), 1u);
  EXPECT_NEAR(hulls.figures.gaps_m[0].first, 12.0, 0.03);
  EXPECT_NEAR(hulls.figures.gaps_m[0].second, 13.2, 0.03);
  RowHullOptions short_gaps;
  short_gaps.gap_m = 0.2;
  EXPECT_EQ(hulls_of(row, short_gaps).chains.size(), 3u);
}

TEST(RowHull, PostInAGapIsNoCanopy) {
  RowCanopy row{0, straight(20.0), {}};
  RandomStream random(5, "test", "canopy");
  for (const auto& [from_m, to_m] : {std::pair(0.0, 9.0), std::pair(9.9, 20.0)}) {
    test::sample(test::surface_of(test::box(0.6, 0.6, 2.0), from_m, to_m, 0.1), {.noise_m = 0.01},
                 random, row.points);
  }
  const RowHulls without = hulls_of(row);
  test::sample(test::surface_of(test::box(0.1, 0.0, 2.1), 9.4, 9.5, 0.1), {.noise_m = 0.01}, random,
               row.points);
  const RowHulls hulls = hulls_of(row);
  ASSERT_EQ(hulls.chains.size(), 2u);
  ASSERT_EQ(hulls.figures.gaps_m.size(), 1u);
  EXPECT_NEAR(hulls.figures.gaps_m[0].first, 9.0, 0.03);
  EXPECT_NEAR(hulls.figures.gaps_m[0].second, 9.9, 0.03);
  EXPECT_NEAR(hulls.figures.volume_m3 / without.figures.volume_m3, 1.0, 0.01);
}

TEST(RowHull, StrayPointsMoveNothing) {
  for (const double per_m2 : {1500.0, 200.0}) {
    SCOPED_TRACE(per_m2);
    test::VineRow row = test::vine_row(2, 40.0, {.per_m2 = per_m2, .noise_m = 0.01});
    const RowHulls clean = hulls_of(row.canopy);
    RandomStream random(9, "test", "strays");
    const std::size_t strays = row.canopy.points.size() / 100;
    for (std::size_t i = 0; i < strays; ++i) {
      row.canopy.points.emplace_back(random.uniform(-1.0, 41.0), random.uniform(-1.2, 1.2),
                                     random.uniform(0.3, 3.5));
    }
    const RowHulls hulls = hulls_of(row.canopy);
    ASSERT_EQ(hulls.chains.size(), 1u);
    EXPECT_NEAR(hulls.figures.volume_m3 / clean.figures.volume_m3, 1.0, 0.04);
    EXPECT_NEAR(hulls.figures.length_m, 40.0, 0.3);
    EXPECT_GE(hulls.figures.containment, 0.97);
  }
}

TEST(RowHull, BudgetIsKeptOverAllRows) {
  std::vector<RowCanopy> rows;
  for (int i = 0; i < 3; ++i) {
    rows.push_back(test::vine_row(i, 30.0, {.per_m2 = 600.0, .noise_m = 0.01}).canopy);
  }
  const auto run = [&](double per_m, double bytes) {
    RowHullOptions options;
    options.budget_bytes_per_m = per_m;
    options.budget_bytes = bytes;
    return make_row_hulls(rows, flat, options);
  };
  const auto bytes_of = [](const std::vector<RowHulls>& all) {
    double bytes = 0.0, counted = 0.0;
    for (const RowHulls& hulls : all) {
      bytes += static_cast<double>(hulls.mesh_bytes);
      for (const TriangleMesh& mesh : hulls.meshes_W) {
        counted += 12.0 * static_cast<double>(mesh.vertices.size()) +
                   13.0 * static_cast<double>(mesh.triangles.size());
      }
    }
    EXPECT_EQ(bytes, counted);
    return bytes;
  };
  const auto free = run(0.0, 0.0), tight = run(700.0, 0.0), total = run(0.0, 40'000.0);
  EXPECT_GT(bytes_of(free), 90.0 * 1000.0);
  // To the last section of 304 bytes.
  EXPECT_LE(bytes_of(tight), 90.0 * 700.0);
  EXPECT_GT(bytes_of(tight), 90.0 * 700.0 - 700.0);
  EXPECT_LE(bytes_of(total), 40'000.0);
  EXPECT_GT(bytes_of(total), 40'000.0 - 700.0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(free[i].simplify_error_m, tight[i].simplify_error_m);
    EXPECT_GE(tight[i].figures.containment, 0.98);
  }
}

// A small budget takes sections away. Where a row swells between two that stay, the straight side
// between them passes deep inside of it: who does not see the points out there takes the section
// for cheap, and moves the sides of the whole row out afterwards to get them back.
TEST(RowHull, ASmallBudgetDoesNotSwellARowOfBushes) {
  for (const double thin_m : {0.10, 0.25}) {
    // Bushes of 0.5 m more, 0.3 m long, 3 m apart.
    const auto octagon = [&](double s_m) {
      const double from_bush_m = std::remainder(s_m - 1.5, 3.0);
      const double radius_m = thin_m + 0.5 * std::exp(-from_bush_m * from_bush_m / (0.15 * 0.15));
      std::vector<Eigen::Vector2d> corners;
      for (int k = 0; k < 8; ++k) {
        const double angle = (k + 0.5) * kPi / 4.0;
        corners.emplace_back(radius_m * std::cos(angle), 1.0 + radius_m * std::sin(angle));
      }
      return corners;
    };
    const RowCanopy row = row_of(octagon, 0.0, 24.0, {.per_m2 = 600.0, .noise_m = 0.03});
    const auto volume_m3 = [&](double bytes_per_m) {
      RowHullOptions options;
      options.budget_bytes_per_m = bytes_per_m;
      const RowHulls hulls = hulls_of(row, options);
      double sum_m3 = 0.0;
      for (const TriangleMesh& mesh : hulls.meshes_W) sum_m3 += mesh_volume_m3(mesh);
      return sum_m3;
    };
    const double wide_m3 = volume_m3(1300.0);
    // 1.04 and 1.07 are reached; blind beyond 3 cm it was 1.9 and 2.0 of the thin row, 1.6 of the
    // other.
    EXPECT_LT(volume_m3(700.0) / wide_m3, 1.15) << thin_m;
    EXPECT_LT(volume_m3(400.0) / wide_m3, 1.15) << thin_m;
  }
}

TEST(RowHull, DirectionsAreCloseToTheSmallestPolygon) {
  const auto section = test::ellipse(0.3, 0.7, 1.3, [](double) { return 1.0; });
  const RowCanopy row = row_of(section, 0.0, 5.0, {.per_m2 = 4000.0});
  const RowStretches cut = slice_row(row, {});
  for (const int corners : {6, 8, 12}) {
    const HullDirections directions = choose_directions(cut.stretches, corners);
    std::vector<double> h;
    for (int k = 0; k < corners; ++k) {
      const Eigen::Vector2d n = directions.normal(k);
      h.push_back(1.3 * n.y() + std::hypot(0.3 * n.x(), 0.7 * n.y()));
    }
    // The affine image of the regular polygon around a circle.
    const double min_m2 = 0.3 * 0.7 * corners * std::tan(kPi / corners);
    EXPECT_GE(directions.area_m2(h.data()), min_m2 * (1.0 - 1e-9)) << corners;
    EXPECT_LE(directions.area_m2(h.data()), min_m2 * 1.04) << corners;
  }
}

TEST(RowHull, TheSameBitsTwiceAndInAnyCompany) {
  std::vector<RowCanopy> rows;
  for (int i = 0; i < 4; ++i) {
    rows.push_back(test::vine_row(i, 15.0, {.per_m2 = 300.0, .noise_m = 0.02}).canopy);
  }
  RowHullOptions options;
  options.budget_bytes_per_m = 0.0;  // the only thing that rows share
  const auto first = make_row_hulls(rows, flat, options),
             again = make_row_hulls(rows, flat, options);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(first[i].meshes_W[0].vertices, again[i].meshes_W[0].vertices);
    EXPECT_EQ(first[i].meshes_W[0].triangles, again[i].meshes_W[0].triangles);
    EXPECT_EQ(first[i].figures.containment, again[i].figures.containment);
    EXPECT_EQ(hulls_of(rows[i], options).meshes_W[0].vertices, first[i].meshes_W[0].vertices);
  }
}

TEST(RowHull, TooFewPointsMakeNoMeshButANote) {
  const auto expect_none = [](std::vector<Eigen::Vector3f> points) {
    const RowCanopy row{5, straight(10.0), std::move(points)};
    const RowHulls hulls = hulls_of(row);
    EXPECT_TRUE(hulls.meshes_W.empty());
    ASSERT_EQ(hulls.notes.size(), 1u);
    EXPECT_EQ(hulls.notes[0].rfind("row 5: its ", 0), 0u) << hulls.notes[0];
    EXPECT_EQ(hulls.figures.points, static_cast<std::int64_t>(row.points.size()));
    EXPECT_EQ(hulls.figures.containment, 0.0);
  };
  expect_none({});
  expect_none({{1, 0, 1}, {2, 0.1f, 1.2f}, {3, 0, 1.1f}});
  expect_none(std::vector<Eigen::Vector3f>(10'000, {4.0f, 0.1f, 1.5f}));
  std::vector<Eigen::Vector3f> slice;
  RandomStream random(1, "test", "slice");
  for (int i = 0; i < 500; ++i) {
    slice.push_back(
        Eigen::Vector3d(5.0, random.uniform(-0.3, 0.3), random.uniform(0.6, 2.0)).cast<float>());
  }
  expect_none(slice);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect_none(std::vector<Eigen::Vector3f>(50, {nan, 0.0f, 1.0f}));
  expect_none(std::vector<Eigen::Vector3f>(50, {1e30f, -1e30f, 1e30f}));
}

TEST(RowHull, PointsOnOneLineMakeAThinMesh) {
  // A wire: no section has any area of its own.
  std::vector<Eigen::Vector3f> wire;
  for (int i = 0; i < 2000; ++i) wire.emplace_back(0.005f * static_cast<float>(i), 0.0f, 1.5f);
  const RowHulls hulls = hulls_of({0, straight(10.0), wire});
  ASSERT_EQ(hulls.meshes_W.size(), 1u);
  expect_watertight(hulls.meshes_W[0]);
  EXPECT_LT(hulls.figures.volume_m3, 10.0 * 0.1 * 0.1);
  EXPECT_GE(hulls.figures.containment, 0.98);
}

TEST(RowHull, OptionsOutOfRangeAreRefused) {
  const auto error_of = [](auto&& change) {
    RowHullOptions options;
    change(options);
    try {
      make_row_hulls({}, flat, options);
    } catch (const ConfigError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error_of([](RowHullOptions& o) { o.corners = 4; }),
            "row meshes: corners = 4, must be 5 to 16");
  EXPECT_EQ(error_of([](RowHullOptions& o) { o.slice_m = 0.0; }),
            "row meshes: slice_m = 0, must be 0.02 to 5 m");
  EXPECT_EQ(error_of([](RowHullOptions& o) { o.containment = 1.5; }),
            "row meshes: containment = 1.5, must be 0.5 to 1");
  EXPECT_EQ(error_of([](RowHullOptions& o) { o.budget_bytes = std::nan(""); }),
            "row meshes: budget_bytes = nan, must be >= 0");
  EXPECT_TRUE(make_row_hulls({}, flat).empty());
}

}  // namespace
}  // namespace vinerow::mapping::row_hull_test
