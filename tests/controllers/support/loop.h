#pragma once
/// The loop of all tests and benchmarks of controllers, guidances and estimators: parts of one
/// vehicle between their signals, each at its own rate, a plant that moves between their ticks, and
/// the clock. Neither kernel nor physics.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/stepped_parts.h"
#include "engine/api/vehicle.h"
#include "tests/controllers/support/parts.h"
#include "tests/controllers/support/plant.h"

namespace vinerow::test {

struct LoopSetup {
  std::string vehicle = "rover";  ///< its signals are "<vehicle>/<name>"
  VehicleDescription description = make_rover_description();
  Duration tick{25'000'000};  ///< of the clock
  Duration physics = {};      ///< step of the plant, a divisor of the tick; 0: the tick
  double gravity_mps2 = 9.80665;
  std::uint64_t seed = 0;
  const RowMap* map = nullptr;
  std::vector<SensorMounting> sensors = {};
};

/// An event and when it was written.
struct LoopEvent : Event {
  Time time;
};

class Loop {
 public:
  explicit Loop(LoopSetup setup);
  Loop(const Loop&) = delete;

  /// Parts step in the order in which they are added. @param period  0: the tick
  /// @throws ConfigError as the part does
  Controller& add_controller(const PartChoice& choice, Duration period = {});
  Guidance& add_guidance(const PartChoice& choice, Duration period = {});
  Estimator& add_estimator(const PartChoice& choice, Duration period = {});
  /// Context and ports for a part without a registry. @param role  "controller", "guidance", ...
  template <class Context>
  Context make_context(const std::string& role, Duration period = {}) const;
  Ports ports(const std::string& role) { return {bus_, setup_.vehicle, full_part(role)}; }

  /// A plant that moves by the signal "actuators"; it must outlive the loop.
  void set_plant(Plant& plant);
  /// A plant that moves by other signals.
  void set_plant(std::function<Odometry()> truth, std::function<void(double dt_s)> move);
  /// Changes the estimate, which is the truth; null: it stays that.
  void set_estimate(std::function<void(Odometry& estimate)> change) {
    change_estimate_ = std::move(change);
  }
  /// Writes further signals before the parts step.
  void set_inputs(std::function<void()> inputs) { inputs_ = std::move(inputs); }
  /// Where the movement authority ends at a time, along the plan; null: there is none.
  void set_stop_at(std::function<double(double time_s)> stop_at_m) {
    stop_at_m_ = std::move(stop_at_m);
  }

  /// sense(), decide() and move().
  void tick();
  /// Ticks until this time. `each` is called in each tick after decide().
  void run_until(double time_s, const std::function<void()>& each = {});
  /// decide() and the clock, without plant and inputs: for a part between signals that a test
  /// writes.
  void step();
  void step(const Odometry& estimate);
  /// Writes "estimate", or "truth" if there is an estimator; "authority"; and further inputs.
  void sense();
  /// Steps the parts that are due.
  void decide();
  /// Moves the plant and the clock by one tick.
  void move();
  /// True in the first tick of each period.
  bool is_due(Duration period) const { return now_.ns % period.ns < setup_.tick.ns; }

  Time now() const { return now_; }
  double time_s() const { return now_.s(); }
  const VehicleDescription& description() const { return setup_.description; }
  const Controller& controller() const { return *controller_; }
  bool finished() const { return controller_->finished(); }
  const Guidance& guidance() const { return *guidance_; }

  /// Signals by their local names. A test is the writer of those that it writes.
  template <class T>
  void write(std::string_view name, const T& value) {
    write(name, value, now_);
  }
  template <class T>
  void write(std::string_view name, const T& value, Time stamp);
  void give_plan(const PlannedPath& plan) { write("plan", plan); }
  void give_authority(double stop_at_m) {
    write("authority", MovementAuthority{stop_at_m, -1, ""});
  }
  /// @throws std::logic_error if no such signal of this type was written
  template <class T>
  const T& read(std::string_view name) const;
  /// An entry of a signal of named values. @throws std::logic_error if there is none
  double value(std::string_view name, std::string_view entry) const;
  const std::vector<double>& actuators() const { return read<NamedValues>("actuators").values; }
  const FollowerState& follower() const { return read<FollowerState>("follower"); }
  const SignalBase* find(std::string_view name) const;

  /// Events of all parts so far.
  const std::vector<LoopEvent>& events() const { return events_; }
  /// Those with these words.
  std::vector<LoopEvent> events_with(std::string_view words) const;
  bool has_event(std::string_view words) const { return !events_with(words).empty(); }

 private:
  struct Member {
    Duration period;
    std::unique_ptr<SteppedPart> part;
    const Signal<Event>* event;
    std::uint64_t events_seen = 0;
  };

  std::string full_part(const std::string& role) const { return setup_.vehicle + "." + role; }
  template <class Part>
  Part& add(const std::string& role, Duration period, std::unique_ptr<Part> part);

  LoopSetup setup_;
  std::string test_part_;  ///< the writer of what a test writes
  SignalBus bus_;
  mutable std::map<std::string, SignalBase*, std::less<>> signals_;  ///< by local name
  std::vector<Member> members_;
  Controller* controller_ = nullptr;
  Guidance* guidance_ = nullptr;
  bool has_estimator_ = false, is_checked_ = false;
  std::function<Odometry()> truth_;
  std::function<void(double)> move_;
  std::function<void(Odometry&)> change_estimate_;
  std::function<void()> inputs_;
  std::function<double(double)> stop_at_m_;
  std::vector<LoopEvent> events_;
  Time now_;
};

template <class Context>
Context Loop::make_context(const std::string& role, Duration period) const {
  Context context;
  context.vehicle = setup_.vehicle;
  context.part = full_part(role);
  context.seed = setup_.seed;
  context.period = period.ns > 0 ? period : setup_.tick;
  context.physics_step = setup_.physics;
  context.gravity_mps2 = setup_.gravity_mps2;
  context.vehicle_description = &setup_.description;
  context.map = setup_.map;
  context.sensors = setup_.sensors;
  return context;
}

template <class T>
void Loop::write(std::string_view name, const T& value, Time stamp) {
  auto found = signals_.find(name);
  if (found == signals_.end() || found->second->writer() != test_part_) {
    ports("test").write<T>(std::string(name));
    find(name);
    found = signals_.find(name);
  }
  if (!is_message<T>(*found->second)) throw std::logic_error("another type: " + std::string(name));
  static_cast<Signal<T>*>(found->second)->write(stamp, value);
}

template <class T>
const T& Loop::read(std::string_view name) const {
  const SignalBase* signal = find(name);
  if (signal == nullptr || signal->sequence() == 0 || !is_message<T>(*signal)) {
    throw std::logic_error("not written: " + std::string(name));
  }
  return static_cast<const Signal<T>*>(signal)->value();
}

}  // namespace vinerow::test
