#include "tests/controllers/support/flight_loop.h"

#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::test {
namespace {

constexpr Duration kLoopStep{1'000'000};

}  // namespace

FlightPath hover_at(const Eigen::Vector3d& p_W, double yaw_rad) {
  TrajectoryPoint point;
  point.p_W = p_W;
  point.yaw_rad = yaw_rad;
  return [point](double) { return point; };
}

FlightPath row_and_turn(const Eigen::Vector3d& p_W, double yaw_rad, double speed_mps,
                        double straight_m, double radius_m, double turn_rad) {
  // Integrated once at 1 ms; the function reads the table.
  constexpr double kAcceleration_mps2 = 1.5, kDt_s = 0.001, kRamp_m = 1.5;
  constexpr int kSamples = 60'000;
  auto table = std::make_shared<std::vector<TrajectoryPoint>>();
  TrajectoryPoint at;
  at.p_W = p_W;
  at.yaw_rad = yaw_rad;
  double speed = 0.0, way_m = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    // Curvature as a trapezium over the way, whose area is the turn.
    const double full = radius_m > 0.0 ? 1.0 / radius_m : 0.0;
    const double on_m = way_m - straight_m;
    const double length_m = full > 0.0 ? std::abs(turn_rad) / full : 0.0;  // ramps count half each
    const double up = std::clamp(on_m / kRamp_m, 0.0, 1.0);
    const double down = std::clamp((on_m - length_m) / kRamp_m, 0.0, 1.0);
    const double curvature = full * (up - down);
    const double acceleration = speed < speed_mps ? kAcceleration_mps2 : 0.0;
    const Eigen::Vector3d along(std::cos(at.yaw_rad), std::sin(at.yaw_rad), 0.0);
    const Eigen::Vector3d left(-along.y(), along.x(), 0.0);
    at.v_W = speed * along;
    at.a_W = acceleration * along + speed * speed * curvature * left;
    at.yaw_rate_radps = speed * curvature;
    table->push_back(at);
    at.p_W += kDt_s * at.v_W + 0.5 * kDt_s * kDt_s * at.a_W;
    at.yaw_rad += kDt_s * at.yaw_rate_radps;
    way_m += kDt_s * speed;
    speed = std::min(speed + kDt_s * acceleration, speed_mps);
  }
  return [table](double time_s) {
    const auto index = static_cast<std::size_t>(std::max(std::lround(time_s / kDt_s), 0L));
    return (*table)[std::min(index, table->size() - 1)];
  };
}

FlightLoop::FlightLoop(const FlightSetup& setup)
    : setup_(setup),
      description_(describe(setup.told.value_or(setup.numbers))),
      sim_(setup.numbers) {
  const PartSpec& spec = parts().spec(PartKind::kController, setup.controller.type);
  ControllerContext context;
  context.vehicle = "drone";
  context.part = "drone.controller";
  context.vehicle_description = &description_;
  context.gravity_mps2 = setup.numbers.gravity_mps2;
  context.physics_step = kLoopStep;
  context.period = period_of_rate(setup.rate_Hz > 0.0 ? setup.rate_Hz : spec.default_rate_Hz);
  control_period_ = context.period;
  guidance_period_ = period_of_rate(setup.guidance_rate_Hz);
  controller_ = parts().make_controller(setup.controller.type,
                                        make_parameters(spec, setup.controller.values), context);
  Ports world(bus_, "drone", "test");
  estimate_ = world.write<Odometry>("estimate");
  authority_ = world.write<MovementAuthority>("authority");
  if (!setup.guidance.type.empty()) {
    context.part = "drone.guidance";
    context.period = guidance_period_;
    const PartSpec& guide = parts().spec(PartKind::kGuidance, setup.guidance.type);
    guidance_ = parts().make_guidance(setup.guidance.type,
                                      make_parameters(guide, setup.guidance.values), context);
    Ports ports(bus_, "drone", "drone.guidance");
    guidance_->connect(ports);
    world.write<PlannedPath>("plan").write(Time{}, setup.plan);
  } else {
    reference_out_ = world.write<ReferenceTrajectory>("reference");
    trajectory_.points.resize(static_cast<std::size_t>(setup.points));
    trajectory_.dt_s = setup.dt_s;
  }
  reference_in_ = world.read<ReferenceTrajectory>("reference");
  Ports ports(bus_, "drone", "drone.controller");
  controller_->connect(ports);
  actuators_ = world.read<NamedValues>("actuators");
  wrench_ = world.read<NamedValues>("wrench");
  follower_ = world.read<FollowerState>("follower");

  sim_.set_wind(setup.wind);
  sim_.set_floor(setup.floor_m);
  sim_.state().p_W = setup.start.p;
  sim_.state().q_WB = setup.start.q;
  if (setup.rotors_on) sim_.state().rotors_radps.setConstant(sim_.hover_radps());
}

void FlightLoop::write_reference() {
  for (std::size_t i = 0; i < trajectory_.points.size(); ++i) {
    trajectory_.points[i] = setup_.path(time_s() + setup_.dt_s * static_cast<double>(i));
  }
  trajectory_.phase = setup_.phase ? setup_.phase(time_s()) : Phase::kHover;
  reference_out_.write(now_, trajectory_);
}

void FlightLoop::run_until(double time_s, const std::function<void(const FlightLoop&)>& each_step) {
  const Time end{duration_from_s(time_s).ns};
  while (now_ < end) {
    estimate_.write(now_, sim_.truth());
    if (now_.ns % guidance_period_.ns == 0) {
      if (setup_.stop_at_m) authority_.write(now_, {setup_.stop_at_m(this->time_s()), -1, ""});
      guidance_ ? guidance_->step(now_) : write_reference();
    }
    if (now_.ns % control_period_.ns == 0) controller_->step(now_);
    if (each_step) each_step(*this);
    sim_.step(actuators_.value().values, kLoopStep.s());
    now_ = now_ + kLoopStep;
  }
  estimate_.write(now_, sim_.truth());
}

Eigen::Vector3d FlightLoop::error_in_yaw_frame() const {
  const TrajectoryPoint at = setup_.path(time_s());
  return Eigen::AngleAxisd(-at.yaw_rad, Eigen::Vector3d::UnitZ()) * (sim_.state().p_W - at.p_W);
}

WindField gusty_wind(const Eigen::Vector3d& mean_W, double gust_mps, double correlation_s,
                     double longest_s, std::uint64_t seed) {
  constexpr double kDt_s = 0.01;
  const double keep = std::exp(-kDt_s / correlation_s), sigma = 0.5 * gust_mps;
  RandomStream random(seed, "test", "gust");
  auto table = std::make_shared<std::vector<Eigen::Vector3d>>();
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();
  for (int i = 0; i * kDt_s <= longest_s; ++i) {
    for (int axis = 0; axis < 2; ++axis) {
      noise(axis) = keep * noise(axis) + sigma * std::sqrt(1.0 - keep * keep) * random.normal();
    }
    table->push_back(mean_W + noise.cwiseMax(-gust_mps).cwiseMin(gust_mps));
  }
  return [table](double time_s, const Eigen::Vector3d&) -> Eigen::Vector3d {
    const double place = std::clamp(time_s / kDt_s, 0.0, static_cast<double>(table->size() - 2));
    const auto index = static_cast<std::size_t>(place);
    const double s = place - static_cast<double>(index);
    return (1.0 - s) * (*table)[index] + s * (*table)[index + 1];
  };
}

}  // namespace vinerow::test
