#include "tests/controllers/estimation/row_localisation/localisation_lab.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/world_model.h"

namespace vinerow::test {
namespace {

using Eigen::Vector3d;
constexpr double kTick_s = 0.01;
constexpr double kEllipse95 = 5.991464547;  // chi-square, 2 degrees of freedom

/// x'' = -2 zeta w x' - w^2 x + noise: a smooth wander of given standard deviation.
class Wander {
 public:
  Wander(double std, double frequency_radps, RandomStream& random) : w_(frequency_radps) {
    x_ = std * random.normal();
    v_ = std * w_ * random.normal();
    noise_ = std * std::sqrt(4.0 * kDamping * w_ * w_ * w_ * kTick_s);
  }
  double step(RandomStream& random) {
    v_ += kTick_s * (-2.0 * kDamping * w_ * v_ - w_ * w_ * x_) + noise_ * random.normal();
    return x_ += kTick_s * v_;
  }

 private:
  static constexpr double kDamping = 0.7;
  double w_, x_, v_, noise_;
};

/// First-order Gauss-Markov, three axes.
class SlowNoise {
 public:
  SlowNoise(const Vector3d& std, double time_s, double step_s, RandomStream& random)
      : std_(std), keep_(time_s > 0.0 ? std::exp(-step_s / time_s) : 0.0) {
    step(random, 1.0);
  }
  const Vector3d& step(RandomStream& random) {
    return step(random, std::sqrt(1.0 - keep_ * keep_));
  }

 private:
  const Vector3d& step(RandomStream& random, double fresh) {
    for (int i = 0; i < 3; ++i) x_[i] = keep_ * x_[i] + fresh * std_[i] * random.normal();
    return x_;
  }
  Vector3d std_, x_ = Vector3d::Zero();
  double keep_;
};

struct TrueState {
  Pose X_WB;
  double s;
};

std::vector<TrueState> draw_flight(const LabSetup& setup, const LocalisationWorld& world,
                                   std::uint64_t seed) {
  RandomStream random(seed, "lab", "flight");
  Wander along(setup.gust_std_m, setup.gust_radps, random),
      across(setup.gust_std_m, setup.gust_radps, random),
      up(setup.gust_std_m, setup.gust_radps, random),
      yaw(setup.yaw_std_rad, setup.yaw_radps, random),
      roll(setup.tilt_std_rad, setup.tilt_radps, random),
      pitch(setup.tilt_std_rad, setup.tilt_radps, random);
  // t = 0 lies in the middle of an alley for an even number of rows.
  const double middle = world.setup().rows % 2 == 0 ? 0.0 : 0.5 * world.setup().spacing_m;
  std::vector<TrueState> flight;
  const int ticks = static_cast<int>(std::lround(setup.duration_s / kTick_s));
  for (int k = 0; k <= ticks; ++k) {
    const double s = setup.speed_mps * k * kTick_s + along.step(random);
    const double t = middle + across.step(random);
    const double h = setup.height_m + up.step(random);
    const double heading = world.setup().azimuth_rad + yaw.step(random);
    flight.push_back({{quaternion_from_rpy({roll.step(random), pitch.step(random), heading}),
                       world.place(s, t, h)},
                      s});
  }
  return flight;
}

double read_range(const LabSetup& setup, const LocalisationWorld& world, const Pose& X_WS,
                  RandomStream& random) {
  double range = world.true_range(X_WS.p, X_WS.q * Vector3d::UnitX(), setup.max_range_m);
  if (setup.cone_rad > 0.0) {
    for (int i = -6; i <= 6; ++i) {
      for (int j = -2; j <= 2; ++j) {
        const double a = i / 6.0, b = j / 3.0;
        if (a * a + b * b > 1.0) continue;
        const Vector3d dir(std::cos(a * setup.cone_rad) * std::cos(b * setup.cone_rad),
                           std::sin(a * setup.cone_rad) * std::cos(b * setup.cone_rad),
                           std::sin(b * setup.cone_rad));
        range = std::min(range, world.true_range(X_WS.p, X_WS.q * dir, setup.max_range_m));
      }
    }
  }
  const double error = random.uniform(-setup.range_bound_m, setup.range_bound_m);
  const bool is_missed = random.uniform() < setup.missed_share;
  const bool is_false = random.uniform() < setup.false_share;
  const double share = random.uniform();
  if (is_false) return 0.02 + share * (std::min(range, setup.max_range_m) - 0.02);
  if (is_missed) return std::numeric_limits<double>::infinity();
  return std::max(0.0, range + error);
}

std::vector<controllers::RangeSensorModel> make_sensors(const LabSetup& setup) {
  std::vector<controllers::RangeSensorModel> sensors;
  for (const double angle : setup.sensor_angles_rad) {
    controllers::RangeSensorModel sensor;
    sensor.name = "range" + std::to_string(sensors.size());
    sensor.X_BS.q = quaternion_from_rpy({0, 0, angle});
    sensor.half_angle_rad = setup.filter_fan_rays > 1 ? setup.cone_rad : 0.0;
    sensor.fan_rays = setup.filter_fan_rays;
    sensor.bound_m = setup.range_bound_m;
    sensors.push_back(sensor);
  }
  return sensors;
}

Time tick_time(int tick) {
  return Time{static_cast<std::int64_t>(tick) * 10'000'000};
}

LabSample judge(const LabFilter& filter, const LocalisationWorld& world, const TrueState& truth,
                double time_s) {
  LabSample sample;
  sample.time_s = time_s;
  sample.s_m = truth.s;
  const Vector3d error = filter.p_W() - truth.X_WB.p;
  sample.lateral_m = error.dot(world.left_W());
  sample.longitudinal_m = error.dot(world.along_W());
  const Eigen::Matrix2d P = filter.covariance().topLeftCorner<2, 2>();
  const Eigen::Vector2d e = error.head<2>();
  const double nees = e.dot(P.inverse() * e);
  sample.nees = std::isfinite(nees) && nees >= 0.0 ? std::min(nees, 100.0) : 100.0;
  sample.in_ellipse = sample.nees <= kEllipse95;
  sample.in_set = filter.contains(truth.X_WB.p);
  return sample;
}

}  // namespace

LabRun fly(const LabSetup& setup, std::uint64_t seed, const LabFilterMaker& make) {
  const LocalisationWorld world(setup.world, seed);
  const std::vector<TrueState> flight = draw_flight(setup, world, seed);
  const std::vector<controllers::RangeSensorModel> sensors = make_sensors(setup);
  const auto filter = make(LabContext{world.map(), world.map_index(), sensors, setup});
  RandomStream start(seed, "lab", "start"), inertial(seed, "lab", "inertial"),
      satellites(seed, "lab", "satellites"), echoes(seed, "lab", "echoes"),
      up_sensor(seed, "lab", "height");
  SlowNoise velocity(Vector3d::Constant(setup.velocity_std_mps), setup.velocity_time_s, kTick_s,
                     inertial);
  SlowNoise slow_fix(setup.fix_std_m, setup.fix_time_s, setup.fix_every * kTick_s, satellites);
  // By the tick of measurement.
  std::vector<Vector3d> fixes(flight.size());
  std::vector<double> heights(flight.size());
  std::vector<std::vector<controllers::RangeReading>> ranges(flight.size());

  LabRun run;
  const double up_std =
      setup.start_vertical_std_m < 0.0 ? setup.start_std_m : setup.start_vertical_std_m;
  const Vector3d start_std(setup.start_std_m, setup.start_std_m, up_std);
  for (int k = 0; k < static_cast<int>(flight.size()); ++k) {
    const TrueState& truth = flight[k];
    const Time now = tick_time(k);
    if (k == 0) {
      Vector3d p = truth.X_WB.p + world.place(0, setup.start_alleys_off * setup.world.spacing_m, 0);
      for (int i = 0; i < 3; ++i) p[i] += start_std[i] * start.normal();
      filter->start(now, p, start_std.cwiseAbs2().asDiagonal());
    }
    // Inertial unit: the mean velocity since the last tick.
    const Vector3d v_true = k == 0 ? Vector3d(Vector3d::Zero())
                                   : Vector3d((truth.X_WB.p - flight[k - 1].X_WB.p) / kTick_s);
    Vector3d v = v_true + velocity.step(inertial), p_inertial = truth.X_WB.p;
    for (int i = 0; i < 3; ++i) {
      v[i] += setup.velocity_white_std_mps * inertial.normal();
      p_inertial[i] += setup.inertial_std_m[i] * inertial.normal();
    }
    RollPitchYaw rpy = rpy_from_quaternion(truth.X_WB.q);
    rpy.roll_rad += setup.roll_std_rad * inertial.normal();
    rpy.pitch_rad += setup.roll_std_rad * inertial.normal();
    rpy.yaw_rad += setup.heading_std_rad * inertial.normal();
    filter->inertial(now, v, quaternion_from_rpy(rpy), p_inertial, setup.inertial_std_m);

    // Measured now.
    if (k % setup.fix_every == 0) fixes[k] = truth.X_WB.p + slow_fix.step(satellites);
    if (k % setup.range_every == 0) {
      const int count = static_cast<int>(sensors.size());
      for (int i = 0; i < count; ++i) {
        if (setup.in_turn && (k / setup.range_every) % count != i) continue;
        const double range = read_range(setup, world, truth.X_WB * sensors[i].X_BS, echoes);
        ranges[k].push_back({i, range, setup.max_range_m});
      }
    }
    if (k % setup.range_every == 0) {
      heights[k] = truth.X_WB.p.z() + setup.height_std_m * up_sensor.normal();
    }
    // Delivered now.
    const double time_s = k * kTick_s;
    const bool is_out = time_s >= setup.outage_from_s && time_s < setup.outage_to_s;
    if (const int m = k - setup.fix_age; m >= 0 && m % setup.fix_every == 0 && !is_out) {
      filter->fix(setup.has_stamps ? tick_time(m) : now, fixes[m], setup.fix_std_m);
    }
    if (const int m = k - setup.range_age;
        m >= 0 && m % setup.range_every == 0 && setup.height_std_m > 0.0) {
      filter->height(setup.has_stamps ? tick_time(m) : now, heights[m], setup.height_std_m);
    }
    if (const int m = k - setup.range_age; m >= 0 && !ranges[m].empty()) {
      filter->ranges(setup.has_stamps ? tick_time(m) : now, ranges[m]);
    }
    run.samples.push_back(judge(*filter, world, truth, time_s));
  }
  return run;
}

LabScore study(const LabSetup& setup, int count, const LabFilterMaker& make,
               const std::function<bool(const LabSample&)>& counts) {
  LabScore score;
  double n = 0.0;
  for (int seed = 1; seed <= count; ++seed) {
    const LabRun run = fly(setup, static_cast<std::uint64_t>(seed), make);
    ++score.seeds;
    const LabSample& last = run.samples.back();
    if (!(std::hypot(last.lateral_m, last.longitudinal_m) < 1.0 + 0.0 * last.nees)) {
      ++score.lost;
    }
    for (const LabSample& sample : run.samples) {
      if (counts ? !counts(sample) : sample.time_s < 3.0) continue;
      n += 1.0;
      score.nees += sample.nees;
      score.lateral_m += sample.lateral_m * sample.lateral_m;
      score.longitudinal_m += sample.longitudinal_m * sample.longitudinal_m;
      score.lateral_mean_m += sample.lateral_m;
      score.longitudinal_mean_m += sample.longitudinal_m;
      score.lateral_max_m = std::max(score.lateral_max_m, std::abs(sample.lateral_m));
      score.coverage += sample.in_ellipse;
      score.containment += sample.in_set;
    }
  }
  score.lateral_m = std::sqrt(score.lateral_m / n);
  score.longitudinal_m = std::sqrt(score.longitudinal_m / n);
  for (double* mean : {&score.lateral_mean_m, &score.longitudinal_mean_m, &score.nees,
                       &score.coverage, &score.containment}) {
    *mean /= n;
  }
  return score;
}

namespace {

class DistanceFilterUnderTest final : public LabFilter {
 public:
  DistanceFilterUnderTest(const controllers::DistanceFilterParams& params,
                          const LabContext& context, bool has_map)
      : law_(params, context.map.accuracy, has_map ? &context.index : nullptr, context.sensors),
        heading_std_rad_(context.setup.heading_std_rad) {}

  void start(Time now, const Vector3d& p_W, const Eigen::Matrix3d& covariance) override {
    law_.start(now, p_W, covariance);
  }
  void inertial(Time now, const Vector3d& v_W, const Eigen::Quaterniond& q_WB, const Vector3d& p_W,
                const Vector3d& std_m) override {
    law_.predict(now, v_W, q_WB, heading_std_rad_);
    law_.take_inertial_position(now, p_W, std_m);
  }
  void fix(Time measured, const Vector3d& p_W, const Vector3d& std_m) override {
    law_.take_fix(measured, p_W, std_m, Vector3d::Zero());
  }
  void height(Time measured, double z_m, double std_m) override {
    law_.take_height(measured, z_m, std_m);
  }
  void ranges(Time measured, std::span<const controllers::RangeReading> readings) override {
    law_.take_ranges(measured, readings);
  }
  Vector3d p_W() const override { return law_.kalman().p_W(); }
  Eigen::Matrix3d covariance() const override { return law_.kalman().position_covariance(); }
  bool contains(const Vector3d& p_W) const override { return law_.set().contains(p_W); }

 private:
  controllers::DistanceFilterLaw law_;
  double heading_std_rad_;
};

}  // namespace

LabFilterMaker distance_filter(const controllers::DistanceFilterParams& params, bool has_map) {
  return [params, has_map](const LabContext& context) {
    return std::make_unique<DistanceFilterUnderTest>(params, context, has_map);
  };
}

controllers::DistanceFilterParams reading_params(controllers::InertialReading reading) {
  controllers::DistanceFilterParams params;
  params.reading = reading;
  params.kalman = controllers::kalman_params_of(reading);
  return params;
}

}  // namespace vinerow::test
