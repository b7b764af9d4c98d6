#include "engine/sensors/ultrasound.h"

#include <cmath>
#include <limits>

#include "engine/math/angles.h"
#include "engine/sensors/delay_line.h"
#include "engine/sensors/mounting.h"

namespace vinerow {
namespace {

/// Unit directions in S: the axis, then rings of 6, 12, 18 ... rays at equal angular spacing.
std::vector<Eigen::Vector3d> cone_directions(double half_angle_rad, int rings) {
  std::vector<Eigen::Vector3d> directions{Eigen::Vector3d::UnitX()};
  for (int ring = 1; ring <= rings; ++ring) {
    const double off_axis = half_angle_rad * ring / rings;
    for (int k = 0; k < 6 * ring; ++k) {
      const double around = 2.0 * kPi * k / (6 * ring);
      directions.emplace_back(std::cos(off_axis), std::sin(off_axis) * std::cos(around),
                              std::sin(off_axis) * std::sin(around));
    }
  }
  return directions;
}

class Ultrasound final : public Sensor {
 public:
  Ultrasound(const ParameterSet& parameters, const SensorContext& context)
      : name_(context.name),
        scene_(context.scene),
        X_BS_(mounting_pose(parameters)),
        outages_(outages_of(parameters)),
        line_(delay_of(parameters), context.period),
        random_(context.random()),
        half_angle_rad_(rad_from_deg(parameters.number("half_angle_deg"))),
        min_range_m_(parameters.number("min_range_m")),
        max_range_m_(parameters.number("max_range_m")),
        noise_std_m_(parameters.number("noise_std_m")),
        directions_S_(
            cone_directions(half_angle_rad_, static_cast<int>(parameters.integer("rings")))) {}

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    out_ = ports.write<RangeSample>(name_);
  }
  Duration delay() const override { return line_.delay(); }
  std::optional<Pose> mounting_X_BS() const override { return X_BS_; }
  void deliver(Time) override { line_.deliver(out_); }

  void step(Time now) override {
    RangeSample sample;
    sample.min_range_m = min_range_m_;
    sample.max_range_m = max_range_m_;
    sample.half_angle_rad = half_angle_rad_;
    sample.X_WS = truth_.value().X_WB * X_BS_;
    const double noise = noise_std_m_ * random_.normal();
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& dir_S : directions_S_) {
      const auto hit =
          scene_->cast_ray(sample.X_WS.p, sample.X_WS.q * dir_S, std::min(nearest, max_range_m_));
      if (hit) nearest = hit->distance_m;
    }
    const bool seen = std::isfinite(nearest) && !is_in_outage(outages_, now);
    sample.range_m =
        seen ? std::max(min_range_m_, nearest + noise) : std::numeric_limits<double>::infinity();
    if (sample.range_m > max_range_m_) sample.range_m = std::numeric_limits<double>::infinity();
    line_.push(now, sample, out_);
  }

 private:
  std::string name_;
  const SceneQuery* scene_;
  Pose X_BS_;
  std::vector<Outage> outages_;
  DelayLine<RangeSample> line_;
  RandomStream random_;
  double half_angle_rad_;
  double min_range_m_;
  double max_range_m_;
  double noise_std_m_;
  std::vector<Eigen::Vector3d> directions_S_;
  SignalReader<Odometry> truth_;
  SignalWriter<RangeSample> out_;
};

}  // namespace

PartSpec ultrasound_spec() {
  PartSpec spec;
  spec.name = "ultrasound";
  spec.description = "Ultrasonic ranger: first return in a cone of rays, with white noise";
  spec.default_rate_Hz = 20.0;
  // Defaults: HC-SR04 data sheet (2 cm to 4 m, 3 mm, 15 degrees effective cone).
  spec.parameters = mounting_parameters({0.0, 0.0, 0.0});
  spec.parameters.push_back(number_parameter("half_angle_deg", "deg", 15.0, 0.0, 80.0,
                                             "half angle of the cone; 0 = a single ray"));
  spec.parameters.push_back(integer_parameter("rings", 2, 0, 8, "rings of rays around the axis"));
  spec.parameters.push_back(
      positive_parameter("min_range_m", "m", 0.02, "shortest distance it tells"));
  spec.parameters.push_back(
      positive_parameter("max_range_m", "m", 4.0, "longest distance it tells"));
  spec.parameters.push_back(
      number_parameter("noise_std_m", "m", 0.003, 0.0, 10.0, "white noise of the reading"));
  spec.parameters.push_back(delay_parameter());
  spec.parameters.push_back(outage_parameter());
  spec.reads = {"truth"};
  spec.writes = {"<name>: RangeSample"};
  return spec;
}

std::unique_ptr<Sensor> make_ultrasound(const ParameterSet& parameters,
                                        const SensorContext& context) {
  return std::make_unique<Ultrasound>(parameters, context);
}

}  // namespace vinerow
