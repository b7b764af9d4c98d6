#include "controllers/parts/aircraft/trim_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/parts/aircraft/trim_solver.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

/// Largest spacing of the table. Between its points the interpolated trim leaves less than
/// 0.005 m/s2 or rad/s2 (trim_table_test.cpp).
constexpr double kClimbStep_rad = rad_from_deg(2.0);
constexpr double kBankStep_rad = rad_from_deg(2.5);
constexpr double kMinBankStep_rad = rad_from_deg(0.01);

TrimPoint point_of(const Trim& trim) {
  return {trim.controls, trim.u_mps,   trim.v_mps,     trim.w_mps,   trim.p_radps,
          trim.q_radps,  trim.r_radps, trim.pitch_rad, trim.roll_rad};
}

/// a + s (b - a), number by number.
TrimPoint trim_between(const TrimPoint& a, const TrimPoint& b, double s) {
  const auto mix = [s](double from, double to) { return (1.0 - s) * from + s * to; };
  return {{mix(a.controls.throttle, b.controls.throttle),
           mix(a.controls.elevator_rad, b.controls.elevator_rad),
           mix(a.controls.aileron_rad, b.controls.aileron_rad)},
          mix(a.u_mps, b.u_mps),
          mix(a.v_mps, b.v_mps),
          mix(a.w_mps, b.w_mps),
          mix(a.p_radps, b.p_radps),
          mix(a.q_radps, b.q_radps),
          mix(a.r_radps, b.r_radps),
          mix(a.pitch_rad, b.pitch_rad),
          mix(a.roll_rad, b.roll_rad)};
}

/// The steepest and the flattest flight of one bank, at the ends of the throttle.
struct ClimbRange {
  Trim lowest, highest;
};

class TableMaker {
 public:
  TableMaker(const Aircraft& aircraft, double airspeed_mps)
      : aircraft_(aircraft), solver_(aircraft), airspeed_mps_(airspeed_mps) {}

  std::optional<ClimbRange> climbs_at(double bank_rad) {
    const TrimRequest request{airspeed_mps_, 0.0, bank_rad};
    const std::optional<Trim> lowest =
        in_range(solver_.solve_at_throttle(request, aircraft_.throttle_min()));
    const std::optional<Trim> highest =
        in_range(solver_.solve_at_throttle(request, aircraft_.throttle_max()));
    if (!lowest || !highest) return std::nullopt;
    return ClimbRange{*lowest, *highest};
  }

  /// @param neighbour  the last trim, as the start of the search; set to the result
  TrimPoint at(const ClimbRange& range, double climb_rad, double bank_rad,
               std::optional<Trim>& neighbour) {
    if (climb_rad <= range.lowest.request.climb_angle_rad) return point_of(range.lowest);
    if (climb_rad >= range.highest.request.climb_angle_rad) return point_of(range.highest);
    const TrimRequest request{airspeed_mps_, climb_rad, bank_rad};
    std::optional<Trim> trim;
    if (neighbour) trim = in_range(solver_.solve(request, &*neighbour));
    if (!trim) trim = in_range(solver_.solve(request));
    neighbour = trim;
    // Below some throttle a propeller only windmills: the last interval is the glide.
    return point_of(trim ? *trim : range.lowest);
  }

 private:
  std::optional<Trim> in_range(std::optional<Trim> trim) const {
    if (!trim) return trim;
    const AircraftControls& wanted = trim->controls;
    const AircraftControls limited = aircraft_.limit(wanted);
    const double beyond = std::abs(limited.throttle - wanted.throttle) +
                          std::abs(limited.elevator_rad - wanted.elevator_rad) +
                          std::abs(limited.aileron_rad - wanted.aileron_rad);
    return beyond < 1e-9 ? trim : std::nullopt;
  }

  Aircraft aircraft_;
  TrimSolver solver_;
  double airspeed_mps_;
};

}  // namespace

TrimTable::TrimTable(const Aircraft& aircraft, double airspeed_mps, double max_bank_rad,
                     const std::string& who)
    : airspeed_mps_(airspeed_mps), bank_max_rad_(max_bank_rad) {
  const Result<Trim> level = find_trim(aircraft, {airspeed_mps, 0.0, 0.0});
  if (!level) throw ConfigError(fmt::format("{}: {}", who, level.reason()));
  level_ = *level;
  TableMaker maker(aircraft, airspeed_mps);
  const std::optional<ClimbRange> wings_level = maker.climbs_at(0.0);
  if (!wings_level) {
    throw ConfigError(fmt::format("{}: no steady flight at {:.2f} m/s with the throttle at an end",
                                  who, airspeed_mps));
  }
  climb_min_rad_ = wings_level->lowest.request.climb_angle_rad;
  climb_max_rad_ = wings_level->highest.request.climb_angle_rad;
  // Banks too steep for the lift of the wings are left out.
  const auto holds = [&](double bank_rad) {
    return maker.climbs_at(bank_rad) && maker.climbs_at(-bank_rad);
  };
  if (!holds(bank_max_rad_)) {
    double good = 0.0, bad = bank_max_rad_;
    while (bad - good > kMinBankStep_rad) {
      const double middle = 0.5 * (good + bad);
      (holds(middle) ? good : bad) = middle;
    }
    bank_max_rad_ = good;
  }
  climbs_ =
      std::max(1, static_cast<int>(std::ceil((climb_max_rad_ - climb_min_rad_) / kClimbStep_rad)));
  half_banks_ = std::max(1, static_cast<int>(std::ceil(bank_max_rad_ / kBankStep_rad)));
  for (int j = -half_banks_; j <= half_banks_; ++j) {
    const double bank_rad = bank_max_rad_ * j / half_banks_;
    const std::optional<ClimbRange> range = maker.climbs_at(bank_rad);
    std::optional<Trim> neighbour;
    for (int i = 0; i <= climbs_; ++i) {
      const double climb_rad = climb_min_rad_ + (climb_max_rad_ - climb_min_rad_) * i / climbs_;
      points_.push_back(maker.at(range.value_or(*wings_level), climb_rad, bank_rad, neighbour));
    }
  }
}

TrimPoint TrimTable::at(double climb_angle_rad, double bank_rad) const {
  const double climb = std::isfinite(climb_angle_rad) ? climb_angle_rad : 0.0;
  const double bank = std::isfinite(bank_rad) ? bank_rad : 0.0;
  const auto place = [](double share, int intervals) {
    const double x = std::clamp(share, 0.0, 1.0) * intervals;
    const int i = std::min(static_cast<int>(x), intervals - 1);
    return std::pair{i, x - i};
  };
  const auto [i, s] = place((climb - climb_min_rad_) / (climb_max_rad_ - climb_min_rad_), climbs_);
  // Banks are counted from level to either side, so that left and right give the same bits.
  const bool to_left = bank < 0.0;
  const auto [j, t] =
      bank_max_rad_ > 0.0 ? place(std::abs(bank) / bank_max_rad_, half_banks_) : std::pair{0, 0.0};
  const auto along_climb = [&, i = i, s = s](int bank_step) {
    const int column = half_banks_ + (to_left ? -bank_step : bank_step);
    const auto index = static_cast<std::size_t>(column * (climbs_ + 1) + i);
    return trim_between(points_[index], points_[index + 1], s);
  };
  return trim_between(along_climb(j), along_climb(j + 1), t);
}

TrimTables::TrimTables(const Aircraft& aircraft, double min_mps, double max_mps,
                       double max_bank_rad, const std::string& who) {
  const double cruise_mps = aircraft.cruise_speed_mps;
  const auto add = [&](int step) {
    tables_.emplace_back(aircraft, cruise_mps + step * kSpeedStep_mps, max_bank_rad, who);
  };
  const auto flies = [&](int step) {
    const double speed_mps = cruise_mps + step * kSpeedStep_mps;
    return speed_mps >= min_mps && speed_mps <= max_mps &&
           TableMaker(aircraft, speed_mps).climbs_at(0.0).has_value() &&
           find_trim(aircraft, {speed_mps, 0.0, 0.0}).ok();
  };
  int slowest = 0, fastest = 0;
  while (flies(slowest - 1)) --slowest;
  while (flies(fastest + 1)) ++fastest;
  for (int step = slowest; step <= fastest; ++step) add(step);
  cruise_ = static_cast<std::size_t>(-slowest);
}

double TrimTables::within(double airspeed_mps) const {
  if (!(airspeed_mps > 0.0)) return cruise().airspeed_mps();
  return std::clamp(airspeed_mps, min_mps(), max_mps());
}

TrimPoint TrimTables::at(double airspeed_mps, double climb_angle_rad, double bank_rad) const {
  // Counted from the cruise speed, so that there it equals its table without rounding.
  const double x = (within(airspeed_mps) - cruise().airspeed_mps()) / kSpeedStep_mps;
  const double floor_x = std::floor(x);
  const auto last = static_cast<std::ptrdiff_t>(tables_.size()) - 1;
  const std::ptrdiff_t i =
      std::clamp(static_cast<std::ptrdiff_t>(cruise_) + static_cast<std::ptrdiff_t>(floor_x),
                 std::ptrdiff_t{0}, last);
  const TrimPoint low = tables_[static_cast<std::size_t>(i)].at(climb_angle_rad, bank_rad);
  const double share = x - floor_x;
  if (share == 0.0 || i == last) return low;
  return trim_between(low, tables_[static_cast<std::size_t>(i) + 1].at(climb_angle_rad, bank_rad),
                      share);
}

}  // namespace vinerow::controllers
