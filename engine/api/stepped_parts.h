#pragma once
/// The extension points that run between physics steps. A class sees signals only, so the same
/// object runs in a simulation and in a unit test.
///
/// Order inside an instant: sensors, estimators, planners and guidance, controllers, actuators,
/// physics, metrics. Local signal names (see Ports): "truth" (kernel), "<sensor name>" (sensors),
/// "estimate" (estimator), "plan" and "plan_tree" (planner), "local_command" (guidance), "command"
/// VelocityCommand or "actuators" NamedValues (controller), "follower" (controller), "reference"
/// (guidance of flying vehicles: ReferenceTrajectory of rotorcraft, AirReference of what has
/// wings). A part tells people what happened by writing an Event of its own, "<part>_event"; the
/// kernel passes it on to "run/events".

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/messages/path.h"
#include "engine/api/part.h"
#include "engine/api/scene_query.h"
#include "engine/api/vehicle.h"
#include "engine/core/result.h"
#include "engine/math/geo_origin.h"

namespace vinerow {

/// Measures. Reads "truth" and the scene, writes its own name.
///
/// A sensor with a delay measures in step() and hands the reading over in deliver(), which the
/// kernel calls `delay()` later, once per step() and in the same order. The signal's stamp is the
/// time of the measurement.
class Sensor : public SteppedPart {
 public:
  /// Time between measurement and delivery, a multiple of the physics step; constant.
  virtual Duration delay() const { return {}; }
  /// Only called where delay() > 0.
  virtual void deliver(Time /*now*/) {}
  /// Where it sits and looks (x of S), if that means anything.
  virtual std::optional<Pose> mounting_X_BS() const { return std::nullopt; }
};

/// A sensor as guidance and controllers are told of it: a data sheet, not a truth.
struct SensorMounting {
  std::string name;  ///< of the sensor and its signal
  std::string type;
  Pose X_BS;
};

/// What a sensor needs beside PartContext.
struct SensorContext : PartContext {
  std::string name;  ///< of the sensor, and of the signal it writes
  const SceneQuery* scene = nullptr;
  const WorldModel* world = nullptr;
  const Vehicle* vehicle_truth = nullptr;  ///< for inertial sensors
};

/// Reads sensors, writes "estimate" (Odometry). A vehicle acts on one; others may run beside it as
/// observers (observer.h).
class Estimator : public SteppedPart {};

struct EstimatorContext : PartContext {
  const VehicleDescription* vehicle_description = nullptr;
  const RowMap* map = nullptr;
  std::vector<SensorMounting> sensors;  ///< those with a mounting, in the file's order
  GeoOrigin origin;                     ///< of W
};

/// What the maker of a vehicle's map needs. A map is plain data (RowMap): the vehicle's planner,
/// guidance, estimator and controller know the world by it alone.
struct MapContext : PartContext {
  const WorldModel* world = nullptr;  ///< the truth, which is surveyed
  const SceneQuery* scene = nullptr;
};

/// What a planner tells about its work beside the path.
struct PlanReport {
  /// "nodes", "iterations", "length_m", "clearance_m" and what else it counts; goes into
  /// summary.json.
  std::map<std::string, double> numbers;
  LineList tree;  ///< what was searched, on the ground; may be empty
};

/// Makes a path from a map when its mission phase starts. Stops on iterations, never on seconds.
class Planner {
 public:
  virtual ~Planner() = default;
  /// @param start  pose of the vehicle (from its estimate)
  /// @returns the path, or the reason why there is none
  virtual Result<PlannedPath> plan(const Pose& start) = 0;
  /// About the last plan(), also a failed one. @returns nullptr if it keeps no report
  virtual const PlanReport* report() const { return nullptr; }
};

struct PlannerContext : PartContext {
  const VehicleDescription* vehicle_description = nullptr;
  const RowMap* map = nullptr;
  /// Ground height of the map, m; used to lift planned points.
  const SceneQuery* scene = nullptr;
  GeoOrigin origin;  ///< of W, for files in latitude and longitude
};

/// Local planning: reads "estimate" and "plan", writes "reference" signals that a controller reads.
class Guidance : public SteppedPart {};

/// Reads "estimate" and "plan" (or guidance's signals), writes "actuators" (NamedValues) and
/// "follower".
class Controller : public SteppedPart {
 public:
  /// True when there is nothing left to do; the kernel ends the mission of the vehicle.
  virtual bool finished() const { return false; }
};

struct ControllerContext : PartContext {
  const VehicleDescription* vehicle_description = nullptr;
  const RowMap* map = nullptr;
  std::vector<SensorMounting> sensors;  ///< those with a mounting, in the file's order
};

/// Judges a run. Reads signals (truth and plan), never writes any.
class Metric : public SteppedPart {
 public:
  /// Called once after the last step. Names carry units: "cross_track_rms_m". Values may be NaN =
  /// "not measured".
  virtual std::map<std::string, double> results() const = 0;
};

struct MetricContext : PartContext {
  const VehicleDescription* vehicle_description = nullptr;
  const SceneQuery* scene = nullptr;
  const WorldModel* world = nullptr;
  const Vehicle* vehicle_truth = nullptr;  ///< for what no signal tells: crash()
  /// Names of the vehicle's observers; observer_signals() tells what each one writes.
  std::vector<std::string> observers;
};

/// Builds the true world. Everything is decided here; a WorldModel does not change afterwards.
struct WorldContext : PartContext {};

}  // namespace vinerow
