#pragma once
/// Checks of a vehicle that end its work or the run: invalid state, edge of the ground, contacts,
/// crashes, driven wheels without progress.

#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/sim/crash.h"
#include "engine/sim/progress_watch.h"
#include "engine/sim/vehicle_assembly.h"

namespace vinerow {

class VehicleWatch {
 public:
  /// All references outlive the watch. @param first_body, end_body  of the vehicle in the physics
  /// world: index of the first, and behind the last
  VehicleWatch(const scenario::VehicleConfig& config, const RunContext& run, const Vehicle& vehicle,
               int first_body, int end_body);

  /// Signal "contacts".
  void connect(Ports& ports) { contacts_writer_ = ports.write<NamedValues>("contacts"); }
  /// The vehicle's work begins: counts touches from 0 and progress from here.
  void begin(Time now);
  void publish_contacts(Time now) { contacts_writer_.write(now, contacts_); }

  /// After each physics step. @param parts  of the present phase
  /// @throws SimulationError if the state is not finite or plausible, or if there is no ground
  void check(Time now, const VehicleParts& parts);
  /// While the controller has something to do. @param p_W  of the vehicle
  /// @param actuators  commanded values, in the order of the description
  void check_progress(Time now, const Eigen::Vector3d& p_W, const std::vector<double>& actuators);

  /// Its task cannot be done. Without effect if it has crashed, got stuck or given up before.
  void give_up(Time now, const std::string& reason) {
    if (!crash_) set_crash(now, EndKind::kGaveUp, reason);
  }

  /// How the vehicle crashed or got stuck, or why its guidance or controller gave up, if so.
  const std::optional<Crash>& crash() const { return crash_; }

 private:
  [[noreturn]] void fail(Time now, const std::string& text) const;
  /// Outside the ground a vehicle would fall forever. @throws SimulationError
  void demand_ground(Time now, const Pose& X_WB) const;
  void watch_contacts(Time now);
  void watch_crash(Time now, const VehicleParts& parts);
  void set_crash(Time now, EndKind kind, const std::string& text);

  const scenario::VehicleConfig& config_;
  const RunContext& run_;
  const Vehicle& vehicle_;
  int first_body_, end_body_;
  SignalWriter<NamedValues> contacts_writer_;
  NamedValues contacts_{{"touches", "touching"}, {0.0, 0.0}};
  Time last_contact_{-1'000'000'000};
  ProgressWatch progress_;
  Time progress_seen_;
  std::optional<Crash> crash_;
};

}  // namespace vinerow
