#include "tests/benchmarks/localisation_flight.h"

#include <cmath>

#include "engine/api/world_model.h"

namespace vinerow::bench {
namespace {

using Eigen::Vector3d;

/// Estimates nothing.
class Listener final : public test::LabFilter {
 public:
  explicit Listener(RecordedFlight& flight) : flight_(flight) {}

  void start(Time, const Vector3d& p_W, const Eigen::Matrix3d& covariance) override {
    flight_.start_W = p_W;
    flight_.start_covariance_m2 = covariance;
  }
  void inertial(Time now, const Vector3d& v_W, const Eigen::Quaterniond& q_WB, const Vector3d& p_W,
                const Vector3d& std_m) override {
    flight_.ticks.push_back({now, v_W, p_W, std_m, q_WB, {}, {}, {}});
  }
  void fix(Time, const Vector3d& p_W, const Vector3d&) override {
    flight_.ticks.back().fix_W = p_W;
  }
  void height(Time, double z_m, double) override { flight_.ticks.back().height_m = z_m; }
  void ranges(Time, std::span<const controllers::RangeReading> readings) override {
    flight_.ticks.back().ranges.assign(readings.begin(), readings.end());
  }
  Vector3d p_W() const override { return flight_.start_W; }
  Eigen::Matrix3d covariance() const override { return flight_.start_covariance_m2; }

 private:
  RecordedFlight& flight_;
};

/// The line with further points, `step_m` apart at most.
std::vector<Vector3d> refined(const std::vector<Vector3d>& line_W, double step_m) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i + 1 < line_W.size(); ++i) {
    const Vector3d edge_W = line_W[i + 1] - line_W[i];
    const int pieces = static_cast<int>(std::ceil(edge_W.head<2>().norm() / step_m));
    for (int k = 0; k < pieces; ++k) points.push_back(line_W[i] + k * edge_W / pieces);
  }
  points.push_back(line_W.back());
  return points;
}

}  // namespace

RecordedFlight record_flight(const test::LabSetup& setup, std::uint64_t seed) {
  RecordedFlight flight;
  flight.setup = setup;
  flight.world = std::make_unique<test::LocalisationWorld>(setup.world, seed);
  flight.map = flight.world->map();
  for (PlantRow& row : flight.map.rows) row.line_W = refined(row.line_W, 2.0);
  for (Alley& alley : flight.map.alleys) alley.line_W = refined(alley.line_W, 2.0);
  test::fly(setup, seed, [&flight](const test::LabContext& context) {
    flight.sensors = context.sensors;
    return std::make_unique<Listener>(flight);
  });
  return flight;
}

test::LabSetup sixteen_rows(double cone_rad) {
  test::LabSetup setup;
  setup.world.rows = 16;
  setup.world.length_m = 118.0;
  setup.duration_s = 70.0;
  setup.cone_rad = cone_rad;
  setup.filter_fan_rays = cone_rad > 0.0 ? 7 : 1;
  return setup;
}

void start(const RecordedFlight& flight, test::LabFilter& filter) {
  filter.start(flight.ticks.front().now, flight.start_W, flight.start_covariance_m2);
}

void feed(const RecordedFlight& flight, const FlightTick& tick, test::LabFilter& filter) {
  filter.inertial(tick.now, tick.v_W, tick.q_WB, tick.p_inertial_W, tick.std_inertial_m);
  if (tick.fix_W) filter.fix(tick.now, *tick.fix_W, flight.setup.fix_std_m);
  if (tick.height_m) filter.height(tick.now, *tick.height_m, flight.setup.height_std_m);
  if (!tick.ranges.empty()) filter.ranges(tick.now, tick.ranges);
}

}  // namespace vinerow::bench
