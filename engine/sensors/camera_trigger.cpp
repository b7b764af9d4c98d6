#include "engine/sensors/camera_trigger.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/api/messages/sensors.h"
#include "engine/api/plan_stretch.h"
#include "engine/api/survey_camera.h"
#include "engine/math/angles.h"
#include "engine/sensors/camera_gimbal.h"
#include "engine/sensors/mounted_sensor.h"

namespace vinerow::sensors {
namespace {

/// Length of the rays. Chosen: longer distances do not occur in a survey.
constexpr double kFarthest_m = 10'000.0;
constexpr SurfaceMask kGround = mask_of(SurfaceClass::kTerrain);

struct CameraTriggerParams {
  SurveyCameraParams camera;
  std::optional<double> interval_s;  ///< default: the camera's minimum
  std::optional<double> distance_m;  ///< instead of interval_s
  bool is_on_lanes = true;
  bool has_gimbal = false;
  // Chosen: travel of small servo gimbals. The lag is a little above that of small digital servos
  // (0.04 s), because the gimbal must first measure the attitude. Direct drives are much faster.
  double gimbal_limit_rad = rad_from_deg(30.0);
  double gimbal_lag_s = 0.05;
};

std::string find_fault_in_trigger(const CameraTriggerParams& p) {
  if (p.distance_m && p.interval_s) {
    return fmt::format(
        "interval_s = {} s and distance_m = {} m are both given, must be one of them",
        *p.interval_s, *p.distance_m);
  }
  const SurveyCamera camera = p.camera.resolve();
  const double shortest_s = 1.0 / camera.max_rate_Hz;
  if (!p.interval_s || *p.interval_s >= shortest_s - 1e-9) return "";
  return fmt::format(
      "interval_s = {} s, must be at least {:.4g} s: camera '{}' takes at most {} picture{} per "
      "second",
      *p.interval_s, shortest_s, camera.name, camera.max_rate_Hz,
      camera.max_rate_Hz == 1.0 ? "" : "s");
}

const ParameterTable<CameraTriggerParams>& camera_trigger_table() {
  using P = CameraTriggerParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .include(&P::camera, survey_camera_table())
          .number("interval_s", "s", &P::interval_s, kPositive,
                  "time between pictures; default: the camera's minimum")
          .number("distance_m", "m", &P::distance_m, kPositive,
                  "distance over ground between pictures, instead of interval_s")
          .choice("on", &P::is_on_lanes, {{"lanes", true}, {"always", false}},
                  "take pictures only on the plan's legs, or always")
          .choice("mount", &P::has_gimbal, {{"fixed", false}, {"gimbal", true}},
                  "gimbal: a stabilised mount compensates the vehicle's roll and pitch")
          .degrees("gimbal_limit_deg", &P::gimbal_limit_rad, between(0.0, 90.0),
                   "largest roll and pitch that the gimbal compensates")
          .number("gimbal_lag_s", "s", &P::gimbal_lag_s, between(0.0, 10.0),
                  "time constant of the gimbal; 0: no lag")
          .rule(find_fault_in_trigger);
  return table;
}

/// Default mounting: straight down, upper edge of the picture ahead.
struct CameraMountingParams {
  MountingParams mounting{.rotation_rad = {0.0, rad_from_deg(90.0), 0.0}};
};

const ParameterTable<CameraMountingParams>& camera_mounting_table() {
  using P = CameraMountingParams;
  static const ParameterTable<P> table =
      ParameterTable<P>().include(&P::mounting, mounting_table());
  return table;
}

class CameraTrigger final : public MountedSensor<CameraShot> {
 public:
  CameraTrigger(const ParameterSet& parameters, const SensorContext& context)
      : CameraTrigger(camera_trigger_table().read(parameters, context.part), parameters, context) {}
  CameraTrigger(const CameraTriggerParams& params, const ParameterSet& parameters,
                const SensorContext& context)
      : MountedSensor(parameters, context),
        scene_(context.scene),
        camera_(params.camera.resolve()),
        on_lanes_(params.is_on_lanes),
        has_gimbal_(params.has_gimbal),
        gimbal_(params.gimbal_limit_rad, params.gimbal_lag_s),
        distance_m_(params.distance_m.value_or(0.0)) {
    const double shortest_s = 1.0 / camera_.max_rate_Hz;
    fastest_ = duration_from_s(shortest_s);
    interval_ = duration_from_s(std::max(params.interval_s.value_or(shortest_s), shortest_s));
    const double across = std::tan(camera_.half_angle_across_rad());
    const double along = std::tan(camera_.half_angle_along_rad());
    corners_S_ = {Eigen::Vector3d(1, across, along), Eigen::Vector3d(1, -across, along),
                  Eigen::Vector3d(1, -across, -along), Eigen::Vector3d(1, across, -along)};
    for (Eigen::Vector3d& corner : corners_S_) corner.normalize();
  }

  void connect(Ports& ports) override {
    if (on_lanes_) {
      // Makes the bus check that a planner writes the plan: without lanes there would never be a
      // picture.
      static_cast<void>(ports.read<PlannedPath>("plan"));
      plan_.connect(ports);
    }
    estimate_ = ports.read_optional<Odometry>("estimate");
    MountedSensor::connect(ports);
  }

  void step(Time now) override {
    const Odometry& truth = body();
    // A gimbal also moves between the pictures.
    const Eigen::Quaterniond q_W =
        has_gimbal_ ? gimbal_.advance((now - last_).s(), truth.X_WB.q) : truth.X_WB.q;
    last_ = now;
    // The trigger uses the vehicle's estimate; without an estimator it uses the truth.
    const Odometry& known = estimate_.has_value() ? estimate_.value() : truth;
    if (!is_due(now, known) || readings_.is_in_outage(now)) {
      readings_.push_nothing();
      return;
    }
    waits_for_lane_ = false;
    shot_.index += 1;
    look({q_W * X_BS_.q, X_WS().p});
    shot_at_ = now;
    shot_from_W_ = known.X_WB.p.head<2>();
    readings_.push(now, shot_, shot_);
  }

 private:
  bool is_due(Time now, const Odometry& known) {
    bool begins = shot_.index < 0;
    if (on_lanes_) {
      plan_.take_over();
      const int lane = plan_.lane(known.X_WB.p, known.X_WB.q * known.v_WB_B);
      begins = lane != lane_;
      lane_ = lane;
      waits_for_lane_ = begins || waits_for_lane_;
      if (lane < 0) return false;
      begins = waits_for_lane_;
    }
    if (shot_.index >= 0) {
      const Duration since = now - shot_at_;
      if (since.ns < (begins ? fastest_ : interval_).ns) return false;
      const double distance_flown_m = (known.X_WB.p.head<2>() - shot_from_W_).norm();
      if (!begins && distance_flown_m < distance_m_) return false;
    }
    return true;
  }

  void look(const Pose& X_WS) {
    shot_.X_WS = X_WS;
    const auto axis =
        scene_->cast_ray(X_WS.p, X_WS.q * Eigen::Vector3d::UnitX(), kFarthest_m, kGround);
    shot_.distance_m = axis ? axis->distance_m : 0.0;
    shot_.gsd_m = camera_.gsd_m(shot_.distance_m);
    shot_.on_ground = axis.has_value();
    for (std::size_t i = 0; i < corners_S_.size(); ++i) {
      const Eigen::Vector3d dir_W = X_WS.q * corners_S_[i];
      const auto hit = scene_->cast_ray(X_WS.p, dir_W, kFarthest_m, kGround);
      shot_.on_ground = shot_.on_ground && hit.has_value();
      shot_.corners_W[i] = hit ? Eigen::Vector3d(X_WS.p + hit->distance_m * dir_W)
                               : Eigen::Vector3d(Eigen::Vector3d::Zero());
    }
  }

  const SceneQuery* scene_;
  SurveyCamera camera_;
  bool on_lanes_;
  bool has_gimbal_;
  CameraGimbal gimbal_;
  Time last_;  ///< last tick
  Duration fastest_;
  Duration interval_;
  double distance_m_;  ///< 0: triggered by time
  std::array<Eigen::Vector3d, 4> corners_S_;
  CameraShot shot_;  ///< last picture
  Time shot_at_;
  Eigen::Vector2d shot_from_W_ = Eigen::Vector2d::Zero();  ///< by the estimate, at the last picture
  int lane_ = -1;
  bool waits_for_lane_ = false;  ///< a lane has started and has no picture yet
  PlanStretch plan_;
  SignalReader<Odometry> estimate_;
};

}  // namespace

PartSpec camera_trigger_spec() {
  PartSpec spec = mounted_sensor_spec<CameraShot>(
      "camera_trigger",
      "Survey camera: pictures by time or by distance, each with its pose and its footprint on the "
      "ground",
      20.0, camera_trigger_table(), camera_mounting_table());
  spec.reads.push_back("plan (if on: lanes)");
  spec.reads.push_back("estimate (if available: lane, and distance from the last picture)");
  spec.gives = ProductKind::kPictures;
  return spec;
}

std::unique_ptr<Sensor> make_camera_trigger(const ParameterSet& parameters,
                                            const SensorContext& context) {
  return std::make_unique<CameraTrigger>(parameters, context);
}

}  // namespace vinerow::sensors
