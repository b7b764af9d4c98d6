#pragma once
/// Error and consistency of the estimate and of every observer.
///
/// A sample counts only if the estimate was written at the instant of the tick, so that its age is
/// not mistaken for an error, and only from `from_s` on. Rotorcraft are judged until their
/// reference is done: after landing below the canopy, their rangers see only the ground. Results
/// are NaN if the estimate is the truth itself: equal to it, with zero covariance. Results:
///   estimate_lateral_std_m, _rms_m, _max_m; estimate_longitudinal_std_m, _rms_m, _max_m: across
///     and along the direction of the nearest true row within `row_reach_m`, else of the true
///     heading; lateral is positive to the left, std is about the mean
///   estimate_vertical_rms_m, estimate_yaw_rms_deg
///   nees_mean: mean of e' P^-1 e, with the horizontal error e and its stated covariance P; 2 for a
///     consistent filter. NaN if there is no covariance
///   nees_in_95_share: share of the samples inside the 95 % ellipse, e' P^-1 e <= 5.991
///   estimate_consistent: 1 if nees_mean is in the 95 % interval of a chi-square variable with 2 n
///     degrees of freedom divided by n, widened by `nees_margin` at both ends, else 0. Samples are
///     correlated, so n is their effective sample size by batch means (batch_means.h). The margin
///     is needed in long runs, because with a large n every model error is significant.
///     Y. Bar-Shalom, X. R. Li, T. Kirubarajan, "Estimation with Applications to Tracking and
///     Navigation", 2001, section 5.4
///   ellipsoid_containment_share: share of the values of "ellipsoid" that contain the true
///     position; one without height is judged in the plane
///   nis_<source>_mean: mean of the values nis_<source> in "estimator_state", for the sources in
///     the parameter `nis`; a value counts when it changes
/// The results of every observer (engine/api/observer.h) are <observer>_lateral_rms_m,
/// <observer>_consistent, <observer>_nees_mean, <observer>_nis_<source>_mean and so on.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/result_spec.h"

namespace vinerow::metrics {

const std::vector<ResultSpec>& estimation_results();
PartSpec estimation_spec();
std::unique_ptr<Metric> make_estimation(const ParameterSet& parameters,
                                        const MetricContext& context);

}  // namespace vinerow::metrics
