#pragma once
/// Eight rays against the triangles of a block, in single precision: which of them are worth a test
/// in double precision. Most rays that meet the box of a leaf miss the leaf.

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "engine/physics/triangle_blocks.h"
#include "engine/physics/vector8.h"

namespace vinerow::physics {

/// Rays that Embree follows together.
constexpr std::size_t kPacket = 8;

/// The rays of a packet, and the same in the frame of a mesh.
///
/// As in TriangleRay the axes are permuted, here for all rays as suits the first one: z is the axis
/// along which it mostly runs. Each ray is x = x_0 + s_x z, y = y_0 + s_y z, and a corner q is at
/// (q_x - x_0 - s_x q_z, q_y - y_0 - s_y q_z) from it. Both numbers stay as small as the mesh,
/// however far away the ray starts, so that single precision goes a long way:
/// TriangleBlock::area_error is the bound of its errors.
class PacketRays {
 public:
  /// Rays that lean more against z count as near to everything.
  static constexpr float kMostSlope = 2.0f;

  unsigned entry = std::numeric_limits<unsigned>::max();  ///< mesh whose frame it is

  /// Takes over the rays in the frame of a mesh. @param first  lane that takes part
  template <class Lane>
  VINEROW_ALWAYS_INLINE void enter(const Eigen::Matrix3d& R_MW, const Eigen::Vector3d& p_MW,
                                   unsigned entry_of_mesh, const Lane* lanes, unsigned first) {
    entry = entry_of_mesh;
    choose_axes(R_MW * lanes[first].dir_W);
    for (std::size_t half = 0; half < kPacket; half += 4) {
      double p_W[3][4], dir_W[3][4];
      for (std::size_t i = 0; i < 4; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          p_W[axis][i] = lanes[half + i].p_W[axis];
          dir_W[axis][i] = lanes[half + i].dir_W[axis];
        }
      }
      const auto in_mesh = [&R_MW](const double(&v_W)[3][4], int axis, Double4& v_M) {
        Double4 v[3];
        __builtin_memcpy(v, v_W, sizeof v);
        v_M = R_MW(axis, 0) * v[0] + R_MW(axis, 1) * v[1] + R_MW(axis, 2) * v[2];
      };
      Double4 dir_x, dir_y, dir_z, x, y, z;
      in_mesh(dir_W, x_, dir_x);
      in_mesh(dir_W, y_, dir_y);
      in_mesh(dir_W, z_, dir_z);
      in_mesh(p_W, x_, x);
      in_mesh(p_W, y_, y);
      in_mesh(p_W, z_, z);
      z += p_MW[z_];
      const Double4 slope_x = dir_x / dir_z, slope_y = dir_y / dir_z;
      const auto store = [half](const Double4& values, float(&to)[kPacket]) {
        for (std::size_t i = 0; i < 4; ++i) to[half + i] = static_cast<float>(values[i]);
      };
      store(slope_x, slope_x_);
      store(slope_y, slope_y_);
      store((x + p_MW[x_]) - slope_x * z, x_0_);
      store((y + p_MW[y_]) - slope_y * z, y_0_);
    }
    Float8 x, y;
    load8(slope_x_, x);
    load8(slope_y_, y);
    const Mask8 is_fit =
        (x <= kMostSlope) & (x >= -kMostSlope) & (y <= kMostSlope) & (y >= -kMostSlope);
    unfit_ = ~bits_of(is_fit);
  }

  /// Bit i: ray i may meet a triangle of the block. None is left out that TriangleRay finds to meet
  /// one.
  VINEROW_ALWAYS_INLINE unsigned find_near(const TriangleBlock& block) const {
    Mask8 misses_all = Mask8{} - 1;
    Float8 x_0, y_0, slope_x, slope_y;
    load8(x_0_, x_0);
    load8(y_0_, y_0);
    load8(slope_x_, slope_x);
    load8(slope_y_, slope_y);
    for (std::uint32_t i = 0; i < block.count; ++i) {
      Float8 x[3], y[3];
      for (int corner = 0; corner < 3; ++corner) {
        const auto& q_M = block.corners_M[corner];
        x[corner] = (q_M[x_][i] - x_0) - slope_x * q_M[z_][i];
        y[corner] = (q_M[y_][i] - y_0) - slope_y * q_M[z_][i];
      }
      // Twice the signed areas of the triangles formed by the ray and each edge.
      const Float8 u = x[2] * y[1] - y[2] * x[1];
      const Float8 v = x[0] * y[2] - y[0] * x[2];
      const Float8 w = x[1] * y[0] - y[1] * x[0];
      const Float8 vw_low = v < w ? v : w, vw_high = v > w ? v : w;
      const Float8 low = u < vw_low ? u : vw_low, high = u > vw_high ? u : vw_high;
      misses_all &= (low < -block.area_error) & (high > block.area_error);
    }
    return ~bits_of(misses_all) | unfit_;
  }

 private:
  VINEROW_ALWAYS_INLINE void choose_axes(const Eigen::Vector3d& dir_M) {
    const double x = std::abs(dir_M.x()), y = std::abs(dir_M.y()), z = std::abs(dir_M.z());
    z_ = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
    x_ = z_ == 2 ? 0 : z_ + 1;
    y_ = z_ == 0 ? 2 : z_ - 1;
  }

  int x_ = 0, y_ = 1, z_ = 2;
  unsigned unfit_ = 0;  ///< bit i: ray i leans more
  float x_0_[kPacket], y_0_[kPacket], slope_x_[kPacket], slope_y_[kPacket];
};

}  // namespace vinerow::physics
