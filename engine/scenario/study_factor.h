#pragma once
/// The factors of a study file.

#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/scenario/study.h"

namespace vinerow::scenario {

/// A range of a number, in equal steps or, on a logarithmic scale, in equal ratios.
struct FactorRange {
  double from = 0.0, to = 0.0;
  bool logarithmic = false;
  bool whole = false;  ///< rounded to whole numbers
};

/// Keys of a range: of a factor beside its key, and of each key of a sample.
const ParameterTable<FactorRange>& factor_range_table();

/// How a sample of a region is drawn.
enum class SampleKind { kLatinHypercube, kSobol };

struct SampleParams {
  SampleKind kind = SampleKind::kLatinHypercube;
  std::int64_t count = 0;
  std::int64_t seed = 1;
};
const ParameterTable<SampleParams>& sample_table();

/// Of a range: so far apart, or so many.
struct RangeSteps {
  std::optional<double> step;
  std::optional<std::int64_t> count;
};
const ParameterTable<RangeSteps>& range_steps_table();

/// The number at a share (0 to 1) of a range, to twelve digits: 0.3 and not 0.30000000000000004.
double number_at(const FactorRange& range, double share);

/// All factors. @param node  the mapping `factors` @throws ConfigError
std::vector<Factor> read_factors(const io::YamlNode& node);

/// Most levels of a factor and most cells of a study.
inline constexpr double kMostCells = 1e6;

}  // namespace vinerow::scenario
