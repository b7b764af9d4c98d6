#pragma once
/// Fast approximation of CloudFrame for the points of one parcel, about 30 times as fast.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "engine/io/clouds/point_cloud.h"
#include "engine/io/clouds/point_cloud_crs.h"

namespace vinerow::io {

/// Transformation from a CRS to W by polynomials fitted to a CloudFrame over a box.
///
/// W is linear in the height: W = A(x, y) + (z - z0) B(x, y). A is a polynomial of degree 3, B one
/// of degree 2. At a distance of L m from the middle of the box, the residual of A is of the order
/// of L^4 / 24 R^3 (R: radius of the Earth; 0.01 um at 3 km), and that of B of L^2 / 2 R^2 per
/// metre of height. The constructor measures the error on a grid of other points at three heights.
/// If one error exceeds kError_m (datum grids with steps, a pole, a box as large as a country), the
/// exact frame is used instead. Thread safe if is_fitted().
class ParcelFrame {
 public:
  static constexpr double kError_m = 2e-5;

  /// @param exact  must outlive this object. @param box  in the CRS's units, not empty
  /// @throws ConfigError if the middle of the box cannot be transformed
  ParcelFrame(const CloudFrame& exact, const Eigen::AlignedBox3d& box);

  bool is_fitted() const { return is_fitted_; }
  /// @param points  inside the box; transformed in place to m in W. @throws ConfigError as
  /// CloudFrame
  void to_local(std::span<CloudPoint> points) const;

 private:
  static constexpr int kTerms = 10, kSlopeTerms = 6;
  using Terms = Eigen::Matrix<double, kTerms, 1>;

  static Terms terms_of(double u, double v);
  Eigen::Vector3d fitted(const Eigen::Vector3d& position) const;
  void fit();
  double measured_error_m() const;
  Eigen::Vector3d at(double u, double v, double w) const;

  const CloudFrame* exact_;
  Eigen::Vector3d middle_, half_;  // of the box; half_ > 0
  // Coefficients of x, y, z and a zero that fills the vector registers.
  Eigen::Matrix<double, 4, kTerms> place_ = Eigen::Matrix<double, 4, kTerms>::Zero();
  Eigen::Matrix<double, 4, kSlopeTerms> slope_ =
      Eigen::Matrix<double, 4, kSlopeTerms>::Zero();  // m per unit of z
  bool is_fitted_ = false;
};

}  // namespace vinerow::io
