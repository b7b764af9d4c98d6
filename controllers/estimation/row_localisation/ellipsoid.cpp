#include "controllers/estimation/row_localisation/ellipsoid.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {

constexpr double kMinGain = 1e-9;    // least K of a pseudo-measurement
constexpr double kMinShape = 1e-14;  // least remaining shape, along a and across it, of 1

}  // namespace

const char* to_string(CutStatus status) {
  switch (status) {
    case CutStatus::kCut:
      return "cut";
    case CutStatus::kSingleCut:
      return "single_cut";
    case CutStatus::kInterval:
      return "interval";
    case CutStatus::kNoUpdate:
      return "no_update";
    case CutStatus::kEmpty:
      return "empty";
    case CutStatus::kInverted:
      return "inverted";
    case CutStatus::kDegenerate:
      break;
  }
  return "degenerate";
}

ParallelCut parallel_cut(int dimension, double alpha, double alpha_hat) {
  ParallelCut cut;
  cut.alpha = alpha;
  cut.alpha_hat = alpha_hat;
  const double n = dimension;
  if (std::isnan(alpha) || std::isnan(alpha_hat)) return cut;
  // An infinite bound means no plane; both at -infinity leave the ellipsoid unchanged.
  const auto end_with = [&cut](CutStatus status) {
    cut.status = status;
    return cut;
  };
  if (alpha + alpha_hat > 0.0) return end_with(CutStatus::kInverted);
  if (alpha > 1.0 || alpha_hat > 1.0) return end_with(CutStatus::kEmpty);
  const bool is_single = alpha < -1.0 || alpha_hat < -1.0;
  const double b = cut.alpha = std::max(alpha, -1.0);
  const double h = cut.alpha_hat = std::max(alpha_hat, -1.0);
  if (b * h >= 1.0 / n) return end_with(CutStatus::kNoUpdate);

  if (dimension == 1) {
    cut.tau = 0.5 * (b - h);
    const double half = 0.5 * (b + h);
    cut.delta = half * half;
    if (!(cut.delta > kMinShape)) {
      cut.tau = 0.0, cut.delta = 1.0;
      return end_with(CutStatus::kDegenerate);
    }
    return end_with(CutStatus::kInterval);
  }
  const double sum = b + h;
  const double between = h * h - b * b;
  const double rho =
      std::sqrt(std::max(0.0, 4.0 * (1.0 - b * b) * (1.0 - h * h) + n * n * between * between));
  const double apart = 1.0 - b * h + 0.5 * rho;
  const double rest =
      sum * sum *
      (0.5 * n * n + (0.25 * n * n * (h - b) * (h - b) - 1.0) / (1.0 + b * h + 0.5 * rho)) /
      ((n + 1.0) * apart);
  const double delta = n * n / (n * n - 1.0) * (1.0 - 0.5 * (b * b + h * h - rho / n));
  // Not (rest <= small), so that NaN (0/0, for a slab that only touches) ends here too.
  if (!(rest > kMinShape) || !(delta > kMinShape)) {
    return end_with(CutStatus::kDegenerate);
  }
  cut.rest = rest;
  cut.sigma = 1.0 - rest;
  cut.tau = 0.5 * (b - h) * cut.sigma;
  cut.delta = delta;
  return end_with(is_single ? CutStatus::kSingleCut : CutStatus::kCut);
}

template <int N>
ParallelCut cut_ellipsoid(Eigen::Matrix<double, N, 1>& c, Eigen::Matrix<double, N, N>& P,
                          const Eigen::Matrix<double, N, 1>& a, double lower, double upper,
                          const CutOptions& options) {
  using Vector = Eigen::Matrix<double, N, 1>;
  const Vector Pa = P * a;
  const double s2 = a.dot(Pa);
  const double centre = a.dot(c);
  if (!(s2 > 0.0) || !std::isfinite(s2) || !std::isfinite(centre)) return {};
  const double s = std::sqrt(s2);
  const ParallelCut cut = parallel_cut(N, (centre - upper) / s, (lower - centre) / s);
  if (!cut.cuts()) return cut;
  c -= cut.tau / s * Pa;
  const double divisor = options.printed_square_root ? s : s2;
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) {
      P(i, j) = P(j, i) = cut.delta * (P(i, j) - cut.sigma * (Pa[i] * Pa[j] / divisor));
    }
  }
  return cut;
}

template ParallelCut cut_ellipsoid<1>(Eigen::Matrix<double, 1, 1>&, Eigen::Matrix<double, 1, 1>&,
                                      const Eigen::Matrix<double, 1, 1>&, double, double,
                                      const CutOptions&);
template ParallelCut cut_ellipsoid<2>(Eigen::Vector2d&, Eigen::Matrix2d&, const Eigen::Vector2d&,
                                      double, double, const CutOptions&);
template ParallelCut cut_ellipsoid<3>(Eigen::Vector3d&, Eigen::Matrix3d&, const Eigen::Vector3d&,
                                      double, double, const CutOptions&);

PseudoMeasurement pseudo_measurement(const ParallelCut& cut, double centre_along_a, double spread_m,
                                     double set_scale) {
  PseudoMeasurement measurement;
  if (!cut.cuts() || cut.gain() < kMinGain) return measurement;
  const double K = cut.gain();
  const double spread = spread_m / set_scale;
  measurement.valid = true;
  measurement.value = centre_along_a - cut.tau * spread_m / K;
  measurement.variance = spread * spread * (1.0 - K) / K;
  return measurement;
}

}  // namespace vinerow::controllers
