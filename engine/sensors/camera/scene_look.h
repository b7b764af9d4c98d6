#pragma once
/// Light that surfaces and the sky send to a camera.
///
/// Sun and clear sky are those of the pictures for people (engine/imaging). Surfaces reflect evenly
/// into all directions (Lambert); leaves also let light through. In shadow only the sky and the
/// ground light a surface; light that goes from leaf to leaf is not followed. Radiance is relative
/// to the sun's irradiance above the atmosphere, which is 1 in each channel.

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>

#include "engine/api/mesh.h"
#include "engine/api/scene_query.h"
#include "engine/imaging/daylight.h"
#include "engine/imaging/texture.h"
#include "engine/sensors/camera/turf.h"

namespace vinerow::sensors {

/// What a camera's picture has: colours, or one band. Bands of plant cameras are about 20 to 50 nm
/// wide.
enum class Channel {
  kColour,
  kMono,     ///< grey
  kBlue,     ///< about 475 nm
  kGreen,    ///< 560 nm
  kRed,      ///< 668 nm
  kRedEdge,  ///< 717 nm
  kNir       ///< 840 nm
};

/// Surface at a hit.
struct SeenSurface {
  Eigen::Vector3f normal_W = Eigen::Vector3f::UnitZ();  ///< unit, towards the camera
  Eigen::Vector3f albedo = Eigen::Vector3f::Zero();     ///< by channel; of a band all are equal
  Eigen::Vector3f passed = Eigen::Vector3f::Zero();     ///< share of light let through, by channel
  Label label = Label::kObstacle;
};

class SceneLook {
 public:
  /// Reads the textures of the world's meshes.
  /// @param world  outlives this object
  /// @throws ConfigError if one of them cannot be read
  SceneLook(const WorldModel& world, Channel channel);

  const Eigen::Vector3d& sun_direction_W() const { return light_.sun_direction_W; }

  /// @param meshes  to which hit.mesh belongs  @param footprint_m  width of a pixel there
  SeenSurface surface(const SceneRay& ray, const RayHit& hit, std::span<const MeshInstance> meshes,
                      double footprint_m) const;
  /// Radiance of a surface towards the camera. @param sun  share of the sun's disc that it sees
  Eigen::Vector3f radiance(const SeenSurface& surface, float sun) const;
  /// Radiance from where a ray meets nothing: sky, and land beyond the world below the horizon.
  Eigen::Vector3f far_radiance(const Eigen::Vector3d& dir_W) const;
  /// Radiance of a level white surface in the open, for the white balance.
  Eigen::Vector3f white() const;

 private:
  Eigen::Vector3f in_band(const Eigen::Vector3f& rgb, Label label) const;

  Channel channel_;
  imaging::SceneLight light_;
  Eigen::Vector3f sun_, sky_, ground_;  ///< irradiances of the channels
  float air_share_ = 1.0f;              ///< of the band's scattering against red
  Turf turf_;
  std::map<std::string, imaging::Texture> textures_;  ///< by Material::texture
};

}  // namespace vinerow::sensors
