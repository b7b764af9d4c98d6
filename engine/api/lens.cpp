#include "engine/api/lens.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Points of the way from the axis to a pixel, along which the inverse is followed.
constexpr int kStages = 16;
/// Area of a pixel's solid angle, against that at the axis, below which the lens folds.
constexpr double kFolded = 1e-3;
/// Step at which an iteration has converged.
constexpr double kStill = 1e-13;

}  // namespace

Vector2d Lens::distorted(const Vector2d& p) const {
  const auto& [k1, k2, p1, p2, k3] = info_.distortion;
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

/// Jacobian of distorted().
Eigen::Matrix2d Lens::slope(const Vector2d& p) const {
  const auto& [k1, k2, p1, p2, k3] = info_.distortion;
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double rate = 2.0 * (k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3));  // d radial / d r2, doubled
  Eigen::Matrix2d j;
  j << radial + x * x * rate + 2.0 * p1 * y + 6.0 * p2 * x,
      x * y * rate + 2.0 * p1 * x + 2.0 * p2 * y, x * y * rate + 2.0 * p1 * x + 2.0 * p2 * y,
      radial + y * y * rate + 6.0 * p1 * y + 2.0 * p2 * x;
  return j;
}

double Lens::fisheye_radius(double angle) const {
  const auto& [k1, k2, k3, k4, unused] = info_.distortion;
  const double a2 = angle * angle;
  return angle * (1.0 + a2 * (k1 + a2 * (k2 + a2 * (k3 + a2 * k4))));
}

double Lens::fisheye_slope(double angle) const {
  const auto& [k1, k2, k3, k4, unused] = info_.distortion;
  const double a2 = angle * angle;
  return 1.0 + a2 * (3.0 * k1 + a2 * (5.0 * k2 + a2 * (7.0 * k3 + a2 * 9.0 * k4)));
}

/// Newton's method, along the straight way from the axis to the pixel, so that the solution is the
/// one that is connected with the axis. @returns nullopt if the lens folds on the way
std::optional<Vector3d> Lens::direction(double u, double v) const {
  const Vector2d target((u - info_.cx_px) / info_.fx_px, (v - info_.cy_px) / info_.fy_px);
  constexpr int kSteps = 8;
  if (info_.lens == CameraInfo::Lens::kFisheye) {
    const double radius = target.norm();
    if (radius == 0.0) return Vector3d::UnitZ();
    double angle = 0.0;
    for (int stage = 1; stage <= kStages; ++stage) {
      const double wanted = radius * stage / kStages;
      for (int i = 0; i < kSteps; ++i) {
        const double rate = fisheye_slope(angle);
        if (!(rate > kFolded)) return std::nullopt;
        const double step = (fisheye_radius(angle) - wanted) / rate;
        angle -= step;
        if (std::abs(step) < kStill) break;
      }
    }
    if (!(angle > 0.0 && angle < kPi) || !(fisheye_slope(angle) > kFolded)) return std::nullopt;
    const double across = std::sin(angle) / radius;
    return Vector3d(across * target.x(), across * target.y(), std::cos(angle));
  }
  const bool is_plain = std::all_of(info_.distortion.begin(), info_.distortion.end(),
                                    [](double k) { return k == 0.0; });
  if (is_plain) return Vector3d(target.x(), target.y(), 1.0).normalized();
  Vector2d p = Vector2d::Zero();
  for (int stage = 1; stage <= kStages; ++stage) {
    const Vector2d wanted = target * (static_cast<double>(stage) / kStages);
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Matrix2d j = slope(p);
      if (!(j.determinant() > kFolded) || !(j.trace() > 0.0)) return std::nullopt;
      const Vector2d step = j.inverse() * (distorted(p) - wanted);
      p -= step;
      if (step.squaredNorm() < kStill * kStill) break;
    }
  }
  constexpr double kClose = 1e-9;
  const Eigen::Matrix2d j = slope(p);
  if (!(j.determinant() > kFolded) || !((distorted(p) - target).norm() < kClose)) {
    return std::nullopt;
  }
  return Vector3d(p.x(), p.y(), 1.0).normalized();
}

std::optional<Vector2d> Lens::project(const Vector3d& direction) const {
  Vector2d p;
  if (info_.lens == CameraInfo::Lens::kFisheye) {
    const double across = direction.head<2>().norm();
    const double angle = std::atan2(across, direction.z());
    if (!(fisheye_slope(angle) > kFolded)) return std::nullopt;
    p = across > 0.0 ? Vector2d(direction.head<2>() * (fisheye_radius(angle) / across))
                     : Vector2d::Zero();
  } else {
    if (!(direction.z() > 0.0)) return std::nullopt;
    p = direction.head<2>() / direction.z();
    if (!(slope(p).determinant() > kFolded)) return std::nullopt;
    p = distorted(p);
  }
  return Vector2d(info_.fx_px * p.x() + info_.cx_px, info_.fy_px * p.y() + info_.cy_px);
}

}  // namespace vinerow
