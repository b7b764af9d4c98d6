#include "worlds/mesh/sdf_rows.h"

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"
#include "engine/math/decomposition.h"
#include "worlds/mapping/model/row_map.h"

namespace vinerow::worlds {
namespace {

bool has_prefix(const io::SdfInclude& include, const std::string& prefix) {
  return !prefix.empty() && include.model.rfind(prefix, 0) == 0;
}

/// Pieces of one line.
struct Line {
  Eigen::Vector2d direction;
  Eigen::Vector2d origin;
  double start_m, end_m;  // along the direction from the origin
};

}  // namespace

std::vector<mapping::RowCurve> find_sdf_rows(const std::vector<io::SdfInclude>& includes,
                                             const std::string& prefix, double piece_length_m,
                                             double apart_m) {
  std::vector<Line> lines;
  for (const io::SdfInclude& include : includes) {
    if (!has_prefix(include, prefix)) continue;
    const double yaw = yaw_from_quaternion(include.X_WM.q);
    const Eigen::Vector2d d(std::cos(yaw), std::sin(yaw)), p = include.X_WM.p.head<2>();
    const auto same_line = [&](const Line& line) {
      const Eigen::Vector2d across(-line.direction.y(), line.direction.x());
      return std::abs(line.direction.dot(d)) > std::cos(rad_from_deg(10.0)) &&
             std::abs(across.dot(p - line.origin)) < apart_m;
    };
    const auto found = std::find_if(lines.begin(), lines.end(), same_line);
    const double half_m = 0.5 * piece_length_m;
    if (found == lines.end()) {
      lines.push_back({d, p, -half_m, half_m});
    } else {
      const double s_m = found->direction.dot(p - found->origin);
      found->start_m = std::min(found->start_m, s_m - half_m);
      found->end_m = std::max(found->end_m, s_m + half_m);
    }
  }
  std::vector<mapping::RowCurve> rows;
  for (const Line& line : lines) {
    rows.emplace_back(std::vector<Eigen::Vector2d>{line.origin + line.start_m * line.direction,
                                                   line.origin + line.end_m * line.direction});
  }
  return rows.empty() ? rows : mapping::order_rows(std::move(rows));
}

Eigen::Vector3d fit_ground_plane(const std::vector<io::SdfInclude>& includes,
                                 const std::string& prefix) {
  std::vector<Eigen::Vector3d> feet;
  for (const io::SdfInclude& include : includes) {
    if (has_prefix(include, prefix)) feet.push_back(include.X_WM.p);
  }
  if (feet.empty()) return Eigen::Vector3d::Zero();
  Eigen::MatrixXd A(feet.size(), 3);
  Eigen::VectorXd b(feet.size());
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    A.row(row) << 1.0, feet[i].x(), feet[i].y();
    b(row) = feet[i].z();
  }
  // Pieces in one line leave the slope across it open: the least norm gives none.
  return solve_least_norm(A, b);
}

}  // namespace vinerow::worlds
