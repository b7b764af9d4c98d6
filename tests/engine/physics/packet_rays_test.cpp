#include "engine/physics/packet_rays.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <bit>

#include "engine/core/random.h"
#include "engine/physics/triangle_ray.h"

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

struct Lane {
  Vector3d p_W, dir_W;
};
using Lanes = std::array<Lane, kPacket>;

Vector3d draw(RandomStream& random, double reach_m) {
  return {random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m),
          random.uniform(-reach_m, reach_m)};
}

/// A fan of four triangles, as a leaf is one.
TriangleBlock make_leaf(RandomStream& random, double size_m, const Vector3d& middle_M) {
  TriangleMesh mesh;
  for (int k = 0; k < 6; ++k) {
    mesh.vertices.push_back((middle_M + draw(random, size_m)).cast<float>());
    if (k >= 2) {
      const auto last = static_cast<std::uint32_t>(k);
      mesh.triangles.push_back({0, last - 1, last});
    }
  }
  TriangleBlock block = make_triangle_blocks(mesh).back();
  EXPECT_EQ(block.slices, 1);
  return block;
}

Vector3d corner_of(const TriangleBlock& block, std::size_t corner, std::size_t triangle) {
  return {block.corners_M[corner][0][triangle], block.corners_M[corner][1][triangle],
          block.corners_M[corner][2][triangle]};
}

/// Rays of eight pixels side by side, towards the corners and edges of a leaf, from near and far,
/// in meshes near and far from their origin: each that the exact test finds to meet the leaf counts
/// as near.
TEST(PacketRays, NoneIsLeftOutThatMeetsATriangle) {
  RandomStream random(1, "", "packets");
  int met = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Eigen::Quaterniond q(
        Eigen::AngleAxisd(random.uniform(0.0, 6.0), draw(random, 1.0).normalized()));
    const Eigen::Matrix3d R_MW = q.toRotationMatrix();
    const Vector3d p_MW = draw(random, 100.0);
    const double mesh_m = trial % 3 == 0 ? 500.0 : 1.0;
    const TriangleBlock leaf = make_leaf(random, trial % 2 ? 0.05 : 0.12, draw(random, mesh_m));
    const double far_m = trial % 5 == 0 ? 1000.0 : 5.0;
    const Vector3d p_M = corner_of(leaf, 0, 0) + draw(random, far_m);
    Lanes lanes;
    for (Lane& lane : lanes) {
      // Corners, points on edges, points inside.
      const auto triangle = static_cast<std::size_t>(random.uniform(0.0, 1.0) * leaf.count);
      const Vector3d a = corner_of(leaf, 0, triangle), b = corner_of(leaf, 1, triangle),
                     c = corner_of(leaf, 2, triangle);
      const double u = random.uniform(0.0, 1.0) < 0.3 ? 0.0 : random.uniform(0.0, 1.0);
      const double v = random.uniform(0.0, 1.0) < 0.3 ? 0.0 : random.uniform(0.0, 1.0 - u);
      const Vector3d aim_M = a + u * (b - a) + v * (c - a);
      lane.p_W = R_MW.transpose() * (p_M - p_MW);
      lane.dir_W = R_MW.transpose() * (aim_M - p_M).normalized();
    }
    PacketRays packet;
    packet.enter(R_MW, p_MW, 0, lanes.data(), 0);
    const unsigned near = packet.find_near(leaf);
    for (std::size_t i = 0; i < kPacket; ++i) {
      double found_m[TriangleBlock::kSize];
      const TriangleRay ray(R_MW * lanes[i].p_W + p_MW, R_MW * lanes[i].dir_W);
      if (ray.distances_m(leaf, found_m) == 0) continue;
      ++met;
      EXPECT_TRUE(near >> i & 1U) << "trial " << trial << ", ray " << i;
    }
  }
  EXPECT_GT(met, 100000);
}

/// A leaf of 10 cm in a plane: rays along its normal that miss it by a tenth of a millimetre are
/// left out.
TEST(PacketRays, ThoseBesideALeafAreLeftOut) {
  TriangleMesh mesh;
  mesh.vertices = {{1.0f, 1.0f, 2.0f}, {1.1f, 1.0f, 2.0f}, {1.0f, 1.1f, 2.0f}};
  mesh.triangles = {{0, 1, 2}};
  const TriangleBlock leaf = make_triangle_blocks(mesh).front();
  const float out = 1e-4f;
  const std::array<std::array<float, 2>, kPacket> places = {{{1.0f - out, 1.05f},
                                                             {1.0f + out, 1.05f},
                                                             {1.05f, 1.0f - out},
                                                             {1.05f, 1.0f + out},
                                                             {1.05f + out, 1.05f + out},
                                                             {1.05f - out, 1.05f - out},
                                                             {3.0f, 3.0f},
                                                             {1.02f, 1.02f}}};
  Lanes lanes;
  for (std::size_t i = 0; i < kPacket; ++i) {
    lanes[i] = {{places[i][0], places[i][1], -40.0}, Vector3d::UnitZ()};
  }
  PacketRays packet;
  packet.enter(Eigen::Matrix3d::Identity(), Vector3d::Zero(), 0, lanes.data(), 0);
  EXPECT_EQ(packet.find_near(leaf) & 0xffU, 0b10101010U);
}

/// Rays across the first one's axis, and in its plane, cannot be ruled out by these numbers.
TEST(PacketRays, ThoseAcrossTheFirstAreNear) {
  RandomStream random(2, "", "leaf");
  const TriangleBlock leaf = make_leaf(random, 0.1, {50.0, 0.0, 0.0});
  Lanes lanes;
  lanes.fill({Vector3d::Zero(), Vector3d::UnitZ()});
  lanes[3].dir_W = Vector3d::UnitX();
  lanes[5].dir_W = Vector3d(0.0, -3.0, 1.0).normalized();
  PacketRays packet;
  packet.enter(Eigen::Matrix3d::Identity(), Vector3d::Zero(), 0, lanes.data(), 0);
  EXPECT_EQ(packet.find_near(leaf) & 0xffU, 0b101000U);
}

TEST(PacketRays, EightNumbersAsBits) {
  const int numbers[8] = {-1, 0, 0, 1, -1, 0, 0, 7};
  EXPECT_EQ(bits_of_eight(numbers), 0b10011001U);
}

}  // namespace
}  // namespace vinerow::physics
