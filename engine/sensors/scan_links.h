#pragma once
/// Links of vehicles before a sensor that moves while it scans or takes a picture.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/api/scene_query.h"

namespace vinerow::sensors {

/// The scene has all links where they are at one instant. Links of other vehicles stand still there
/// for all rays, each of which starts where the sensor is at its own time. Own links move with the
/// sensor: they are met from where it is at the instant of the links. Else they
/// would be off by the way of the vehicle from one time to the other.
class ScanLinks {
 public:
  /// @param vehicle  name of the sensor's
  ScanLinks(VehicleScene& scene, const std::string& vehicle);

  VehicleScene& scene() const { return scene_; }
  bool is_own(int link) const { return whose_[static_cast<std::size_t>(link)] == Whose::kOwn; }

  /// Replaces hits by nearer ones on links, and rays by own rays where those met an own link.
  /// Thread safe. @param own_rays  the same in S, from where S is at the instant of the links
  /// @param scratch  as many as rays
  void cast(std::span<SceneRay> rays, std::span<SceneRay> own_rays,
            std::span<std::optional<RayHit>> hits, std::span<std::optional<RayHit>> scratch) const;

 private:
  enum class Whose { kOwn, kOther };
  void find(Whose whose, std::span<SceneRay> rays, std::span<const std::optional<RayHit>> hits,
            std::span<std::optional<RayHit>> found) const;
  void look_beyond(Whose whose, const SceneRay& ray, std::optional<RayHit>& hit) const;

  VehicleScene& scene_;
  std::vector<Whose> whose_;  ///< each link is
  bool has_own_ = false, has_others_ = false;
};

}  // namespace vinerow::sensors
