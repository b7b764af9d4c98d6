#include "worlds/parts/crate.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vinerow::worlds {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3f kBoard(0.42f, 0.29f, 0.16f), kFrame(0.33f, 0.215f, 0.11f),
    kShade(0.05f, 0.035f, 0.02f);

/// A closed box with flat faces.
void append_box(TriangleMesh& mesh, const Vector3d& low, const Vector3d& high,
                const Vector3f& colour) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      Vector3f normal = Vector3f::Zero();
      normal[axis] = side == 1 ? 1.0f : -1.0f;
      for (const auto& corner :
           {std::array{0, 0}, std::array{1, 0}, std::array{1, 1}, std::array{0, 1}}) {
        Vector3d p;
        p[axis] = side == 1 ? high[axis] : low[axis];
        p[u] = corner[0] == 1 ? high[u] : low[u];
        p[v] = corner[1] == 1 ? high[v] : low[v];
        mesh.vertices.push_back(p.cast<float>());
        mesh.normals.push_back(normal);
        mesh.colours.push_back(colour);
      }
      // u, v and the axis are right-handed: counter-clockwise seen from the axis' positive side.
      if (side == 1) {
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
      } else {
        mesh.triangles.push_back({first, first + 2, first + 1});
        mesh.triangles.push_back({first, first + 3, first + 2});
      }
    }
  }
}

/// No two boards of a crate have quite the same tone.
Vector3f tone_of(int board) {
  constexpr std::array<float, 7> kTones = {1.0f, 0.86f, 1.1f, 0.93f, 1.18f, 0.8f, 1.04f};
  return kTones[static_cast<std::size_t>(board) % kTones.size()] * kBoard;
}

}  // namespace

TriangleMesh make_box(const Vector3d& size_m, double foot_m) {
  TriangleMesh mesh;
  const Vector3d half(0.5 * size_m.x(), 0.5 * size_m.y(), 0.0);
  append_box(mesh, Vector3d(0, 0, -foot_m) - half, Vector3d(0, 0, size_m.z()) + half,
             {0.7f, 0.7f, 0.7f});
  mesh.colours.clear();
  return mesh;
}

TriangleMesh make_crate(const Vector3d& size_m, double foot_m) {
  constexpr double kBoard_m = 0.11, kGap_m = 0.008;
  const double thick_m = std::min(0.02, 0.1 * size_m.minCoeff());
  const double frame_m = std::min(0.09, 0.2 * size_m.z());
  const double x = 0.5 * size_m.x(), y = 0.5 * size_m.y(), top = size_m.z();
  TriangleMesh mesh;
  const double inner = 1.5 * thick_m;
  append_box(mesh, {-x + inner, -y + inner, -foot_m}, {x - inner, y - inner, top - thick_m},
             kShade);
  int board = 0;
  // Upright boards on all four sides, set back behind the frames.
  const auto boards = [&](double length_m, auto&& place) {
    const int count = std::max(1, static_cast<int>(std::lround(length_m / kBoard_m)));
    const double step_m = length_m / count;
    for (int k = 0; k < count; ++k) {
      const double from_m = -0.5 * length_m + k * step_m + 0.5 * kGap_m;
      place(from_m, from_m + step_m - kGap_m, tone_of(board++));
    }
  };
  const double set = 0.5 * thick_m;  // boards stand back by this
  for (const double side : {-1.0, 1.0}) {
    boards(size_m.x() - 2.0 * thick_m, [&](double from, double to, const Vector3f& tone) {
      const double outer = side * (y - set), back = side * (y - inner);
      append_box(mesh, {from, std::min(outer, back), -foot_m},
                 {to, std::max(outer, back), top - thick_m}, tone);
    });
    boards(size_m.y() - 2.0 * thick_m, [&](double from, double to, const Vector3f& tone) {
      const double outer = side * (x - set), back = side * (x - inner);
      append_box(mesh, {std::min(outer, back), from, -foot_m},
                 {std::max(outer, back), to, top - thick_m}, tone);
    });
  }
  // Frames: bands around foot and head, posts at the corners.
  const double head_m = top - thick_m - frame_m;
  for (const auto& band : {std::array{-foot_m, frame_m}, std::array{head_m, top - thick_m}}) {
    for (const double side : {-1.0, 1.0}) {
      append_box(mesh, {-x + thick_m, std::min(side * y, side * (y - thick_m)), band[0]},
                 {x - thick_m, std::max(side * y, side * (y - thick_m)), band[1]}, kFrame);
      append_box(mesh, {std::min(side * x, side * (x - thick_m)), -y + thick_m, band[0]},
                 {std::max(side * x, side * (x - thick_m)), y - thick_m, band[1]}, kFrame);
    }
  }
  for (const double i : {-1.0, 1.0}) {
    for (const double j : {-1.0, 1.0}) {
      append_box(
          mesh, {std::min(i * x, i * (x - thick_m)), std::min(j * y, j * (y - thick_m)), -foot_m},
          {std::max(i * x, i * (x - thick_m)), std::max(j * y, j * (y - thick_m)), top - thick_m},
          0.9f * kFrame);
    }
  }
  boards(size_m.x(), [&](double from, double to, const Vector3f& tone) {
    append_box(mesh, {from, -y, top - thick_m}, {to, y, top}, 1.1f * tone);
  });
  return mesh;
}

}  // namespace vinerow::worlds
