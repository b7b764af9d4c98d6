#include "engine/sensors/camera/view_caster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "engine/api/height_field.h"
#include "engine/api/world_model.h"
#include "engine/core/parallel.h"
#include "engine/sensors/blindness.h"

namespace vinerow::sensors {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kFar_m = 1000.0;
constexpr double kLift_m = 1e-3;  // of shadow rays from their surface
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// Rays side by side cost half as much: they go in blocks of four by two pixels. Those of a tile
// meet the same triangles, which stay in the cache.
constexpr int kBlockColumns = 4, kBlockRows = 2;
constexpr int kTileColumns = 32, kTileRows = 32;
constexpr std::size_t kTilesAtOnce = 2;  // by a thread, which takes a ms

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

}  // namespace

/// Pixels that are cast together.
struct ViewCaster::Tile {
  int first_row, rows;
  int first_column, columns;
  int width;  ///< of the picture

  /// Tile number `index`, row by row.
  static Tile of(const Lens& lens, std::size_t index) {
    const auto across = static_cast<std::size_t>(calc_tiles(lens.width(), kTileColumns));
    const int row = static_cast<int>(index / across) * kTileRows;
    const int column = static_cast<int>(index % across) * kTileColumns;
    return {row, std::min(kTileRows, lens.height() - row), column,
            std::min(kTileColumns, lens.width() - column), lens.width()};
  }
  static std::size_t count(const Lens& lens) {
    return static_cast<std::size_t>(calc_tiles(lens.width(), kTileColumns)) *
           static_cast<std::size_t>(calc_tiles(lens.height(), kTileRows));
  }

  /// Calls use(row of the tile, column of the picture) in the order of the rays.
  template <class F>
  void for_each(F&& use) const {
    const int end = first_column + columns;
    for (int block_row = 0; block_row < rows; block_row += kBlockRows) {
      for (int block = first_column; block < end; block += kBlockColumns) {
        for (int row = block_row; row < std::min(block_row + kBlockRows, rows); ++row) {
          for (int x = block; x < std::min(block + kBlockColumns, end); ++x) use(row, x);
        }
      }
    }
  }
  std::size_t pixel(int row, int x) const {
    return static_cast<std::size_t>(first_row + row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }

 private:
  static int calc_tiles(int pixels, int of_tile) { return (pixels + of_tile - 1) / of_tile; }
};

/// The rays of a tile, and what they meet.
struct ViewCaster::TileRays {
  Eigen::Matrix3d row_R_WC[kTileRows];  ///< of the camera at each row's exposure
  Eigen::Matrix3d R_WC;                 ///< at the stamp
  std::vector<SceneRay> rays, sun_rays;
  std::vector<SceneRay>
      own_rays;  ///< the same from the pose at the stamp; empty: they are no others
  std::vector<std::optional<RayHit>> hits, vehicle_hits;
  std::vector<bool> on_vehicle;
  std::vector<SeenSurface> surfaces;
  std::vector<std::size_t> sun_ray;  ///< of each ray, or kNone
  // Of the rays to the sun: whether plants, or vehicles, are in their way.
  std::unique_ptr<bool[]> is_shaded, is_shaded_by_vehicle;

  TileRays() {
    constexpr std::size_t kMost = kTileColumns * kTileRows;
    rays.reserve(kMost);
    own_rays.reserve(kMost);
    hits.reserve(kMost);
    vehicle_hits.reserve(kMost);
    on_vehicle.reserve(kMost);
    surfaces.reserve(kMost);
    sun_rays.reserve(kMost);
    sun_ray.reserve(kMost);
    is_shaded = std::make_unique<bool[]>(kMost);
    is_shaded_by_vehicle = std::make_unique<bool[]>(kMost);
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
  std::map<const TriangleMesh*, Eigen::AlignedBox3d> boxes_M;  // meshes stand many times
  for (const MeshInstance& instance : world.meshes) {
    const auto [box, is_new] = boxes_M.try_emplace(instance.mesh.get());
    if (is_new) box->second = instance.mesh->bounds();
    const Eigen::AlignedBox3d& box_M = box->second;
    if (box_M.isEmpty()) continue;
    for (int i = 0; i < 8; ++i) {
      const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
      world_top_m_ = std::max(world_top_m_, (instance.X_WM * box_M.corner(corner)).z());
    }
  }
  if (world.terrain) {
    for (const float height_m : world.terrain->heights_m) {
      world_top_m_ = std::max(world_top_m_, double{1} * height_m);
    }
  }
  make_tile_rays();
}

ViewCaster::~ViewCaster() = default;

void ViewCaster::set_vehicles(VehicleScene& vehicles, const std::string& own) {
  links_.emplace(vehicles, own);
  link_reach_m_.clear();
  for (const MeshInstance& link : vehicles.links()) {
    double reach_m = 0.0;
    for (const Vector3f& p_M : link.mesh->vertices) {
      reach_m = std::max(reach_m, double{1} * p_M.norm());
    }
    link_reach_m_.push_back(reach_m);
  }
}

void ViewCaster::find_top() {
  top_m_ = world_top_m_;
  for (std::size_t i = 0; i < link_reach_m_.size(); ++i) {
    top_m_ = std::max(top_m_, links_->scene().links()[i].X_WM.p.z() + link_reach_m_[i]);
  }
}

void ViewCaster::make_tile_rays() {
  const std::size_t chunks = (Tile::count(lens_) + kTilesAtOnce - 1) / kTilesAtOnce;
  while (tile_rays_.size() < std::min(most_threads(), chunks)) {
    tile_rays_.push_back(std::make_unique<TileRays>());
  }
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
  if (links_) links_->scene().update();
  find_top();
  make_tile_rays();
  // Few captures, so that std::function needs no memory for them.
  const struct {
    const CameraMotion& motion;
    double exposure_s;
    View& view;
  } picture{motion, exposure_s, view};
  for_chunks(Tile::count(lens_), kTilesAtOnce,
             [this, &picture](std::size_t, std::size_t begin, std::size_t end) {
               TileRays& rays = *tile_rays_[thread_in_loop()];
               for (std::size_t i = begin; i < end; ++i) {
                 const Tile tile = Tile::of(lens_, i);
                 for (int sample = 0; sample < settings_.samples; ++sample) {
                   cast_tile(picture.motion, picture.exposure_s, sample, tile, rays, picture.view);
                 }
               }
             });
  const auto share = 1.0f / static_cast<float>(settings_.samples);
  for (float& value : view.radiance) value *= share;
}

void ViewCaster::cast_tile(const CameraMotion& motion, double exposure_s, int sample,
                           const Tile& tile, TileRays& r, View& view) const {
  add_rays(motion, exposure_s, sample, tile, r);
  r.hits.resize(r.rays.size());
  light_.cast_rays(r.rays, r.hits);
  look_at_vehicles(r);
  if (sample == 0 && settings_.facts) write_facts(tile, r, view);
  if (settings_.channels > 0) add_light(tile, r, view);
}

void ViewCaster::add_rays(const CameraMotion& motion, double exposure_s, int sample,
                          const Tile& tile, TileRays& r) const {
  const Vector3d& offset = offsets_[static_cast<std::size_t>(sample)];
  const auto right = static_cast<float>(offset.x()), down = static_cast<float>(offset.y());
  const double later_s = offset.z() * exposure_s;
  const Eigen::Matrix3d R_WC = motion.X_WS.q.toRotationMatrix() * R_SC();
  Vector3d row_p_W[kTileRows];
  for (int row = 0; row < tile.rows; ++row) {
    const double row_s = row_time_s(tile.first_row + row, lens_.height(), settings_.readout_s);
    const OpticalPlace place = motion.place_at(row_s + later_s);
    row_p_W[row] = place.p_W;
    r.row_R_WC[row] = place.R_WC;
  }
  // The own body keeps its place before the camera.
  const bool moves = links_ && !(motion.v_W.isZero(0.0) && motion.w_WS_S.isZero(0.0)) &&
                     (settings_.readout_s > 0.0 || settings_.samples > 1);
  r.R_WC = R_WC;
  r.own_rays.clear();
  r.rays.clear();
  const int last_x = lens_.width() - 1, last_y = lens_.height() - 1;
  tile.for_each([&](int row, int x) {
    const std::size_t pixel = tile.pixel(row, x);
    Vector3f dir_C = direction_C_[pixel];
    if (sample > 0) {
      // Towards the neighbours: the lens is smooth over a pixel.
      const std::size_t width = static_cast<std::size_t>(lens_.width());
      const Vector3f along = x < last_x ? Vector3f(direction_C_[pixel + 1] - dir_C)
                                        : Vector3f(dir_C - direction_C_[pixel - 1]);
      const Vector3f across = tile.first_row + row < last_y
                                  ? Vector3f(direction_C_[pixel + width] - dir_C)
                                  : Vector3f(dir_C - direction_C_[pixel - width]);
      dir_C += right * along + down * across;
    }
    const Vector3d dir = dir_C.cast<double>();
    r.rays.push_back({row_p_W[row], (r.row_R_WC[row] * dir).normalized(), kFar_m});
    if (moves) r.own_rays.push_back({motion.X_WS.p, (R_WC * dir).normalized(), kFar_m});
  });
}

/// Replaces hits by nearer ones on vehicles, and rays on the own one by those of the stamp.
void ViewCaster::look_at_vehicles(TileRays& r) const {
  r.on_vehicle.assign(r.rays.size(), false);
  if (!links_) return;
  r.vehicle_hits.resize(r.rays.size());
  if (!r.own_rays.empty()) {
    links_->cast(r.rays, r.own_rays, r.hits, r.vehicle_hits);
    for (std::size_t i = 0; i < r.rays.size(); ++i) {
      r.on_vehicle[i] = r.hits[i] && r.hits[i]->surface == SurfaceClass::kVehicle;
    }
    return;
  }
  for (std::size_t i = 0; i < r.rays.size(); ++i) {
    if (r.hits[i]) r.rays[i].max_distance_m = r.hits[i]->distance_m;
  }
  links_->scene().cast_rays(r.rays, r.vehicle_hits);
  for (std::size_t i = 0; i < r.rays.size(); ++i) {
    if (!r.vehicle_hits[i]) continue;
    r.hits[i] = r.vehicle_hits[i];
    r.on_vehicle[i] = true;
  }
}

void ViewCaster::write_facts(const Tile& tile, const TileRays& r, View& view) const {
  std::size_t i = 0;
  ThingNumbers::Found last;
  tile.for_each([&](int row, int x) {
    const std::size_t pixel = tile.pixel(row, x), ray = i++;
    if (!r.hits[ray]) {
      if (r.rays[ray].dir_W.z() < 0.0) view.label[pixel] = Label::kGround;
      return;
    }
    const RayHit& hit = *r.hits[ray];
    // Along the axes of the row's own camera: the pixel's direction has them.
    view.depth_m[pixel] = static_cast<float>(hit.distance_m * direction_C_[pixel].z());
    const bool is_own = !r.own_rays.empty() && r.on_vehicle[ray] && links_->is_own(hit.mesh);
    const Eigen::Matrix3d& R_WC = is_own ? r.R_WC : r.row_R_WC[row];
    view.normal_C[pixel] = (R_WC.transpose() * hit.normal_W).cast<float>();
    if (r.on_vehicle[ray]) {
      view.label[pixel] = Label::kVehicle;
      view.thing[pixel] = numbers_.of_vehicle(links_->scene().vehicle_of(hit.mesh));
      return;
    }
    view.thing[pixel] = numbers_.of(hit, last);
    view.label[pixel] = numbers_.label(hit);
  });
}

SeenSurface ViewCaster::surface_of(const TileRays& r, std::size_t ray) const {
  const RayHit& hit = *r.hits[ray];
  const double cosine = std::max(0.05, std::abs(hit.normal_W.dot(r.rays[ray].dir_W)));
  const double footprint_m = hit.distance_m / (lens_.info().fx_px * cosine);
  return look_.surface(
      r.rays[ray], hit,
      r.on_vehicle[ray] ? links_->scene().links() : std::span<const MeshInstance>(world_.meshes),
      footprint_m);
}

void ViewCaster::add_light(const Tile& tile, TileRays& r, View& view) const {
  // Rays to the sun from all surfaces that it could light.
  const Vector3d& sun_W = look_.sun_direction_W();
  r.surfaces.resize(r.rays.size());
  r.sun_rays.clear();
  r.sun_ray.assign(r.rays.size(), kNone);
  for (std::size_t i = 0; i < r.rays.size(); ++i) {
    if (!r.hits[i]) continue;
    r.surfaces[i] = surface_of(r, i);
    const double facing = r.surfaces[i].normal_W.cast<double>().dot(sun_W);
    if (!settings_.shadows || (facing <= 0.0 && r.surfaces[i].passed.isZero())) continue;
    const Vector3d p_W = r.rays[i].p_W + r.hits[i]->distance_m * r.rays[i].dir_W;
    const double side = r.hits[i]->normal_W.dot(sun_W) < 0.0 ? -kLift_m : kLift_m;
    r.sun_ray[i] = r.sun_rays.size();
    // Nothing is above the top. The sun is never lower than 2 degrees.
    const double up_m = std::max(0.0, top_m_ - p_W.z());
    const double far_m = std::min(kFar_m, up_m / sun_W.z() + 2.0 * kLift_m);
    r.sun_rays.push_back({p_W + side * r.hits[i]->normal_W, sun_W, far_m});
  }
  light_.find_blocked(r.sun_rays, {r.is_shaded.get(), r.sun_rays.size()});
  if (links_) {
    links_->scene().find_blocked(r.sun_rays, {r.is_shaded_by_vehicle.get(), r.sun_rays.size()});
  }
  std::size_t i = 0;
  tile.for_each([&](int row, int x) {
    const std::size_t ray = i++;
    Vector3f radiance;
    if (r.hits[ray]) {
      const std::size_t to_sun = r.sun_ray[ray];
      const bool is_shaded =
          to_sun != kNone && (r.is_shaded[to_sun] || (links_ && r.is_shaded_by_vehicle[to_sun]));
      radiance = look_.radiance(r.surfaces[ray], is_shaded ? 0.0f : 1.0f);
    } else {
      radiance = look_.far_radiance(r.rays[ray].dir_W);
    }
    float* values =
        &view.radiance[tile.pixel(row, x) * static_cast<std::size_t>(settings_.channels)];
    for (int c = 0; c < settings_.channels; ++c) values[c] += radiance[c];
  });
}

std::string ViewCaster::blindness(const Pose& X_WS) {
  // A grid of pixels from border to border.
  constexpr int kGrid = 7;
  const Eigen::Matrix3d R_WC = X_WS.q.toRotationMatrix() * R_SC();
  std::vector<Vector3d> view_W;
  for (int row = 0; row < kGrid; ++row) {
    for (int column = 0; column < kGrid; ++column) {
      const auto x = static_cast<std::size_t>(column * (lens_.width() - 1) / (kGrid - 1));
      const auto y = static_cast<std::size_t>(row * (lens_.height() - 1) / (kGrid - 1));
      const std::size_t pixel = y * static_cast<std::size_t>(lens_.width()) + x;
      view_W.push_back((R_WC * direction_C_[pixel].cast<double>()).normalized());
    }
  }
  return find_blindness(X_WS, world_, light_, links_ ? &links_->scene() : nullptr, view_W);
}

}  // namespace vinerow::sensors
