#pragma once
/// Missions of rovers with exact kinematics: a planner, then an estimator and a controller in a
/// loop (loop.h), one pose per cycle. The plant is paper B's, or a steered one for controllers that
/// want that (plant.h).

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/forward.h"
#include "engine/api/vehicle.h"
#include "engine/core/indirect.h"
#include "engine/math/deviation.h"
#include "tests/controllers/support/loop.h"

namespace vinerow::test {

struct MissionSetup {
  Indirect<RowMap> map;
  controllers::Pose2 start;
  PartChoice planner{"coverage", {}};
  PartChoice estimator{"", {}};  ///< "" = the truth
  PartChoice controller{"pure_pursuit", {}};
  double cycle_s = 0.025;
  double accuracy_m = 0.0;  ///< uniform error of each coordinate of the fix
  std::uint64_t seed = 1;
  double longest_s = 2000.0;
  /// Where the movement authority ends at a time, along the plan; default: there is none.
  std::function<double(double time_s)> stop_at_m;
};

struct MissionResult {
  bool finished = false;
  double time_s = 0.0;
  double average_m = 0.0;  ///< ATD
  double max_m = 0.0;
  double leg_rms_m = 0.0;         ///< of samples nearest to legs
  std::int64_t oscillations = 0;  ///< OF
  double relative_accuracy = 0.0;
  double max_yaw_rate_radps = 0.0;
  PlannedPath plan;
  std::vector<controllers::Pose2> poses;
};

/// Of the vehicle that a controller drives here: paper B's rover, or the steered one where the
/// controller refuses that.
const VehicleDescription& vehicle_for(const std::string& controller);

/// Paper B's orchard: plant rows at x = 10, 20 .. 90, alleys at x = 5, 15 .. 95, y from 10 to 90.
RowMap make_paper_map();
/// Paper B's mission in reading R1: waypoint pitch as given, semicircles, pure_pursuit on the
/// truth.
MissionSetup make_paper_mission(double pitch_m = 0.33);

/// @param vehicle  that is planned for; null: paper B's rover
std::unique_ptr<Planner> make_planner(const PartChoice& choice, const RowMap& map,
                                      const VehicleDescription* vehicle = nullptr);
/// The plan, or a failed DEMAND with the planner's reason.
PlannedPath plan_mission(const MissionSetup& setup);

MissionResult run_mission(const MissionSetup& setup);
/// Mean and standard deviation of the relative accuracy over seeds 1..count.
std::pair<double, double> run_seeds(MissionSetup setup, int count);

}  // namespace vinerow::test
