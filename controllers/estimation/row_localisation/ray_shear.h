#pragma once
/// Watertight test of whether a ray passes through a triangle.

#include <Eigen/Core>
#include <utility>

namespace vinerow::controllers {

/// Sheared coordinates along a ray. Source: Woop, Benthin, Wald, "Watertight ray/triangle
/// intersection", Journal of Computer Graphics Techniques 2 (2013). Corners are sheared so that the
/// ray becomes an axis. The side on which it passes an edge then follows from the same plane points
/// for both facets of that edge, so no ray passes between neighbours.
class RayShear {
 public:
  explicit RayShear(const Eigen::Vector3d& u) {
    u.cwiseAbs().maxCoeff(&z_);
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    if (u[z_] < 0.0) std::swap(x_, y_);
    shear_x_ = u[x_] / u[z_];
    shear_y_ = u[y_] / u[z_];
  }
  /// @pre the facet faces the ray
  bool passes_through(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                      const Eigen::Vector3d& p) const {
    const Point A = flat(a, p), B = flat(b, p), C = flat(c, p);
    return C.x * B.y - C.y * B.x >= 0.0 && A.x * C.y - A.y * C.x >= 0.0 &&
           B.x * A.y - B.y * A.x >= 0.0;
  }

 private:
  struct Point {
    double x, y;
  };
  Point flat(const Eigen::Vector3f& corner, const Eigen::Vector3d& p) const {
    const double z = corner[z_] - p[z_];
    return {corner[x_] - p[x_] - shear_x_ * z, corner[y_] - p[y_] - shear_y_ * z};
  }

  Eigen::Index x_, y_, z_;
  double shear_x_, shear_y_;
};

}  // namespace vinerow::controllers
