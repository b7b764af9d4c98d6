#include "vehicles/parts/validation.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"

namespace vinerow::vehicles {

void demand_positive(const std::string& who, const char* field, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  throw ConfigError(fmt::format("{}: {} = {}, must be > 0", who, field, value));
}

void demand_not_negative(const std::string& who, const char* field, double value) {
  if (std::isfinite(value) && value >= 0.0) return;
  throw ConfigError(fmt::format("{}: {} = {}, must be >= 0", who, field, value));
}

void demand_range(const std::string& who, const char* field, double value, double min, double max) {
  if (value >= min && value <= max) return;
  throw ConfigError(fmt::format("{}: {} = {}, must be {} to {}", who, field, value, min, max));
}

}  // namespace vinerow::vehicles
