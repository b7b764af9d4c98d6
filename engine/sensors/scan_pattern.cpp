#include "engine/sensors/scan_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::sensors {
namespace {

constexpr double kMaxPulses = 2e6;

/// A pulse that is nearer than this to the edge between two frames, in periods of its laser, stands
/// on it: rounding must not move it to the frame before.
constexpr double kEdge = 1e-6;

Eigen::Vector3d direction(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

/// Whole number of the first of a train of pulses in a frame.
/// @param begin  of the frame, in periods of the train from its pulse 0
std::int64_t first_pulse(double begin) {
  return static_cast<std::int64_t>(std::ceil(begin - kEdge));
}

/// Time in a frame of a pulse that belongs to it.
double within_frame(double time_s, double period_s) {
  return std::clamp(time_s, 0.0, std::nextafter(period_s, 0.0));
}

int columns_of(const ScanPatternParams& p) {
  return p.columns.value_or(kColumns);
}

std::string find_fault_in_lasers(const ScanPatternParams& p) {
  if (p.is_rosette) return "";
  if (p.elevations_deg.empty()) return "elevations_deg has no laser";
  if (!p.azimuth_offsets_deg.empty() && p.azimuth_offsets_deg.size() != p.elevations_deg.size()) {
    return fmt::format("azimuth_offsets_deg has {} numbers, elevations_deg {}: one for each laser",
                       p.azimuth_offsets_deg.size(), p.elevations_deg.size());
  }
  if (p.column_s <= 0.0 || !p.columns) return "";
  return fmt::format(
      "columns = {} and column_s = {:g} s are both given, must be one of them; column_s = 0 is "
      "none",
      *p.columns, p.column_s);
}

std::string find_fault_in_rosette(const ScanPatternParams& p) {
  if (p.lowest_deg < p.highest_deg) return "";
  return fmt::format("lowest_deg = {:g} deg, must be < highest_deg = {:g} deg", p.lowest_deg,
                     p.highest_deg);
}

std::string find_fault_in_turn(const ScanPatternParams& p, double period_s) {
  const bool has_clock = p.column_s > 0.0;
  if (has_clock && p.column_s > period_s) {
    return fmt::format("column_s = {:g} s, must be at most the time of a turn, {:g} s", p.column_s,
                       period_s);
  }
  const double column_s = has_clock ? p.column_s : period_s / columns_of(p);
  const double pulses = static_cast<double>(p.elevations_deg.size()) * period_s / column_s;
  if (pulses > kMaxPulses * (1.0 + 1e-9)) {
    const std::string what = has_clock ? fmt::format("column_s = {:g} s", p.column_s)
                                       : fmt::format("columns = {}", columns_of(p));
    return fmt::format("{} lasers and {} make {:.0f} pulses a turn, must be at most {:.0f}",
                       p.elevations_deg.size(), what, pulses, kMaxPulses);
  }
  if (p.firing_s <= column_s * (1.0 + 1e-9)) return "";
  return fmt::format(
      "firing_s = {:g} s, must be at most the time from a column to the next, {:g} s", p.firing_s,
      column_s);
}

std::string find_fault_in_frame(const ScanPatternParams& p, double period_s) {
  const double pulses = p.pulses_per_s * period_s;
  if (pulses >= 1.0 - 1e-9 && pulses <= kMaxPulses * (1.0 + 1e-9)) return "";
  return fmt::format("pulses_per_s = {:g} make {:g} pulses a period of {:g} s, must be 1 to {:.0f}",
                     p.pulses_per_s, pulses, period_s, kMaxPulses);
}

class Spinning final : public ScanPattern {
 public:
  Spinning(const ScanPatternParams& params, double period_s)
      : period_s_(period_s),
        has_clock_(params.column_s > 0.0),
        column_s_(has_clock_ ? params.column_s : period_s / columns_of(params)),
        columns_(has_clock_ ? period_s / params.column_s : columns_of(params)),
        half_view_rad_(rad_from_deg(0.5 * params.field_of_view_deg)) {
    const std::size_t lasers = params.elevations_deg.size();
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      const double elevation_deg = params.elevations_deg[laser];
      // Of two at the same elevation the first counts as the lower one.
      std::uint16_t ring = 0;
      for (std::size_t other = 0; other < lasers; ++other) {
        const double other_deg = params.elevations_deg[other];
        if (other_deg < elevation_deg || (other_deg == elevation_deg && other < laser)) ++ring;
      }
      const double delay_s =
          params.firing_s * static_cast<double>(laser) / static_cast<double>(lasers);
      const double azimuth_deg =
          params.azimuth_offsets_deg.empty() ? 0.0 : params.azimuth_offsets_deg[laser];
      lasers_.push_back(
          {.delay_s = delay_s,
           .elevation_rad = rad_from_deg(elevation_deg),
           .azimuth_offset_rad = rad_from_deg(azimuth_deg),
           .column_shift = std::lround(delay_s / column_s_ - azimuth_deg / 360.0 * columns_),
           .ring = ring});
    }
    pulses_.reserve(most_pulses());
    fill(0);
  }

  std::span<const LaserPulse> pulses(std::uint64_t frame) override {
    if (has_clock_) fill(frame);
    return pulses_;
  }

  std::size_t most_pulses() const override {
    return lasers_.size() * (static_cast<std::size_t>(columns_) + 1);
  }

 private:
  struct Laser {
    double delay_s;  ///< from the column's first laser
    double elevation_rad, azimuth_offset_rad;
    std::int64_t column_shift;  ///< from the column that it fires in to the one that it looks at
    std::uint16_t ring;
  };

  void fill(std::uint64_t frame) {
    constexpr double kRounding_rad = 1e-9;  // pulses at both edges belong to the view
    pulses_.clear();
    // In the train of columns. One that has begun in the frame before may end in this one.
    const double begin = static_cast<double>(frame) * columns_;
    const double end = static_cast<double>(frame + 1) * columns_;
    for (std::int64_t column = first_pulse(begin) - 1; column < first_pulse(end); ++column) {
      for (const Laser& laser : lasers_) {
        const double delay = laser.delay_s / column_s_;
        if (column < first_pulse(begin - delay)) continue;
        if (column >= first_pulse(end - delay)) break;
        const double time_s = within_frame(
            (static_cast<double>(column) - begin) * column_s_ + laser.delay_s, period_s_);
        const double azimuth_rad =
            wrap_angle(kPi - 2.0 * kPi * time_s / period_s_ + laser.azimuth_offset_rad);
        if (std::abs(azimuth_rad) > half_view_rad_ + kRounding_rad) continue;
        pulses_.push_back({time_s, direction(azimuth_rad, laser.elevation_rad), laser.ring,
                           has_clock_ ? 0u : picture_column(column, frame, laser)});
      }
    }
  }

  /// @pre a turn has a whole number of columns
  std::uint32_t picture_column(std::int64_t column, std::uint64_t frame, const Laser& laser) const {
    const auto columns = static_cast<std::int64_t>(columns_);
    const std::int64_t seen =
        column - static_cast<std::int64_t>(frame) * columns + laser.column_shift;
    return static_cast<std::uint32_t>((seen % columns + columns) % columns);
  }

  double period_s_;
  bool has_clock_;   ///< that fires the columns
  double column_s_;  ///< from a column to the next
  double columns_;   ///< of a turn, not a whole number with a clock
  double half_view_rad_;
  std::vector<Laser> lasers_;
  std::vector<LaserPulse> pulses_;
};

class Rosette final : public ScanPattern {
 public:
  Rosette(const ScanPatternParams& params, double period_s)
      : params_(params), period_s_(period_s), per_frame_(params.pulses_per_s * period_s) {
    pulses_.reserve(most_pulses());
  }

  std::span<const LaserPulse> pulses(std::uint64_t frame) override {
    pulses_.clear();
    const double begin = static_cast<double>(frame) * per_frame_;
    const std::int64_t last = first_pulse(static_cast<double>(frame + 1) * per_frame_);
    for (std::int64_t number = first_pulse(begin); number < last; ++number) {
      const auto laser = static_cast<int>(number % params_.lasers);
      const double time_s = static_cast<double>(number) / params_.pulses_per_s;
      const double turn = fraction(params_.turns_per_s * time_s);
      // Up and down evenly: 0 to 1 and back.
      const double wave =
          fraction(params_.waves_per_s * time_s + static_cast<double>(laser) / params_.lasers);
      const double height = 1.0 - std::abs(2.0 * wave - 1.0);
      const double elevation_deg =
          params_.lowest_deg + height * (params_.highest_deg - params_.lowest_deg);
      const double in_frame_s = (static_cast<double>(number) - begin) / params_.pulses_per_s;
      pulses_.push_back({within_frame(in_frame_s, period_s_),
                         direction(kPi - 2.0 * kPi * turn, rad_from_deg(elevation_deg)),
                         static_cast<std::uint16_t>(laser)});
    }
    return pulses_;
  }

  std::size_t most_pulses() const override { return static_cast<std::size_t>(per_frame_) + 1; }

 private:
  static double fraction(double value) { return value - std::floor(value); }

  ScanPatternParams params_;
  double period_s_;
  double per_frame_;  ///< not always a whole number
  std::vector<LaserPulse> pulses_;
};

}  // namespace

const ParameterTable<ScanPatternParams>& scan_pattern_table() {
  using P = ScanPatternParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("pattern", &P::is_rosette, {{"spinning", false}, {"rosette", true}},
                  "lasers at fixed elevations that turn once in a period, or a path that never "
                  "repeats")
          .numbers("elevations_deg", "deg", &P::elevations_deg, between(-90.0, 90.0),
                   "spinning: elevation of each laser, in the order in which they fire")
          .numbers("azimuth_offsets_deg", "deg", &P::azimuth_offsets_deg, between(-180.0, 180.0),
                   "spinning: azimuth of each laser in its column, to the left; default: none")
          .integer("columns", &P::columns, between(1, 100'000),
                   fmt::format("spinning: firings of each laser in a turn; default: {}, unless "
                               "there is column_s",
                               kColumns))
          .number("column_s", "s", &P::column_s, between(0.0, 1.0),
                  "spinning: time from a firing of a laser to its next, at any rate of turns; 0: "
                  "columns count")
          .number("firing_s", "s", &P::firing_s, between(0.0, 1.0),
                  "spinning: time in which the lasers of a column fire one after the other")
          .number("field_of_view_deg", "deg", &P::field_of_view_deg, above(0.0, 360.0),
                  "spinning: angle about the forward direction in which pulses are sent")
          .integer("lasers", &P::lasers, between(1, 64), "rosette: number of lasers")
          .number("pulses_per_s", "1/s", &P::pulses_per_s, above(0.0, 1e7),
                  "rosette: pulses of all lasers together")
          .number("lowest_deg", "deg", &P::lowest_deg, between(-90.0, 90.0),
                  "rosette: lowest elevation")
          .number("highest_deg", "deg", &P::highest_deg, between(-90.0, 90.0),
                  "rosette: highest elevation")
          .number("turns_per_s", "1/s", &P::turns_per_s, kPositive, "rosette: turns in azimuth")
          .number("waves_per_s", "1/s", &P::waves_per_s, kPositive,
                  "rosette: ups and downs in elevation")
          .rule(find_fault_in_lasers)
          .rule(find_fault_in_rosette);
  return table;
}

std::unique_ptr<ScanPattern> make_scan_pattern(const ScanPatternParams& params, double period_s,
                                               const std::string& who) {
  const std::string fault = params.is_rosette ? find_fault_in_frame(params, period_s)
                                              : find_fault_in_turn(params, period_s);
  if (!fault.empty()) throw ConfigError(fmt::format("{}: {}", who, fault));
  if (params.is_rosette) return std::make_unique<Rosette>(params, period_s);
  return std::make_unique<Spinning>(params, period_s);
}

}  // namespace vinerow::sensors
