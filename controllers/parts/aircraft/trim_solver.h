#pragma once
/// Newton's method for steady flight, without actuator limits (flight_trim.h checks those).
///
/// Unknowns: angle of attack, side slip, roll, pitch, elevator, aileron, and either the throttle
/// (climb angle given) or the climb angle (throttle given). Equations: no acceleration, no angular
/// acceleration, and the climb angle. In a steady turn p, q, r are the components of the turn rate,
/// g tan(bank) / V, in body axes.

#include <optional>

#include "controllers/parts/aircraft/flight_equations.h"
#include "controllers/parts/aircraft/flight_trim.h"

namespace vinerow::controllers {

/// State of the equations of flight at a trim.
AirState air_state_of(const Trim& trim);

class TrimSolver {
 public:
  explicit TrimSolver(const Aircraft& aircraft) : aircraft_(aircraft), equations_(aircraft) {}

  /// @param near  a neighbouring trim to start from; null: the start is searched
  /// @returns nullopt if Newton's method does not converge to steady flight, or converges beyond
  /// the stall (where more angle of attack gives less lift)
  std::optional<Trim> solve(const TrimRequest& request, const Trim* near = nullptr);
  /// The same with the throttle given; the search starts at the request's climb angle.
  std::optional<Trim> solve_at_throttle(const TrimRequest& request, double throttle,
                                        const Trim* near = nullptr);

  /// Largest lift (across the path, with the thrust's share) in straight flight at constant speed,
  /// as far as elevons and throttle maintain it; 0 if the elevons balance it nowhere.
  struct Lift {
    double lift_N = 0.0;
    double alpha_rad = 0.0;
  };
  Lift largest_lift(double airspeed_mps, double climb_angle_rad);

 private:
  using Vector7 = Eigen::Matrix<double, 7, 1>;
  /// `throttle` is empty if the climb angle is given and the throttle is the seventh unknown.
  struct Problem {
    TrimRequest request;
    std::optional<double> throttle;
  };

  std::optional<Trim> solve_problem(const Problem& problem, const Trim* near);
  Trim expand(const Problem& problem, const Vector7& y) const;
  Vector7 residual(const Problem& problem, const Vector7& y);
  Vector7 search_start(const Problem& problem);
  bool is_stalled(const Trim& trim);

  Aircraft aircraft_;
  FlightEquations equations_;
};

}  // namespace vinerow::controllers
