#include "worlds/parts/canopy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/check.h"
#include "engine/math/angles.h"
#include "worlds/parts/primitives.h"

namespace vinerow::worlds {
namespace {

constexpr double kExponent =
    3.0;  // of the super-ellipse: boxy as a hedged row, yet round at the edges

/// Point of the unit super-ellipse in direction of the angle.
Eigen::Vector2d unit_point(double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double r = std::pow(std::pow(std::abs(c), kExponent) + std::pow(std::abs(s), kExponent),
                            -1.0 / kExponent);
  return {r * c, r * s};
}

double cut_normal(RandomStream& random) {
  return std::clamp(random.normal(), -2.0, 2.0);
}

}  // namespace

const ParameterTable<CanopyParams>& canopy_table() {
  using P = CanopyParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("canopy_base_m", "m", &P::base_m, between(0.0, 10.0),
                  "lowest leaves above ground")
          .number("canopy_top_m", "m", &P::top_m, above(0.0, 30.0), "highest leaves above ground")
          .number("canopy_variation", "", &P::variation, between(0.0, 0.4),
                  "standard deviation of width and height from vine to vine, as a share")
          .number("canopy_step_m", "m", &P::step_m, {.min = 0.05},
                  "distance between sections of the canopy's hull")
          .rule([](const P& p) -> std::string {
            if (p.base_m < p.top_m) return "";
            return fmt::format("canopy_base_m = {} m, must be < canopy_top_m = {} m", p.base_m,
                               p.top_m);
          });
  return table;
}

mapping::CanopySize canopy_size(const CanopyParams& params) {
  return {params.width_m, params.base_m, params.top_m};
}

CanopyShape::CanopyShape(const CanopyParams& params, double length_m, int vine_count,
                         RandomStream random)
    : length_m_(length_m) {
  VINEROW_DEMAND(length_m > 0.0 && vine_count >= 1);
  const double height_m = params.top_m - params.base_m;
  for (int i = 0; i < vine_count; ++i) {
    CanopySection vine;
    vine.width_m = params.width_m * (1.0 + params.variation * cut_normal(random));
    vine.top_m = params.top_m + 0.5 * params.variation * height_m * cut_normal(random);
    vine.base_m = params.base_m * (1.0 + 0.5 * params.variation * cut_normal(random));
    vine.shift_m = 0.3 * params.variation * params.width_m * cut_normal(random);
    vines_.push_back(vine);
  }
  // Shoots stick out and leave hollows: lumps of a hand's breadth, relative to the width.
  lump_m_ = 0.25 * params.variation * params.width_m;
  for (double& phase : phases_) phase = random.uniform(0.0, 2.0 * kPi);
}

CanopySection CanopyShape::section(double u_m) const {
  const auto count = static_cast<double>(vines_.size());
  const double at = std::clamp(u_m / length_m_ * count - 0.5, 0.0, count - 1.0);
  const auto i = static_cast<std::size_t>(at);
  const std::size_t j = std::min(i + 1, vines_.size() - 1);
  const double share = 0.5 - 0.5 * std::cos(kPi * (at - static_cast<double>(i)));
  const auto blend = [&](double CanopySection::*field) {
    return (1.0 - share) * vines_[i].*field + share * vines_[j].*field;
  };
  return {blend(&CanopySection::width_m), blend(&CanopySection::base_m),
          blend(&CanopySection::top_m), blend(&CanopySection::shift_m)};
}

Eigen::Vector2d CanopyShape::surface_point(double u_m, double angle_rad) const {
  const CanopySection s = section(u_m);
  const Eigen::Vector2d unit = unit_point(angle_rad);
  const double lump_m =
      lump_m_ * (0.5 * std::sin(2.0 * kPi * u_m / 0.83 + 2.0 * angle_rad + phases_[0]) +
                 0.5 * std::sin(2.0 * kPi * u_m / 0.47 - 3.0 * angle_rad + phases_[1]) +
                 0.4 * std::sin(2.0 * kPi * u_m / 0.31 + 5.0 * angle_rad + phases_[2]));
  const double middle_m = 0.5 * (s.base_m + s.top_m);
  return {s.shift_m + (0.5 * s.width_m + lump_m) * unit.x(),
          middle_m + (0.5 * (s.top_m - s.base_m) + lump_m) * unit.y()};
}

Eigen::Vector2d CanopyShape::surface_normal(double u_m, double angle_rad) const {
  const CanopySection s = section(u_m);
  const Eigen::Vector2d unit = unit_point(angle_rad);
  // Gradient of the super-ellipse's equation.
  const auto power = [](double v) {
    return std::copysign(std::pow(std::abs(v), kExponent - 1.0), v);
  };
  return Eigen::Vector2d(power(unit.x()) / s.width_m, power(unit.y()) / (s.top_m - s.base_m))
      .normalized();
}

TriangleMesh make_canopy_hull(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                              const std::vector<CanopyStretch>& stretches,
                              const CanopyParams& params) {
  VINEROW_DEMAND(!stretches.empty());
  TriangleMesh mesh;
  const double start_m = stretches.front().start_m, end_m = stretches.back().end_m;
  const double length_m = end_m - start_m;
  const int sections = std::max(2, static_cast<int>(std::ceil(length_m / params.step_m)));
  const int n = params.ring_points;
  const Eigen::Vector3f kGreen(0.05f, 0.13f, 0.03f);
  std::size_t at = 0;
  for (int i = 0; i <= sections; ++i) {
    const double s_m = start_m + length_m * i / sections;
    while (at + 1 < stretches.size() && s_m >= stretches[at].end_m) ++at;
    const CanopyStretch& stretch = stretches[at];
    const double share =
        std::clamp((s_m - stretch.start_m) / (stretch.end_m - stretch.start_m), 0.0, 1.0);
    const double u_m = share * stretch.shape->length_m();
    // The last hand's breadth at both ends is rounded off.
    const double to_end_m = std::min(s_m - start_m, end_m - s_m);
    const double kRound_m = 0.25;
    const double t = std::clamp(to_end_m / kRound_m, 0.0, 1.0);
    const double shrink = 0.35 + 0.65 * std::sqrt(t * (2.0 - t));
    const CanopySection section = stretch.shape->section(u_m);
    const Eigen::Vector2d middle(section.shift_m, 0.5 * (section.base_m + section.top_m));
    const Pose X_WR = mapping::row_frame(row, ground, s_m);
    for (int k = 0; k < n; ++k) {
      // Half a step of turn puts no vertex at the very bottom, which keeps the underside flat.
      const double angle = 2.0 * kPi * (k + 0.5) / n;
      const Eigen::Vector2d p =
          middle + shrink * (stretch.shape->surface_point(u_m, angle) - middle);
      mesh.vertices.push_back((X_WR * Eigen::Vector3d(0.0, p.x(), p.y())).cast<float>());
    }
  }
  const auto count = static_cast<std::uint32_t>(n);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(sections); ++i) {
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t a = i * count + k, b = i * count + (k + 1) % count;
      mesh.triangles.push_back({a, b + count, a + count});
      mesh.triangles.push_back({a, b, b + count});
    }
  }
  const auto last = static_cast<std::uint32_t>(sections) * count;
  for (std::uint32_t k = 1; k + 1 < count; ++k) {
    mesh.triangles.push_back({0, k + 1, k});
    mesh.triangles.push_back({last, last + k, last + k + 1});
  }
  mesh.colours.assign(mesh.vertices.size(), kGreen);
  calc_vertex_normals(mesh);
  return mesh;
}

}  // namespace vinerow::worlds
