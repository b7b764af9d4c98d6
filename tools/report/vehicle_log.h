#pragma once
/// Signals of a vehicle for plots, as columns over time.

#include <map>
#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/api/vehicle.h"
#include "engine/playback/log_trace.h"
#include "tools/report/run_folder.h"

namespace vinerow::tools::report {

/// Named numbers over time.
struct Columns {
  std::vector<double> t_s;
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;  ///< one per name, each as long as t_s

  bool empty() const { return t_s.empty(); }
  /// Null if there is no such column.
  const std::vector<double>* find(const std::string& name) const;
};

/// Reference of a rotorcraft over time.
struct FlightReference {
  std::vector<double> t_s;
  std::vector<Eigen::Vector3d> p_W;
  std::vector<double> speed_mps, yaw_rad;
  std::vector<int> phase;  ///< ReferenceTrajectory::Phase
};

struct VehicleLog {
  std::string name;
  std::string style;  ///< CSS class of its colour, "v0" (engine/playback/vehicle_colours.h)
  bool flies = false;
  bool has_wings = false;
  std::vector<ActuatorSpec> actuators;
  playback::Trace<Odometry> truth;
  playback::Trace<PlannedPath> plan;
  std::map<std::string, playback::Trace<Odometry>> estimates;  ///< "estimate" unless it is the
                                                               ///< truth; estimates of observers
  FlightReference reference;
  playback::Trace<AirReference> air_reference;
  playback::Trace<VelocityCommand> command;
  playback::Trace<BatteryState> battery;
  playback::Trace<MovementAuthority> authority;
  std::map<std::string, Columns> columns;  ///< by signal: actuators, wheels, deviation, steering...

  const Columns* find(const std::string& signal) const;
};

/// Reads every vehicle of a run; empty if it has no log.
std::vector<VehicleLog> read_vehicles(const RunFolder& run);

}  // namespace vinerow::tools::report
