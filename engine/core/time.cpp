#include "engine/core/time.h"

#include <cmath>

#include "engine/core/check.h"

namespace vinerow {

Duration duration_from_s(double seconds) {
  VINEROW_DEMAND(std::isfinite(seconds) && std::abs(seconds) < 9.0e9);
  return {std::llround(seconds * 1e9)};
}

Duration period_of_rate(double rate_Hz) {
  VINEROW_DEMAND(std::isfinite(rate_Hz) && rate_Hz > 0.0);
  return {std::llround(1e9 / rate_Hz)};
}

}  // namespace vinerow
