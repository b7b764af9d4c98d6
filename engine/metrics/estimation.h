#pragma once
/// How far the estimate is from the truth, and whether it knows; likewise of every observer.
///
/// Looked at where the estimate was written at the very instant of the tick, from `from_s` on, so
/// that nothing is mistaken for an error that is only age. What flies on rotors is judged until its
/// reference is done: landed below the canopy its rangers see the ground alone. Nothing is measured
/// (NaN) where the estimate is the truth itself: equal, and with zero covariance. Results:
///   estimate_lateral_std_m, _rms_m, _max_m; estimate_longitudinal_std_m, _rms_m, _max_m: across
///   and
///     along the direction of the nearest true row within `row_reach_m`, elsewhere the true
///     heading; lateral is positive to the left, std is about the mean
///   estimate_vertical_rms_m, estimate_yaw_rms_deg
///   nees_mean: mean of e' P^-1 e, e the horizontal error and P its stated covariance; 2 for a
///     filter that is right about itself. NaN where it states none
///   nees_in_95_share: share of the samples inside the 95 % ellipse, e' P^-1 e <= 5.991
///   estimate_consistent: 1 where nees_mean lies in the 95 % interval of a chi-square variable with
///     2 n degrees of freedom over n, widened by `nees_margin` at both ends, else 0. n is not the
///     number of samples, which hang together, but how many independent ones they are worth by
///     batch means (batch_means.h). A long run cannot do without the margin: with n large enough
///     no model is right. Y. Bar-Shalom, X. R. Li, T. Kirubarajan, "Estimation with Applications to
///     Tracking and Navigation", 2001, section 5.4
///   ellipsoid_containment_share: share of the signal "ellipsoid" that contains the true position;
///     one without height is judged in the plane
///   nis_<source>_mean: mean of the values nis_<source> of "estimator_state", of those sources that
///     the parameter `nis` names; a value counts when it has changed
/// Of every observer (engine/api/observer.h) the same: <observer>_lateral_rms_m,
/// <observer>_consistent, <observer>_nees_mean, <observer>_nis_<source>_mean and so on.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

const std::vector<MetricNumber>& estimation_numbers();
PartSpec estimation_spec();
std::unique_ptr<Metric> make_estimation(const ParameterSet& parameters,
                                        const MetricContext& context);

}  // namespace vinerow::metrics
