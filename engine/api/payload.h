#pragma once
/// Extension point Payload: what a vehicle carries to work with (a sprayer, a scouting camera) and
/// its effect on the true canopy.

#include <map>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/part.h"
#include "engine/api/scene_query.h"
#include "engine/api/vehicle.h"

namespace vinerow {

/// Patch of a row's true canopy on one side: one step along the row, one band of height.
struct CanopyPatch {
  int row = 0;    ///< PlantRow::id
  int side = 1;   ///< +1 left of the row's line, -1 right of it
  int along = 0;  ///< step along the row's line, from its first point
  int band = 0;   ///< band of height, from the ground up
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< middle of its triangles, m
  double area_m2 = 0.0;                           ///< of canopy triangles
  double amount = 0.0;                            ///< per m2; in CanopyCoverage::unit
};

/// Effect of a payload on the canopy.
struct CanopyCoverage {
  std::string quantity = "deposit";  ///< "deposit", "seen"
  std::string unit = "ml/m2";
  double wanted = 0.0;  ///< a patch counts as covered from this amount
  double step_m = 0.25;
  double band_m = 0.25;
  std::vector<CanopyPatch> patches;  ///< patches with area, sorted by row, side, along, band
};

/// Runs after the actuators. Reads signals ("estimate", "plan", "follower"), writes its own name.
class Payload : public SteppedPart {
 public:
  /// Called once after the last step. The kernel adds the results to the vehicle's metrics as
  /// "<payload's name>_<result>"; names carry units.
  virtual std::map<std::string, double> results() const = 0;
  /// @returns nullptr if the payload does not act on the canopy
  virtual const CanopyCoverage* coverage() const { return nullptr; }
};

struct PayloadContext : PartContext {
  std::string name;  ///< of the payload, and of the signal it writes
  const SceneQuery* scene = nullptr;
  const WorldModel* world = nullptr;
  const Vehicle* vehicle_truth = nullptr;
  const VehicleDescription* vehicle_description = nullptr;
  const RowMap* map = nullptr;  ///< the vehicle's map
};

}  // namespace vinerow
