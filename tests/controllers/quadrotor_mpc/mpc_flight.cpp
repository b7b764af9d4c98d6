#include "tests/controllers/quadrotor_mpc/mpc_flight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace vinerow::test {

FlightPath straight(const Eigen::Vector3d& p_W, double yaw_rad, double speed_mps) {
  return [=](double time_s) {
    TrajectoryPoint point;
    point.v_W = speed_mps * Eigen::Vector3d(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
    point.p_W = p_W + time_s * point.v_W;
    point.yaw_rad = yaw_rad;
    return point;
  };
}

namespace {

struct Sample {
  TrajectoryPoint point;
  bool is_turn = false, is_row = false;
};

/// Of the way: row, right arc, left arc, right arc, row.
double curvature_at(const RowsAndTurnNumbers& n, double distance_m, double total_m) {
  const double R = n.radius_m, a = std::acos((R + 0.5 * n.spacing_m) / (2.0 * R));
  double s = distance_m - n.row_m;
  if (s < 0.0 || distance_m > total_m - n.row_m) return 0.0;
  if (s < R * a) return -1.0 / R;
  s -= R * a;
  if (s < R * (M_PI + 2.0 * a)) return 1.0 / R;
  return -1.0 / R;
}

}  // namespace

RowsAndTurn make_rows_and_turn(const RowsAndTurnNumbers& n) {
  constexpr double kDt_s = 0.001;
  const double a = std::acos((n.radius_m + 0.5 * n.spacing_m) / (2.0 * n.radius_m));
  const double turn_m = n.radius_m * (M_PI + 4.0 * a), total_m = 2.0 * n.row_m + turn_m;
  const double k = 2.0 * M_PI / n.bump_length_m;
  auto table = std::make_shared<std::vector<Sample>>();
  double distance_m = 0.0, v = n.turn_mps;
  Eigen::Vector2d p(0.0, 0.0);
  double yaw = n.yaw_rad;
  while (distance_m < total_m) {
    const bool in_turn = distance_m >= n.row_m && distance_m <= total_m - n.row_m;
    // Brakes so as to enter the turn, and to end, at the turn's speed.
    const double left_m =
        distance_m < n.row_m ? n.row_m - distance_m : std::max(total_m - distance_m, 0.0);
    const double may = in_turn ? n.turn_mps
                               : std::min(n.row_mps, std::sqrt(n.turn_mps * n.turn_mps +
                                                               2.0 * n.acceleration_mps2 * left_m));
    double acceleration = std::clamp((may - v) / kDt_s, -n.acceleration_mps2, n.acceleration_mps2);
    if (std::abs(may - v) < 1e-9) acceleration = 0.0;
    const double curvature = curvature_at(n, distance_m, total_m);
    const Eigen::Vector2d t(std::cos(yaw), std::sin(yaw)), left(-t.y(), t.x());
    const Eigen::Vector2d east(std::cos(n.yaw_rad), std::sin(n.yaw_rad));
    // Height by the place along the first row.
    const double x = east.dot(p), x1 = v * east.dot(t);
    const Eigen::Vector2d a2 = acceleration * t + v * v * curvature * left;
    const double x2 = east.dot(a2);
    Sample sample;
    sample.point.p_W << p, 1.5 + n.slope * x + n.bump_m * std::sin(k * x);
    sample.point.v_W << v * t, (n.slope + n.bump_m * k * std::cos(k * x)) * x1;
    sample.point.a_W << a2, (n.slope + n.bump_m * k * std::cos(k * x)) * x2 -
                                n.bump_m * k * k * std::sin(k * x) * x1 * x1;
    sample.point.yaw_rad = yaw;
    sample.point.yaw_rate_radps = v * curvature;
    sample.is_turn = in_turn;
    sample.is_row = !in_turn;
    table->push_back(sample);
    // Along the arc, exactly.
    const double step = v * kDt_s + 0.5 * acceleration * kDt_s * kDt_s, bend = curvature * step;
    p += step * (std::cos(0.5 * bend) * t + std::sin(0.5 * bend) * left);
    yaw += bend;
    v += acceleration * kDt_s;
    distance_m += step;
  }
  const auto at = [table](double time_s) -> const Sample& {
    const long index = std::lround(time_s / kDt_s);
    return (*table)[std::clamp(index, 0L, static_cast<long>(table->size()) - 1)];
  };
  RowsAndTurn rows;
  rows.path = [at](double t) { return at(t).point; };
  rows.is_row = [at](double t) { return at(t).is_row; };
  rows.is_turn = [at](double t) { return at(t).is_turn; };
  rows.end_s = static_cast<double>(table->size() - 1) * kDt_s;
  return rows;
}

FlightErrors fly(QuadrotorLoop& loop, const RowsAndTurn& rows, double from_s) {
  FlightErrors errors;
  double square = 0.0;
  int samples = 0;
  while (loop.time_s() < rows.end_s - 1.0) {
    loop.tick();
    const double t = loop.time_s();
    if (t < from_s) continue;
    const Eigen::Vector3d e = loop.path_error();
    errors.finite = errors.finite && e.allFinite() && loop.sim().state().w_B.allFinite();
    if (rows.is_row(t)) {
      square += e.y() * e.y();
      ++samples;
      errors.lateral_max_m = std::max(errors.lateral_max_m, std::abs(e.y()));
      const TrajectoryPoint at = rows.path(t);
      const Eigen::Vector3d along(std::cos(at.yaw_rad), std::sin(at.yaw_rad), 0.0);
      errors.speed_max_mps =
          std::max(errors.speed_max_mps, std::abs(along.dot(loop.sim().state().v_W - at.v_W)));
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
