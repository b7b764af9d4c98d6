#include "engine/api/parameter_limits.h"

#include <cmath>

namespace vinerow {
namespace {

struct UnitLimits {
  const char* unit;
  double largest;
  double smallest;  ///< lower limit of values that must be above 0
};

constexpr UnitLimits kUnitLimits[] = {
    {"m", 1e7, 1e-9},      {"s", 1e9, 1e-9},    {"Hz", 1e9, 1e-9},    {"m/s", 1e4, 1e-9},
    {"km/h", 1e5, 1e-9},   {"m/s2", 1e5, 1e-9}, {"rad/s", 1e4, 1e-9}, {"deg/s", 1e6, 1e-9},
    {"rad/s2", 1e6, 1e-9}, {"deg", 1e6, 1e-9},  {"rad", 1e5, 1e-9},   {"kg", 1e6, 1e-9},
};
constexpr UnitLimits kOtherUnits = {"", 1e15, 1e-15};

}  // namespace

ParameterSpec with_limits_of_unit(ParameterSpec spec) {
  if (spec.kind != ParameterKind::kNumber && spec.kind != ParameterKind::kNumberList) return spec;
  UnitLimits limits = kOtherUnits;
  for (const UnitLimits& own : kUnitLimits) {
    if (spec.unit == own.unit) limits = own;
  }
  if (!std::isfinite(spec.max)) spec.max = limits.largest;
  if (!std::isfinite(spec.min)) spec.min = -limits.largest;
  if (spec.min_exclusive && spec.min == 0.0) {
    spec.min = limits.smallest;
    spec.min_exclusive = false;
  }
  return spec;
}

}  // namespace vinerow
