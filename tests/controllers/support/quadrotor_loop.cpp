#include "tests/controllers/support/quadrotor_loop.h"

#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::test {

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

namespace {

Duration control_period(const QuadrotorSetup& setup) {
  const PartSpec& spec = parts().spec(PartKind::kController, setup.controller.type);
  return period_of_rate(setup.rate_Hz > 0.0 ? setup.rate_Hz : spec.default_rate_Hz);
}

LoopSetup make_loop_setup(const QuadrotorSetup& setup) {
  LoopSetup loop;
  loop.vehicle = "drone";
  loop.description = describe(setup.assumed.value_or(setup.numbers));
  loop.tick = setup.tick.ns > 0 ? setup.tick : control_period(setup);
  loop.physics = setup.physics;
  loop.gravity_mps2 = setup.numbers.gravity_mps2;
  return loop;
}

}  // namespace

QuadrotorLoop::QuadrotorLoop(const QuadrotorSetup& setup)
    : Loop(make_loop_setup(setup)), setup_(setup), sim_(setup.numbers) {
  const Duration guidance_period = period_of_rate(setup.guidance_rate_Hz);
  if (!setup.guidance.type.empty()) {
    add_guidance(setup.guidance, guidance_period);
    give_plan(setup.plan);
  } else {
    trajectory_.points.resize(static_cast<std::size_t>(setup.points));
    trajectory_.dt_s = setup.dt_s;
    set_inputs([this, guidance_period] {
      if (is_due(guidance_period)) write_reference();
    });
  }
  add_controller(setup.controller, control_period(setup));
  set_plant(sim_);
  set_stop_at(setup.stop_at_m);

  sim_.set_wind(setup.wind);
  sim_.set_floor(setup.floor_m);
  sim_.state().p_W = setup.start.p;
  sim_.state().q_WB = setup.start.q;
  if (setup.starts_on_path) {
    const TrajectoryPoint first = setup_.path(0.0);
    sim_.state().p_W = first.p_W;
    sim_.state().v_W = first.v_W;
    sim_.state().q_WB = Eigen::AngleAxisd(first.yaw_rad, Eigen::Vector3d::UnitZ());
  }
  if (setup.rotors_on) sim_.state().rotors_radps.setConstant(sim_.hover_radps());
}

void QuadrotorLoop::write_reference() {
  for (std::size_t i = 0; i < trajectory_.points.size(); ++i) {
    trajectory_.points[i] = setup_.path(time_s() + setup_.dt_s * static_cast<double>(i));
  }
  trajectory_.phase = setup_.phase ? setup_.phase(time_s()) : Phase::kHover;
  write("reference", trajectory_);
}

void QuadrotorLoop::set_phase(Phase phase) {
  setup_.phase = [phase](double) { return phase; };
}

Eigen::Vector3d QuadrotorLoop::path_error() const {
  const TrajectoryPoint at = setup_.path(time_s());
  return Eigen::AngleAxisd(-at.yaw_rad, Eigen::Vector3d::UnitZ()) * (sim_.state().p_W - at.p_W);
}

WindField gusty_wind(const Eigen::Vector3d& mean_W, double gust_mps, double correlation_s,
                     double longest_s, std::uint64_t seed, int axes) {
  constexpr double kDt_s = 0.01;
  const double keep = std::exp(-kDt_s / correlation_s), sigma = 0.5 * gust_mps;
  RandomStream random(seed, "test", "gust");
  auto table = std::make_shared<std::vector<Eigen::Vector3d>>();
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();
  for (int i = 0; i * kDt_s <= longest_s; ++i) {
    for (int axis = 0; axis < axes; ++axis) {
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
