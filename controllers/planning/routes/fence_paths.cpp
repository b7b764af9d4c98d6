#include "controllers/planning/routes/fence_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/angles.h"
#include "engine/math/planar.h"

namespace vinerow::controllers {
namespace {

using Vec = Eigen::Vector2d;

constexpr int kCircleCorners = 48;

/// Whether two segments have a point in common that is inside both, or one ends on the other.
bool do_cross(const Vec& a, const Vec& b, const Vec& c, const Vec& d) {
  const auto side = [](const Vec& p, const Vec& q, const Vec& r) { return cross(q - p, r - p); };
  const double a_side = side(c, d, a), b_side = side(c, d, b);
  const double c_side = side(a, b, c), d_side = side(a, b, d);
  return a_side * b_side <= 0.0 && c_side * d_side <= 0.0 &&
         !(a_side == 0.0 && b_side == 0.0 && c_side == 0.0 && d_side == 0.0);
}

Polygon make_circle(const Vec& centre, double radius_m) {
  Polygon polygon;
  for (int i = 0; i < kCircleCorners; ++i) {
    const double angle_rad = 2.0 * kPi * i / kCircleCorners;
    polygon.push_back(centre + radius_m * Vec(std::cos(angle_rad), std::sin(angle_rad)));
  }
  return polygon;
}

}  // namespace

FencePaths::FencePaths(const io::MissionFile& mission, const GeoOrigin& origin, double margin_m) {
  const LocalFrame frame(origin);
  const auto local = [&](Geodetic place) {
    place.altitude_m = origin.altitude_m;
    return Vec(frame.to_local(place).head<2>());
  };
  for (const io::FencePolygon& fence : mission.fence_polygons) {
    Polygon polygon;
    for (const Geodetic& point : fence.points) polygon.push_back(local(point));
    add(fence.inclusion, without_repeats(polygon));
  }
  for (const io::FenceCircle& fence : mission.fence_circles) {
    // The polygon contains an exclusion circle; an inclusion circle contains its polygon.
    const double outside = fence.inclusion ? 1.0 : 1.0 / std::cos(kPi / kCircleCorners);
    add(fence.inclusion, make_circle(local(fence.centre), outside * fence.radius_m));
  }
  for (const Fence& fence : fences_) add_bends(fence, margin_m);
}

void FencePaths::add(bool inclusion, Polygon polygon) {
  if (polygon.size() < 3) return;
  if (signed_area_m2(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  fences_.push_back({inclusion, std::move(polygon)});
}

void FencePaths::add_bends(const Fence& fence, double margin_m) {
  const Polygon& polygon = fence.polygon;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec before = (polygon[i] - polygon[(i + n - 1) % n]).normalized();
    const Vec after = (polygon[(i + 1) % n] - polygon[i]).normalized();
    const double turn = cross(before, after);
    // Paths bend only at corners with more than 180 degrees of free ground.
    if (fence.inclusion == (turn > 0.0)) continue;
    // Outside is to the right of the edges. The bend is at most three margins from the corner.
    const Vec outwards = Vec(before.y() + after.y(), -before.x() - after.x()).normalized();
    const double share = std::max(outwards.dot(Vec(after.y(), -after.x())), 1.0 / 3.0);
    const Vec bend = polygon[i] + (fence.inclusion ? -1.0 : 1.0) * margin_m / share * outwards;
    if (is_free(bend)) bends_W_.push_back(bend);
  }
}

bool FencePaths::is_free(const Vec& p_W) const {
  return std::all_of(fences_.begin(), fences_.end(), [&](const Fence& fence) {
    return contains(fence.polygon, p_W) == fence.inclusion;
  });
}

bool FencePaths::is_free(const Vec& from_W, const Vec& to_W) const {
  if (!is_free(from_W) || !is_free(to_W)) return false;
  for (const Fence& fence : fences_) {
    const Polygon& polygon = fence.polygon;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      if (do_cross(from_W, to_W, polygon[i], polygon[(i + 1) % polygon.size()])) return false;
    }
  }
  return true;
}

std::optional<std::vector<Vec>> FencePaths::find_path(const Vec& from_W, const Vec& to_W) const {
  if (is_free(from_W, to_W)) return std::vector<Vec>{};
  if (!is_free(from_W) || !is_free(to_W)) return std::nullopt;
  std::vector<Vec> places = {from_W, to_W};
  places.insert(places.end(), bends_W_.begin(), bends_W_.end());
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> length_m(places.size(), kFar);
  std::vector<std::size_t> before(places.size(), 0);
  std::vector<bool> is_done(places.size(), false);
  length_m[0] = 0.0;
  while (true) {
    std::size_t at = places.size();
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!is_done[i] && length_m[i] < (at < places.size() ? length_m[at] : kFar)) at = i;
    }
    if (at == places.size()) return std::nullopt;
    if (at == 1) break;
    is_done[at] = true;
    for (std::size_t i = 1; i < places.size(); ++i) {
      if (is_done[i]) continue;
      const double there_m = length_m[at] + (places[i] - places[at]).norm();
      if (there_m >= length_m[i] || !is_free(places[at], places[i])) continue;
      length_m[i] = there_m;
      before[i] = at;
    }
  }
  std::vector<Vec> path;
  for (std::size_t i = before[1]; i != 0; i = before[i]) path.push_back(places[i]);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace vinerow::controllers
