#include "engine/sensors/lidar.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/api/messages/sensors.h"
#include "engine/core/constants.h"
#include "engine/math/angles.h"
#include "engine/sensors/mounted_sensor.h"

namespace vinerow::sensors {
namespace {

constexpr int kMaxBeams = 20'000;
constexpr int kMaxSubRays = 15;

/// Defaults: the geometry of a Hokuyo UST-10LX with ideal readings. assets/sensors has real
/// scanners.
struct LidarParams {
  double field_of_view_deg = 270.0;
  double angle_step_deg = 0.25;
  double min_range_m = 0.06;
  double max_range_m = 10.0;
  double accuracy_m = 0.0;
  double noise_std_m = 0.01;
  double noise_growth = 0.0;
  double dark_range_m = 1000.0;
  double beam_dropout_share = 0.0;
  double canopy_reflectance = 0.45;
  double ground_reflectance = 0.25;
  double stem_reflectance = 0.35;
  double obstacle_reflectance = 0.4;
  double divergence_rad = 0.0;
  int sub_rays = 1;
  bool is_mixed = false;
  double pulse_m = 0.75;

  double count_beams() const { return std::floor(field_of_view_deg / angle_step_deg + 1e-6) + 1.0; }
};

std::string find_fault_in_beams(const LidarParams& p) {
  if (p.count_beams() <= kMaxBeams) return "";
  return fmt::format(
      "angle_step_deg = {} deg makes {:.0f} beams of field_of_view_deg = {} deg, must be at most "
      "{}",
      p.angle_step_deg, p.count_beams(), p.field_of_view_deg, kMaxBeams);
}

std::string find_fault_in_sub_rays(const LidarParams& p) {
  if (p.sub_rays % 2 != 0) return "";
  return fmt::format("sub_rays = {}, must be odd: one ray is in the middle", p.sub_rays);
}

std::string find_fault_in_laser_range(const LidarParams& p) {
  if (p.min_range_m < p.max_range_m) return "";
  return fmt::format("min_range_m = {} m, must be < max_range_m = {} m", p.min_range_m,
                     p.max_range_m);
}

const ParameterTable<LidarParams>& lidar_table() {
  using P = LidarParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("field_of_view_deg", "deg", &P::field_of_view_deg, between(0.0, 360.0),
                  "angle between the first and the last beam")
          .number("angle_step_deg", "deg", &P::angle_step_deg, kPositive,
                  "angle between neighbouring beams")
          .number("min_range_m", "m", &P::min_range_m, above(0.0, 1e4),
                  "shortest distance it reports")
          .number("max_range_m", "m", &P::max_range_m, above(0.0, 1e4),
                  "longest distance it reports")
          .number("accuracy_m", "m", &P::accuracy_m, between(0.0, 10.0),
                  "largest constant error; the device's own is drawn once, uniformly")
          .number("noise_std_m", "m", &P::noise_std_m, between(0.0, 10.0),
                  "white noise of a range at 0 m")
          .number("noise_growth", "m/m", &P::noise_growth, between(0.0, 1.0),
                  "growth of that noise with distance")
          .number("dark_range_m", "m", &P::dark_range_m, kPositive,
                  "distance at which a surface of 10 % reflectance at normal incidence is detected "
                  "nine times in ten; large: nothing is lost")
          .number("beam_dropout_share", "", &P::beam_dropout_share, between(0.0, 1.0),
                  "share of the beams that are lost at random")
          .number("canopy_reflectance", "", &P::canopy_reflectance, between(0.0, 1.0),
                  "near-infrared reflectance of leaves")
          .number("ground_reflectance", "", &P::ground_reflectance, between(0.0, 1.0),
                  "near-infrared reflectance of soil and grass")
          .number("stem_reflectance", "", &P::stem_reflectance, between(0.0, 1.0),
                  "near-infrared reflectance of posts and trunks")
          .number("obstacle_reflectance", "", &P::obstacle_reflectance, between(0.0, 1.0),
                  "near-infrared reflectance of everything else")
          .degrees("divergence_deg", &P::divergence_rad, between(0.0, 5.0), "full width of a beam")
          .integer("sub_rays", &P::sub_rays, between(1, kMaxSubRays),
                   "rays across a beam's width, an odd number")
          .choice("edge", &P::is_mixed, {{"nearest", false}, {"mixed", true}},
                  "reading of a beam that meets two surfaces: the nearer one, or their mean "
                  "weighted by power")
          .number("pulse_m", "m", &P::pulse_m, kPositive,
                  "surfaces of a beam closer together than this make one echo")
          .rule(find_fault_in_beams)
          .rule(find_fault_in_sub_rays)
          .rule(find_fault_in_laser_range);
  return table;
}

class Lidar final : public MountedSensor<LaserScan> {
 public:
  Lidar(const ParameterSet& parameters, const SensorContext& context)
      : Lidar(lidar_table().read(parameters, ""), parameters, context) {}
  Lidar(const LidarParams& params, const ParameterSet& parameters, const SensorContext& context)
      : MountedSensor(parameters, context),
        scene_(context.scene),
        random_(context.random()),
        beams_(static_cast<int>(params.count_beams())),
        sub_rays_(params.sub_rays),
        is_mixed_(params.is_mixed),
        pulse_m_(params.pulse_m),
        dark_range_m_(params.dark_range_m),
        noise_std_m_(params.noise_std_m),
        noise_growth_(params.noise_growth),
        dropout_share_(params.beam_dropout_share),
        reflectance_{} {
    set_reflectances(params);
    offset_m_ = context.random("offset").uniform(-params.accuracy_m, params.accuracy_m);
    scan_.min_range_m = params.min_range_m;
    scan_.max_range_m = params.max_range_m;
    scan_.angle_step_rad = rad_from_deg(params.angle_step_deg);
    scan_.first_angle_rad = -0.5 * scan_.angle_step_rad * (beams_ - 1);
    scan_.ranges_m.assign(beams_, kInfinity);
    true_scan_ = scan_;
    readings_.prefill(scan_);
    for (int beam = 0; beam < beams_; ++beam) {
      for (int sub = 0; sub < sub_rays_; ++sub) {
        const double aside =
            sub_rays_ == 1 ? 0.0 : static_cast<double>(sub) / (sub_rays_ - 1) - 0.5;
        const double angle_rad =
            scan_.first_angle_rad + beam * scan_.angle_step_rad + aside * params.divergence_rad;
        directions_S_.emplace_back(std::cos(angle_rad), std::sin(angle_rad), 0.0);
      }
    }
  }

  void step(Time now) override {
    scan_.X_WS = true_scan_.X_WS = X_WS();
    const bool is_silent = readings_.is_in_outage(now);
    for (int beam = 0; beam < beams_; ++beam) {
      // Always draw the same count for a beam, so that later readings do not depend on what it
      // detects.
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

  void set_reflectances(const LidarParams& params) {
    reflectance_.fill(params.obstacle_reflectance);
    const auto of = [&](SurfaceClass surface) -> double& {
      return reflectance_[static_cast<std::size_t>(surface)];
    };
    of(SurfaceClass::kCanopy) = params.canopy_reflectance;
    of(SurfaceClass::kTerrain) = params.ground_reflectance;
    of(SurfaceClass::kPost) = params.stem_reflectance;
    of(SurfaceClass::kTrunk) = params.stem_reflectance;
  }

  static double detection_probability(double power) {
    const double fourth = power * power * power * power;
    return fourth / (fourth + 1.0 / 9.0);
  }

  /// Distance and power of a beam. @param truth_m  set to the distance along its middle
  Echo cast(int beam, double& truth_m) const {
    std::array<Echo, kMaxSubRays> hits;
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
  std::vector<Eigen::Vector3d> directions_S_;  ///< directions of all sub-rays, beam by beam
  LaserScan scan_;
  LaserScan true_scan_;
};

}  // namespace

PartSpec lidar_spec() {
  return mounted_sensor_spec<LaserScan>(
      "lidar",
      "2D laser scanner: ranges in a plane, with noise, dropouts by distance and incidence, and "
      "beam divergence; a scan is instantaneous",
      40.0, lidar_table().specs());
}

std::unique_ptr<Sensor> make_lidar(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Lidar>(parameters, context);
}

}  // namespace vinerow::sensors
