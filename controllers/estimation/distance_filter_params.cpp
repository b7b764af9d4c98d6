#include "controllers/estimation/distance_filter_params.h"

#include <array>

namespace vinerow {
namespace {

constexpr std::array kFusions = {"range_ekf",        "joint",  "joint_each", "replace", "increment",
                                 "increment_matrix", "scalar", "truncated"};
constexpr std::array kFusionValues = {DistanceFusion::kRangeEkf,  DistanceFusion::kJoint,
                                      DistanceFusion::kJointEach, DistanceFusion::kReplace,
                                      DistanceFusion::kIncrement, DistanceFusion::kIncrementMatrix,
                                      DistanceFusion::kScalar,    DistanceFusion::kTruncated};

}  // namespace

std::vector<ParameterSpec> distance_filter_parameters() {
  return {
      choice_parameter(
          "fusion", "range_ekf", {kFusions.begin(), kFusions.end()},
          "how an echo is fused: the range itself (range_ekf); paper C, fig. 4, after "
          "all echoes of a moment (joint) or each (joint_each); the cut ellipse as the "
          "new covariance (replace); what the cut adds as a scalar (increment) or a "
          "matrix (increment_matrix); position along the normal, uniform over the slab "
          "(scalar); the Gaussian cut off by the slab (truncated)"),
      choice_parameter("reading", "velocity", {"velocity", "random_walk", "position_fix"},
                       "what the inertial unit is taken for: a velocity with a slow error (R3), a "
                       "velocity whose errors are a random walk (R2), a position fix at its own "
                       "rate (R1)"),
      choice_parameter("association", "ray_cast", {"ray_cast", "closest_segment"},
                       "the facet the beam meets first, or paper C's segment that fits the reading "
                       "best"),
      positive_parameter("set_scale", "", 3.0, "k: the cut ellipse is k^2 times the covariance"),
      boolean_parameter(
          "printed_square_root", false,
          "paper C's eq. 15 as printed; its P' may be indefinite, and is refused then"),
      positive_parameter("bound_sigma", "", 3.0,
                         "bounds of slabs and of the ellipsoid, in standard deviations"),
      optional(
          positive_parameter("walk_m2_per_s", "m2/s", 1e-6,
                             "noise let into each coordinate; if absent 1e-6 (velocity), 0.023 "
                             "(random_walk), 1.98 (position_fix), which fit paper C's table 3")),
      number_parameter("velocity_std_mps", "m/s", 0.05, 0.0, 10.0,
                       "1 sigma of the velocity's slow error (VN-200: 0.05); reading: velocity"),
      positive_parameter("velocity_time_s", "s", 5.0, "its correlation time"),
      number_parameter(
          "yaw_std_deg", "deg", 0.0, 0.0, 90.0,
          "1 sigma of the heading; 0: as the inertial unit states, 0.2 if it does not"),
      positive_parameter("inertial_std_m", "m", 1.0,
                         "1 sigma of the inertial unit's position where it states none; reading: "
                         "position_fix"),
      number_parameter("inflation", "", 0.0, 0.0, 1e6,
                       "factor on the variance of the map's error; 0: 2.5 l / (v T), at least 1"),
      number_parameter("gate_sigma", "", 3.5, 0.0, 100.0,
                       "echoes further off are refused; 0: none (range_ekf, scalar)"),
      number_parameter("huber_sigma", "", 0.0, 0.0, 100.0,
                       "echoes further off weigh less; 0: never (range_ekf)"),
      number_parameter("fix_gate_sigma", "", 5.0, 0.0, 100.0,
                       "fixes and heights further off are refused; 0: none"),
      positive_parameter("fix_inflation", "", 1.0,
                         "factor on the variance of fixes; 2 tau f for errors that stay for tau"),
      number_parameter("lost_share", "", 0.8, 0.0, 1.0,
                       "share of refused echoes over lost_time_s at which the filter is lost"),
      number_parameter("lost_time_s", "s", 2.0, 0.0, 1000.0, "0: no such watch"),
      number_parameter("lost_std_m", "m", 0.5, 0.0, 100.0,
                       "what a lost filter adds to its horizontal standard deviation"),
  };
}

DistanceFilterParams read_distance_filter_params(const ParameterSet& parameters) {
  DistanceFilterParams params;
  for (std::size_t i = 0; i < kFusions.size(); ++i) {
    if (parameters.text("fusion") == kFusions[i]) params.fusion = kFusionValues[i];
  }
  const std::string& reading = parameters.text("reading");
  params.reading = reading == "velocity"      ? InertialReading::kVelocity
                   : reading == "random_walk" ? InertialReading::kRandomWalk
                                              : InertialReading::kPositionFix;
  params.association = parameters.text("association") == "ray_cast"
                           ? EchoAssociation::kRayCast
                           : EchoAssociation::kClosestSegment;
  params.kalman = kalman_params_of(params.reading);
  if (params.reading == InertialReading::kVelocity) {
    params.kalman.velocity_std_mps = parameters.number("velocity_std_mps");
  }
  params.kalman.velocity_time_s = parameters.number("velocity_time_s");
  if (parameters.has("walk_m2_per_s")) {
    params.kalman.walk_m2_per_s = parameters.number("walk_m2_per_s");
  }
  params.set_scale = parameters.number("set_scale");
  params.printed_square_root = parameters.boolean("printed_square_root");
  params.bound_sigma = parameters.number("bound_sigma");
  params.inflation = parameters.number("inflation");
  params.gate_sigma = parameters.number("gate_sigma");
  params.huber_sigma = parameters.number("huber_sigma");
  params.fix_gate_sigma = parameters.number("fix_gate_sigma");
  params.fix_inflation = parameters.number("fix_inflation");
  params.lost_share = parameters.number("lost_share");
  params.lost_time_s = parameters.number("lost_time_s");
  params.lost_std_m = parameters.number("lost_std_m");
  return params;
}

}  // namespace vinerow
