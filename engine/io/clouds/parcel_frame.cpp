#include "engine/io/clouds/parcel_frame.h"

#include <Eigen/QR>
#include <cmath>
#include <numbers>

#include "engine/core/error.h"

namespace vinerow::io {
namespace {

/// Least-squares coefficients of the functions in the columns of `terms`, one column for each
/// column of `values`. One matrix type for both fits: a decomposition is expensive to compile.
Eigen::MatrixXd fit_terms(const Eigen::MatrixXd& terms, const Eigen::MatrixXd& values) {
  return terms.householderQr().solve(values);
}

}  // namespace

ParcelFrame::ParcelFrame(const CloudFrame& exact, const Eigen::AlignedBox3d& box)
    : exact_(&exact), middle_(box.center()), half_(0.5 * box.sizes()) {
  // For a box without width, any positive half width is suitable.
  const double widest = std::max(half_.head<2>().maxCoeff(), 1e-6);
  for (int k = 0; k < 2; ++k) half_[k] = std::max(half_[k], 1e-3 * widest);
  half_.z() = std::max(half_.z(), 1.0);
  exact_->to_local(middle_);
  try {
    fit();
    is_fitted_ = measured_error_m() <= kError_m;
  } catch (const ConfigError&) {
    // A corner cannot be transformed, but the points might: use the exact frame.
  }
}

ParcelFrame::Terms ParcelFrame::terms_of(double u, double v) {
  const double uu = u * u, vv = v * v;
  Terms terms;
  terms << 1.0, u, v, uu, u * v, vv, uu * u, uu * v, u * vv, vv * v;
  return terms;
}

Eigen::Vector3d ParcelFrame::at(double u, double v, double w) const {
  return middle_ + half_.cwiseProduct(Eigen::Vector3d(u, v, w));
}

/// Least squares at Chebyshev nodes, for an even error up to the edges of the box.
void ParcelFrame::fit() {
  constexpr int kNodes = 6;
  Eigen::Matrix<double, kNodes * kNodes, kTerms> terms;
  Eigen::Matrix<double, kNodes * kNodes, 3> places, slopes;
  for (int i = 0; i < kNodes; ++i) {
    for (int j = 0; j < kNodes; ++j) {
      const double u = std::cos((i + 0.5) * std::numbers::pi / kNodes);
      const double v = std::cos((j + 0.5) * std::numbers::pi / kNodes);
      const Eigen::Vector3d low = exact_->to_local(at(u, v, -1.0));
      const Eigen::Vector3d high = exact_->to_local(at(u, v, 1.0));
      const int row = kNodes * i + j;
      terms.row(row) = terms_of(u, v).transpose();
      places.row(row) = 0.5 * (low + high).transpose();
      slopes.row(row) = (high - low).transpose() / (2.0 * half_.z());
    }
  }
  place_.topRows<3>() = fit_terms(terms, places).transpose();
  slope_.topRows<3>() = fit_terms(terms.leftCols<kSlopeTerms>(), slopes).transpose();
}

double ParcelFrame::measured_error_m() const {
  constexpr int kSteps = 12;
  double largest = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (const double w : {-1.0, 0.3, 1.0}) {
        const Eigen::Vector3d position = at(2.0 * i / kSteps - 1.0, 2.0 * j / kSteps - 1.0, w);
        const double error = (fitted(position) - exact_->to_local(position)).norm();
        if (!(error <= largest)) largest = error;
      }
    }
  }
  return largest;
}

Eigen::Vector3d ParcelFrame::fitted(const Eigen::Vector3d& position) const {
  const Eigen::Vector3d d = position - middle_;
  const Terms terms = terms_of(d.x() / half_.x(), d.y() / half_.y());
  // Column by column: Eigen's product takes four times as long for this shape.
  Eigen::Vector4d sum = place_.col(0) + d.z() * slope_.col(0);
  for (int k = 1; k < kSlopeTerms; ++k) {
    sum += terms[k] * (place_.col(k) + d.z() * slope_.col(k));
  }
  for (int k = kSlopeTerms; k < kTerms; ++k) sum += terms[k] * place_.col(k);
  return sum.head<3>();
}

void ParcelFrame::to_local(std::span<CloudPoint> points) const {
  if (!is_fitted_) {
    exact_->to_local(points);
    return;
  }
  for (CloudPoint& point : points) point.position = fitted(point.position);
}

}  // namespace vinerow::io
