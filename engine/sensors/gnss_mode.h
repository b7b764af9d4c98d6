#pragma once
/// How good a solution a receiver has: none, by code alone, with corrections from satellites, by
/// carrier phase with ambiguities as they come (float) or resolved (fixed).
///
/// Every tick it has the best mode whose conditions hold:
///   standalone  four satellites by code that tell a position, dilution at most `max_pdop`; at a
///               cold start not before `cold_start_s`
///   sbas        the same, for `sbas_s` already (corrections SBAS or RTK: a receiver that loses its
///               carrier phases corrects its codes)
///   float       `float_satellites` by carrier phase, dilution at most `max_rtk_pdop` (RTK)
///   fixed       `fixed_satellites` likewise, for `time_to_fix_s` already; `time_to_refix_s` where
///               it had been fixed and was at least float ever since
/// A condition that fails takes its mode away at once.

#include <vector>

#include "engine/api/messages/sensors.h"
#include "engine/api/parameters.h"

namespace vinerow {

enum class GnssCorrections { kNone, kSbas, kRtk };

struct GnssModeRules {
  GnssCorrections corrections;
  double max_pdop;
  double cold_start_s;  ///< 0: runs already
  double sbas_s;
  int float_satellites;
  int fixed_satellites;
  double max_rtk_pdop;
  double time_to_fix_s;
  double time_to_refix_s;
};

std::vector<ParameterSpec> gnss_mode_parameters();
/// @param part  for errors  @throws ConfigError if fixed needs fewer satellites than float, or
/// fixing anew takes longer than fixing first
GnssModeRules read_gnss_mode_rules(const ParameterSet& parameters, const std::string& part);
/// Whether the receiver has run for long at the start.
bool is_running_at_start(const ParameterSet& parameters);

class GnssModes {
 public:
  /// @param running  begins as if all conditions had held for long
  GnssModes(const GnssModeRules& rules, double period_s, bool running);

  /// One tick. @param code_pdop,carrier_pdop  infinity where there is no position
  GnssFix::Mode step(double code_pdop, int carrier_count, double carrier_pdop);

 private:
  GnssModeRules rules_;
  double period_s_;
  double on_s_;          ///< since switched on
  double code_s_;        ///< standalone's conditions have held
  double fixable_s_;     ///< fixed's conditions have held
  bool has_been_fixed_;  ///< and at least float ever since
};

}  // namespace vinerow
