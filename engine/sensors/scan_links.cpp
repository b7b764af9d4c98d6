#include "engine/sensors/scan_links.h"

#include "engine/api/mesh.h"

namespace vinerow::sensors {

ScanLinks::ScanLinks(VehicleScene& scene, const std::string& vehicle) : scene_(scene) {
  for (const MeshInstance& link : scene.links()) {
    const bool is_own = link.name.starts_with(vehicle + "/");
    whose_.push_back(is_own ? Whose::kOwn : Whose::kOther);
    (is_own ? has_own_ : has_others_) = true;
  }
}

void ScanLinks::cast(std::span<SceneRay> rays, std::span<SceneRay> own_rays,
                     std::span<std::optional<RayHit>> hits,
                     std::span<std::optional<RayHit>> scratch) const {
  if (has_others_) {
    find(Whose::kOther, rays, hits, scratch);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (scratch[i]) hits[i] = scratch[i];
    }
  }
  if (!has_own_) return;
  find(Whose::kOwn, own_rays, hits, scratch);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!scratch[i]) continue;
    hits[i] = scratch[i];
    rays[i] = own_rays[i];  // the normal of the hit goes with it
  }
}

/// Hits on these links that are nearer than what the rays have met.
void ScanLinks::find(Whose whose, std::span<SceneRay> rays,
                     std::span<const std::optional<RayHit>> hits,
                     std::span<std::optional<RayHit>> found) const {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i]) rays[i].max_distance_m = hits[i]->distance_m;
  }
  scene_.cast_rays(rays, found);
  for (std::size_t i = 0; i < rays.size(); ++i) look_beyond(whose, rays[i], found[i]);
}

/// Goes on from a link of the others to the first of these.
void ScanLinks::look_beyond(Whose whose, const SceneRay& ray, std::optional<RayHit>& hit) const {
  constexpr double kBeyond_m = 1e-4;  // vehicles do not come as near to each other
  double passed_m = 0.0;
  while (hit && whose_[static_cast<std::size_t>(hit->mesh)] != whose) {
    passed_m += hit->distance_m + kBeyond_m;
    const double left_m = ray.max_distance_m - passed_m;
    hit = left_m > 0.0 ? scene_.cast_ray(ray.p_W + passed_m * ray.dir_W, ray.dir_W, left_m)
                       : std::nullopt;
  }
  if (hit) hit->distance_m += passed_m;
}

}  // namespace vinerow::sensors
