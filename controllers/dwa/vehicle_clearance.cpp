#include "controllers/dwa/vehicle_clearance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/constants.h"

namespace vinerow::controllers {
namespace {

constexpr int kCoverDiscs = 3;
constexpr double kInsideSpacing_m = 0.05;

/// Distance of a point inside a convex outline from its edge; negative outside.
double depth_in(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& p) {
  double depth_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d along = outline[(i + 1) % outline.size()] - outline[i];
    depth_m = std::min(depth_m, cross(along, p - outline[i]) / along.norm());
  }
  return depth_m;
}

/// The largest discs inside an outline: about the points of a grid, without those inside others.
std::vector<DiscOutline::Disc> fill_with_discs(const std::vector<Eigen::Vector2d>& outline,
                                               const Eigen::AlignedBox2d& box) {
  // An even number of intervals puts points on the axis, where the largest discs are.
  const Eigen::Vector2i count =
      2 * (0.5 * box.sizes() / kInsideSpacing_m).array().ceil().cast<int>();
  std::vector<DiscOutline::Disc> all, largest;
  for (int i = 0; i <= count.x(); ++i) {
    for (int j = 0; j <= count.y(); ++j) {
      const Eigen::Vector2d share(static_cast<double>(i) / count.x(),
                                  static_cast<double>(j) / count.y());
      const Eigen::Vector2d p = box.min() + box.sizes().cwiseProduct(share);
      const double depth_m = depth_in(outline, p);
      if (depth_m > kInsideSpacing_m) all.push_back({p, depth_m, true});
    }
  }
  for (const DiscOutline::Disc& disc : all) {
    const bool is_inside_another = std::any_of(all.begin(), all.end(), [&](const auto& other) {
      return other.radius_m > disc.radius_m &&
             (other.centre_B - disc.centre_B).norm() + disc.radius_m < other.radius_m + 1e-9;
    });
    if (!is_inside_another) largest.push_back(disc);
  }
  return largest;
}

}  // namespace

DiscOutline DiscOutline::three_circles(double radius_m, double spacing_m) {
  DiscOutline result;
  for (const double x : {-spacing_m, 0.0, spacing_m}) {
    result.discs_.push_back({{x, 0.0}, radius_m});
  }
  return result;
}

DiscOutline DiscOutline::circumscribed(const std::vector<Eigen::Vector2d>& outline_B) {
  double radius_m = 0.0;
  for (const Eigen::Vector2d& p : outline_B) radius_m = std::max(radius_m, p.norm());
  DiscOutline result;
  result.discs_.push_back({{0.0, 0.0}, radius_m});
  return result;
}

DiscOutline DiscOutline::polygon(const std::vector<Eigen::Vector2d>& outline_B, double spacing_m) {
  DiscOutline result;
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < outline_B.size(); ++i) {
    const Eigen::Vector2d &a = outline_B[i], &b = outline_B[(i + 1) % outline_B.size()];
    box.extend(a);
    const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing_m)));
    for (int k = 0; k < parts; ++k) result.discs_.push_back({a + (b - a) * k / parts, 0.0});
  }
  // A small object inside touches no edge; discs inside detect it.
  for (const Disc& disc : fill_with_discs(outline_B, box)) result.discs_.push_back(disc);
  const double slice_m = box.sizes().x() / kCoverDiscs;
  for (int i = 0; i < kCoverDiscs; ++i) {
    result.cover_.push_back({{box.min().x() + (i + 0.5) * slice_m, box.center().y()},
                             std::hypot(0.5 * slice_m, 0.5 * box.sizes().y())});
  }
  return result;
}

double DiscOutline::uncovered_m(const std::vector<Eigen::Vector2d>& outline_B) const {
  double worst_m = 0.0;
  constexpr int kParts = 50;
  for (std::size_t i = 0; i < outline_B.size(); ++i) {
    for (int k = 0; k < kParts; ++k) {
      const Eigen::Vector2d p =
          outline_B[i] + (outline_B[(i + 1) % outline_B.size()] - outline_B[i]) * k / kParts;
      double gap_m = std::numeric_limits<double>::infinity();
      for (const Disc& disc : discs_) {
        gap_m = std::min(gap_m, (p - disc.centre_B).norm() - disc.radius_m);
      }
      worst_m = std::max(worst_m, gap_m);
    }
  }
  return worst_m;
}

FreeSpace FreeSpaceFinder::measure_discs(const std::vector<DiscOutline::Disc>& discs,
                                         const Eigen::Vector2d& p_W,
                                         const Eigen::Vector2d& ahead) const {
  FreeSpace clearance{kInfinity, kInfinity};
  const Eigen::Vector2d left = left_of(ahead);
  for (const DiscOutline::Disc& disc : discs) {
    const Eigen::Vector2d at = p_W + disc.centre_B.x() * ahead + disc.centre_B.y() * left;
    const double known_m = known_->at(at) - disc.radius_m;
    const double unknown_m = unknown_->empty() ? kInfinity : unknown_->at(at) - disc.radius_m;
    if (!disc.only_overlap || known_m < 0.0)
      clearance.known_m = std::min(clearance.known_m, known_m);
    if (!disc.only_overlap || unknown_m < 0.0)
      clearance.unknown_m = std::min(clearance.unknown_m, unknown_m);
  }
  return clearance;
}

FreeSpace FreeSpaceFinder::measure(const DiscOutline& outline, const Eigen::Vector2d& p_W,
                                   const Eigen::Vector2d& ahead) const {
  return measure_discs(outline.discs(), p_W, ahead);
}

bool FreeSpaceFinder::meets(const DiscOutline& outline, const Eigen::Vector2d& p_W,
                            const Eigen::Vector2d& ahead, const FreeSpace& need) const {
  if (!outline.cover().empty() && measure_discs(outline.cover(), p_W, ahead).meets(need)) {
    return true;
  }
  const Eigen::Vector2d left = left_of(ahead);
  for (const DiscOutline::Disc& disc : outline.discs()) {
    const Eigen::Vector2d at = p_W + disc.centre_B.x() * ahead + disc.centre_B.y() * left;
    const double known_m = known_->at(at) - disc.radius_m;
    if (known_m < need.known_m && (!disc.only_overlap || known_m < 0.0)) return false;
    if (unknown_->empty()) continue;
    const double unknown_m = unknown_->at(at) - disc.radius_m;
    if (unknown_m < need.unknown_m && (!disc.only_overlap || unknown_m < 0.0)) return false;
  }
  return true;
}

}  // namespace vinerow::controllers
