#include "engine/sensors/gnss_mode.h"

#include <fmt/format.h>

#include "engine/core/error.h"

namespace vinerow {
namespace {

constexpr double kLong_s = 1e9;
constexpr double kRounding_s = 1e-9;

}  // namespace

std::vector<ParameterSpec> gnss_mode_parameters() {
  return {
      choice_parameter("corrections", "rtk", {"none", "sbas", "rtk"},
                       "what the receiver is told: nothing, SBAS, or a base station's RTK"),
      choice_parameter("start", "running", {"running", "cold"},
                       "running: it has had its best solution for long; cold: switched on now"),
      number_parameter("cold_start_s", "s", 25.0, 0.0, 1e4, "time to first fix, start: cold"),
      number_parameter("max_pdop", "", 25.0, 1.0, 1e3, "largest dilution of a position by code"),
      number_parameter("sbas_s", "s", 6.0, 0.0, 1e4, "until corrections are there"),
      integer_parameter("float_satellites", 5, 4, 50, "least number for carrier phase, float"),
      integer_parameter("fixed_satellites", 6, 4, 50, "least number for carrier phase, fixed"),
      number_parameter("max_rtk_pdop", "", 5.0, 1.0, 1e3,
                       "largest dilution of a position by carrier phase"),
      number_parameter("time_to_fix_s", "s", 10.0, 0.0, 1e4, "from float to fixed, first time"),
      number_parameter("time_to_refix_s", "s", 4.0, 0.0, 1e4, "from float to fixed again"),
  };
}

GnssModeRules read_gnss_mode_rules(const ParameterSet& parameters, const std::string& part) {
  GnssModeRules rules;
  const std::string& corrections = parameters.text("corrections");
  rules.corrections = corrections == "rtk"    ? GnssCorrections::kRtk
                      : corrections == "sbas" ? GnssCorrections::kSbas
                                              : GnssCorrections::kNone;
  rules.max_pdop = parameters.number("max_pdop");
  rules.cold_start_s = parameters.number("cold_start_s");
  rules.sbas_s = parameters.number("sbas_s");
  rules.float_satellites = static_cast<int>(parameters.integer("float_satellites"));
  rules.fixed_satellites = static_cast<int>(parameters.integer("fixed_satellites"));
  rules.max_rtk_pdop = parameters.number("max_rtk_pdop");
  rules.time_to_fix_s = parameters.number("time_to_fix_s");
  rules.time_to_refix_s = parameters.number("time_to_refix_s");
  if (rules.fixed_satellites < rules.float_satellites) {
    throw ConfigError(fmt::format("{}: fixed_satellites = {}, must be >= float_satellites = {}",
                                  part, rules.fixed_satellites, rules.float_satellites));
  }
  if (rules.time_to_refix_s > rules.time_to_fix_s) {
    throw ConfigError(fmt::format("{}: time_to_refix_s = {} s, must be <= time_to_fix_s = {} s",
                                  part, rules.time_to_refix_s, rules.time_to_fix_s));
  }
  return rules;
}

bool is_running_at_start(const ParameterSet& parameters) {
  return parameters.text("start") == "running";
}

GnssModes::GnssModes(const GnssModeRules& rules, double period_s, bool running)
    : rules_(rules),
      period_s_(period_s),
      on_s_(running ? kLong_s : -period_s),
      code_s_(running ? kLong_s : -period_s),
      fixable_s_(running ? kLong_s : -period_s),
      has_been_fixed_(false) {}

GnssFix::Mode GnssModes::step(double code_pdop, int carrier_count, double carrier_pdop) {
  using Mode = GnssFix::Mode;
  // Times count from the first tick at which a condition holds.
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

}  // namespace vinerow
