#include "engine/physics/triangle_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/random.h"
#include "engine/physics/triangle_ray.h"

namespace vinerow::physics {
namespace {

/// Leaves of two triangles each, far apart, and between them some triangles on their own.
TriangleMesh make_leaves(int leaves, RandomStream& random) {
  TriangleMesh mesh;
  const auto corner = [&](double reach_m) {
    return Eigen::Vector3f(random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m),
                           random.uniform(-reach_m, reach_m));
  };
  for (int leaf = 0; leaf < leaves; ++leaf) {
    const Eigen::Vector3f middle = corner(20.0);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 4; ++k) mesh.vertices.push_back(middle + corner(0.1));
    mesh.triangles.push_back({first, first + 1, first + 2});
    if (leaf % 5 != 0) mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

TEST(TriangleBlocks, EachTriangleIsInOneOfThem) {
  RandomStream random(1, "", "leaves");
  const TriangleMesh mesh = make_leaves(200, random);
  std::uint32_t next = 0;
  int of_two = 0;
  for (const TriangleBlock& block : make_triangle_blocks(mesh)) {
    EXPECT_EQ(block.first, next);
    ASSERT_GE(block.count, 1u);
    ASSERT_LE(block.count, 2u) << "leaves stand far apart";
    of_two += block.count == 2;
    next += block.count;
    for (std::uint32_t i = 0; i < block.count; ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(block.corners_M[corner][axis][i],
                    mesh.vertices[mesh.triangles[block.first + i][corner]][axis]);
        }
      }
    }
  }
  EXPECT_EQ(next, mesh.triangles.size());
  EXPECT_GT(of_two, 100);
  EXPECT_TRUE(make_triangle_blocks(TriangleMesh{}).empty());
}

TEST(TriangleBlocks, TheFacesOfAStripFillThem) {
  TriangleMesh strip;
  for (int i = 0; i <= 40; ++i) {
    strip.vertices.emplace_back(0.5f * (i / 2), i % 2, 0.1f * (i % 3));
    if (i >= 2) {
      const auto last = static_cast<std::uint32_t>(i);
      strip.triangles.push_back({last - 2, last - 1, last});
    }
  }
  EXPECT_EQ(strip.triangles.size(), 39u);
  EXPECT_LE(make_triangle_blocks(strip).size(), 11u);
}

/// Against all ways to cut a short mesh into blocks.
TEST(TriangleBlocks, TheyCostTheLeastOfAllCuts) {
  RandomStream random(3, "", "cuts");
  for (int trial = 0; trial < 20; ++trial) {
    TriangleMesh mesh;
    constexpr std::uint32_t kCount = 9;
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    std::vector<Eigen::AlignedBox3f> boxes;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      middle.x() += static_cast<float>(random.uniform(0.0, 1.5));
      boxes.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3f away(static_cast<float>(random.uniform(-1.0, 1.0)),
                                   static_cast<float>(random.uniform(-1.0, 1.0)),
                                   static_cast<float>(random.uniform(-1.0, 1.0)));
        mesh.vertices.push_back(middle + away);
        boxes.back().extend(mesh.vertices.back());
      }
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const auto surface = [](const Eigen::AlignedBox3f& box) {
      const Eigen::Vector3d s = box.sizes().cast<double>();
      return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
    };
    double mean = 0.0;
    for (const Eigen::AlignedBox3f& box : boxes) mean += surface(box) / kCount;
    // Bit i of a cut: a block begins at triangle i + 1. A block costs as much as a mean triangle.
    const auto cost_of = [&](unsigned cut) {
      double cost = 0.0;
      for (std::uint32_t first = 0; first < kCount;) {
        Eigen::AlignedBox3f box = boxes[first];
        std::uint32_t end = first + 1;
        for (; end < kCount && (cut >> (end - 1) & 1) == 0; ++end) box.extend(boxes[end]);
        cost += end - first <= TriangleBlock::kSize ? surface(box) + mean : 1e9;
        first = end;
      }
      return cost;
    };
    double least = 1e9;
    for (unsigned cut = 0; cut < 1u << (kCount - 1); ++cut) least = std::min(least, cost_of(cut));
    unsigned chosen = 0;
    for (const TriangleBlock& block : make_triangle_blocks(mesh)) {
      if (block.first > 0) chosen |= 1u << (block.first - 1);
    }
    EXPECT_NEAR(cost_of(chosen), least, 1e-5 * least);
  }
}

/// A wire of 5 m at 45 degrees, of two triangles, 4 mm wide.
TriangleMesh make_wire(const Eigen::Vector3f& dir) {
  const Eigen::Vector3f side = 0.004f * Eigen::Vector3f::UnitZ();
  TriangleMesh mesh;
  mesh.vertices = {Eigen::Vector3f::Zero(), 5.0f * dir, 5.0f * dir + side, side};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(TriangleBlocks, ASlantingWireHasABoxForEachSlice) {
  const double half = std::sqrt(0.5);
  const TriangleMesh wire = make_wire(Eigen::Vector3d(half, half, 0.0).cast<float>());
  const std::vector<TriangleBlock> blocks = make_triangle_blocks(wire);
  ASSERT_EQ(blocks.size(), 8u) << "slices of 0.5 m of 3.5 m along x";
  Pose X;
  X.p = {100.0, -20.0, 3.0};
  X.q = Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.1, 0.2, 1.0).normalized());
  std::vector<Eigen::AlignedBox3d> boxes, boxes_X;
  double surface_m2 = 0.0;
  for (const TriangleBlock& block : blocks) {
    EXPECT_EQ(block.first, 0u);
    EXPECT_EQ(block.count, 2u);
    boxes.push_back(calc_box(block, Pose{}));
    boxes_X.push_back(calc_box(block, X));
    surface_m2 += boxes.back().sizes().x() * boxes.back().sizes().y();
  }
  // Squares along the diagonal of one of 5 m / sqrt(2): an eighth of it.
  EXPECT_NEAR(surface_m2, 12.5 / 8.0, 1e-5);
  // Every point of the wire is in a slice's box.
  RandomStream random(7, "", "wire");
  for (int k = 0; k < 2000; ++k) {
    const double u = random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0 - u);
    const auto& [a, b, c] = wire.triangles[static_cast<std::size_t>(k % 2)];
    const Eigen::Vector3d p = wire.vertices[a].cast<double>() * (1.0 - u - v) +
                              wire.vertices[b].cast<double>() * u +
                              wire.vertices[c].cast<double>() * v;
    const auto is_in = [](const std::vector<Eigen::AlignedBox3d>& all, const Eigen::Vector3d& q) {
      return std::any_of(all.begin(), all.end(), [&](const Eigen::AlignedBox3d& box) {
        return box.squaredExteriorDistance(q) < 1e-24;
      });
    };
    EXPECT_TRUE(is_in(boxes, p)) << p.transpose();
    EXPECT_TRUE(is_in(boxes_X, X * p)) << p.transpose();
  }
}

TEST(TriangleBlocks, OthersAreNotCut) {
  EXPECT_EQ(make_triangle_blocks(make_wire(Eigen::Vector3f::UnitX())).size(), 1u)
      << "along an axis";
  TriangleMesh ground;
  ground.vertices = {{0, 0, 0}, {40, 0, 1}, {40, 40, 2}, {0, 40, 1}};
  ground.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(make_triangle_blocks(ground).size(), 1u) << "slices have as large boxes together";
}

/// Rays through corners, edges and the inside of triangles, beside them and in their planes.
TEST(TriangleBlocks, ARayMeetsFourTrianglesAsItMeetsEachAlone) {
  RandomStream random(2, "", "rays");
  const TriangleMesh mesh = make_leaves(60, random);
  const std::vector<TriangleBlock> blocks = make_triangle_blocks(mesh);
  int met = 0, missed = 0, last_met = 0;
  const auto compare = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& dir,
                           const TriangleBlock& block) {
    const TriangleRay ray(p, dir);
    double found_m[TriangleBlock::kSize];
    const unsigned bits = ray.distances_m(block, found_m);
    ASSERT_LT(bits, 1u << block.count) << "a triangle that is not there";
    for (std::uint32_t i = 0; i < block.count; ++i) {
      const auto& [a, b, c] = mesh.triangles[block.first + i];
      const auto alone_m = ray.distance_m(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
      ASSERT_EQ((bits >> i & 1) != 0, alone_m.has_value());
      if (alone_m) {
        EXPECT_EQ(found_m[i], *alone_m);
      }
      ++(alone_m ? met : missed);
      last_met += alone_m && i == 1;
    }
  };
  for (const TriangleBlock& block : blocks) {
    for (int k = 0; k < 60; ++k) {
      const auto& vertices = mesh.triangles[block.first + (k % 2 ? block.count - 1 : 0)];
      const Eigen::Vector3d a = mesh.vertices[vertices[0]].cast<double>();
      const Eigen::Vector3d b = mesh.vertices[vertices[1]].cast<double>();
      const Eigen::Vector3d c = mesh.vertices[vertices[2]].cast<double>();
      const double u = k % 3 == 0 ? 0.0 : random.uniform(-0.1, 1.0);
      const double v = k % 5 == 0 ? 0.0 : random.uniform(-0.1, 1.0);
      const Eigen::Vector3d aim = a + u * (b - a) + v * (c - a);
      Eigen::Vector3d p(random.uniform(-30.0, 30.0), random.uniform(-30.0, 30.0),
                        random.uniform(-30.0, 30.0));
      if (k % 7 == 0) p = aim + 3.0 * (b - a);  // in the plane
      if (k % 11 == 0) p = 2.0 * aim - p;
      Eigen::Vector3d dir = (aim - p).normalized();
      if (k % 13 == 0) dir = -dir;                               // behind the start
      if (k % 17 == 0) p = aim, dir = Eigen::Vector3d::UnitZ();  // starts on it
      compare(p, dir, block);
    }
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(missed, 1000);
  EXPECT_GT(last_met, 300);
  compare(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()),
          Eigen::Vector3d::UnitX(), blocks[0]);
}

}  // namespace
}  // namespace vinerow::physics
