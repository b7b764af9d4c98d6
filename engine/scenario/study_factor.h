#pragma once
/// Reader of the factors of a study file.

#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/scenario/study.h"

namespace vinerow::scenario {

/// Range of a number, with equal steps or, on a logarithmic scale, equal ratios.
struct FactorRange {
  double from = 0.0, to = 0.0;
  bool logarithmic = false;
  bool whole = false;  ///< rounded to whole numbers
};

/// Keys of a range, used by a factor and by each key of a sample.
const ParameterTable<FactorRange>& factor_range_table();

/// Sampling method for a region.
enum class SampleKind { kLatinHypercube, kSobol };

struct SampleParams {
  SampleKind kind = SampleKind::kLatinHypercube;
  std::int64_t count = 0;
  std::int64_t seed = 1;
};
const ParameterTable<SampleParams>& sample_table();

/// Levels of a range: by their spacing or by their number.
struct RangeSteps {
  std::optional<double> step;
  std::optional<std::int64_t> count;
};
const ParameterTable<RangeSteps>& range_steps_table();

/// The number at a share (0 to 1) of a range, rounded to twelve digits: 0.3, not
/// 0.30000000000000004.
double number_at(const FactorRange& range, double share);

/// Reads all factors. @param node  the mapping `factors` @throws ConfigError
std::vector<Factor> read_factors(const io::YamlNode& node);

/// Maximum number of levels of a factor and of cells of a study.
inline constexpr double kMaxCells = 1e6;

}  // namespace vinerow::scenario
