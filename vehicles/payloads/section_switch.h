#pragma once
/// Automatic switching of a sprayer's left and right sections. It uses only what the vehicle knows:
/// its estimate, the rows of its map and, if `on_legs_only`, the kind of the plan's stretch.
///
/// A section is commanded open if the boom, `lead_s` ahead on the present course, has a row of the
/// map within reach on that side that is parallel to the heading, and the vehicle is not slower
/// than `min_speed_mps`. Sections therefore close in turns (the angle), on headlands (no row) and
/// at a halt. A valve follows its command after `valve_lag_s`; a command that is withdrawn sooner
/// has no effect.

#include <optional>

#include "engine/api/messages/motion.h"
#include "engine/api/plan_stretch.h"
#include "engine/api/signal.h"
#include "vehicles/payloads/sprayer_params.h"
#include "vehicles/payloads/worked_rows.h"

namespace vinerow::vehicles {

struct Sections {
  bool left = false;
  bool right = false;
};

/// Valve that follows its command after a lag.
class LaggingValve {
 public:
  /// @returns true if it is open at `now`
  bool follow(bool command, Time now, Duration lag);

 private:
  bool command_ = false;
  bool open_ = false;
  Time due_;
};

class SectionSwitch {
 public:
  /// @param map  map of the vehicle
  SectionSwitch(const SprayerParams& params, const RowMap& map);

  /// Reads "estimate", and "plan" if sections open on legs only.
  void connect(Ports& ports);
  /// @returns the sections that are open now
  Sections step(Time now);

 private:
  Sections wanted();

  SprayerParams params_;
  Duration lag_;
  RowLines rows_;
  SignalReader<Odometry> estimate_;
  PlanStretch plan_;
  LaggingValve left_, right_;
};

}  // namespace vinerow::vehicles
