// The error-state filter on a flight of PX4's simulated Iris, against PX4's own filter.
// Data: PX4-ECL (BSD-3), test/replay_data/iris_gps.csv, and what its 24-state filter made of it,
// test/change_indication/iris_gps.csv. N, E, D and forward, right, down there; E, N, U and forward,
// left, up here.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "controllers/estimation/inertial/error_state_kalman.h"
#include "controllers/estimation/inertial/navigation_measurements.h"
#include "controllers/estimation/inertial/navigation_start.h"
#include "engine/math/angles.h"
#include "tests/support/data.h"

namespace vinerow::test::error_state_px4_test {
namespace {

using Eigen::Vector3d;

struct Row {
  Time time;
  std::string sensor;
  std::vector<double> values;
};

std::vector<Row> read_log(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::vector<Row> rows;
  for (std::string line; std::getline(stream, line);) {
    std::stringstream cells(line);
    Row row;
    std::string cell;
    std::getline(cells, cell, ',');
    row.time.ns = std::stoll(cell) * 1000;
    std::getline(cells, row.sensor, ',');
    while (std::getline(cells, cell, ',')) row.values.push_back(std::stod(cell));
    rows.push_back(row);
  }
  return rows;
}

/// N, E, D by time in ns.
std::map<std::int64_t, Vector3d> read_reference(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::map<std::int64_t, Vector3d> positions;
  std::string line, cell;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::stringstream cells(line);
    std::vector<double> values;
    while (std::getline(cells, cell, ',')) values.push_back(std::stod(cell));
    positions[static_cast<std::int64_t>(values[0]) * 1000] = {values[8], values[9], values[10]};
  }
  return positions;
}

TEST(ErrorStateKalman, FliesPx4sIrisAsPx4sFilterDoes) {
  VINEROW_OUTSIDE_DATA(folder, "px4_ecl/test");
  const std::vector<Row> log = read_log(folder / "replay_data/iris_gps.csv");
  const auto reference = read_reference(folder / "change_indication/iris_gps.csv");
  ASSERT_GT(log.size(), 20'000u);

  // Noises as PX4 takes them (parameters EKF2_GYR_NOISE 0.015 rad/s, EKF2_ACC_NOISE 0.35 m/s2 per
  // sample at 200 Hz, GPS 0.5 m and 0.3 m/s, heading 0.3 rad; fixes are 110 ms old,
  // EKF2_GPS_DELAY).
  controllers::ErrorStateKalmanParams params;
  params.imu = {0.015 / std::sqrt(200.0), 0.35 / std::sqrt(200.0), 1e-4, 1e-3};
  controllers::ErrorStateKalman filter(params);
  const Duration late{110'000'000};
  const auto to_body = [](const std::vector<double>& v, int at) {
    return Vector3d(v[at], -v[at + 1], -v[at + 2]);
  };
  Vector3d force_sum = Vector3d::Zero(), first_fix(0, 0, 0);
  const double north_rad = 0.5 * kPi;
  int forces = 0, fixes_used = 0, fixes = 0;
  Vector3d field_B = Vector3d::Zero();
  // Largest difference of N, E, height from the reference.
  Vector3d worst = Vector3d::Zero();
  double highest_m = 0.0;
  auto next = reference.begin();
  for (const Row& row : log) {
    if (row.sensor == "mag") {
      field_B = to_body(row.values, 0);
    } else if (row.sensor == "imu") {
      const Vector3d f_B = to_body(row.values, 0), w_B = to_body(row.values, 3);
      if (!filter.started()) {
        force_sum += f_B;
        ++forces;
      } else {
        filter.predict(row.time, w_B, f_B);
      }
    } else if (row.sensor == "gps") {
      // alt mm, lon 1e7, lat 1e7, vN, vE, vD.
      const double latitude = row.values[2] * 1e-7, longitude = row.values[1] * 1e-7;
      if (!filter.started()) {
        first_fix = {longitude, latitude, row.values[0] * 1e-3};
        const Vector3d f_B = force_sum / forces;
        controllers::NavState state;
        state.q_WB = controllers::level_attitude(
            f_B, controllers::heading_from_field(f_B, field_B, north_rad));
        controllers::ErrorVector std;
        std << Vector3d::Constant(0.5), Vector3d::Constant(0.5), Vector3d(0.05, 0.05, 0.3),
            Vector3d::Constant(0.01), Vector3d::Constant(0.2);
        filter.start(row.time, state, controllers::ErrorCovariance(std.cwiseAbs2().asDiagonal()));
        continue;
      }
      const double east_m =
          rad_from_deg(longitude - first_fix.x()) * 6'388'000.0 * std::cos(rad_from_deg(latitude));
      const double north_m = rad_from_deg(latitude - first_fix.y()) * 6'370'000.0;
      const Vector3d p(east_m, north_m, row.values[0] * 1e-3 - first_fix.z());
      const Vector3d v(row.values[4], row.values[3], -row.values[5]);
      const Time measured = row.time - late;
      const double age_s = (filter.time() - measured).s();
      if (!filter.remembers(measured)) continue;
      ++fixes;
      const controllers::VectorMeasurement place =
          controllers::place_measurement(filter.past(measured), Vector3d::Zero(), p);
      fixes_used += filter
                        .correct_vector(place.innovation, filter.at_age(place.H, age_s),
                                        Vector3d::Constant(0.25), 5)
                        .used();
      const controllers::VectorMeasurement speed =
          controllers::velocity_measurement(filter.past(measured), Vector3d::Zero(), v);
      filter.correct_vector(speed.innovation, filter.at_age(speed.H, age_s),
                            Vector3d::Constant(0.09), 5);
      const controllers::ScalarMeasurement heading =
          controllers::magnetic_measurement(filter.past(filter.time()), field_B, north_rad);
      filter.correct_scalar(heading.innovation, heading.H, 0.09, 5);
    }
    while (next != reference.end() && next->first <= row.time.ns) {
      // What comes after 34.4 s runs free; before 2 s PX4's filter finds its start.
      if (filter.started() && next->first > 2'000'000'000 && next->first < 34'400'000'000) {
        const Vector3d p = filter.state().p_WI;
        const Vector3d ned(p.y(), p.x(), -p.z());
        worst = worst.cwiseMax((ned - next->second).cwiseAbs());
        highest_m = std::max(highest_m, p.z());
      }
      ++next;
    }
  }
  std::printf("worst difference: N %.3f, E %.3f, height %.3f m; highest %.2f m; fixes %d of %d\n",
              worst.x(), worst.y(), worst.z(), highest_m, fixes_used, fixes);
  EXPECT_LT(worst.x(), 0.3);
  EXPECT_LT(worst.y(), 0.3);
  EXPECT_LT(worst.z(), 0.5);
  EXPECT_NEAR(highest_m, 3.6, 0.5);
  EXPECT_EQ(fixes_used, fixes);
}

}  // namespace
}  // namespace vinerow::test::error_state_px4_test
