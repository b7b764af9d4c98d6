#pragma once
/// Solution mode of a GNSS receiver: none, by code alone, with corrections from satellites, by
/// carrier phase with float or resolved (fixed) ambiguities.
///
/// Every tick selects the best mode whose conditions hold:
///   standalone  four satellites by code that determine a position, dilution at most `max_pdop`;
///               after a cold start not before `cold_start_s`
///   sbas        the same, for at least `sbas_s` (corrections SBAS or RTK: a receiver that loses
///               its carrier phases corrects its codes)
///   float       `float_satellites` by carrier phase, dilution at most `max_rtk_pdop` (RTK)
///   fixed       the same with `fixed_satellites`, for at least `time_to_fix_s`; for at least
///               `time_to_refix_s` if it was fixed before and at least float ever since
/// If a condition fails, its mode ends at once.

#include "engine/api/messages/sensors.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::sensors {

enum class GnssCorrections { kNone, kSbas, kRtk };

struct GnssModeRules {
  GnssCorrections corrections = GnssCorrections::kRtk;
  bool is_running_at_start = true;  ///< it has been on for a long time
  double cold_start_s = 25.0;       ///< if it is not running at the start
  double max_pdop = 25.0;
  double sbas_s = 6.0;
  int float_satellites = 5;
  int fixed_satellites = 6;
  double max_rtk_pdop = 5.0;
  double time_to_fix_s = 10.0;
  double time_to_refix_s = 4.0;
};

/// Rejects rules by which fixed needs fewer satellites than float, or a later fix takes longer than
/// the first.
const ParameterTable<GnssModeRules>& gnss_mode_table();

class GnssModes {
 public:
  /// If the receiver runs at the start, all conditions count as having held for a long time.
  GnssModes(const GnssModeRules& rules, double period_s);

  /// Advances by one tick. @param code_pdop,carrier_pdop  infinity without a position
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
