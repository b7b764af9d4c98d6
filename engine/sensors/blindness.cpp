#include "engine/sensors/blindness.h"

#include <compare>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace vinerow::sensors {
namespace {

using Eigen::Vector3d;

constexpr double kSight_m = 1000.0;
constexpr SurfaceMask kClosed =
    kAllSurfaces & ~mask_of(SurfaceClass::kTerrain) & ~mask_of(SurfaceClass::kCanopy);

/// All around, along no axis.
const Vector3d kAround[] = {{0.613, 0.271, 0.742},    {-0.587, 0.423, 0.691},
                            {0.127, -0.811, 0.571},   {0.839, -0.293, -0.459},
                            {-0.719, -0.541, -0.437}, {-0.239, 0.857, -0.457},
                            {0.353, 0.149, -0.924}};

/// Normal of the triangle as its corners are ordered, in W.
Vector3d outward_W(const MeshInstance& instance, int triangle) {
  const TriangleMesh& mesh = *instance.mesh;
  const auto& t = mesh.triangles[static_cast<std::size_t>(triangle)];
  const Vector3d a = mesh.vertices[t[0]].cast<double>();
  const Vector3d ab = mesh.vertices[t[1]].cast<double>() - a;
  const Vector3d ac = mesh.vertices[t[2]].cast<double>() - a;
  return instance.X_WM.q * ab.cross(ac);
}

/// Mesh that shuts in a camera at p_W: ahead and in most other directions a ray leaves it more
/// often than it enters it, or the other way about where its triangles are turned inside out.
/// Bodies have seams and slots, so that not all directions need to agree; a board is not in the
/// most of them.
std::optional<int> find_mesh_around(const Vector3d& p_W, const Vector3d& forward_W,
                                    const RayScene& scene, std::span<const MeshInstance> meshes,
                                    SurfaceMask mask) {
  std::vector<Vector3d> directions = {forward_W};
  directions.insert(directions.end(), std::begin(kAround), std::end(kAround));
  constexpr std::size_t kMost = 6;
  constexpr double kPast_m = 1e-6;           // a hit
  std::map<int, std::size_t> directions_of;  // of the meshes ahead
  for (const Vector3d& direction : directions) {
    const Vector3d dir_W = direction.normalized();
    std::map<int, int> leaves;
    double from_m = 0.0;
    while (const auto hit = scene.cast_ray(p_W + from_m * dir_W, dir_W, kSight_m - from_m, mask)) {
      from_m += hit->distance_m + kPast_m;
      if (from_m >= kSight_m) break;
      if (hit->mesh < 0) continue;
      const MeshInstance& instance = meshes[static_cast<std::size_t>(hit->mesh)];
      leaves[hit->mesh] += outward_W(instance, hit->triangle).dot(dir_W) > 0.0 ? 1 : -1;
    }
    const bool is_ahead = &direction == &directions.front();
    for (const auto& [mesh, times] : leaves) {
      if (times != 0 && (is_ahead || directions_of.contains(mesh))) ++directions_of[mesh];
    }
  }
  for (const auto& [mesh, count] : directions_of) {
    if (count >= kMost) return mesh;
  }
  return std::nullopt;
}

/// The first thing that a ray meets: a mesh of the world, or a vehicle.
struct FirstMet {
  bool is_vehicle = false;
  int number = -1;
  auto operator<=>(const FirstMet&) const = default;
};

FirstMet find_first(const Vector3d& p_W, const Vector3d& dir_W, const RayScene& light,
                    VehicleScene* vehicles) {
  // A body around a camera is this near. Chosen: larger than crates and vehicles, smaller than
  // halls.
  constexpr double kNear_m = 3.0;
  const auto world = light.cast_ray(p_W, dir_W, kNear_m, kAllSurfaces);
  const auto link =
      vehicles == nullptr ? std::nullopt : vehicles->cast_ray(p_W, dir_W, kNear_m, kAllSurfaces);
  if (link && (!world || link->distance_m < world->distance_m)) {
    return {true, vehicles->vehicle_of(link->mesh)};
  }
  return {false, world ? world->mesh : -1};
}

bool is_in_box(const MeshInstance& instance, const Vector3d& p_W) {
  return instance.mesh->bounds().contains(instance.X_WM.inverse() * p_W);
}

/// Body that leaves no sight to a camera within its box: a crate of boards has gaps, and the body
/// of a vehicle may be open below, so that they shut in nothing.
std::string find_body_in_sight(const Vector3d& p_W, std::span<const Vector3d> view_W,
                               const WorldModel& world, const RayScene& light,
                               VehicleScene* vehicles) {
  // Chosen: what is left are gaps between boards.
  constexpr double kMost = 0.9;
  std::map<FirstMet, std::size_t> rays_of;
  for (const Vector3d& dir_W : view_W) {
    const FirstMet met = find_first(p_W, dir_W, light, vehicles);
    if (met.number >= 0) ++rays_of[met];
  }
  for (const auto& [met, rays] : rays_of) {
    if (static_cast<double>(rays) < kMost * static_cast<double>(view_W.size())) continue;
    // Neither a wall nor a roof that the camera looks at, nor a vehicle seen from close up: at most
    // five of the directions point to the same side.
    std::size_t around = 0;
    for (const Vector3d& direction : kAround) {
      around += find_first(p_W, direction.normalized(), light, vehicles) == met ? 1 : 0;
    }
    if (around + 2 < std::size(kAround)) continue;
    if (!met.is_vehicle) {
      const MeshInstance& instance = world.meshes[static_cast<std::size_t>(met.number)];
      const bool is_closed = (mask_of(instance.surface) & kClosed) != 0;
      if (is_closed && is_in_box(instance, p_W)) return "is inside of " + instance.name;
      continue;
    }
    const std::span<const MeshInstance> links = vehicles->links();
    for (std::size_t i = 0; i < links.size(); ++i) {
      const bool is_its = vehicles->vehicle_of(static_cast<int>(i)) == met.number;
      if (is_its && is_in_box(links[i], p_W)) return "is inside of " + links[i].name;
    }
  }
  return "";
}

}  // namespace

std::string find_blindness(const Pose& X_WS, const WorldModel& world, const RayScene& light,
                           VehicleScene* vehicles, std::span<const Vector3d> view_W) {
  const Vector3d& p_W = X_WS.p;
  const Vector3d forward_W = X_WS.q * Vector3d::UnitX();
  const auto above =
      light.cast_ray(p_W, Vector3d::UnitZ(), kSight_m, mask_of(SurfaceClass::kTerrain));
  if (above && above->mesh < 0) return "is below the ground";
  if (const auto mesh = find_mesh_around(p_W, forward_W, light, world.meshes, kClosed)) {
    return "is inside of " + world.meshes[static_cast<std::size_t>(*mesh)].name;
  }
  if (vehicles != nullptr) {
    vehicles->update();
    if (const auto link =
            find_mesh_around(p_W, forward_W, *vehicles, vehicles->links(), kAllSurfaces)) {
      return "is inside of " + vehicles->links()[static_cast<std::size_t>(*link)].name;
    }
  }
  return find_body_in_sight(p_W, view_W, world, light, vehicles);
}

}  // namespace vinerow::sensors
