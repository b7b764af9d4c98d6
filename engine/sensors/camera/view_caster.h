#pragma once
/// Rays of a camera's picture: what each pixel sees.
///
/// A pixel is a ray through its middle, at the middle of its row's exposure. Depth, normal, label
/// and number of the thing are those of this ray: they do not blend at edges. The radiance is the
/// mean of `samples` rays, the first of which is that one; the others lie elsewhere in the pixel
/// and in its exposure, which gives smooth edges and motion blur. Their mean place is the middle
/// (but for two samples), so that colours are where depth and labels are.
///
/// The stamp is the middle of the picture's exposure. Row j of h is exposed about
/// (j / (h - 1) - 1/2) readout_s later (rolling shutter; 0: global). In between the camera moves
/// with the velocities that it has at the stamp: for an acceleration a the outer rows are off by
/// a readout_s^2 / 8. The own body moves with it; other vehicles stand still where they are at the
/// stamp.
///
/// Tiles are cast on all cores (core/parallel.h); the picture does not depend on their number.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/lens.h"
#include "engine/api/scene_query.h"
#include "engine/math/pose.h"
#include "engine/sensors/camera/camera_motion.h"
#include "engine/sensors/camera/scene_look.h"
#include "engine/sensors/camera/thing_numbers.h"
#include "engine/sensors/scan_links.h"

namespace vinerow::sensors {

/// Values of all pixels, row by row. Empty: not wanted.
struct View {
  std::vector<float> radiance;  ///< relative, by channel
  std::vector<float> depth_m;   ///< along the axis; 0: nothing is seen
  /// In the optical frame at the row's exposure, as the depth; zero: nothing is seen.
  std::vector<Eigen::Vector3f> normal_C;
  std::vector<Label> label;
  std::vector<std::uint32_t> thing;
};

struct ViewSettings {
  int samples = 1;
  double readout_s = 0.0;
  bool shadows = true;
  int channels = 3;   ///< of the radiance; 0: none
  bool facts = true;  ///< depth, normal, label and thing of each pixel
};

class ViewCaster {
 public:
  /// References outlive this object. @param vehicles  null: none
  ViewCaster(const Lens& lens, const ViewSettings& settings, const WorldModel& world,
             const RayScene& light, const SceneLook& look);
  ~ViewCaster();

  /// Vehicles that it sees from now on. @param own  name of the one that carries it
  void set_vehicles(VehicleScene& vehicles, const std::string& own);

  /// @param exposure_s  for motion blur
  void cast(const CameraMotion& motion, double exposure_s, View& view);

  /// Reason why a camera here sees nothing: "is inside of rover/body". Empty: there is none.
  std::string blindness(const Pose& X_WS);

 private:
  struct Tile;
  struct TileRays;
  void make_tile_rays();
  void find_top();
  void cast_tile(const CameraMotion& motion, double exposure_s, int sample, const Tile& tile,
                 TileRays& r, View& view) const;
  void add_rays(const CameraMotion& motion, double exposure_s, int sample, const Tile& tile,
                TileRays& r) const;
  void look_at_vehicles(TileRays& r) const;
  void write_facts(const Tile& tile, const TileRays& r, View& view) const;
  void add_light(const Tile& tile, TileRays& r, View& view) const;
  SeenSurface surface_of(const TileRays& r, std::size_t ray) const;

  const Lens& lens_;
  ViewSettings settings_;
  const WorldModel& world_;
  const RayScene& light_;
  const SceneLook& look_;
  /// Height that no surface exceeds: of the world, and of the vehicles too at this picture.
  double world_top_m_ = -std::numeric_limits<double>::infinity(), top_m_ = 0.0;
  std::optional<ScanLinks> links_;
  std::vector<double> link_reach_m_;  ///< of each link's mesh from its origin
  ThingNumbers numbers_;
  std::vector<Eigen::Vector3f> direction_C_;  ///< of each pixel, in the optical frame
  /// Of each sample: to the right and down, in pixels; later, as a share of the exposure.
  std::vector<Eigen::Vector3d> offsets_;
  std::vector<std::unique_ptr<TileRays>> tile_rays_;  ///< of each thread
};

}  // namespace vinerow::sensors
