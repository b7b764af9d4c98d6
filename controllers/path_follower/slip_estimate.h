#pragma once
/// How much of the yaw rate asked of the wheels a skid-steered vehicle really turns.
///
/// Wheels that are pushed sideways slip, so the vehicle turns as if its track were wider than it is
/// (1.3 to 2.5 times on soil): w = eta * w_wheels. eta is learnt while turning by a normalised
/// gradient step on the low-passed yaw rates, both through the same filter so that lags cancel.

namespace vinerow {

struct SlipEstimateParams {
  double initial = 1.0;       ///< eta
  double learn_time_s = 0.0;  ///< time constant of learning; 0 = eta stays
  double filter_s = 0.3;      ///< low-pass of both yaw rates
  double response_s = 0.0;    ///< lag of the vehicle's yaw rate behind the wheels'
  double min = 0.25;
  double max = 1.25;
};

class SlipEstimate {
 public:
  explicit SlipEstimate(const SlipEstimateParams& params)
      : params_(params), effectiveness_(params.initial) {}

  /// @param asked_radps     yaw rate the wheels stood for since the last call
  /// @param measured_radps  yaw rate of the vehicle now
  void update(double asked_radps, double measured_radps, double dt_s);

  double effectiveness() const { return effectiveness_; }

 private:
  SlipEstimateParams params_;
  double effectiveness_;
  double lagged_radps_ = 0.0;
  double asked_radps_ = 0.0;
  double measured_radps_ = 0.0;
};

}  // namespace vinerow
