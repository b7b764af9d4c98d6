#include "engine/sensors/camera/view_caster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"

namespace vinerow::sensors {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kFar_m = 1000.0;
constexpr double kShadow_m = 60.0;  // tall enough a plant for a sun of 2 degrees
constexpr double kLift_m = 1e-3;    // of shadow rays from their surface
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// Rays side by side cost half as much: they go in blocks of four by two pixels.
constexpr int kBlockColumns = 4, kBandRows = 2;

/// Places of samples about the middle, the first of which is the middle. The others fill the pixel
/// and its exposure evenly: additive recurrence of the golden ratio and its relatives (Roberts
/// 2018), moved so that their mean is the middle too.
std::vector<Vector3d> sample_offsets(int samples) {
  const auto fraction = [](int sample, double step) {
    const double value = 0.5 + sample * step;
    return value - std::floor(value) - 0.5;
  };
  std::vector<Vector3d> offsets;
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < samples; ++k) {
    offsets.emplace_back(fraction(k, 0.7548776662), fraction(k, 0.5698402910),
                         fraction(k, 0.6180339887));
    sum += offsets.back();
  }
  if (samples < 3) return offsets;
  for (int k = 1; k < samples; ++k) offsets[static_cast<std::size_t>(k)] -= sum / (samples - 1);
  return offsets;
}

Label label_at(const WorldModel& world, const RayHit& hit) {
  if (hit.mesh < 0) return label_of(hit.surface);
  const MeshInstance& instance = world.meshes[static_cast<std::size_t>(hit.mesh)];
  return instance.label.value_or(label_of(instance.surface));
}

/// Normal of the triangle as its corners are ordered, in W.
Vector3d outward_W(const MeshInstance& instance, int triangle) {
  const TriangleMesh& mesh = *instance.mesh;
  const auto& t = mesh.triangles[static_cast<std::size_t>(triangle)];
  const Vector3d a = mesh.vertices[t[0]].cast<double>();
  const Vector3d ab = mesh.vertices[t[1]].cast<double>() - a;
  const Vector3d ac = mesh.vertices[t[2]].cast<double>() - a;
  return instance.X_WM.q * ab.cross(ac);
}

}  // namespace

const Eigen::Matrix3d& R_SC() {
  static const Eigen::Matrix3d matrix =
      (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished();
  return matrix;
}

/// Neighbouring rows that are cast together.
struct ViewCaster::Band {
  int first_row, rows;
  int width;

  /// Calls use(row of the band, column) in the order of the rays.
  template <class F>
  void for_each(F&& use) const {
    for (int block = 0; block < width; block += kBlockColumns) {
      for (int row = 0; row < rows; ++row) {
        for (int x = block; x < std::min(block + kBlockColumns, width); ++x) use(row, x);
      }
    }
  }
  std::size_t pixel(int row, int x) const {
    return static_cast<std::size_t>(first_row + row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

ViewCaster::ViewCaster(const Lens& lens, const ViewSettings& settings, const WorldModel& world,
                       const RayScene& light, const SceneLook& look)
    : lens_(lens),
      settings_(settings),
      world_(world),
      light_(light),
      look_(look),
      numbers_(world.meshes),
      offsets_(sample_offsets(settings.samples)) {
  direction_C_.reserve(static_cast<std::size_t>(lens.width()) * lens.height());
  for (int y = 0; y < lens.height(); ++y) {
    for (int x = 0; x < lens.width(); ++x) {
      direction_C_.push_back(lens.direction(x, y).value_or(Vector3d::UnitZ()).cast<float>());
    }
  }
  const auto most = static_cast<std::size_t>(kBandRows * lens.width());
  rays_.reserve(most);
  hits_.reserve(most);
  vehicle_hits_.reserve(most);
  on_vehicle_.reserve(most);
  surfaces_.reserve(most);
  sun_rays_.reserve(most);
  sun_ray_.reserve(most);
  is_shaded_ = std::make_unique<bool[]>(most);
  is_shaded_by_vehicle_ = std::make_unique<bool[]>(most);
}

void ViewCaster::cast(const CameraMotion& motion, double exposure_s, View& view) {
  const std::size_t pixels = direction_C_.size();
  view.radiance.assign(pixels * static_cast<std::size_t>(settings_.channels), 0.0f);
  if (settings_.facts) {
    view.depth_m.assign(pixels, 0.0f);
    view.normal_C.assign(pixels, Vector3f::Zero());
    view.label.assign(pixels, Label::kSky);
    view.thing.assign(pixels, ThingNumbers::kNothing);
  }
  if (vehicles_) vehicles_->update();
  for (int y = 0; y < lens_.height(); y += kBandRows) {
    const Band band{y, std::min(kBandRows, lens_.height() - y), lens_.width()};
    for (int sample = 0; sample < settings_.samples; ++sample) {
      cast_band(motion, exposure_s, sample, band, view);
    }
  }
  const auto share = 1.0f / static_cast<float>(settings_.samples);
  for (float& value : view.radiance) value *= share;
}

void ViewCaster::cast_band(const CameraMotion& motion, double exposure_s, int sample,
                           const Band& band, View& view) {
  add_rays(motion, exposure_s, sample, band);
  hits_.resize(rays_.size());
  light_.cast_rays(rays_, hits_);
  look_at_vehicles();
  if (sample == 0 && settings_.facts)
    write_facts(band, motion.X_WS.q.toRotationMatrix() * R_SC(), view);
  if (settings_.channels > 0) add_light(band, view);
}

void ViewCaster::add_rays(const CameraMotion& motion, double exposure_s, int sample,
                          const Band& band) {
  const Vector3d& offset = offsets_[static_cast<std::size_t>(sample)];
  const auto right = static_cast<float>(offset.x()), down = static_cast<float>(offset.y());
  const double later_s = offset.z() * exposure_s;
  const Eigen::Matrix3d R_WC = motion.X_WS.q.toRotationMatrix() * R_SC();
  Eigen::Matrix3d row_R_WC[kBandRows];
  Vector3d row_p_W[kBandRows];
  for (int row = 0; row < band.rows; ++row) {
    const double share =
        lens_.height() > 1 ? (band.first_row + row) / (lens_.height() - 1.0) - 0.5 : 0.0;
    const double time_s = share * settings_.readout_s + later_s;
    row_p_W[row] = motion.X_WS.p + time_s * motion.v_W;
    row_R_WC[row] = R_WC;
    const Vector3d turn_S = time_s * motion.w_WS_S;
    const double angle = turn_S.norm();
    if (angle > 0.0) {
      row_R_WC[row] = motion.X_WS.q.toRotationMatrix() *
                      Eigen::AngleAxisd(angle, turn_S / angle).toRotationMatrix() * R_SC();
    }
  }
  rays_.clear();
  const int last_x = lens_.width() - 1, last_y = lens_.height() - 1;
  band.for_each([&](int row, int x) {
    const std::size_t pixel = band.pixel(row, x);
    Vector3f dir_C = direction_C_[pixel];
    if (sample > 0) {
      // Towards the neighbours: the lens is smooth over a pixel.
      const std::size_t width = static_cast<std::size_t>(lens_.width());
      const Vector3f along = x < last_x ? Vector3f(direction_C_[pixel + 1] - dir_C)
                                        : Vector3f(dir_C - direction_C_[pixel - 1]);
      const Vector3f across = band.first_row + row < last_y
                                  ? Vector3f(direction_C_[pixel + width] - dir_C)
                                  : Vector3f(dir_C - direction_C_[pixel - width]);
      dir_C += right * along + down * across;
    }
    rays_.push_back({row_p_W[row], (row_R_WC[row] * dir_C.cast<double>()).normalized(), kFar_m});
  });
}

/// Replaces hits by nearer ones on vehicles.
void ViewCaster::look_at_vehicles() {
  on_vehicle_.assign(rays_.size(), false);
  if (!vehicles_) return;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (hits_[i]) rays_[i].max_distance_m = hits_[i]->distance_m;
  }
  vehicle_hits_.resize(rays_.size());
  vehicles_->cast_rays(rays_, vehicle_hits_);
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (!vehicle_hits_[i]) continue;
    hits_[i] = vehicle_hits_[i];
    on_vehicle_[i] = true;
  }
}

void ViewCaster::write_facts(const Band& band, const Eigen::Matrix3d& R_WC, View& view) const {
  std::size_t i = 0;
  band.for_each([&](int row, int x) {
    const std::size_t pixel = band.pixel(row, x), ray = i++;
    if (!hits_[ray]) {
      if (rays_[ray].dir_W.z() < 0.0) view.label[pixel] = Label::kGround;
      return;
    }
    const RayHit& hit = *hits_[ray];
    // Distance along the axis of the row's own camera: the pixel's direction has it.
    view.depth_m[pixel] = static_cast<float>(hit.distance_m * direction_C_[pixel].z());
    view.normal_C[pixel] = (R_WC.transpose() * hit.normal_W).cast<float>();
    if (on_vehicle_[ray]) {
      view.label[pixel] = Label::kVehicle;
      view.thing[pixel] = numbers_.of_vehicle(vehicles_->vehicle_of(hit.mesh));
      return;
    }
    view.thing[pixel] = numbers_.of(hit);
    view.label[pixel] = label_at(world_, hit);
  });
}

SeenSurface ViewCaster::surface_of(std::size_t ray) const {
  const RayHit& hit = *hits_[ray];
  const double cosine = std::max(0.05, std::abs(hit.normal_W.dot(rays_[ray].dir_W)));
  const double footprint_m = hit.distance_m / (lens_.info().fx_px * cosine);
  return look_.surface(
      rays_[ray], hit,
      on_vehicle_[ray] ? vehicles_->links() : std::span<const MeshInstance>(world_.meshes),
      footprint_m);
}

void ViewCaster::add_light(const Band& band, View& view) {
  // Rays to the sun from all surfaces that it could light.
  const Vector3d& sun_W = look_.sun_direction_W();
  surfaces_.resize(rays_.size());
  sun_rays_.clear();
  sun_ray_.assign(rays_.size(), kNone);
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (!hits_[i]) continue;
    surfaces_[i] = surface_of(i);
    const double facing = surfaces_[i].normal_W.cast<double>().dot(sun_W);
    if (!settings_.shadows || (facing <= 0.0 && surfaces_[i].passed.isZero())) continue;
    const Vector3d p_W = rays_[i].p_W + hits_[i]->distance_m * rays_[i].dir_W;
    const double side = hits_[i]->normal_W.dot(sun_W) < 0.0 ? -kLift_m : kLift_m;
    sun_ray_[i] = sun_rays_.size();
    sun_rays_.push_back({p_W + side * hits_[i]->normal_W, sun_W, kShadow_m});
  }
  constexpr SurfaceMask kCasters = kAllSurfaces & ~mask_of(SurfaceClass::kTerrain);
  light_.find_blocked(sun_rays_, {is_shaded_.get(), sun_rays_.size()}, kCasters);
  if (vehicles_) {
    vehicles_->find_blocked(sun_rays_, {is_shaded_by_vehicle_.get(), sun_rays_.size()});
  }
  std::size_t i = 0;
  band.for_each([&](int row, int x) {
    const std::size_t ray = i++;
    Vector3f radiance;
    if (hits_[ray]) {
      const std::size_t to_sun = sun_ray_[ray];
      const bool is_shaded =
          to_sun != kNone && (is_shaded_[to_sun] || (vehicles_ && is_shaded_by_vehicle_[to_sun]));
      radiance = look_.radiance(surfaces_[ray], is_shaded ? 0.0f : 1.0f);
    } else {
      radiance = look_.far_radiance(rays_[ray].dir_W);
    }
    float* values =
        &view.radiance[band.pixel(row, x) * static_cast<std::size_t>(settings_.channels)];
    for (int c = 0; c < settings_.channels; ++c) values[c] += radiance[c];
  });
}

std::string ViewCaster::blindness(const Pose& X_WS) {
  const Vector3d& p_W = X_WS.p;
  const Vector3d forward_W = X_WS.q * Vector3d::UnitX();
  const auto above =
      light_.cast_ray(p_W, Vector3d::UnitZ(), kFar_m, mask_of(SurfaceClass::kTerrain));
  if (above && above->mesh < 0) return "is below the ground";
  // The inside of a closed body shows the backs of its triangles.
  constexpr SurfaceMask kClosed =
      kAllSurfaces & ~mask_of(SurfaceClass::kTerrain) & ~mask_of(SurfaceClass::kCanopy);
  const auto inside = [&](const std::optional<RayHit>& hit, std::span<const MeshInstance> meshes) {
    if (!hit || hit->mesh < 0) return std::string();
    const MeshInstance& instance = meshes[static_cast<std::size_t>(hit->mesh)];
    const bool is_back = outward_W(instance, hit->triangle).dot(forward_W) > 0.0;
    return is_back ? "is inside of " + instance.name : std::string();
  };
  std::string reason = inside(light_.cast_ray(p_W, forward_W, kFar_m, kClosed), world_.meshes);
  if (!reason.empty() || !vehicles_) return reason;
  vehicles_->update();
  return inside(vehicles_->cast_ray(p_W, forward_W, kFar_m), vehicles_->links());
}

}  // namespace vinerow::sensors
