#include "vehicles/payloads/canopy_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/commands.h"
#include "engine/api/plan_stretch.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "vehicles/payloads/canopy_patches.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

constexpr double kMmPerM = 1000.0;
constexpr SurfaceMask kOpaque = kAllSurfaces & ~mask_of(SurfaceClass::kWire);

struct ViewRay {
  Vector3d dir_S;  ///< unit; x of S is the optical axis, y to the picture's left, z up in it
  double cos_off_axis;
};

class CanopyCamera final : public Payload {
 public:
  CanopyCamera(const ParameterSet& parameters, const PayloadContext& context)
      : name_(context.name),
        scene_(*context.scene),
        on_legs_only_(parameters.text("on") == "legs"),
        stabilised_(parameters.boolean("stabilised")),
        range_m_(parameters.number("range_m")),
        least_cos_(std::cos(rad_from_deg(parameters.number("max_incidence_deg")))),
        wanted_gsd_m_(parameters.number("wanted_gsd_mm") / kMmPerM),
        patches_(*context.world, parameters.number("patch_step_m"),
                 parameters.number("patch_band_m")),
        coverage_(patches_.empty_coverage()),
        best_gsd_m_(coverage_.patches.size(), std::numeric_limits<double>::infinity()),
        last_picture_(coverage_.patches.size(), 0) {
    coverage_.quantity = "seen";
    coverage_.unit = "pictures";
    coverage_.wanted = static_cast<double>(parameters.integer("wanted_views"));
    const auto& p = parameters.numbers("position_m");
    p_BS_ = {p[0], p[1], p[2]};
    if (parameters.numbers("yaws_deg").empty()) {
      throw ConfigError(
          fmt::format("{}: yaws_deg = [], must name at least one camera", context.part));
    }
    for (const double yaw_deg : parameters.numbers("yaws_deg")) {
      cameras_.push_back(quaternion_from_rpy(
          {0.0, rad_from_deg(parameters.number("pitch_deg")), rad_from_deg(yaw_deg)}));
    }
    make_rays(parameters);
    told_.names = {"pictures", "patches_in_picture", "gsd_mm", "seen_share"};
    told_.values.assign(told_.names.size(), 0.0);
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    if (on_legs_only_) {
      estimate_ = ports.read<Odometry>("estimate");
      static_cast<void>(ports.read<PlannedPath>("plan"));
      plan_.connect(ports);
    }
    writer_ = ports.write<NamedValues>(name_);
  }

  void step(Time now) override {
    if (!truth_.has_value() || !is_due()) return;
    const Pose& X_WB = truth_.value().X_WB;
    Eigen::Quaterniond q_W = X_WB.q;
    if (stabilised_) q_W = quaternion_from_rpy({0.0, 0.0, yaw_from_quaternion(X_WB.q)});
    shown_ = 0;
    shown_gsd_m_ = 0.0;
    shown_rays_ = 0;
    for (const Eigen::Quaterniond& camera : cameras_) take_picture({q_W * camera, X_WB * p_BS_});
    told_.values = {static_cast<double>(pictures_), static_cast<double>(shown_),
                    shown_rays_ > 0 ? kMmPerM * shown_gsd_m_ / shown_rays_ : 0.0,
                    patches_.area_m2() > 0.0 ? seen_m2_ / patches_.area_m2() : 0.0};
    writer_.write(now, told_);
  }

  std::map<std::string, double> results() const override {
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    double twice_m2 = 0.0, gsd = 0.0;
    for (std::size_t i = 0; i < coverage_.patches.size(); ++i) {
      const CanopyPatch& patch = coverage_.patches[i];
      if (patch.amount >= 2.0) twice_m2 += patch.area_m2;
      if (patch.amount >= 1.0) gsd += patch.area_m2 * best_gsd_m_[i];
    }
    const double all_m2 = patches_.area_m2();
    return {{"pictures", static_cast<double>(pictures_)},
            {"canopy_pictures", static_cast<double>(canopy_pictures_)},
            {"seen_share", all_m2 > 0.0 ? seen_m2_ / all_m2 : nothing},
            {"seen_twice_share", all_m2 > 0.0 ? twice_m2 / all_m2 : nothing},
            {"gsd_mean_mm", seen_m2_ > 0.0 ? kMmPerM * gsd / seen_m2_ : nothing}};
  }

  const CanopyCoverage* coverage() const override { return &coverage_; }

 private:
  void make_rays(const ParameterSet& parameters) {
    const double half_width = std::tan(0.5 * rad_from_deg(parameters.number("fov_horizontal_deg")));
    const double half_height = std::tan(0.5 * rad_from_deg(parameters.number("fov_vertical_deg")));
    pixel_ = 2.0 * std::sqrt(half_width / static_cast<double>(parameters.integer("image_columns")) *
                             half_height / static_cast<double>(parameters.integer("image_rows")));
    const auto columns = parameters.integer("ray_columns"), rows = parameters.integer("ray_rows");
    for (std::int64_t row = 0; row < rows; ++row) {
      for (std::int64_t column = 0; column < columns; ++column) {
        const double left =
            1.0 - (2.0 * static_cast<double>(column) + 1.0) / static_cast<double>(columns);
        const double up = 1.0 - (2.0 * static_cast<double>(row) + 1.0) / static_cast<double>(rows);
        const Vector3d dir_S = Vector3d(1.0, left * half_width, up * half_height).normalized();
        rays_.push_back({dir_S, dir_S.x()});
      }
    }
  }

  bool is_due() {
    if (!on_legs_only_) return true;
    plan_.take_over();
    return plan_.has_plan() && estimate_.has_value() &&
           plan_.is_leg(plan_.find(estimate_.value().X_WB.p).segment);
  }

  void take_picture(const Pose& X_WS) {
    ++pictures_;
    const int shown_before = shown_;
    for (const ViewRay& ray : rays_) {
      const Vector3d dir_W = X_WS.q * ray.dir_S;
      const auto hit = scene_.cast_ray(X_WS.p, dir_W, range_m_, kOpaque);
      if (!hit || hit->surface != SurfaceClass::kCanopy) continue;
      const double cos_incidence = -hit->normal_W.dot(dir_W);
      if (!(cos_incidence >= least_cos_) || cos_incidence <= 0.0) continue;
      const double depth_m = hit->distance_m * ray.cos_off_axis;
      const double gsd_m = depth_m * pixel_ * std::sqrt(ray.cos_off_axis / cos_incidence);
      if (gsd_m > wanted_gsd_m_) continue;
      see(patches_.find(X_WS.p + hit->distance_m * dir_W), gsd_m);
    }
    canopy_pictures_ += shown_ > shown_before;
  }

  void see(int index, double gsd_m) {
    if (index < 0) return;
    shown_gsd_m_ += gsd_m;
    ++shown_rays_;
    const auto i = static_cast<std::size_t>(index);
    best_gsd_m_[i] = std::min(best_gsd_m_[i], gsd_m);
    if (last_picture_[i] == pictures_) return;
    last_picture_[i] = pictures_;
    ++shown_;
    CanopyPatch& patch = coverage_.patches[i];
    if (patch.amount == 0.0) seen_m2_ += patch.area_m2;
    patch.amount += 1.0;
  }

  std::string name_;
  const SceneQuery& scene_;
  bool on_legs_only_;
  bool stabilised_;
  double range_m_;
  double least_cos_;
  double wanted_gsd_m_;
  Vector3d p_BS_;
  std::vector<Eigen::Quaterniond> cameras_;  // R_BS, of a stabilised one against B's heading
  std::vector<ViewRay> rays_;
  double pixel_ = 0.0;  // size of a pixel at depth 1
  CanopyPatches patches_;
  CanopyCoverage coverage_;
  std::vector<double> best_gsd_m_;          // of each patch
  std::vector<std::int64_t> last_picture_;  // that shows each patch
  SignalReader<Odometry> truth_, estimate_;
  PlanStretch plan_;
  SignalWriter<NamedValues> writer_;
  NamedValues told_;

  std::int64_t pictures_ = 0;
  std::int64_t canopy_pictures_ = 0;  // that show a patch
  double seen_m2_ = 0.0;
  int shown_ = 0;  // patches in the pictures of this tick
  int shown_rays_ = 0;
  double shown_gsd_m_ = 0.0;
};

}  // namespace

PartSpec canopy_camera_spec() {
  constexpr double kMostPixels = 100'000.0;
  PartSpec spec;
  spec.name = "canopy_camera";
  spec.description =
      "Scouting cameras that look at the rows: patches of the true canopy that their pictures show "
      "sharply enough";
  // Defaults: a 5 Mpx machine vision camera (Sony IMX264: 2448 x 2048 pixels of 3.45 um) behind a
  // lens of 6 mm: 2 atan(2448 * 3.45 um / 2 / 6 mm) by 2 atan(2048 * 3.45 um / 2 / 6 mm).
  spec.parameters = {
      number_list_parameter("position_m", "m", {0.0, 0.0, 0.0},
                            "place of the cameras in the body frame (x forward, y left, z up)", 3),
      number_list_parameter("yaws_deg", "deg", {90.0, -90.0},
                            "heading of each camera against the vehicle's, positive to the left"),
      number_parameter("pitch_deg", "deg", 0.0, -90.0, 90.0,
                       "of the optical axes, positive looks down"),
      boolean_parameter("stabilised", true,
                        "a gimbal takes the vehicle's roll and pitch out of the pictures"),
      number_parameter("fov_horizontal_deg", "deg", 70.3, 1.0, 170.0, "angle of view across"),
      number_parameter("fov_vertical_deg", "deg", 61.0, 1.0, 170.0, "angle of view in height"),
      integer_parameter("image_columns", 2448, 1.0, kMostPixels, "pixels of a picture across"),
      integer_parameter("image_rows", 2048, 1.0, kMostPixels, "pixels of a picture in height"),
      number_parameter("range_m", "m", 5.0, 0.1, 200.0, "farther canopy does not count"),
      number_parameter("max_incidence_deg", "deg", 65.0, 0.0, 89.0,
                       "largest angle between a ray and the surface's normal"),
      positive_parameter("wanted_gsd_mm", "mm", 2.0, "largest ground sampling distance"),
      integer_parameter("wanted_views", 1, 1.0, 1000.0,
                        "pictures that must show a patch for it to count as covered"),
      choice_parameter("on", "always", {"legs", "always"},
                       "where it takes pictures: on the plan's legs only, or all the time"),
      integer_parameter("ray_columns", 24, 1.0, 1000.0, "rays of a picture across"),
      integer_parameter("ray_rows", 20, 1.0, 1000.0, "rays of a picture in height"),
      number_parameter("patch_step_m", "m", 0.25, 0.02, 10.0, "size of a patch along the row"),
      number_parameter("patch_band_m", "m", 0.25, 0.02, 10.0, "size of a patch in height"),
  };
  spec.default_rate_Hz = 2.0;
  spec.reads = {"truth", "estimate and plan (where on: legs)"};
  spec.writes = {"<name>"};
  return spec;
}

std::unique_ptr<Payload> make_canopy_camera(const ParameterSet& parameters,
                                            const PayloadContext& context) {
  return std::make_unique<CanopyCamera>(parameters, context);
}

}  // namespace vinerow::vehicles
