#include "tests/controllers/support/aircraft_loop.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/aircraft/flight_trim.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::test {
namespace {

constexpr double kSpeed_mps = 12.0, kGravity_mps2 = 9.80665;

AirReference make_reference(AirPhase phase) {
  AirReference reference;
  reference.phase = phase;
  reference.power = true;
  reference.airspeed_mps = kSpeed_mps;
  return reference;
}

}  // namespace

AirCourse fly_straight(double course_rad, double height_m, double climb_angle_rad) {
  return fly_circle(course_rad, height_m, 0.0, climb_angle_rad);
}

AirCourse fly_circle(double course_rad, double height_m, double bank_rad, double climb_angle_rad) {
  return [=](double time_s) {
    AirReference at = make_reference(bank_rad == 0.0 ? AirPhase::kStraight : AirPhase::kTurn);
    // Bank to the right turns to the right: the heading from east falls.
    at.heading_rate_radps = -kGravity_mps2 * std::tan(bank_rad) / kSpeed_mps;
    at.heading_rad = course_rad + at.heading_rate_radps * time_s;
    at.course_rad = at.heading_rad;
    at.bank_rad = bank_rad;
    at.climb_angle_rad = climb_angle_rad;
    at.height_m = height_m + kSpeed_mps * std::sin(climb_angle_rad) * time_s;
    return at;
  };
}

AirCourse fly_lanes(int lanes, double bank_rad) {
  // Integrated once at 5 ms: where the heading is to go, and a bank that follows with its lag.
  constexpr double kDt_s = 0.005, kLag_s = 0.45, kGain_per_s = 1.0;
  const double kRate_radps = rad_from_deg(60.0);
  constexpr double kLane_s = 260.0 / kSpeed_mps, kAcross_s = 2.0;
  const double climbs_deg[] = {0.0, 3.0, -1.0, 2.0, 5.0, 1.0, -3.0};
  auto table = std::make_shared<std::vector<AirReference>>();
  AirReference at = make_reference(AirPhase::kStraight);
  at.height_m = 100.0;
  double goal_rad = 0.0, wanted_rad = 0.0, lagged_rad = 0.0, since_s = 0.0;
  int corner = 0, piece = 0;
  for (int i = 0; corner < 2 * lanes; ++i) {
    if (i % 800 == 799) at.climb_angle_rad = rad_from_deg(climbs_deg[++piece % 7]);
    const double off = wrap_angle(goal_rad - at.heading_rad);
    const bool on_course = std::abs(off) < rad_from_deg(1.0) && std::abs(lagged_rad) < 0.02;
    since_s = on_course ? since_s + kDt_s : since_s;
    if (since_s > (corner % 2 == 0 ? kLane_s : kAcross_s)) {
      // Two corners to the right, two to the left.
      goal_rad += corner % 4 < 2 ? -0.5 * kPi : 0.5 * kPi;
      ++corner;
      since_s = 0.0;
    }
    const double requested_rad =
        std::clamp(-std::atan(kSpeed_mps * kGain_per_s * wrap_angle(goal_rad - at.heading_rad) /
                              kGravity_mps2),
                   -bank_rad, bank_rad);
    wanted_rad += std::clamp(requested_rad - wanted_rad, -kRate_radps * kDt_s, kRate_radps * kDt_s);
    lagged_rad += kDt_s / kLag_s * (wanted_rad - lagged_rad);
    at.bank_rad = wanted_rad;
    at.heading_rate_radps = -kGravity_mps2 * std::tan(lagged_rad) / kSpeed_mps;
    at.heading_rad += kDt_s * at.heading_rate_radps;
    at.course_rad = goal_rad;
    at.phase = on_course ? AirPhase::kStraight : AirPhase::kTurn;
    at.height_m += kDt_s * kSpeed_mps * std::sin(at.climb_angle_rad);
    table->push_back(at);
  }
  return [table](double time_s) {
    const auto index = static_cast<std::size_t>(std::max(std::lround(time_s / kDt_s), 0L));
    return (*table)[std::min(index, table->size() - 1)];
  };
}

namespace {

LoopSetup make_loop_setup(const AircraftSetup& setup) {
  LoopSetup loop;
  loop.vehicle = "plane";
  loop.description = describe(setup.assumed.value_or(setup.numbers));
  const PartSpec& spec = parts().spec(PartKind::kController, setup.controller.type);
  loop.tick = period_of_rate(setup.rate_Hz > 0.0 ? setup.rate_Hz : spec.default_rate_Hz);
  loop.physics = setup.physics;
  loop.gravity_mps2 = setup.numbers.gravity_mps2;
  return loop;
}

}  // namespace

AircraftLoop::AircraftLoop(const AircraftSetup& setup)
    : Loop(make_loop_setup(setup)), sim_(setup.numbers) {
  add_controller(setup.controller);
  set_plant(sim_);
  set_inputs([this, reference = setup.reference] { write("reference", reference(time_s())); });

  const AirReference first = setup.reference(0.0);
  const controllers::Aircraft aircraft =
      controllers::read_aircraft(describe(setup.numbers), setup.numbers.gravity_mps2, "test");
  const Result<controllers::Trim> trim =
      controllers::find_trim(aircraft, {first.airspeed_mps, first.climb_angle_rad, first.bank_rad});
  VINEROW_DEMAND(trim.ok());
  sim_.set_wind(setup.wind);
  // From east to the left becomes from north to the right.
  const double psi = 0.5 * kPi - first.heading_rad + setup.turned_rad;
  sim_.start({0, 0, first.height_m + setup.higher_m}, trim->roll_rad + setup.roll_rad,
             trim->pitch_rad + setup.pitch_rad, psi,
             Eigen::Vector3d(trim->u_mps + setup.faster_mps, trim->v_mps, trim->w_mps),
             {trim->p_radps, trim->q_radps, trim->r_radps},
             {trim->controls.throttle, trim->controls.elevator_rad, trim->controls.aileron_rad});
  // The velocity of the trim is through the air.
  sim_.state().velocity += sim_.state().velocity - sim_.air_velocity();
}

WindField markov_wind(const Eigen::Vector3d& mean_W, double bound_mps, double along_rad,
                      double longest_s, std::uint64_t seed) {
  constexpr double kDt_s = 0.01, kLength_m = 60.0;
  const double keep = std::exp(-kDt_s * kSpeed_mps / kLength_m);
  RandomStream random(seed, "test", "gust");
  auto table = std::make_shared<std::vector<double>>();
  double noise = 0.0;
  for (int i = 0; i * kDt_s <= longest_s; ++i) {
    noise = keep * noise + 0.5 * bound_mps * std::sqrt(1.0 - keep * keep) * random.normal();
    table->push_back(std::clamp(noise, -bound_mps, bound_mps));
  }
  const Eigen::Vector3d along(std::cos(along_rad), std::sin(along_rad), 0.0);
  return [=](double time_s, const Eigen::Vector3d&) -> Eigen::Vector3d {
    const double place = std::clamp(time_s / kDt_s, 0.0, static_cast<double>(table->size() - 2));
    const auto index = static_cast<std::size_t>(place);
    const double s = place - static_cast<double>(index);
    return mean_W + ((1.0 - s) * (*table)[index] + s * (*table)[index + 1]) * along;
  };
}

GaussMarkovGust::GaussMarkovGust(std::uint64_t seed, double strength)
    : random_(seed, "test", "gust"), strength_(strength) {
  for (double& along : direction_) along = random_.normal();
  direction_ /= direction_.cwiseAbs().maxCoeff();  // up to 1 m/s along each axis
  value_ = 0.5 * random_.normal();
}

Eigen::Vector3d GaussMarkovGust::next() {
  const double keep = std::exp(-0.05 * 12.0 / 60.0);
  value_ = keep * value_ + 0.5 * std::sqrt(1.0 - keep * keep) * random_.normal();
  return strength_ * std::clamp(value_, -1.0, 1.0) * direction_;
}

}  // namespace vinerow::test
