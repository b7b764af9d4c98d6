#include "vehicles/parts/dryden.h"

#include <algorithm>
#include <cmath>

namespace vinerow::vehicles {
namespace {

constexpr double kFoot_m = 0.3048;
constexpr double kSqrt3 = 1.7320508075688772;

/// One exact step of x' = A x + noise over `distance` (in lengths L): decay of both states, and the
/// noise added over the step as the lower triangle of its covariance's root.
struct Step {
  double distance, decay;
  double aa, ab, bb;
};

/// Covariance of the noise: with y = 2 distance
///   Q_aa = (1 - e^-y) / 2, Q_ab = (1 - e^-y (1 + y)) / 4, Q_bb = (1 - e^-y (1 + y + y^2/2)) / 4.
/// The brackets are incomplete gamma functions; their series keeps digits where y is small.
Step make_step(double distance) {
  const double y = 2.0 * distance;
  const double decay = std::exp(-distance), decay2 = decay * decay;
  double gamma2, gamma3;  // of orders 2 and 3, the latter halved
  if (y < 0.1) {
    gamma2 = y * y * (1 / 2.0 - y * (1 / 3.0 - y * (1 / 8.0 - y * (1 / 30.0 - y / 144.0))));
    gamma3 =
        0.5 * y * y * y * (1 / 3.0 - y * (1 / 4.0 - y * (1 / 10.0 - y * (1 / 36.0 - y / 168))));
  } else {
    gamma2 = 1.0 - decay2 * (1.0 + y);
    gamma3 = 1.0 - decay2 * (1.0 + y + 0.5 * y * y);
  }
  Step step{distance, decay, std::sqrt(-0.5 * std::expm1(-y)), 0.0, 0.0};
  step.ab = 0.25 * gamma2 / step.aa;
  step.bb = std::sqrt(std::max(0.0, 0.25 * gamma3 - step.ab * step.ab));
  return step;
}

}  // namespace

DrydenScales calc_dryden_scales(double height_m, double wind_20ft_mps) {
  const double h_ft = std::clamp(height_m / kFoot_m, 10.0, 1000.0);
  const double root = std::pow(0.177 + 0.000823 * h_ft, 0.4);
  DrydenScales scales;
  scales.length_w_m = h_ft * kFoot_m;
  scales.length_uv_m = scales.length_w_m / (root * root * root);
  scales.sigma_w_mps = 0.1 * wind_20ft_mps;
  scales.sigma_uv_mps = scales.sigma_w_mps / root;
  return scales;
}

DrydenTurbulence::DrydenTurbulence(RandomStream random) : random_(random) {
  u_ = random_.normal();
  // Steady covariance of (a, b): 1/2, 1/4; 1/4, 1/4.
  const double root8 = std::sqrt(0.125);
  for (Transverse* filter : {&v_, &w_}) {
    filter->a = 2.0 * root8 * random_.normal();
    filter->b = 0.5 * filter->a + root8 * random_.normal();
  }
}

void DrydenTurbulence::advance(double distance_m, const DrydenScales& scales) {
  if (!(distance_m > 0.0)) return;
  const Step uv = make_step(distance_m / scales.length_uv_m);
  const Step w = make_step(distance_m / scales.length_w_m);
  // The noise of u has the variance 1 - decay^2, which is 2 Q_aa.
  u_ = uv.decay * u_ + std::sqrt(2.0) * uv.aa * random_.normal();
  const auto advance_filter = [this](const Step& step, Transverse& filter) {
    const double n1 = random_.normal(), n2 = random_.normal();
    const double a = filter.a;
    filter.a = step.decay * a + step.aa * n1;
    filter.b = step.decay * (filter.b + step.distance * a) + step.ab * n1 + step.bb * n2;
  };
  advance_filter(uv, v_);
  advance_filter(w, w_);
}

Eigen::Vector3d DrydenTurbulence::unit() const {
  return {u_, kSqrt3 * v_.a + (1.0 - kSqrt3) * v_.b, kSqrt3 * w_.a + (1.0 - kSqrt3) * w_.b};
}

}  // namespace vinerow::vehicles
