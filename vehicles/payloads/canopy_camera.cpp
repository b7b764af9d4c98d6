#include "vehicles/payloads/canopy_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/commands.h"
#include "engine/api/parameter_table.h"
#include "engine/api/plan_stretch.h"
#include "engine/math/angles.h"
#include "vehicles/payloads/canopy_patches.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

constexpr double kMmPerM = 1000.0;
constexpr SurfaceMask kOpaque = kAllSurfaces & ~mask_of(SurfaceClass::kWire);

/// Defaults: a 5 Mpx machine vision camera (Sony IMX264: 2448 x 2048 pixels of 3.45 um) behind a
/// lens of 6 mm: 2 atan(2448 * 3.45 um / 2 / 6 mm) by 2 atan(2048 * 3.45 um / 2 / 6 mm).
struct CanopyCameraParams {
  Vector3d p_BS = {0.0, 0.0, 0.0};
  std::vector<double> yaws_rad = {rad_from_deg(90.0), rad_from_deg(-90.0)};  ///< of each camera
  double pitch_rad = 0.0;
  bool stabilised = true;
  double fov_horizontal_rad = rad_from_deg(70.3);
  double fov_vertical_rad = rad_from_deg(61.0);
  int image_columns = 2448;
  int image_rows = 2048;
  double range_m = 5.0;
  double max_incidence_rad = rad_from_deg(65.0);
  double wanted_gsd_m = 0.002;
  int wanted_views = 1;
  bool on_legs_only = false;
  int ray_columns = 24;
  int ray_rows = 20;
  double step_m = 0.25;  ///< of a patch along the row
  double band_m = 0.25;  ///< of a patch in height
};

constexpr ParameterConversion kMillimetres = {[](double value_mm) { return value_mm / kMmPerM; },
                                              [](double value_m) { return value_m * kMmPerM; }};

const ParameterTable<CanopyCameraParams>& canopy_camera_table() {
  using P = CanopyCameraParams;
  constexpr double kMaxPixels = 100'000.0;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .numbers("position_m", "m", &P::p_BS, between(-100.0, 100.0),
                   "position of the cameras in the body frame (x forward, y left, z up)")
          .numbers("yaws_deg", "deg", &P::yaws_rad, kAnyNumber,
                   "heading of each camera relative to the vehicle's, positive to the left", 0,
                   kDegrees)
          .degrees("pitch_deg", &P::pitch_rad, between(-90.0, 90.0),
                   "pitch of the optical axes; positive looks down")
          .boolean("stabilised", &P::stabilised,
                   "a gimbal takes the vehicle's roll and pitch out of the pictures")
          .degrees("fov_horizontal_deg", &P::fov_horizontal_rad, between(1.0, 170.0),
                   "angle of view across")
          .degrees("fov_vertical_deg", &P::fov_vertical_rad, between(1.0, 170.0),
                   "angle of view in height")
          .integer("image_columns", &P::image_columns, between(1.0, kMaxPixels),
                   "pixels of a picture across")
          .integer("image_rows", &P::image_rows, between(1.0, kMaxPixels),
                   "pixels of a picture in height")
          .number("range_m", "m", &P::range_m, between(0.1, 200.0),
                  "distance beyond which canopy does not count")
          .degrees("max_incidence_deg", &P::max_incidence_rad, between(0.0, 89.0),
                   "largest angle between a ray and the surface's normal")
          .number("wanted_gsd_mm", "mm", &P::wanted_gsd_m, kPositive,
                  "largest ground sampling distance", kMillimetres)
          .integer("wanted_views", &P::wanted_views, between(1.0, 1000.0),
                   "pictures that must show a patch for it to count as covered")
          .choice("on", &P::on_legs_only, {{"legs", true}, {"always", false}},
                  "takes pictures on the plan's legs only, or all the time")
          .integer("ray_columns", &P::ray_columns, between(1.0, 1000.0), "rays of a picture across")
          .integer("ray_rows", &P::ray_rows, between(1.0, 1000.0), "rays of a picture in height")
          .number("patch_step_m", "m", &P::step_m, between(0.02, 10.0),
                  "size of a patch along the row")
          .number("patch_band_m", "m", &P::band_m, between(0.02, 10.0), "size of a patch in height")
          .rule([](const P& p) -> std::string {
            return p.yaws_rad.empty() ? "yaws_deg = [], must name at least one camera" : "";
          });
  return table;
}

struct ViewRay {
  Vector3d dir_S;  ///< unit; x of S is the optical axis, y to the picture's left, z up in it
  double cos_off_axis;
};

class CanopyCamera final : public Payload {
 public:
  CanopyCamera(const CanopyCameraParams& params, const PayloadContext& context)
      : name_(context.name),
        scene_(*context.scene),
        on_legs_only_(params.on_legs_only),
        stabilised_(params.stabilised),
        range_m_(params.range_m),
        min_cos_(std::cos(params.max_incidence_rad)),
        wanted_gsd_m_(params.wanted_gsd_m),
        p_BS_(params.p_BS),
        patches_(make_canopy_patches(*context.world, params.step_m, params.band_m, context.shelf)),
        coverage_(patches_->empty_coverage()),
        best_gsd_m_(coverage_.patches.size(), std::numeric_limits<double>::infinity()),
        last_picture_(coverage_.patches.size(), 0) {
    coverage_.quantity = "seen";
    coverage_.unit = "pictures";
    coverage_.wanted = params.wanted_views;
    for (const double yaw_rad : params.yaws_rad) {
      cameras_.push_back(quaternion_from_rpy({0.0, params.pitch_rad, yaw_rad}));
    }
    make_rays(params);
    reported_.names = {"pictures", "patches_in_picture", "gsd_mm", "seen_share"};
    reported_.values.assign(reported_.names.size(), 0.0);
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
    reported_.values = {static_cast<double>(pictures_), static_cast<double>(shown_),
                        shown_rays_ > 0 ? kMmPerM * shown_gsd_m_ / shown_rays_ : 0.0,
                        patches_->area_m2() > 0.0 ? seen_m2_ / patches_->area_m2() : 0.0};
    writer_.write(now, reported_);
  }

  std::map<std::string, double> results() const override {
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    double twice_m2 = 0.0, gsd = 0.0;
    for (std::size_t i = 0; i < coverage_.patches.size(); ++i) {
      const CanopyPatch& patch = coverage_.patches[i];
      if (patch.amount >= 2.0) twice_m2 += patch.area_m2;
      if (patch.amount >= 1.0) gsd += patch.area_m2 * best_gsd_m_[i];
    }
    const double all_m2 = patches_->area_m2();
    return {{"pictures", static_cast<double>(pictures_)},
            {"canopy_pictures", static_cast<double>(canopy_pictures_)},
            {"seen_share", all_m2 > 0.0 ? seen_m2_ / all_m2 : nothing},
            {"seen_twice_share", all_m2 > 0.0 ? twice_m2 / all_m2 : nothing},
            {"gsd_mean_mm", seen_m2_ > 0.0 ? kMmPerM * gsd / seen_m2_ : nothing}};
  }

  const CanopyCoverage* coverage() const override { return &coverage_; }

 private:
  void make_rays(const CanopyCameraParams& params) {
    const double half_width = std::tan(0.5 * params.fov_horizontal_rad);
    const double half_height = std::tan(0.5 * params.fov_vertical_rad);
    pixel_ = 2.0 * std::sqrt(half_width / params.image_columns * half_height / params.image_rows);
    const int columns = params.ray_columns, rows = params.ray_rows;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const double left = 1.0 - (2.0 * column + 1.0) / columns;
        const double up = 1.0 - (2.0 * row + 1.0) / rows;
        const Vector3d dir_S = Vector3d(1.0, left * half_width, up * half_height).normalized();
        view_.push_back({dir_S, dir_S.x()});
      }
    }
    rays_.resize(view_.size());
    hits_.resize(view_.size());
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
    for (std::size_t i = 0; i < view_.size(); ++i) {
      rays_[i] = {X_WS.p, X_WS.q * view_[i].dir_S, range_m_};
    }
    scene_.cast_rays(rays_, hits_, kOpaque);
    for (std::size_t i = 0; i < view_.size(); ++i) {
      const std::optional<RayHit>& hit = hits_[i];
      if (!hit || hit->surface != SurfaceClass::kCanopy) continue;
      const Vector3d& dir_W = rays_[i].dir_W;
      const double cos_incidence = -hit->normal_W.dot(dir_W);
      if (!(cos_incidence >= min_cos_) || cos_incidence <= 0.0) continue;
      const double cos_off_axis = view_[i].cos_off_axis;
      const double depth_m = hit->distance_m * cos_off_axis;
      const double gsd_m = depth_m * pixel_ * std::sqrt(cos_off_axis / cos_incidence);
      if (gsd_m > wanted_gsd_m_) continue;
      see(patches_->find(X_WS.p + hit->distance_m * dir_W), gsd_m);
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
  double min_cos_;
  double wanted_gsd_m_;
  Vector3d p_BS_;
  std::vector<Eigen::Quaterniond> cameras_;  // R_BS, of a stabilised one against B's heading
  std::vector<ViewRay> view_;
  std::vector<SceneRay> rays_;  // of view_, and what they meet
  std::vector<std::optional<RayHit>> hits_;
  double pixel_ = 0.0;  // size of a pixel at depth 1
  std::shared_ptr<const CanopyPatches> patches_;
  CanopyCoverage coverage_;
  std::vector<double> best_gsd_m_;          // of each patch
  std::vector<std::int64_t> last_picture_;  // that shows each patch
  SignalReader<Odometry> truth_, estimate_;
  PlanStretch plan_;
  SignalWriter<NamedValues> writer_;
  NamedValues reported_;

  std::int64_t pictures_ = 0;
  std::int64_t canopy_pictures_ = 0;  // that show a patch
  double seen_m2_ = 0.0;
  int shown_ = 0;  // patches in the pictures of this tick
  int shown_rays_ = 0;
  double shown_gsd_m_ = 0.0;
};

std::vector<ResultSpec> canopy_camera_results() {
  using Range = ResultRange;
  return {{"pictures", "1", Range::count(), "pictures taken",
           "Number of pictures taken by the payload's cameras.", ""},
          {"canopy_pictures", "1", Range::count(), "pictures of canopy",
           "Number of pictures that show canopy at the required resolution and incidence.", ""},
          {"seen_share", "1", Range::share(), "canopy seen",
           "Fraction of the canopy surface that at least one picture shows at the required "
           "resolution and incidence.",
           ""},
          {"seen_twice_share", "1", Range::share(), "canopy seen twice",
           "Fraction of the canopy surface that at least two pictures show at the required "
           "resolution and incidence.",
           ""},
          {"gsd_mean_mm", "mm", Range::from_zero(), "mean resolution on canopy",
           "Mean, over the seen canopy surface, of its best ground sampling distance.", ""}};
}

}  // namespace

PartSpec canopy_camera_spec() {
  PartSpec spec;
  spec.name = "canopy_camera";
  spec.results = canopy_camera_results();
  spec.description =
      "Scouting cameras that look at the rows: patches of the true canopy that their pictures show "
      "sharply enough";
  canopy_camera_table().add_to(spec);
  spec.default_rate_Hz = 2.0;
  spec.reads = {"truth", "estimate and plan (if on: legs)"};
  spec.writes = {"<name>"};
  return spec;
}

std::unique_ptr<Payload> make_canopy_camera(const ParameterSet& parameters,
                                            const PayloadContext& context) {
  return std::make_unique<CanopyCamera>(canopy_camera_table().read(parameters, context.part),
                                        context);
}

}  // namespace vinerow::vehicles
