#include "controllers/quadrotor_mpc/limit_watch.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {

bool LimitWatch::keeps(const FlightDeviation& deviation, double share) const {
  return deviation.tilt_rad <= share * limits_.tilt_rad &&
         std::abs(deviation.lateral_m) <= share * limits_.lateral_m &&
         std::abs(deviation.altitude_m) <= share * limits_.altitude_m &&
         std::abs(deviation.speed_mps) <= share * limits_.speed_mps;
}

LimitWatch::PendingEvent LimitWatch::update(const FlightDeviation& deviation, double now_s) {
  constexpr double kBackShare = 0.9;
  if (!is_outside_ && !keeps(deviation, 1.0)) {
    is_outside_ = true;
    left_at_s_ = now_s;
    return PendingEvent::kLeft;
  }
  if (is_outside_ && keeps(deviation, kBackShare)) {
    is_outside_ = false;
    outside_s_ = now_s - left_at_s_;
    return PendingEvent::kBack;
  }
  return PendingEvent::kNone;
}

std::string LimitWatch::describe(const FlightDeviation& deviation) const {
  std::string text;
  const auto add = [&text](const char* name, double value, double limit, const char* unit,
                           int digits) {
    if (std::abs(value) <= limit) return;
    if (!text.empty()) text += ", ";
    text += fmt::format("{} {:.{}f} {} of {:g}", name, value, digits, unit, limit);
  };
  add("tilt", deg_from_rad(deviation.tilt_rad), deg_from_rad(limits_.tilt_rad), "deg", 1);
  add("lateral", deviation.lateral_m, limits_.lateral_m, "m", 2);
  add("altitude", deviation.altitude_m, limits_.altitude_m, "m", 2);
  add("speed", deviation.speed_mps, limits_.speed_mps, "m/s", 2);
  return text;
}

}  // namespace vinerow::controllers
