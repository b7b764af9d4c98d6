#pragma once
/// Title, definition and source of a metric, from the declaration of the part that gives it
/// (engine/api/result_spec.h).

#include <string>

namespace vinerow::tools::report {

struct MetricMeaning {
  std::string title;       ///< a few plain words, "max lateral error on lanes"
  std::string definition;  ///< one or two sentences
  std::string source;      ///< "paper B, eq. 8"; empty if the definition is ours
  bool known = false;      ///< false: no built-in part declares it; the title is made of the name
};

/// @param name  without the vehicle, "cross_track_rms_m". Names of wheels, measurement sources,
/// observers and payloads may be part of it, as in "slip_rms_fl", "nis_range_mean",
/// "ekf_lateral_rms_m" or "sprayer_litres_left"; the title then ends with them.
MetricMeaning metric_meaning(const std::string& name);

}  // namespace vinerow::tools::report
