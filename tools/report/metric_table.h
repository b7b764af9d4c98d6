#pragma once
/// What every metric means, in words, with the equation or section of a paper that it stems from.

#include <string>

namespace vinerow::tools::report {

struct MetricMeaning {
  std::string title;       ///< a few plain words, "largest distance from the lane"
  std::string definition;  ///< one sentence
  std::string source;      ///< "paper B, eq. 8"; "" where it is our own
  bool known = false;      ///< false: made of the name alone
};

/// @param name  without the vehicle, "cross_track_rms_m". Names of wheels, sources of innovations
/// and observers may stand in it, as in "slip_rms_fl", "nis_range_mean" or "ekf_lateral_rms_m".
MetricMeaning metric_meaning(const std::string& name);

}  // namespace vinerow::tools::report
