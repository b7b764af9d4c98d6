#pragma once
/// Parallel cut: the smallest ellipsoid that contains the part of an ellipsoid between two parallel
/// planes.
///
/// E = {x : (x - c)' P^-1 (x - c) <= 1}, slab lower <= a'x <= upper, s = sqrt(a' P a),
/// alpha = (a'c - upper) / s, alpha_hat = (lower - a'c) / s:
///
///     c' = c - tau P a / s,   P' = delta (P - sigma P a a' P / (a' P a))
///     rho^2 = 4 (1 - alpha^2)(1 - alpha_hat^2) + n^2 (alpha_hat^2 - alpha^2)^2
///     sigma = (n + 2 (1 - n^2/4 (alpha + alpha_hat)^2) / (1 - alpha alpha_hat + rho/2)) / (n + 1)
///     1 - sigma = (n^2/2 + (n^2/4 (alpha_hat - alpha)^2 - 1) / (1 + alpha alpha_hat + rho/2))
///                 (alpha + alpha_hat)^2 / ((n + 1)(1 - alpha alpha_hat + rho/2))
///     tau = sigma (alpha - alpha_hat) / 2
///     delta = n^2 / (n^2 - 1) (1 - (alpha^2 + alpha_hat^2 - rho/n) / 2)
///
/// Source: Liao, Todd, "The ellipsoid algorithm using parallel cuts", Comput. Optim. Appl. 2, 1993;
/// paper C (Donati et al., Remote Sensing 14(6) 1374, 2022), eq. 14-15, with these changes: eq. 11
/// reads -a'x <= -lower; P' has no square root (eq. 15 prints one: the result loses positive
/// definiteness or does not contain the set); sigma is rationalised (as printed 0/0 for a slab
/// about the centre), 1 - sigma written without cancellation.
/// In ball coordinates, w = a'(x - c) / s, the slab is alpha_hat <= w <= -alpha.
///
/// P is the shape of a set, not a covariance: see pseudo_measurement().

#include <Eigen/Core>

namespace vinerow::controllers {

enum class CutStatus {
  kCut,         ///< both planes count
  kSingleCut,   ///< one plane is outside the ellipsoid; the other cuts it (deep or shallow)
  kInterval,    ///< n = 1: the remaining interval, exactly
  kNoUpdate,    ///< the ellipsoid is already the smallest that contains the remaining part
  kEmpty,       ///< the slab does not meet the ellipsoid
  kInverted,    ///< lower > upper
  kDegenerate,  ///< the remaining part has no volume (slab of zero width, or one that only
                ///< touches), P is not positive along a, or a number is not finite
};

/// Name such as "single_cut", for signals and errors.
const char* to_string(CutStatus status);

struct ParallelCut {
  CutStatus status = CutStatus::kDegenerate;
  double alpha = 0.0, alpha_hat = 0.0;         ///< clamped to >= -1 after the tests for kEmpty
  double sigma = 0.0, tau = 0.0, delta = 1.0;  ///< values of no change if nothing was cut
  double rest = 1.0;                           ///< 1 - sigma, to full precision for thin slabs too

  /// Whether the ellipsoid becomes smaller.
  bool cuts() const {
    return status == CutStatus::kCut || status == CutStatus::kSingleCut ||
           status == CutStatus::kInterval;
  }
  /// K = 1 - delta (1 - sigma): share by which the shape shrinks along a; > 0 if it cuts.
  double gain() const { return 1.0 - delta * rest; }
};

/// Parameters of the cut. @param dimension  n >= 1
ParallelCut parallel_cut(int dimension, double alpha, double alpha_hat);

struct CutOptions {
  /// As eq. 15 of paper C prints it, for studies: sigma P a (P a)' / sqrt(a' P a). P' may be
  /// indefinite then.
  bool printed_square_root = false;
};

/// Cuts the ellipsoid in place, if ParallelCut::cuts(). P stays symmetric. Instantiated for N = 1,
/// 2, 3. @param a  normal of the slab, any length > 0
template <int N>
ParallelCut cut_ellipsoid(Eigen::Matrix<double, N, 1>& c, Eigen::Matrix<double, N, N>& P,
                          const Eigen::Matrix<double, N, 1>& a, double lower, double upper,
                          const CutOptions& options = {});

/// Information of a cut about a'x, as a measurement with noise. Fusing it with the covariance from
/// which the ellipsoid was made (shape = k^2 covariance) counts nothing twice. The growth of the
/// ellipsoid across a (delta > 1) carries no information and is left out.
struct PseudoMeasurement {
  bool valid = false;     ///< false if the cut has no information (K < 1e-9)
  double value = 0.0;     ///< z = a'c - tau s / K
  double variance = 0.0;  ///< (s/k)^2 (1 - K) / K
};

/// @param centre_along_a  a'c before the cut
/// @param spread_m  s = sqrt(a' P a) before the cut, of the shape  @param set_scale  k
PseudoMeasurement pseudo_measurement(const ParallelCut& cut, double centre_along_a, double spread_m,
                                     double set_scale);

}  // namespace vinerow::controllers
