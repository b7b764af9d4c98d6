#include "controllers/parts/aircraft/trim_solver.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

// Newton's method for left(y) = 0 with the seven unknowns
//   y = (alpha, beta, phi, theta, d_e, d_a, d_t), or gamma instead of d_t if the throttle is given.
// expand() gives the steady motion at airspeed V and bank: velocity in body axes
//   u = V cos(alpha) cos(beta),  v = V sin(beta),  w = V sin(alpha) cos(beta),
// turn rate psi' = g tan(bank) / V and its components
//   p = -psi' sin(theta),  q = psi' sin(phi) cos(theta),  r = psi' cos(phi) cos(theta).
// residual() is left = (u', v', w', p', q', r', h' - V sin(gamma)). Each iteration solves
//   slope step = -left,  slope = d left / d y by central differences,
// and halves the step until |left| falls.

enum Unknown { kAlpha = 0, kBeta, kRoll, kPitch, kElevator, kAileron, kFree };

/// Bound of the iterations. Chosen.
constexpr int kMaxIterations = 60;
/// Steps of the central differences: the terms here are smooth over about 0.1.
constexpr double kStep = 1e-5;
/// Largest acceleration of steady flight, m/s2 and rad/s2. Rounding leaves about 1e-13.
constexpr double kSteady = 1e-9;
/// Acceleration at which the iteration stops, m/s2 and rad/s2: just above rounding.
constexpr double kExact = 1e-12;
/// Largest change of an unknown (rad, 1) in one iteration. Chosen: a full step from a poor
/// start may leave the range of meaningful angles.
constexpr double kLongestStep = 0.3;
/// Smallest share of Newton's step that is tried. Chosen: shorter steps gain nothing.
constexpr double kShortestShare = 1e-3;

/// Range of angles of attack for starts and for the largest lift. Chosen well beyond usual stall
/// angles.
constexpr double kSearchAlpha_rad = rad_from_deg(45.0);
/// Spacing of that search. Chosen: Newton's method does the rest.
constexpr double kSearchStep_rad = rad_from_deg(0.25);
/// Throttle of the start, as a share of the largest. Chosen high, see search_start().
constexpr double kSearchThrottle = 0.9;
/// Alternations of elevator and throttle. Chosen: balancing one unbalances the other slightly.
constexpr int kBalanceRounds = 3;
/// Halvings of a range: 2^-30 of it is left.
constexpr int kBisections = 30;

Eigen::Vector3d velocity_at(double airspeed_mps, double alpha_rad) {
  return {airspeed_mps * std::cos(alpha_rad), 0.0, airspeed_mps * std::sin(alpha_rad)};
}

/// Force across the path, upwards.
double lift_of(const AirLoad& load, double alpha_rad) {
  return load.force_B.x() * std::sin(alpha_rad) - load.force_B.z() * std::cos(alpha_rad);
}

/// Sets `value` between `low` and `high` so that the function of it is zero.
/// @returns false if both ends have the same sign; then `value` is the end nearer to zero
template <class Function>
bool bisect(double& value, double low, double high, Function&& function) {
  const auto at = [&](double x) {
    value = x;
    return function();
  };
  const double at_low = at(low), at_high = at(high);
  if (at_low * at_high > 0.0) {
    value = std::abs(at_low) < std::abs(at_high) ? low : high;
    return false;
  }
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (at(middle) * at_low > 0.0 ? low : high) = middle;
  }
  return true;
}

}  // namespace

AirState air_state_of(const Trim& trim) {
  AirState x = AirState::Zero();
  x.segment<3>(kAirU) << trim.u_mps, trim.v_mps, trim.w_mps;
  x.segment<3>(kAirP) << trim.p_radps, trim.q_radps, trim.r_radps;
  x(kAirPhi) = trim.roll_rad;
  x(kAirTheta) = trim.pitch_rad;
  return x;
}

Trim TrimSolver::expand(const Problem& problem, const Vector7& y) const {
  const bool climb_is_free = problem.throttle.has_value();
  Trim trim;
  trim.request = problem.request;
  if (climb_is_free) trim.request.climb_angle_rad = y(kFree);
  trim.controls = {climb_is_free ? *problem.throttle : y(kFree), y(kElevator), y(kAileron)};
  trim.alpha_rad = y(kAlpha);
  trim.beta_rad = y(kBeta);
  trim.roll_rad = y(kRoll);
  trim.pitch_rad = y(kPitch);
  const double speed = problem.request.airspeed_mps;
  const double turn = aircraft_.gravity_mps2 * std::tan(problem.request.bank_rad) / speed;
  trim.turn_rate_radps = turn;
  trim.u_mps = speed * std::cos(y(kAlpha)) * std::cos(y(kBeta));
  trim.v_mps = speed * std::sin(y(kBeta));
  trim.w_mps = speed * std::sin(y(kAlpha)) * std::cos(y(kBeta));
  trim.p_radps = -turn * std::sin(y(kPitch));
  trim.q_radps = turn * std::sin(trim.roll_rad) * std::cos(y(kPitch));
  trim.r_radps = turn * std::cos(trim.roll_rad) * std::cos(y(kPitch));
  return trim;
}

TrimSolver::Vector7 TrimSolver::residual(const Problem& problem, const Vector7& y) {
  const Trim trim = expand(problem, y);
  const AirState rate = equations_.derivative(air_state_of(trim), trim.controls);
  Vector7 left;
  left << rate.head<6>(),
      rate(kAirHeight) - trim.request.airspeed_mps * std::sin(trim.request.climb_angle_rad);
  return left;
}

TrimSolver::Vector7 TrimSolver::search_start(const Problem& problem) {
  const TrimRequest& request = problem.request;
  Vector7 y = Vector7::Zero();
  // From high throttle down: thrust grows faster than linearly with the throttle, and below a
  // windmilling propeller there may be no slope to follow.
  const double throttle = problem.throttle.value_or(kSearchThrottle * aircraft_.throttle_max());
  y(kFree) = problem.throttle ? request.climb_angle_rad : throttle;
  y(kRoll) = request.bank_rad;
  // The first angle of attack whose lift carries the weight, or else that of the largest lift.
  const double wanted_N = aircraft_.flight_model->mass_kg() * aircraft_.gravity_mps2 *
                          std::cos(request.climb_angle_rad) / std::cos(request.bank_rad);
  double max_N = -1.0;
  for (double alpha = -0.25 * kSearchAlpha_rad; alpha < kSearchAlpha_rad;
       alpha += kSearchStep_rad) {
    const double lift_N = lift_of(equations_.load(velocity_at(request.airspeed_mps, alpha),
                                                  Eigen::Vector3d::Zero(), {throttle, 0.0, 0.0}),
                                  alpha);
    if (lift_N <= max_N) continue;
    max_N = lift_N;
    y(kAlpha) = alpha;
    if (lift_N >= wanted_N) break;
  }
  y(kPitch) = y(kAlpha) + request.climb_angle_rad;
  return y;
}

/// Beyond the stall the lift falls with the angle of attack.
bool TrimSolver::is_stalled(const Trim& trim) {
  const auto lift = [&](double alpha) {
    return lift_of(equations_.load(velocity_at(trim.request.airspeed_mps, alpha),
                                   {trim.p_radps, trim.q_radps, trim.r_radps}, trim.controls),
                   alpha);
  };
  return lift(trim.alpha_rad + kStep) <= lift(trim.alpha_rad - kStep);
}

std::optional<Trim> TrimSolver::solve_problem(const Problem& problem, const Trim* near) {
  Vector7 y = near ? Vector7() : search_start(problem);
  if (near) {
    y << near->alpha_rad, near->beta_rad, near->roll_rad, near->pitch_rad,
        near->controls.elevator_rad, near->controls.aileron_rad,
        problem.throttle ? near->request.climb_angle_rad : near->controls.throttle;
  }
  Vector7 left = residual(problem, y);
  int iterations = 0;
  while (iterations < kMaxIterations && !(left.cwiseAbs().maxCoeff() < kExact)) {
    ++iterations;
    // slope = d left / d y by central differences, then Newton's step.
    Eigen::Matrix<double, 7, 7> slope;
    for (int i = 0; i < 7; ++i) {
      const Vector7 step = kStep * Vector7::Unit(i);
      slope.col(i) = (residual(problem, y + step) - residual(problem, y - step)) / (2.0 * kStep);
    }
    Vector7 step = -slope.colPivHouseholderQr().solve(left);
    if (!step.allFinite()) return std::nullopt;
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) step *= kLongestStep / longest;
    // Shorter steps until one reduces |left|. None does once only rounding is left.
    double share = 1.0;
    Vector7 next = y + step, next_left = residual(problem, next);
    while (!(next_left.norm() < left.norm()) && share > kShortestShare) {
      share *= 0.5;
      next = y + share * step;
      next_left = residual(problem, next);
    }
    if (!(next_left.norm() < left.norm())) break;
    y = next;
    left = next_left;
  }
  if (!(left.cwiseAbs().maxCoeff() < kSteady)) return std::nullopt;
  if (std::abs(y(kAlpha)) > 0.5 * kPi || std::abs(y(kPitch)) > 0.5 * kPi) return std::nullopt;
  Trim trim = expand(problem, y);
  if (is_stalled(trim)) return std::nullopt;
  trim.iterations = iterations;
  trim.residual = left.cwiseAbs().maxCoeff();
  const AirLoad load = equations_.load({trim.u_mps, trim.v_mps, trim.w_mps},
                                       {trim.p_radps, trim.q_radps, trim.r_radps}, trim.controls);
  trim.load_factor =
      lift_of(load, trim.alpha_rad) / (aircraft_.flight_model->mass_kg() * aircraft_.gravity_mps2);
  return trim;
}

std::optional<Trim> TrimSolver::solve(const TrimRequest& request, const Trim* near) {
  return solve_problem(Problem{request, std::nullopt}, near);
}

std::optional<Trim> TrimSolver::solve_at_throttle(const TrimRequest& request, double throttle,
                                                  const Trim* near) {
  return solve_problem(Problem{request, throttle}, near);
}

TrimSolver::Lift TrimSolver::largest_lift(double airspeed_mps, double climb_angle_rad) {
  const double weight_N =
      aircraft_.flight_model->mass_kg() * aircraft_.gravity_mps2 * std::sin(climb_angle_rad);
  Lift largest;
  for (double alpha = 0.0; alpha <= kSearchAlpha_rad; alpha += kSearchStep_rad) {
    AircraftControls controls;
    const auto load = [&] {
      return equations_.load(velocity_at(airspeed_mps, alpha), Eigen::Vector3d::Zero(), controls);
    };
    const auto moment = [&] { return load().torque_B.y(); };
    const auto pull = [&] {
      const AirLoad at = load();
      return at.force_B.x() * std::cos(alpha) + at.force_B.z() * std::sin(alpha) - weight_N;
    };
    // Alternately the elevator without pitching moment and the throttle without acceleration.
    bool is_balanced = true;
    for (int i = 0; i < kBalanceRounds && is_balanced; ++i) {
      is_balanced = bisect(controls.elevator_rad, aircraft_.elevon_min_rad(),
                           aircraft_.elevon_max_rad(), moment);
      bisect(controls.throttle, aircraft_.throttle_min(), aircraft_.throttle_max(), pull);
    }
    if (!is_balanced) continue;
    const double lift_N = lift_of(load(), alpha);
    if (lift_N > largest.lift_N) largest = {lift_N, alpha};
  }
  return largest;
}

}  // namespace vinerow::controllers
