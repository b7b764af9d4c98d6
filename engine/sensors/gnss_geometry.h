#pragma once
/// Dilution of precision: effect of the satellite geometry on range errors.
///
/// The rows of G are (-e_east, -e_north, -e_up, 1) with e the unit vector to the satellite; the
/// fourth unknown is the receiver's clock; Q = (G' W G)^-1. Source: Kaplan, Hegarty, Understanding
/// GPS, 2nd ed., section 7.3.1; weighted as in 7.3.2 with w = (usual variance / variance).

#include <Eigen/Core>
#include <cmath>

namespace vinerow::sensors {

struct Dilution {
  Eigen::Vector3d axes = Eigen::Vector3d::Zero();  ///< sqrt of Q's diagonal: east, north, up
  double clock = 0.0;

  double horizontal() const { return std::hypot(axes.x(), axes.y()); }
  double vertical() const { return axes.z(); }
  double position() const { return axes.norm(); }
};

/// Accumulates the satellites of one fix.
class GnssGeometry {
 public:
  /// @param direction_W  unit
  /// @param weight  > 0; 1: a usual satellite
  void add(const Eigen::Vector3d& direction_W, double weight);
  int count() const { return count_; }
  /// @param dilution  written only if the satellites determine the four unknowns
  /// @returns whether they do
  bool read(Dilution& dilution) const;

 private:
  Eigen::Matrix4d normal_ = Eigen::Matrix4d::Zero();  ///< G' W G
  int count_ = 0;
};

}  // namespace vinerow::sensors
