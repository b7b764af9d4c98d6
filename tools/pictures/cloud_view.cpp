#include "tools/pictures/cloud_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/render/cameras.h"

namespace vinerow::tools {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr float kFar_m = std::numeric_limits<float>::infinity();
constexpr double kNear_m = 0.05;

}  // namespace

CloudView::CloudView(const render::Camera& camera, int width, int height)
    : width_(width * kFine),
      height_(height * kFine),
      px_per_rad_(0.5 * height_ / std::tan(0.5 * camera.fov_rad)),
      R_CW_(camera.X_WC.q.toRotationMatrix().transpose()),
      eye_W_(camera.X_WC.p),
      depth_m_(static_cast<std::size_t>(width_) * height_, kFar_m),
      pixels_(depth_m_.size()) {}

bool CloudView::project(const Vector3d& p_W, Projected& out) const {
  const Vector3d p_C = R_CW_ * (p_W - eye_W_);
  if (p_C.z() < kNear_m) return false;
  out.x = static_cast<float>(0.5 * width_ + px_per_rad_ * p_C.x() / p_C.z());
  out.y = static_cast<float>(0.5 * height_ + px_per_rad_ * p_C.y() / p_C.z());
  out.depth_m = static_cast<float>(p_C.z());
  return true;
}

std::optional<Vector2d> CloudView::pixel_of(const Vector3d& p_W) const {
  Projected p;
  if (!project(p_W, p)) return std::nullopt;
  return Vector2d(p.x, p.y) / kFine;
}

void CloudView::put(int x, int y, float depth_m, const Rgb& colour) {
  const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
  if (!(depth_m < depth_m_[at])) return;
  depth_m_[at] = depth_m;
  for (std::size_t c = 0; c < 3; ++c) {
    pixels_[at][c] = static_cast<std::uint8_t>(std::clamp(colour[c], 0, 255));
  }
}

void CloudView::splat(const Vector3d& p_W, float size_m, const Rgb& colour) {
  Projected p;
  if (!project(p_W, p)) return;
  // Reject points far outside; this also keeps the numbers small enough for int.
  if (!(p.x > -64 && p.y > -64 && p.x < width_ + 64 && p.y < height_ + 64)) return;
  constexpr float kLargest_px = 40.0f;
  const float size_px = std::min(kLargest_px, size_m * static_cast<float>(px_per_rad_) / p.depth_m);
  const int side = std::max(kFine, static_cast<int>(std::ceil(size_px)));
  const int left = static_cast<int>(std::floor(p.x - 0.5f * static_cast<float>(side - 1)));
  const int top = static_cast<int>(std::floor(p.y - 0.5f * static_cast<float>(side - 1)));
  const int right = std::min(width_, left + side), bottom = std::min(height_, top + side);
  constexpr int kRound_px = 4;  // smaller splats are squares
  const float reach2 = side >= kRound_px ? 0.25f * static_cast<float>(side * side) : 1e9f;
  for (int y = std::max(0, top); y < bottom; ++y) {
    for (int x = std::max(0, left); x < right; ++x) {
      const float dx = static_cast<float>(2 * (x - left) + 1 - side) * 0.5f;
      const float dy = static_cast<float>(2 * (y - top) + 1 - side) * 0.5f;
      if (dx * dx + dy * dy <= reach2) put(x, y, p.depth_m, colour);
    }
  }
}

void CloudView::triangle(const Vector3d& a_W, const Vector3d& b_W, const Vector3d& c_W,
                         const Rgb& colour) {
  Projected a, b, c;
  if (!project(a_W, a) || !project(b_W, b) || !project(c_W, c)) return;
  const double area =
      static_cast<double>(b.x - a.x) * (c.y - a.y) - static_cast<double>(b.y - a.y) * (c.x - a.x);
  if (std::abs(area) < 1e-9) return;
  Vector3d normal = (b_W - a_W).cross(c_W - a_W).normalized();
  if (normal.dot(eye_W_ - a_W) < 0.0) normal = -normal;
  const Vector3d sun_C = Vector3d(-0.5, -0.8, -0.45).normalized();
  const double shade = 0.52 + 0.52 * std::max(0.0, normal.dot(R_CW_.transpose() * sun_C));
  Rgb lit;
  for (std::size_t k = 0; k < 3; ++k) lit[k] = static_cast<int>(std::lround(colour[k] * shade));

  const auto low = [](float u, float v, float w) {
    return static_cast<int>(std::floor(std::min({u, v, w})));
  };
  const auto high = [](float u, float v, float w) {
    return static_cast<int>(std::ceil(std::max({u, v, w})));
  };
  const int last_x = std::min(width_ - 1, high(a.x, b.x, c.x));
  const int last_y = std::min(height_ - 1, high(a.y, b.y, c.y));
  for (int y = std::max(0, low(a.y, b.y, c.y)); y <= last_y; ++y) {
    for (int x = std::max(0, low(a.x, b.x, c.x)); x <= last_x; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double wb = ((px - a.x) * (c.y - a.y) - (py - a.y) * (c.x - a.x)) / area;
      const double wc = ((b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x)) / area;
      const double wa = 1.0 - wb - wc;
      if (wa < 0.0 || wb < 0.0 || wc < 0.0) continue;
      // 1 / depth is linear on the picture, depth is not.
      const double inverse = wa / a.depth_m + wb / b.depth_m + wc / c.depth_m;
      put(x, y, static_cast<float>(1.0 / inverse), lit);
    }
  }
}

void CloudView::line(const Vector3d& a_W, const Vector3d& b_W, double width_px, const Rgb& colour) {
  Projected a, b;
  if (!project(a_W, a) || !project(b_W, b)) return;
  constexpr double kNearer = 0.998, kLongest_px = 20000.0;
  const double length_px = std::hypot(b.x - a.x, b.y - a.y);
  if (length_px > kLongest_px) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(length_px)));
  const int side = std::max(1, static_cast<int>(std::lround(width_px * kFine)));
  for (int k = 0; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    const double depth_m = kNearer / ((1.0 - share) / a.depth_m + share / b.depth_m);
    const int left = static_cast<int>(std::lround(a.x + share * (b.x - a.x) - 0.5 * side));
    const int top = static_cast<int>(std::lround(a.y + share * (b.y - a.y) - 0.5 * side));
    for (int y = std::max(0, top); y < std::min(height_, top + side); ++y) {
      for (int x = std::max(0, left); x < std::min(width_, left + side); ++x) {
        put(x, y, static_cast<float>(depth_m), colour);
      }
    }
  }
}

render::Image CloudView::finish(const Rgb& background, float edges) const {
  constexpr int kReach_px = 2, kSides = 8;
  const float strength = 90.0f * edges;
  const int dx[kSides] = {-1, 0, 1, -1, 1, -1, 0, 1}, dy[kSides] = {-1, -1, -1, 0, 0, 1, 1, 1};
  render::Image image;
  image.width = width_ / kFine;
  image.height = height_ / kFine;
  image.rgb.resize(static_cast<std::size_t>(image.width) * image.height * 3);
  std::vector<float> octaves(depth_m_.size());
  std::transform(depth_m_.begin(), depth_m_.end(), octaves.begin(),
                 [](float depth_m) { return std::log2(depth_m); });
  const auto shaded = [&](int x, int y, std::array<float, 3>& sum) {
    const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
    if (depth_m_[at] == kFar_m) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<float>(background[c]);
      return;
    }
    float hidden = 0.0f;
    for (int k = 0; k < kSides; ++k) {
      const int nx = x + kReach_px * dx[k], ny = y + kReach_px * dy[k];
      if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_) continue;
      const float other = octaves[static_cast<std::size_t>(ny) * width_ + nx];
      if (other < octaves[at]) hidden += octaves[at] - other;
    }
    const float shade = std::max(0.45f, std::exp(-strength * hidden / kSides));
    for (std::size_t c = 0; c < 3; ++c) sum[c] += shade * static_cast<float>(pixels_[at][c]);
  };
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::array<float, 3> sum = {0, 0, 0};
      for (int k = 0; k < kFine * kFine; ++k) {
        shaded(x * kFine + k % kFine, y * kFine + k / kFine, sum);
      }
      for (std::size_t c = 0; c < 3; ++c) {
        image.rgb[(static_cast<std::size_t>(y) * image.width + x) * 3 + c] =
            static_cast<std::uint8_t>(std::lround(sum[c] / (kFine * kFine)));
      }
    }
  }
  return image;
}

render::Camera camera_around(const std::vector<Vector3d>& points_W, double azimuth_rad,
                             double elevation_rad, double aspect, double margin) {
  constexpr double kFov_rad = 0.42;  // a long lens shows far rows nearly as large as near ones
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points_W) box.extend(p);
  const Vector3d ahead(std::cos(elevation_rad) * std::cos(azimuth_rad),
                       std::cos(elevation_rad) * std::sin(azimuth_rad), -std::sin(elevation_rad));
  const double half_y = (1.0 - 2.0 * margin) * std::tan(0.5 * kFov_rad), half_x = aspect * half_y;
  Vector3d target = box.center();
  double distance_m = std::max(1.0, box.diagonal().norm());
  // Alternate centring and fitting of the frame around the points; both converge in a few rounds.
  for (int round = 0; round < 12; ++round) {
    const render::Camera camera = render::look_at(target - distance_m * ahead, target, kFov_rad);
    const Eigen::Matrix3d R_CW = camera.X_WC.q.toRotationMatrix().transpose();
    Eigen::AlignedBox2d frame;
    for (const Vector3d& p : points_W) {
      const Vector3d p_C = R_CW * (p - camera.X_WC.p);
      const double depth_m = std::max(kNear_m, p_C.z());
      frame.extend(Vector2d(p_C.x() / depth_m, p_C.y() / depth_m));
    }
    const Vector2d middle = frame.center();
    target += R_CW.transpose() * Vector3d(middle.x(), middle.y(), 0.0) * distance_m;
    const double grow =
        std::max(0.5 * frame.sizes().x() / half_x, 0.5 * frame.sizes().y() / half_y);
    distance_m *= std::clamp(grow, 0.3, 3.0);
  }
  return render::look_at(target - distance_m * ahead, target, kFov_rad);
}

}  // namespace vinerow::tools
