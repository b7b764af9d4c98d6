#include "controllers/autopilot/ardupilot/state_line.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/check.h"

namespace vinerow::controllers {
namespace {

constexpr std::array<std::string_view, 6> kRanges = {"rng_1", "rng_2", "rng_3",
                                                     "rng_4", "rng_5", "rng_6"};
constexpr std::array<std::string_view, 12> kSticks = {"rc_1", "rc_2",  "rc_3",  "rc_4",
                                                      "rc_5", "rc_6",  "rc_7",  "rc_8",
                                                      "rc_9", "rc_10", "rc_11", "rc_12"};

}  // namespace

void StateLine::text(std::string_view words) {
  VINEROW_DEMAND(size_ + words.size() <= buffer_.size());
  std::copy(words.begin(), words.end(), buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += words.size();
}

void StateLine::number(double value) {
  if (!std::isfinite(value)) {
    is_finite_ = false;
    return;
  }
  // Nine places are a nanometre and a nanosecond; ArduPilot's reader takes no exponent. Values
  // beyond 1e12 do not occur in a checked state.
  const auto end = std::to_chars(buffer_.data() + size_, buffer_.data() + buffer_.size(),
                                 std::clamp(value, -1e12, 1e12), std::chars_format::fixed, 9);
  VINEROW_DEMAND(end.ec == std::errc());
  size_ = static_cast<std::size_t>(end.ptr - buffer_.data());
}

void StateLine::list(std::string_view key, const double* values, int count) {
  text("\"");
  text(key);
  text("\":[");
  for (int i = 0; i < count; ++i) {
    if (i > 0) text(",");
    number(values[i]);
  }
  text("]");
}

std::string_view StateLine::write(const ArdupilotState& state) {
  size_ = 0;
  is_finite_ = true;
  const auto field = [this](std::string_view key, double value) {
    text(",\"");
    text(key);
    text("\":");
    number(value);
  };

  text("\n{\"timestamp\":");
  number(state.timestamp_s);
  text(",\"imu\":{");
  list("gyro", state.gyro_FRD_radps.data(), 3);
  text(",");
  list("accel_body", state.specific_force_FRD_mps2.data(), 3);
  text("},");
  list("position", state.position_NED_m.data(), 3);
  text(",");
  const Eigen::Quaterniond& q = state.q_NED_FRD;
  const double wxyz[] = {q.w(), q.x(), q.y(), q.z()};
  list("quaternion", wxyz, 4);
  text(",");
  list("velocity", state.velocity_NED_mps.data(), 3);
  for (std::size_t i = 0; i < kRanges.size(); ++i) {
    if (state.ranges_m[i]) field(kRanges[i], *state.ranges_m[i]);
  }
  if (state.airspeed_mps) field("airspeed", *state.airspeed_mps);
  if (state.battery_V && state.battery_A) {
    text(",\"battery\":{\"voltage\":");
    number(*state.battery_V);
    field("current", *state.battery_A);
    text("}");
  }
  const bool has_sticks = std::any_of(state.sticks_us.begin(), state.sticks_us.end(),
                                      [](const auto& stick) { return stick.has_value(); });
  if (has_sticks) {
    text(",\"rc\":{");
    bool is_first = true;
    for (std::size_t i = 0; i < kSticks.size(); ++i) {
      if (!state.sticks_us[i]) continue;
      text(is_first ? "\"" : ",\"");
      is_first = false;
      text(kSticks[i]);
      text("\":");
      number(*state.sticks_us[i]);
    }
    text("}");
  }
  text("}\n");
  return is_finite_ ? std::string_view(buffer_.data(), size_) : std::string_view();
}

}  // namespace vinerow::controllers
