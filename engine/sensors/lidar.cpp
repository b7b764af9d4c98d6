#include "engine/sensors/lidar.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/api/messages/sensors.h"
#include "engine/core/constants.h"
#include "engine/math/angles.h"
#include "engine/sensors/laser_optics.h"
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
  LaserRanging ranging;
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

const ParameterTable<LidarParams>& lidar_table() {
  using P = LidarParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("field_of_view_deg", "deg", &P::field_of_view_deg, between(0.0, 360.0),
                  "angle between the first and the last beam")
          .number("angle_step_deg", "deg", &P::angle_step_deg, kPositive,
                  "angle between neighbouring beams")
          .include(&P::ranging, laser_ranging_table())
          .degrees("divergence_deg", &P::divergence_rad, between(0.0, 5.0),
                   "full width of a beam, which takes sub_rays > 1")
          .integer("sub_rays", &P::sub_rays, between(1, kMaxSubRays),
                   "rays across a beam's width, an odd number")
          .choice("edge", &P::is_mixed, {{"nearest", false}, {"mixed", true}},
                  "reading of a beam that meets two surfaces: the nearer one, or their mean "
                  "weighted by power")
          .number("pulse_m", "m", &P::pulse_m, kPositive,
                  "surfaces of a beam closer together than this make one echo")
          .rule(find_fault_in_beams)
          .rule(find_fault_in_sub_rays);
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
        optics_(params.ranging, draw_offset_m(params.ranging, context)),
        dropout_share_(params.ranging.beam_dropout_share) {
    scan_.min_range_m = params.ranging.min_range_m;
    scan_.max_range_m = params.ranging.max_range_m;
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
    rays_.resize(directions_S_.size());
    hits_.resize(directions_S_.size());
  }

  void step(Time now) override {
    scan_.X_WS = true_scan_.X_WS = X_WS();
    cast_rays();
    const bool is_silent = readings_.is_in_outage(now);
    for (int beam = 0; beam < beams_; ++beam) {
      // Always draw the same count for a beam, so that later readings do not depend on what it
      // detects.
      const double noise = random_.normal(), luck = random_.uniform();
      double& truth_m = true_scan_.ranges_m[beam];
      const Echo echo = echo_of(beam, truth_m);
      double reading_m = kInfinity;
      if (luck < (1.0 - dropout_share_) * LaserOptics::detection_probability(echo.power) &&
          !is_silent) {
        reading_m = optics_.reading_m(echo.distance_m, noise);
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

  void cast_rays() {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      rays_[i] = {scan_.X_WS.p, scan_.X_WS.q * directions_S_[i], scan_.max_range_m};
    }
    scene_->cast_rays(rays_, hits_);
  }

  /// Distance and power of a beam. @param truth_m  set to the distance along its middle
  Echo echo_of(int beam, double& truth_m) const {
    std::array<Echo, kMaxSubRays> echoes;
    Echo first;
    for (int sub = 0; sub < sub_rays_; ++sub) {
      const auto ray = static_cast<std::size_t>(beam * sub_rays_ + sub);
      const std::optional<RayHit>& hit = hits_[ray];
      Echo& echo = echoes[sub];
      if (hit) {
        echo = {hit->distance_m, optics_.power(*hit, rays_[ray].dir_W) / sub_rays_};
      }
      if (2 * sub + 1 == sub_rays_) truth_m = echo.distance_m;
      first.distance_m = std::min(first.distance_m, echo.distance_m);
    }
    double weighted_m = 0.0;
    for (int sub = 0; sub < sub_rays_; ++sub) {
      if (!(echoes[sub].distance_m <= first.distance_m + pulse_m_)) continue;
      if (!std::isfinite(echoes[sub].distance_m)) continue;
      first.power += echoes[sub].power;
      weighted_m += echoes[sub].power * echoes[sub].distance_m;
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
  LaserOptics optics_;
  double dropout_share_;
  // Of all sub-rays, beam by beam.
  std::vector<Eigen::Vector3d> directions_S_;
  std::vector<SceneRay> rays_;
  std::vector<std::optional<RayHit>> hits_;
  LaserScan scan_;
  LaserScan true_scan_;
};

}  // namespace

PartSpec lidar_spec() {
  return mounted_sensor_spec<LaserScan>(
      "lidar",
      "2D laser scanner: ranges in a plane, with noise, dropouts by distance and incidence, and "
      "beam divergence; a scan is instantaneous",
      40.0, lidar_table());
}

std::unique_ptr<Sensor> make_lidar(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Lidar>(parameters, context);
}

}  // namespace vinerow::sensors
