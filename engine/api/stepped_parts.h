#pragma once
/// Extension points that run between physics steps. A part sees only signals, so the same object
/// runs in a simulation and in a unit test.
///
/// Order within an instant: sensors, estimators, planners and guidance, controllers, actuators,
/// physics, metrics. Local signal names (see Ports): "truth" (kernel), "<sensor name>" (sensors),
/// "estimate" (estimator), "plan" and "plan_tree" (planner), "local_command" (guidance), "command"
/// VelocityCommand or "actuators" NamedValues (controller), "follower" (controller), "reference"
/// (guidance of flying vehicles: ReferenceTrajectory of rotorcraft, AirReference of winged
/// vehicles). To report what happened, a part writes an Event to its own "<part>_event"; the kernel
/// forwards it to "run/events".

#include <filesystem>
#include <functional>
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

/// Sensor. Reads "truth" and the scene, writes the signal of its own name.
///
/// A sensor with a delay measures in step() and delivers the reading in deliver(), which the kernel
/// calls `delay()` later, once per step() and in the same order. The signal's stamp is the time of
/// the measurement.
class Sensor : public SteppedPart {
 public:
  /// Time between measurement and delivery, a multiple of the physics step; constant.
  virtual Duration delay() const { return {}; }
  /// Only called if delay() > 0.
  virtual void deliver(Time /*now*/) {}
  /// Time between two calls of sample(), a multiple of the physics step that divides the period;
  /// constant. Zero: it is not called.
  virtual Duration sampling() const { return {}; }
  /// For sensors that measure while they wait for their reading, as a turning laser does. Called
  /// before step() at an instant that has both.
  virtual void sample(Time /*now*/) {}
  /// Mounting pose (x of S is the viewing direction); nullopt if it has no meaning for the sensor.
  virtual std::optional<Pose> mounting_X_BS() const { return std::nullopt; }
};

/// Mounting of a sensor as estimators, guidance and controllers know it: from a data sheet, not
/// from the truth.
struct SensorMounting {
  std::string name;  ///< of the sensor and its signal
  std::string type;
  Pose X_BS;
};

/// Context of a sensor.
struct SensorContext : PartContext {
  std::string name;  ///< of the sensor, and of the signal it writes
  const SceneQuery* scene = nullptr;
  /// Surfaces as light meets them: leaves one by one where the world has them, and wires. Built at
  /// the first call, which takes time and memory; call it in the constructor.
  std::function<const RayScene&()> light;
  /// Vehicles as cameras see them. Built at the first call; call it at the first step, when all
  /// vehicles exist. Empty function: there are none.
  std::function<VehicleScene&()> vehicles;
  const WorldModel* world = nullptr;
  const Vehicle* vehicle_truth = nullptr;  ///< for inertial sensors
};

/// Estimator. Reads sensors, writes "estimate" (Odometry). A vehicle acts on one; others may run
/// next to it as observers (observer.h).
class Estimator : public SteppedPart {};

struct EstimatorContext : PartContext {
  const VehicleDescription* vehicle_description = nullptr;
  const RowMap* map = nullptr;
  std::vector<SensorMounting> sensors;  ///< those with a mounting, in the file's order
  GeoOrigin origin;                     ///< of W
};

/// Context of a map part. A map is plain data (RowMap): it is all that the vehicle's planner,
/// guidance, estimator and controller know about the world.
struct MapContext : PartContext {
  const WorldModel* world = nullptr;  ///< the truth, from which the map is surveyed
  const SceneQuery* scene = nullptr;
};

/// Report of a planner about its work, in addition to the path.
struct PlanReport {
  /// "nodes", "iterations", "length_m", "clearance_m" and other counts; written to summary.json.
  std::map<std::string, double> numbers;
  LineList tree;  ///< search tree on the ground; may be empty
};

/// Planner. Makes a path from a map when its mission phase starts. Limit iterations, never wall
/// time: results must not depend on the machine.
class Planner {
 public:
  virtual ~Planner() = default;
  /// @param start  pose of the vehicle (from its estimate)
  /// @returns the path, or the reason for the failure
  virtual Result<PlannedPath> plan(const Pose& start) = 0;
  /// Report on the last plan(), also if it failed. @returns nullptr if the planner keeps no report
  virtual const PlanReport* report() const { return nullptr; }
};

struct PlannerContext : PartContext {
  const VehicleDescription* vehicle_description = nullptr;
  const RowMap* map = nullptr;
  /// Ground height of the map, m; used to lift planned points.
  const SceneQuery* scene = nullptr;
  GeoOrigin origin;  ///< of W, for files in latitude and longitude
};

/// Guidance (local planning). Reads "estimate" and "plan", writes "reference" signals for a
/// controller.
class Guidance : public SteppedPart {};

/// Controller. Reads "estimate" and "plan" (or guidance's signals), writes "actuators"
/// (NamedValues) and "follower".
class Controller : public SteppedPart {
 public:
  /// True when the task is complete; the kernel then ends the vehicle's mission.
  virtual bool finished() const { return false; }
};

struct ControllerContext : PartContext {
  const VehicleDescription* vehicle_description = nullptr;
  const RowMap* map = nullptr;
  std::vector<SensorMounting> sensors;  ///< those with a mounting, in the file's order
};

/// Autopilot: firmware outside the run that drives or flies a vehicle, in place of estimator,
/// guidance and controller. Reads sensors and the vehicle's state, writes "actuators"; writes
/// "estimate" if the firmware reports its own.
///
/// step() gives the firmware the state of an instant, finish_step() waits for its outputs and
/// writes them. The kernel calls the latter after all controllers of the instant and before the
/// actuators, so that the firmware of several vehicles computes at the same time. Waiting in vain
/// throws SimulationError.
class Autopilot : public Controller {
 public:
  virtual void finish_step(Time now) = 0;
};

struct AutopilotContext : PartContext {
  const VehicleDescription* vehicle_description = nullptr;
  const Vehicle* vehicle_truth = nullptr;  ///< for what its inertial sensors measure
  const RowMap* map = nullptr;
  std::vector<SensorMounting> sensors;  ///< those with a mounting, in the file's order
  GeoOrigin origin;                     ///< of W
  /// Of this run: where the firmware works and recordings go. It may not exist yet.
  std::filesystem::path folder;
};

/// Metric. Judges a run. Reads signals (truth and plan), never writes any.
class Metric : public SteppedPart {
 public:
  /// Called once after the last step. Names carry units: "cross_track_rms_m". NaN means "not
  /// measured".
  virtual std::map<std::string, double> results() const = 0;
};

struct MetricContext : PartContext {
  const VehicleDescription* vehicle_description = nullptr;
  const SceneQuery* scene = nullptr;
  const WorldModel* world = nullptr;
  const Vehicle* vehicle_truth = nullptr;  ///< for facts that no signal holds: crash()
  /// Names of the vehicle's observers; observer_signals() gives the signals of each.
  std::vector<std::string> observers;
};

/// Context of a World part, which builds the true world. The WorldModel does not change afterwards.
struct WorldContext : PartContext {};

}  // namespace vinerow
