#pragma once
/// Opens and closes the left and the right section of a sprayer by what its vehicle knows: its
/// estimate, the rows of its map, and where asked for the kind of the plan's stretch.
///
/// A section is wanted open where the boom, `lead_s` ahead on the present course, has a row of the
/// map in reach on that side that runs along the heading, and the vehicle is not slower than the
/// least speed. So sections close in turns (their angle), on headlands (no row beside) and at a
/// halt. A valve follows its command `valve_lag_s` later; a command that is taken back sooner never
/// reaches it.

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

/// A valve that follows its command after a while.
class LaggingValve {
 public:
  /// @returns whether it is open at `now`
  bool follow(bool command, Time now, Duration lag);

 private:
  bool command_ = false;
  bool open_ = false;
  Time due_;
};

class SectionSwitch {
 public:
  /// @param map  of the vehicle
  SectionSwitch(const SprayerParams& params, const RowMap& map);

  /// Reads "estimate", and "plan" where sections open on legs only.
  void connect(Ports& ports);
  /// @returns which sections are open now
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
