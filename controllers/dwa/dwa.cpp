#include "controllers/dwa/dwa.h"

#include <fmt/format.h>

#include <cmath>

#include "controllers/dwa/dwa_params.h"
#include "engine/api/map.h"
#include "engine/api/messages/event.h"
#include "engine/api/parameter_table.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {
namespace {

std::vector<SensorMounting> find_rangers(const ControllerContext& context) {
  std::vector<SensorMounting> rangers;
  for (const SensorMounting& sensor : context.sensors) {
    if (sensor.type == "ultrasound") rangers.push_back(sensor);
  }
  return rangers;
}

/// Axle angles from a signal of named values, located by name once.
class SteeringReader {
 public:
  void connect(Ports& ports, const std::string& signal) {
    values_ = ports.read_optional<NamedValues>(signal);
  }
  bool read(AxleAngles* steering) {
    if (!values_.has_value()) return false;
    const NamedValues& now = values_.value();
    if (front_ < 0 || rear_ < 0) {
      for (std::size_t i = 0; i < now.names.size(); ++i) {
        if (now.names[i] == "axle_front_steer_rad") front_ = static_cast<int>(i);
        if (now.names[i] == "axle_rear_steer_rad") rear_ = static_cast<int>(i);
      }
    }
    const int count = static_cast<int>(now.values.size());
    if (front_ < 0 || rear_ < 0 || front_ >= count || rear_ >= count) return false;
    *steering = {now.values[front_], now.values[rear_]};
    return true;
  }

 private:
  SignalReader<NamedValues> values_;
  int front_ = -1;
  int rear_ = -1;
};

class Dwa final : public Guidance {
 public:
  Dwa(const DwaPartParams& params, const ControllerContext& context)
      : source_(context.part),
        known_(context.map != nullptr ? DistanceField(context.map->occupancy) : DistanceField()),
        rangers_(find_rangers(context)),
        memory_(params.memory, rangers_, known_, context.vehicle_description->outline_B(),
                context.vehicle_description->height_above_ground_m),
        guide_(params.guide, make_dwa_outline(params, context),
               context.vehicle_description->outline_B(), known_) {}

  void connect(Ports& ports) override {
    estimate_ = ports.read<Odometry>("estimate");
    plan_ = ports.read<PlannedPath>("plan");
    authority_ = ports.read_optional<MovementAuthority>("authority");
    encoders_.connect(ports, "encoders");
    actuators_.connect(ports, "actuators");
    for (const SensorMounting& ranger : rangers_) {
      ranges_.push_back(ports.read<RangeSample>(ranger.name));
    }
    seen_ranges_.assign(ranges_.size(), 0);
    out_ = ports.write<LocalCommand>("local_command");
    event_writer_ = ports.write<Event>("guidance_event");
  }

  void step(Time now) override {
    if (plan_.is_newer_than(seen_plan_)) guide_.set_plan(plan_.value(), now);
    LocalCommand command;
    guide_.set_stop(read_stop_at_m(authority_));
    if (estimate_.has_value()) {
      const Odometry& estimate = estimate_.value();
      for (std::size_t i = 0; i < ranges_.size(); ++i) {
        if (ranges_[i].is_newer_than(seen_ranges_[i])) {
          memory_.read(static_cast<int>(i), ranges_[i].value());
        }
      }
      memory_.update(now, estimate.X_WB);
      if (guide_.has_plan()) command = guide_.step(now, read_state(estimate), memory_);
    }
    last_ = {command.front_axle_rad, command.rear_axle_rad};
    out_.write(now, command);
    report_event(now);
  }

 private:
  DwaState read_state(const Odometry& estimate) {
    DwaState state;
    state.pose = {estimate.X_WB.p.head<2>(), yaw_from_quaternion(estimate.X_WB.q)};
    const Eigen::Vector2d v_B = estimate.v_WB_B.head<2>();
    state.v_mps = std::copysign(v_B.norm(), v_B.x());
    // Measured angles, else commanded ones, else the last command.
    if (!encoders_.read(&state.steering) && !actuators_.read(&state.steering)) {
      state.steering = last_;
    }
    return state;
  }

  /// Reports the oldest pending event; allocates only if there is one.
  void report_event(Time now) {
    DwaEvent pending;
    if (!guide_.take_event(&pending)) return;
    Event event;
    event.source = source_;
    const double x = pending.p_W.x(), y = pending.p_W.y();
    const std::string what =
        std::isfinite(pending.distance_m)
            ? fmt::format("by an obstacle that the map does not have, {:.2f} m ahead",
                          pending.distance_m)
            : "by obstacles of the map: no motion from here leads on along the plan";
    switch (pending.kind) {
      case DwaEvent::Kind::kSeen:
        event.text = fmt::format(
            "sees an obstacle that the map does not have at ({:.2f}, {:.2f}), {:.2f} m from the "
            "vehicle's centre",
            x, y, pending.distance_m);
        break;
      case DwaEvent::Kind::kReverse:
        event.text = fmt::format("held up at ({:.2f}, {:.2f}) {}; drives back", x, y, what);
        break;
      case DwaEvent::Kind::kBlocked:
        event.level = Event::Level::kWarning;
        event.text = fmt::format("blocked at ({:.2f}, {:.2f}) {}", x, y, what);
        break;
      case DwaEvent::Kind::kFollow:
        event.text = fmt::format("follows the plan again at ({:.2f}, {:.2f})", x, y);
        break;
    }
    event_writer_.write(now, event);
  }

  std::string source_;
  DistanceField known_;
  std::vector<SensorMounting> rangers_;
  ObstacleMemory memory_;
  DwaGuide guide_;
  AxleAngles last_;
  std::uint64_t seen_plan_ = 0;
  std::vector<std::uint64_t> seen_ranges_;
  SignalReader<Odometry> estimate_;
  SignalReader<PlannedPath> plan_;
  SignalReader<MovementAuthority> authority_;
  SteeringReader encoders_;
  SteeringReader actuators_;
  std::vector<SignalReader<RangeSample>> ranges_;
  SignalWriter<LocalCommand> out_;
  SignalWriter<Event> event_writer_;
};

}  // namespace

PartSpec dwa_spec() {
  PartSpec spec;
  spec.name = "dwa";
  spec.description =
      "Dynamic window approach in (v, front, rear axle angle) with obstacles that ultrasound "
      "detects (paper A, eq. 23 corrected); follows the plan while it is free, else passes, backs "
      "out or stops.";
  dwa_table().add_to(spec);
  spec.default_rate_Hz = 10.0;
  spec.reads = {"estimate", "plan", "<ultrasound sensors>", "encoders", "actuators", "authority"};
  spec.writes = {"local_command", "guidance_event"};
  return spec;
}

std::unique_ptr<Guidance> make_dwa(const ParameterSet& parameters,
                                   const ControllerContext& context) {
  return std::make_unique<Dwa>(read_dwa_params(parameters, context), context);
}

}  // namespace vinerow::controllers
