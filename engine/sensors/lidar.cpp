#include "engine/sensors/lidar.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/api/messages/sensors.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/sensors/mounted_sensor.h"

namespace vinerow {
namespace {

constexpr int kMostBeams = 20'000;
constexpr int kMostSubRays = 15;

int count_beams(const ParameterSet& parameters) {
  const double field_deg = parameters.number("field_of_view_deg");
  const double step_deg = parameters.number("angle_step_deg");
  const double count = std::floor(field_deg / step_deg + 1e-6) + 1.0;
  if (count > kMostBeams) {
    throw ConfigError(fmt::format(
        "angle_step_deg = {} deg makes {:.0f} beams of field_of_view_deg = {} deg, must be at most "
        "{}",
        step_deg, count, field_deg, kMostBeams));
  }
  return static_cast<int>(count);
}

int read_sub_rays(const ParameterSet& parameters) {
  const auto count = static_cast<int>(parameters.integer("sub_rays"));
  if (count % 2 == 0) {
    throw ConfigError(fmt::format("sub_rays = {}, must be odd: one lies in the middle", count));
  }
  return count;
}

class Lidar final : public MountedSensor<LaserScan> {
 public:
  Lidar(const ParameterSet& parameters, const SensorContext& context)
      : MountedSensor(parameters, context),
        scene_(context.scene),
        random_(context.random()),
        beams_(count_beams(parameters)),
        sub_rays_(read_sub_rays(parameters)),
        is_mixed_(parameters.text("edge") == "mixed"),
        pulse_m_(parameters.number("pulse_m")),
        dark_range_m_(parameters.number("dark_range_m")),
        noise_std_m_(parameters.number("noise_std_m")),
        noise_growth_(parameters.number("noise_growth")),
        dropout_share_(parameters.number("beam_dropout_share")),
        reflectance_{} {
    set_reflectances(parameters);
    const double accuracy_m = parameters.number("accuracy_m");
    offset_m_ = context.random("offset").uniform(-accuracy_m, accuracy_m);
    scan_.min_range_m = parameters.number("min_range_m");
    scan_.max_range_m = parameters.number("max_range_m");
    if (!(scan_.min_range_m < scan_.max_range_m)) {
      throw ConfigError(fmt::format("min_range_m = {} m, must be < max_range_m = {} m",
                                    scan_.min_range_m, scan_.max_range_m));
    }
    scan_.angle_step_rad = rad_from_deg(parameters.number("angle_step_deg"));
    scan_.first_angle_rad = -0.5 * scan_.angle_step_rad * (beams_ - 1);
    scan_.ranges_m.assign(beams_, kInfinity);
    true_scan_ = scan_;
    readings_.prefill(scan_);
    const double width_rad = rad_from_deg(parameters.number("divergence_deg"));
    for (int beam = 0; beam < beams_; ++beam) {
      for (int sub = 0; sub < sub_rays_; ++sub) {
        const double aside =
            sub_rays_ == 1 ? 0.0 : static_cast<double>(sub) / (sub_rays_ - 1) - 0.5;
        const double angle_rad =
            scan_.first_angle_rad + beam * scan_.angle_step_rad + aside * width_rad;
        directions_S_.emplace_back(std::cos(angle_rad), std::sin(angle_rad), 0.0);
      }
    }
  }

  void step(Time now) override {
    scan_.X_WS = true_scan_.X_WS = X_WS();
    const bool is_silent = readings_.is_in_outage(now);
    for (int beam = 0; beam < beams_; ++beam) {
      // The same count is drawn for every beam, whatever it sees.
      const double noise = random_.normal(), luck = random_.uniform();
      double& truth_m = true_scan_.ranges_m[beam];
      const Echo echo = cast(beam, truth_m);
      double reading_m = kInfinity;
      if (luck < (1.0 - dropout_share_) * detection_probability(echo.power) && !is_silent) {
        const double r = echo.distance_m;
        reading_m = r + offset_m_ + (noise_std_m_ + noise_growth_ * r) * noise;
        if (reading_m < scan_.min_range_m || reading_m > scan_.max_range_m) reading_m = kInfinity;
      }
      scan_.ranges_m[beam] = reading_m;
    }
    readings_.push(now, scan_, true_scan_);
  }

 private:
  struct Echo {
    double distance_m = kInfinity;
    double power = 0.0;
  };

  void set_reflectances(const ParameterSet& parameters) {
    reflectance_.fill(parameters.number("obstacle_reflectance"));
    const auto set = [&](SurfaceClass surface, const char* name) {
      reflectance_[static_cast<std::size_t>(surface)] = parameters.number(name);
    };
    set(SurfaceClass::kCanopy, "canopy_reflectance");
    set(SurfaceClass::kTerrain, "ground_reflectance");
    set(SurfaceClass::kPost, "stem_reflectance");
    set(SurfaceClass::kTrunk, "stem_reflectance");
  }

  static double detection_probability(double power) {
    const double fourth = power * power * power * power;
    return fourth / (fourth + 1.0 / 9.0);
  }

  /// Distance and power of a beam. @param truth_m  set to the distance along its middle
  Echo cast(int beam, double& truth_m) const {
    std::array<Echo, kMostSubRays> hits;
    Echo first;
    for (int sub = 0; sub < sub_rays_; ++sub) {
      const Eigen::Vector3d dir_W = scan_.X_WS.q * directions_S_[beam * sub_rays_ + sub];
      const auto hit = scene_->cast_ray(scan_.X_WS.p, dir_W, scan_.max_range_m);
      Echo& echo = hits[sub];
      if (hit) {
        const double ratio = dark_range_m_ / std::max(hit->distance_m, scan_.min_range_m);
        const double reflectance = reflectance_[static_cast<std::size_t>(hit->surface)];
        echo = {hit->distance_m, 10.0 * reflectance * std::max(0.0, -hit->normal_W.dot(dir_W)) *
                                     ratio * ratio / sub_rays_};
      }
      if (2 * sub + 1 == sub_rays_) truth_m = echo.distance_m;
      first.distance_m = std::min(first.distance_m, echo.distance_m);
    }
    double weighted_m = 0.0;
    for (int sub = 0; sub < sub_rays_; ++sub) {
      if (!(hits[sub].distance_m <= first.distance_m + pulse_m_)) continue;
      if (!std::isfinite(hits[sub].distance_m)) continue;
      first.power += hits[sub].power;
      weighted_m += hits[sub].power * hits[sub].distance_m;
    }
    if (is_mixed_ && first.power > 0.0) first.distance_m = weighted_m / first.power;
    return first;
  }

  const SceneQuery* scene_;
  RandomStream random_;
  int beams_;
  int sub_rays_;
  bool is_mixed_;
  double pulse_m_;
  double dark_range_m_;
  double noise_std_m_;
  double noise_growth_;
  double dropout_share_;
  std::array<double, 8> reflectance_;  ///< by SurfaceClass
  double offset_m_ = 0.0;
  std::vector<Eigen::Vector3d> directions_S_;  ///< of all sub-rays, beam by beam
  LaserScan scan_;
  LaserScan true_scan_;
};

}  // namespace

PartSpec lidar_spec() {
  const auto reflectance = [](const char* name, double value, const char* of) {
    return number_parameter(name, "", value, 0.0, 1.0, fmt::format("near infrared, of {}", of));
  };
  // Defaults: the geometry of a Hokuyo UST-10LX with ideal readings. Real ones: assets/sensors.
  return mounted_sensor_spec<LaserScan>(
      "lidar",
      "2D laser scanner: ranges in a plane, with noise, dropouts by distance and incidence, and "
      "beam divergence; a scan is of one instant",
      40.0,
      {number_parameter("field_of_view_deg", "deg", 270.0, 0.0, 360.0,
                        "between the first and the last beam"),
       positive_parameter("angle_step_deg", "deg", 0.25, "between beams"),
       positive_parameter("min_range_m", "m", 0.06, "shortest distance it tells"),
       positive_parameter("max_range_m", "m", 10.0, "longest distance it tells"),
       number_parameter("accuracy_m", "m", 0.0, 0.0, 10.0,
                        "largest constant error; the device's own is drawn once, uniformly"),
       number_parameter("noise_std_m", "m", 0.01, 0.0, 10.0, "white noise of a range at 0 m"),
       number_parameter("noise_growth", "m/m", 0.0, 0.0, 1.0, "what that grows by with distance"),
       positive_parameter("dark_range_m", "m", 1000.0,
                          "where a surface of 10 % reflectance, met head on, is detected nine "
                          "times in ten; large: nothing is lost"),
       number_parameter("beam_dropout_share", "", 0.0, 0.0, 1.0,
                        "share of the beams that are lost whatever they meet"),
       reflectance("canopy_reflectance", 0.45, "leaves"),
       reflectance("ground_reflectance", 0.25, "soil and grass"),
       reflectance("stem_reflectance", 0.35, "posts and trunks"),
       reflectance("obstacle_reflectance", 0.4, "all else"),
       number_parameter("divergence_deg", "deg", 0.0, 0.0, 5.0, "full width of a beam"),
       integer_parameter("sub_rays", 1, 1, kMostSubRays,
                         "rays across a beam's width, an odd number"),
       choice_parameter("edge", "nearest", {"nearest", "mixed"},
                        "what a beam tells that meets two surfaces: the nearer one, or their mean "
                        "weighted by power"),
       positive_parameter("pulse_m", "m", 0.75,
                          "surfaces of a beam nearer to each other make one echo")});
}

std::unique_ptr<Sensor> make_lidar(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Lidar>(parameters, context);
}

}  // namespace vinerow
