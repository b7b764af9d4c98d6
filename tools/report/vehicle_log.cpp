#include "tools/report/vehicle_log.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/playback/vehicle_colours.h"

namespace vinerow::tools::report {
namespace {

using playback::read_into;

/// Plotted signals; others of the same type are not read.
constexpr const char* kColumns[] = {"actuators", "wheels", "deviation", "steering",
                                    "wrench",    "rotors", "air"};

void read_columns(record::LogPass& pass, const std::string& topic, Columns& columns) {
  pass.read<NamedValues>(topic, [&columns](Time t, const NamedValues& value) {
    if (columns.names.empty()) {
      columns.names = value.names;
      columns.values.resize(value.names.size());
    }
    if (value.values.size() != columns.values.size()) return;
    columns.t_s.push_back(t.s());
    for (std::size_t i = 0; i < value.values.size(); ++i) {
      columns.values[i].push_back(value.values[i]);
    }
  });
}

void read_reference(record::LogPass& pass, const std::string& topic, FlightReference& reference) {
  pass.read<ReferenceTrajectory>(topic, [&reference](Time t, const ReferenceTrajectory& value) {
    if (value.points.empty()) return;
    const TrajectoryPoint& now = value.points.front();
    reference.t_s.push_back(t.s());
    reference.p_W.push_back(now.p_W);
    reference.speed_mps.push_back(now.v_W.norm());
    reference.yaw_rad.push_back(now.yaw_rad);
    reference.phase.push_back(static_cast<int>(value.phase));
  });
}

/// Whether a vehicle acts on the truth: it has no estimator or, if the scenario is unknown, its
/// estimate equals the truth whenever both were logged at the same instant.
bool acts_on_truth(const RunFolder& run, const VehicleLog& vehicle) {
  if (run.scenario) {
    for (const scenario::VehicleConfig& config : run.scenario->vehicles) {
      if (config.name == vehicle.name) return config.estimate_is_truth();
    }
  }
  const playback::Trace<Odometry>& estimate = vehicle.estimates.at("estimate");
  for (std::size_t i = 0; i < estimate.times.size(); ++i) {
    const auto at =
        std::lower_bound(vehicle.truth.times.begin(), vehicle.truth.times.end(), estimate.times[i]);
    if (at == vehicle.truth.times.end() || *at != estimate.times[i]) continue;
    const auto k = static_cast<std::size_t>(at - vehicle.truth.times.begin());
    if (estimate.values[i].X_WB.p != vehicle.truth.values[k].X_WB.p) return false;
  }
  return true;
}

/// @param pass  through `log`; fills the vehicle when it runs
void read_signal(const record::LogReader& log, record::LogPass& pass,
                 const record::ChannelInfo& channel, const std::string& signal,
                 VehicleLog& vehicle) {
  const auto found = channel.metadata.find("vinerow_type");
  if (found == channel.metadata.end() || channel.messages == 0) return;
  const std::string& type = found->second;
  if (type == Odometry::kType && signal == "truth") {
    read_into(pass, channel.topic, vehicle.truth);
  } else if (type == Odometry::kType) {
    if (!playback::is_truth_of_reading(log, channel.topic)) {
      read_into(pass, channel.topic, vehicle.estimates[signal]);
    }
  } else if (type == PlannedPath::kType && signal == "plan") {
    read_into(pass, channel.topic, vehicle.plan);
  } else if (type == ReferenceTrajectory::kType && signal == "reference") {
    read_reference(pass, channel.topic, vehicle.reference);
  } else if (type == AirReference::kType && signal == "reference") {
    read_into(pass, channel.topic, vehicle.air_reference);
  } else if (type == VelocityCommand::kType && signal == "command") {
    read_into(pass, channel.topic, vehicle.command);
  } else if (type == BatteryState::kType) {
    read_into(pass, channel.topic, vehicle.battery);
  } else if (type == MovementAuthority::kType) {
    read_into(pass, channel.topic, vehicle.authority);
  } else if (type == NamedValues::kType &&
             std::find(std::begin(kColumns), std::end(kColumns), signal) != std::end(kColumns)) {
    read_columns(pass, channel.topic, vehicle.columns[signal]);
  }
}

void describe(const VehicleDescription& description, VehicleLog& vehicle) {
  vehicle.actuators = description.actuators;
  vehicle.flies = description.flies();
  vehicle.has_wings = description.fixed_wing.has_value();
}

}  // namespace

const std::vector<double>* Columns::find(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &values[static_cast<std::size_t>(found - names.begin())];
}

const Columns* VehicleLog::find(const std::string& signal) const {
  const auto found = columns.find(signal);
  return found == columns.end() || found->second.empty() ? nullptr : &found->second;
}

std::vector<VehicleLog> read_vehicles(const RunFolder& run) {
  std::vector<VehicleLog> vehicles;
  if (!run.log) return vehicles;
  vehicles.reserve(run.vehicles.size());  // the pass writes to them
  record::LogPass pass(*run.log);
  for (const std::string& name : run.vehicles) {
    VehicleLog& vehicle = vehicles.emplace_back();
    vehicle.name = name;
    vehicle.style = fmt::format("v{}", (vehicles.size() - 1) % playback::kVehicleColours.size());
    // Without a scenario only the signals are known.
    if (!run.models.empty()) describe(run.models[vehicles.size() - 1]->description(), vehicle);
    const std::string prefix = "/" + name + "/";
    for (const record::ChannelInfo& channel : run.log->info().channels) {
      if (!channel.topic.starts_with(prefix)) continue;
      read_signal(*run.log, pass, channel, channel.topic.substr(prefix.size()), vehicle);
    }
  }
  pass.run();
  for (VehicleLog& vehicle : vehicles) {
    if (vehicle.estimates.contains("estimate") && acts_on_truth(run, vehicle)) {
      vehicle.estimates.erase("estimate");
    }
  }
  return vehicles;
}

}  // namespace vinerow::tools::report
