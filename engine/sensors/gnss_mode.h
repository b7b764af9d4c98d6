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

#include "engine/api/messages/sensors.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::sensors {

enum class GnssCorrections { kNone, kSbas, kRtk };

struct GnssModeRules {
  GnssCorrections corrections = GnssCorrections::kRtk;
  bool is_running_at_start = true;  ///< for long already
  double cold_start_s = 25.0;       ///< where it is not
  double max_pdop = 25.0;
  double sbas_s = 6.0;
  int float_satellites = 5;
  int fixed_satellites = 6;
  double max_rtk_pdop = 5.0;
  double time_to_fix_s = 10.0;
  double time_to_refix_s = 4.0;
};

/// Refuses rules by which fixed needs fewer satellites than float, or fixing anew takes longer than
/// fixing first.
const ParameterTable<GnssModeRules>& gnss_mode_table();

class GnssModes {
 public:
  /// A receiver that runs at the start begins as if all conditions had held for long.
  GnssModes(const GnssModeRules& rules, double period_s);

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

}  // namespace vinerow::sensors
