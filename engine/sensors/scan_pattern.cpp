#include "engine/sensors/scan_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/constants.h"
#include "engine/math/angles.h"

namespace vinerow::sensors {
namespace {

constexpr int kMaxPulses = 2'000'000;

Eigen::Vector3d direction(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

std::string find_fault_in_lasers(const ScanPatternParams& p) {
  if (p.is_rosette) return "";
  if (p.elevations_deg.empty()) return "elevations_deg has no laser";
  if (!p.azimuth_offsets_deg.empty() && p.azimuth_offsets_deg.size() != p.elevations_deg.size()) {
    return fmt::format("azimuth_offsets_deg has {} numbers, elevations_deg {}: one for each laser",
                       p.azimuth_offsets_deg.size(), p.elevations_deg.size());
  }
  const double pulses = static_cast<double>(p.elevations_deg.size()) * p.columns;
  if (pulses <= kMaxPulses) return "";
  return fmt::format("{} lasers and columns = {} make {:.0f} pulses a turn, must be at most {}",
                     p.elevations_deg.size(), p.columns, pulses, kMaxPulses);
}

std::string find_fault_in_rosette(const ScanPatternParams& p) {
  if (p.lowest_deg < p.highest_deg) return "";
  return fmt::format("lowest_deg = {:g} deg, must be < highest_deg = {:g} deg", p.lowest_deg,
                     p.highest_deg);
}

class Spinning final : public ScanPattern {
 public:
  Spinning(const ScanPatternParams& params, double period_s) {
    const std::size_t lasers = params.elevations_deg.size();
    const auto ring_of = [&](std::size_t laser) {
      return static_cast<std::uint16_t>(
          std::count_if(params.elevations_deg.begin(), params.elevations_deg.end(),
                        [&](double other) { return other < params.elevations_deg[laser]; }));
    };
    constexpr double kRounding_rad = 1e-9;  // pulses at both edges belong to the view
    const double half_view_rad = rad_from_deg(0.5 * params.field_of_view_deg);
    const double column_s = period_s / params.columns;
    for (int column = 0; column < params.columns; ++column) {
      for (std::size_t laser = 0; laser < lasers; ++laser) {
        LaserPulse pulse;
        pulse.time_s = column * column_s +
                       params.firing_s * static_cast<double>(laser) / static_cast<double>(lasers);
        if (pulse.time_s >= period_s) continue;
        const double offset_rad = params.azimuth_offsets_deg.empty()
                                      ? 0.0
                                      : rad_from_deg(params.azimuth_offsets_deg[laser]);
        const double azimuth_rad =
            wrap_angle(kPi - 2.0 * kPi * pulse.time_s / period_s + offset_rad);
        if (std::abs(azimuth_rad) > half_view_rad + kRounding_rad) continue;
        pulse.dir_S = direction(azimuth_rad, rad_from_deg(params.elevations_deg[laser]));
        pulse.ring = ring_of(laser);
        pulses_.push_back(pulse);
      }
    }
    std::stable_sort(pulses_.begin(), pulses_.end(),
                     [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  }

  std::span<const LaserPulse> pulses(std::uint64_t /*frame*/) override { return pulses_; }

 private:
  std::vector<LaserPulse> pulses_;
};

class Rosette final : public ScanPattern {
 public:
  Rosette(const ScanPatternParams& params, double period_s)
      : params_(params),
        per_frame_(static_cast<std::uint64_t>(std::llround(params.pulses_per_s * period_s))) {
    pulses_.resize(per_frame_);
  }

  std::span<const LaserPulse> pulses(std::uint64_t frame) override {
    for (std::uint64_t i = 0; i < per_frame_; ++i) {
      const std::uint64_t number = frame * per_frame_ + i;
      const auto laser = static_cast<int>(number % static_cast<std::uint64_t>(params_.lasers));
      const double time_s = static_cast<double>(number) / params_.pulses_per_s;
      const double turn = fraction(params_.turns_per_s * time_s);
      // Up and down evenly: 0 to 1 and back.
      const double wave =
          fraction(params_.waves_per_s * time_s + static_cast<double>(laser) / params_.lasers);
      const double height = 1.0 - std::abs(2.0 * wave - 1.0);
      const double elevation_deg =
          params_.lowest_deg + height * (params_.highest_deg - params_.lowest_deg);
      pulses_[i] = {static_cast<double>(i) / params_.pulses_per_s,
                    direction(kPi - 2.0 * kPi * turn, rad_from_deg(elevation_deg)),
                    static_cast<std::uint16_t>(laser)};
    }
    return pulses_;
  }

 private:
  static double fraction(double value) { return value - std::floor(value); }

  ScanPatternParams params_;
  std::uint64_t per_frame_;
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
                   "spinning: firings of each laser in a turn")
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

std::unique_ptr<ScanPattern> make_scan_pattern(const ScanPatternParams& params, double period_s) {
  if (params.is_rosette) return std::make_unique<Rosette>(params, period_s);
  return std::make_unique<Spinning>(params, period_s);
}

}  // namespace vinerow::sensors
