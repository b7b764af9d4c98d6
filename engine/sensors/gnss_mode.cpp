#include "engine/sensors/gnss_mode.h"

#include <fmt/format.h>

#include "engine/api/parameter_table.h"

namespace vinerow::sensors {
namespace {

constexpr double kLong_s = 1e9;
constexpr double kRounding_s = 1e-9;

std::string find_fault_in_satellites(const GnssModeRules& p) {
  if (p.fixed_satellites >= p.float_satellites) return "";
  return fmt::format("fixed_satellites = {}, must be >= float_satellites = {}", p.fixed_satellites,
                     p.float_satellites);
}

std::string find_fault_in_fixing(const GnssModeRules& p) {
  if (p.time_to_refix_s <= p.time_to_fix_s) return "";
  return fmt::format("time_to_refix_s = {} s, must be <= time_to_fix_s = {} s", p.time_to_refix_s,
                     p.time_to_fix_s);
}

}  // namespace

const ParameterTable<GnssModeRules>& gnss_mode_table() {
  using P = GnssModeRules;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("corrections", &P::corrections,
                  {{"none", GnssCorrections::kNone},
                   {"sbas", GnssCorrections::kSbas},
                   {"rtk", GnssCorrections::kRtk}},
                  "corrections that the receiver gets: none, SBAS, or RTK from a base station")
          .choice("start", &P::is_running_at_start, {{"running", true}, {"cold", false}},
                  "running: it already has its best solution; cold: it is switched on at the start")
          .number("cold_start_s", "s", &P::cold_start_s, between(0.0, 1e4),
                  "time to first fix with start: cold")
          .number("max_pdop", "", &P::max_pdop, between(1.0, 1e3),
                  "maximum dilution of a position by code")
          .number("sbas_s", "s", &P::sbas_s, between(0.0, 1e4),
                  "time until corrections are available")
          .integer("float_satellites", &P::float_satellites, between(4, 50),
                   "minimum number of satellites by carrier phase for float")
          .integer("fixed_satellites", &P::fixed_satellites, between(4, 50),
                   "minimum number of satellites by carrier phase for fixed")
          .number("max_rtk_pdop", "", &P::max_rtk_pdop, between(1.0, 1e3),
                  "maximum dilution of a position by carrier phase")
          .number("time_to_fix_s", "s", &P::time_to_fix_s, between(0.0, 1e4),
                  "time from float to fixed, the first time")
          .number("time_to_refix_s", "s", &P::time_to_refix_s, between(0.0, 1e4),
                  "time from float to fixed, later")
          .rule(find_fault_in_satellites)
          .rule(find_fault_in_fixing);
  return table;
}

GnssModes::GnssModes(const GnssModeRules& rules, double period_s)
    : rules_(rules),
      period_s_(period_s),
      on_s_(rules.is_running_at_start ? kLong_s : -period_s),
      code_s_(rules.is_running_at_start ? kLong_s : -period_s),
      fixable_s_(rules.is_running_at_start ? kLong_s : -period_s),
      has_been_fixed_(false) {}

GnssFix::Mode GnssModes::step(double code_pdop, int carrier_count, double carrier_pdop) {
  using Mode = GnssFix::Mode;
  // Times start at the first tick at which a condition holds.
  const auto count = [this](bool holds, double& time_s) {
    time_s = holds ? time_s + period_s_ : -period_s_;
  };
  on_s_ += period_s_;
  const bool has_code = code_pdop <= rules_.max_pdop && on_s_ >= rules_.cold_start_s - kRounding_s;
  count(has_code, code_s_);
  const bool has_phase = has_code && rules_.corrections == GnssCorrections::kRtk &&
                         carrier_pdop <= rules_.max_rtk_pdop;
  const bool is_float = has_phase && carrier_count >= rules_.float_satellites;
  count(has_phase && carrier_count >= rules_.fixed_satellites, fixable_s_);
  has_been_fixed_ = has_been_fixed_ && is_float;
  const double needed_s = has_been_fixed_ ? rules_.time_to_refix_s : rules_.time_to_fix_s;
  if (fixable_s_ >= needed_s - kRounding_s) {
    has_been_fixed_ = true;
    return Mode::kFixed;
  }
  if (is_float) return Mode::kFloat;
  if (!has_code) return Mode::kNone;
  const bool corrected =
      rules_.corrections != GnssCorrections::kNone && code_s_ >= rules_.sbas_s - kRounding_s;
  return corrected ? Mode::kSbas : Mode::kStandalone;
}

}  // namespace vinerow::sensors
