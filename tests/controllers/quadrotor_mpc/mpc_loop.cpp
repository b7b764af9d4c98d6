#include "tests/controllers/quadrotor_mpc/mpc_loop.h"

#include <algorithm>
#include <cmath>

#include "controllers/quadrotor_mpc/quadrotor_mpc.h"
#include "engine/core/check.h"

namespace vinerow::test {

std::unique_ptr<Controller> make_mpc(const Values& parameters,
                                     const VehicleDescription& description, double rate_Hz) {
  ControllerContext context;
  context.vehicle = "drone";
  context.part = "drone.controller";
  context.vehicle_description = &description;
  if (rate_Hz > 0.0) context.period = period_of_rate(rate_Hz);
  ParameterSet set(controllers::quadrotor_mpc_spec().parameters, "quadrotor_mpc");
  for (const auto& [name, value] : parameters) set.set(name, value);
  return controllers::make_quadrotor_mpc(set, context);
}

MpcLoop::MpcLoop(const MpcSetup& setup)
    : setup_(setup),
      description_(describe(setup.told)),
      sim_(setup.numbers),
      controller_(make_mpc(setup.parameters, description_, setup.rate_Hz)),
      period_(period_of_rate(setup.rate_Hz)),
      guidance_period_(period_of_rate(setup.guidance_rate_Hz)) {
  Ports world(bus_, "drone", "test");
  estimate_ = world.write<Odometry>("estimate");
  reference_ = world.write<ReferenceTrajectory>("reference");
  Ports ports(bus_, "drone", "drone.controller");
  controller_->connect(ports);
  actuators_ = world.read<NamedValues>("actuators");
  wrench_ = world.read<NamedValues>("wrench");
  mpc_ = world.read<NamedValues>("mpc");
  event_ = world.read<Event>("controller_event");
  bus_.check_connected();
  trajectory_.points.resize(static_cast<std::size_t>(setup.points));
  const TrajectoryPoint first = setup_.path(0.0);
  sim_.state().p_W = first.p_W;
  sim_.state().v_W = first.v_W;
  sim_.state().q_WB = Eigen::AngleAxisd(first.yaw_rad, Eigen::Vector3d::UnitZ());
  sim_.state().rotors_radps.setConstant(sim_.hover_radps());
}

void MpcLoop::write_reference() {
  trajectory_.phase = setup_.phase;
  for (std::size_t i = 0; i < trajectory_.points.size(); ++i) {
    trajectory_.points[i] = setup_.path(time_s() + 0.05 * static_cast<double>(i));
  }
  reference_.write(now_, trajectory_);
}

void MpcLoop::tick(const std::function<void(const std::function<void()>& decide)>& around) {
  Odometry estimate = sim_.truth();
  if (noise_) noise_(estimate);
  estimate_.write(now_, estimate);
  if (now_.ns % guidance_period_.ns < period_.ns) write_reference();
  around([this] { controller_->step(now_); });
  if (event_.is_newer_than(seen_event_)) events_.push_back(event_.value().text);
  const int steps = static_cast<int>(std::lround(period_.s() / setup_.physics_s));
  const Eigen::Vector3d half_kick =
      0.5 * setup_.physics_s * bias_B_.cwiseQuotient(setup_.numbers.inertia_kgm2);
  for (int i = 0; i < steps; ++i) {
    sim_.state().w_B += half_kick;
    sim_.step(actuators_.value().values, setup_.physics_s);
    sim_.state().w_B += half_kick;
  }
  now_ = now_ + period_;
}

void MpcLoop::run_until(double time_s) {
  while (this->time_s() < time_s - 1e-9) tick();
}

Eigen::Vector3d MpcLoop::error() const {
  const TrajectoryPoint at = setup_.path(time_s());
  return Eigen::AngleAxisd(-at.yaw_rad, Eigen::Vector3d::UnitZ()) * (sim_.state().p_W - at.p_W);
}

double MpcLoop::forward_speed_error() const {
  const TrajectoryPoint at = setup_.path(time_s());
  const Eigen::Vector3d along(std::cos(at.yaw_rad), std::sin(at.yaw_rad), 0.0);
  return along.dot(sim_.state().v_W - at.v_W);
}

double MpcLoop::value_of(const NamedValues& values, const std::string& name) {
  const auto at = std::find(values.names.begin(), values.names.end(), name);
  VINEROW_DEMAND(at != values.names.end());
  return values.values[static_cast<std::size_t>(at - values.names.begin())];
}

FlightErrors fly(MpcLoop& loop, const RowsAndTurn& rows, double from_s) {
  FlightErrors errors;
  double square = 0.0;
  int samples = 0;
  while (loop.time_s() < rows.end_s - 1.0) {
    loop.tick();
    const double t = loop.time_s();
    if (t < from_s) continue;
    const Eigen::Vector3d e = loop.error();
    errors.finite = errors.finite && e.allFinite() && loop.sim().state().w_B.allFinite();
    if (rows.is_row(t)) {
      square += e.y() * e.y();
      ++samples;
      errors.lateral_max_m = std::max(errors.lateral_max_m, std::abs(e.y()));
      errors.speed_max_mps = std::max(errors.speed_max_mps, std::abs(loop.forward_speed_error()));
    } else {
      errors.turn_lateral_max_m = std::max(errors.turn_lateral_max_m, std::abs(e.y()));
    }
    errors.altitude_max_m = std::max(errors.altitude_max_m, std::abs(e.z()));
    errors.along_max_m = std::max(errors.along_max_m, std::abs(e.x()));
    errors.tilt_max_rad = std::max(errors.tilt_max_rad, loop.sim().tilt_rad());
  }
  errors.lateral_rms_m = std::sqrt(square / std::max(samples, 1));
  return errors;
}

}  // namespace vinerow::test
