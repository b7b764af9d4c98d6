#pragma once
/// Controllers of vehicles on wings about steady flight on the plain aircraft of aircraft_sim.h,
/// without kernel and registry: straight and level at 100 m towards east, with gusts along the
/// body's axes.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/flight.h"
#include "engine/api/parameters.h"
#include "engine/api/stepped_parts.h"
#include "engine/core/random.h"
#include "tests/controllers/support/aircraft_sim.h"

namespace vinerow::test {

using Values = std::vector<std::pair<std::string, ParameterSet::Value>>;

struct WingSetup {
  std::string type = "trmpc";  ///< or "mpc_nominal", "fixed_wing_lqr"
  Values parameters;
  AircraftNumbers numbers = make_reference_wing();
  double rate_Hz = 20.0;
  double physics_s = 0.01;
  double low_m = 0.0;    ///< start below the wanted height
  double off_rad = 0.0;  ///< start with the heading turned clockwise by this
};

/// @throws ConfigError as the controller does
std::unique_ptr<Controller> make_wing_controller(const WingSetup& setup,
                                                 const VehicleDescription& description);

class WingLoop {
 public:
  explicit WingLoop(const WingSetup& setup);
  WingLoop(const WingLoop&) = delete;

  /// One period of the controller: it decides, the vehicle flies. @param gust  u_g, v_g, w_g, m/s
  void tick(const Eigen::Vector3d& gust = Eigen::Vector3d::Zero()) {
    tick(gust, [](const std::function<void()>& decide) { decide(); });
  }
  /// The same; `around` is to call what it is given, which is the controller's step.
  void tick(const Eigen::Vector3d& gust,
            const std::function<void(const std::function<void()>& decide)>& around);

  double time_s() const { return static_cast<double>(now_.ns) * 1e-9; }
  AircraftSim& sim() { return sim_; }
  AirReference& reference() { return wanted_; }
  double deviation(const std::string& name) const { return value_of(deviation_.value(), name); }
  double tube(const std::string& name) const { return value_of(tube_.value(), name); }
  const std::vector<double>& actuators() const { return actuators_.value().values; }
  const std::vector<std::string>& events() const { return events_; }

 private:
  static double value_of(const NamedValues& values, const std::string& name);

  WingSetup setup_;
  VehicleDescription description_;
  AircraftSim sim_;
  SignalBus bus_;
  std::unique_ptr<Controller> controller_;
  AirReference wanted_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<AirReference> reference_;
  SignalReader<NamedValues> actuators_, deviation_, tube_;
  SignalReader<Event> event_;
  std::vector<std::string> events_;
  std::uint64_t seen_event_ = 0;
  Time now_;
  Duration period_;
};

/// Gusts of the reference of paper A: Gauss-Markov (60 m at 12 m/s, sigma 0.5 m/s) along a fixed
/// direction, clipped to 1 m/s, times `strength`; drawn once a tick of 0.05 s.
class GaussMarkovGust {
 public:
  explicit GaussMarkovGust(std::uint64_t seed, double strength = 1.0);
  Eigen::Vector3d next();

 private:
  RandomStream random_;
  Eigen::Vector3d direction_;
  double strength_, value_;
};

}  // namespace vinerow::test
