#include "worlds/mapping/hulls/hull_figures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vinerow::mapping {
namespace {

constexpr double kStep_m = 0.05;  // of the table that finds the interval of an s

/// Section of the chain at s between sections j and j + 1.
std::array<double, 16> section_at(const HullChain& chain, int j, double s_m) {
  std::array<double, 16> h{};
  const double share =
      std::clamp((s_m - chain.s_m[j]) / (chain.s_m[j + 1] - chain.s_m[j]), 0.0, 1.0);
  const double *a = chain.section(j), *b = chain.section(j + 1);
  for (int k = 0; k < chain.directions.count(); ++k) h[k] = (1.0 - share) * a[k] + share * b[k];
  return h;
}

/// From a point outside side k of a section, in its plane, to the section; no less than the truth.
double distance_in_plane_m(const HullDirections& directions, const double* h, int k,
                           const Eigen::Vector2d& q) {
  const Eigen::Vector2d a = directions.corner(h, directions.before(k));
  const Eigen::Vector2d b = directions.corner(h, k);
  const Eigen::Vector2d ab = b - a;
  const double t = std::clamp((q - a).dot(ab) / std::max(ab.squaredNorm(), 1e-18), 0.0, 1.0);
  return (a + t * ab - q).norm();
}

}  // namespace

double distance_to_triangle_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                              const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return ap.norm();
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return bp.norm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return (ap - d1 / (d1 - d3) * ab).norm();
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return cp.norm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return (ap - d2 / (d2 - d6) * ac).norm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).norm();
  }
  return std::abs(ap.dot(ab.cross(ac).normalized()));
}

HullContainment::HullContainment(const std::vector<HullChain>& chains, double tolerance_m)
    : tolerance_m_(tolerance_m) {
  for (const HullChain& chain : chains) {
    for (int j = 0; j + 1 < chain.sections(); ++j) {
      double steepest = 0.0;
      const auto look_at = [&](int i) {
        for (int k = 0; k < chain.directions.count(); ++k) {
          steepest = std::max(steepest, std::abs(chain.section(i + 1)[k] - chain.section(i)[k]) /
                                            (chain.s_m[i + 1] - chain.s_m[i]));
        }
      };
      look_at(j);
      for (int i = j; i > 0 && chain.s_m[i] + tolerance_m >= chain.s_m[j]; --i) look_at(i - 1);
      for (int i = j + 1;
           i + 1 < chain.sections() && chain.s_m[i] - tolerance_m <= chain.s_m[j + 1]; ++i) {
        look_at(i);
      }
      intervals_.push_back({&chain, j, steepest});
    }
  }
  if (intervals_.empty()) return;
  low_m_ = chains.front().from_m();
  const auto steps = static_cast<std::size_t>((chains.back().to_m() - low_m_) / kStep_m) + 1;
  std::uint32_t at = 0;
  for (std::size_t i = 0; i < steps; ++i) {
    const double s_m = low_m_ + static_cast<double>(i) * kStep_m;
    while (at + 1 < intervals_.size() &&
           intervals_[at].chain->s_m[intervals_[at].section + 1] < s_m) {
      ++at;
    }
    starts_.push_back(at);
  }
}

bool HullContainment::contains(const Eigen::Vector3d& p) const {
  if (intervals_.empty() || !p.allFinite()) return false;
  const double step =
      std::clamp((p.x() - low_m_) / kStep_m, 0.0, static_cast<double>(starts_.size() - 1));
  std::size_t at = starts_[static_cast<std::size_t>(step)];
  const auto ends_m = [&](std::size_t i) {
    return intervals_[i].chain->s_m[intervals_[i].section + 1];
  };
  while (at + 1 < intervals_.size() && ends_m(at) < p.x()) ++at;
  // Between two chains: near enough to the one before, or to the one behind.
  if (contains_near(intervals_[at], p)) return true;
  const double starts_m = intervals_[at].chain->s_m[intervals_[at].section];
  return p.x() < starts_m && at > 0 && contains_near(intervals_[at - 1], p);
}

bool HullContainment::contains_near(const Interval& interval, const Eigen::Vector3d& p) const {
  const HullChain& chain = *interval.chain;
  const int c = chain.directions.count();
  if (p.x() < chain.from_m() - tolerance_m_ || p.x() > chain.to_m() + tolerance_m_) return false;
  const bool beyond_end = p.x() < chain.from_m() || p.x() > chain.to_m();
  const auto h = section_at(chain, interval.section, p.x());
  const Eigen::Vector2d q = p.tail<2>();
  double max_m = -std::numeric_limits<double>::infinity();
  int side = 0;
  for (int k = 0; k < c; ++k) {
    const double excess_m = chain.directions.normal(k).dot(q) - h[k];
    if (excess_m > max_m) {
      max_m = excess_m;
      side = k;
    }
  }
  if (max_m <= 0.0) return true;  // beyond an end: within the tolerance of its cap
  // Within the tolerance d along the row a side rises by at most steepest * d.
  if (max_m > tolerance_m_ * std::hypot(1.0, interval.steepest)) return false;
  if (!beyond_end && distance_in_plane_m(chain.directions, h.data(), side, q) <= tolerance_m_) {
    return true;
  }
  int first = interval.section, last = interval.section;
  while (first > 0 && chain.s_m[first] > p.x() - tolerance_m_) --first;
  while (last + 2 < chain.sections() && chain.s_m[last + 1] < p.x() + tolerance_m_) ++last;
  const auto corner = [&](int j, int k) {
    const Eigen::Vector2d at = chain.directions.corner(chain.section(j), k % c);
    return Eigen::Vector3d(chain.s_m[j], at.x(), at.y());
  };
  const auto near = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& d) {
    return distance_to_triangle_m(p, a, b, d) <= tolerance_m_;
  };
  for (int j = first; j <= last; ++j) {
    for (int k = 0; k < c; ++k) {
      const Eigen::Vector3d a = corner(j, k), b = corner(j, k + 1);
      const Eigen::Vector3d ahead = corner(j + 1, k), b_ahead = corner(j + 1, k + 1);
      if (near(a, b, b_ahead) || near(a, b_ahead, ahead)) return true;
    }
  }
  for (const int j : {0, chain.sections() - 1}) {
    if (std::abs(chain.s_m[j] - p.x()) > tolerance_m_) continue;
    for (int k = 1; k + 1 < c; ++k) {
      if (near(corner(j, 0), corner(j, k), corner(j, k + 1))) return true;
    }
  }
  return false;
}

std::int64_t HullContainment::count(const std::vector<Eigen::Vector3f>& points) const {
  std::int64_t inside = 0;
  for (const Eigen::Vector3f& p : points) inside += contains(p.cast<double>());
  return inside;
}

double mesh_volume_m3(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  // From a point of the mesh itself: far from the origin nothing is lost.
  const Eigen::Vector3d origin = mesh.vertices.front().cast<double>();
  double six_m3 = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>() - origin;
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>() - origin;
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>() - origin;
    six_m3 += a.dot(b.cross(c));
  }
  return six_m3 / 6.0;
}

SectionMeans mean_sections(const std::vector<HullChain>& chains) {
  SectionMeans means;
  for (const HullChain& chain : chains) {
    const int c = chain.directions.count();
    const auto extent = [&](int j) {
      Eigen::Vector2d low = chain.directions.corner(chain.section(j), 0), high = low;
      for (int k = 1; k < c; ++k) {
        const Eigen::Vector2d corner = chain.directions.corner(chain.section(j), k);
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
      return Eigen::Vector3d(low.y(), high.y(), high.x() - low.x());
    };
    for (int j = 0; j + 1 < chain.sections(); ++j) {
      const double length_m = chain.s_m[j + 1] - chain.s_m[j];
      const Eigen::Vector3d mean = 0.5 * (extent(j) + extent(j + 1));
      means.base_m += length_m * mean[0];
      means.top_m += length_m * mean[1];
      means.width_m += length_m * mean[2];
      means.length_m += length_m;
    }
  }
  if (means.length_m > 0.0) {
    means.base_m /= means.length_m;
    means.top_m /= means.length_m;
    means.width_m /= means.length_m;
  }
  return means;
}

}  // namespace vinerow::mapping
