#include "engine/physics/mesh_rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/physics/check_world.h"
#include "engine/physics/triangle_ray.h"

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

std::array<Vector3d, 3> corners(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [i, j, k] = mesh.triangles[triangle];
  return {mesh.vertices[i].cast<double>(), mesh.vertices[j].cast<double>(),
          mesh.vertices[k].cast<double>()};
}

/// Bound of the error of a ray in single precision if no coordinate exceeds reach_m. The roundings
/// of its start, its direction and the transform into the frame of an instance are some 10 units in
/// the last place (6e-8); the bound is three times that.
double calc_margin_m(double reach_m) {
  return 2e-6 * (reach_m + 1.0);
}

/// Distance at which the ray enters the box, 0 inside; nullopt if it misses the box or ends before.
std::optional<double> enter_m(const Eigen::AlignedBox3d& box, const Vector3d& p,
                              const Vector3d& dir, double max_distance_m) {
  double first_m = 0.0, last_m = max_distance_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (dir[axis] == 0.0) {
      if (p[axis] < box.min()[axis] || p[axis] > box.max()[axis]) return std::nullopt;
      continue;
    }
    const double low_m = (box.min()[axis] - p[axis]) / dir[axis];
    const double high_m = (box.max()[axis] - p[axis]) / dir[axis];
    first_m = std::max(first_m, std::min(low_m, high_m));
    last_m = std::min(last_m, std::max(low_m, high_m));
  }
  if (!(first_m <= last_m)) return std::nullopt;
  return first_m;
}

}  // namespace

struct MeshRays::Impl {
  /// Mesh instances, in the order of Embree's geometry ids.
  struct Placed {
    const MeshInstance* instance;
    int mesh_index;
    Eigen::Matrix3d R_MW;
    Vector3d p_MW;
  };

  /// Data of a geometry's callback: its mesh, and the margin of its boxes.
  struct Boxes {
    const TriangleMesh* mesh;
    Pose X;           ///< the boxes are in the frame of X * (vertex)
    double margin_m;  ///< error bound of a ray in single precision
  };

  /// A ray in Embree's tree traversal, which passes it to the callback.
  struct Cast : RTCIntersectContext {
    const std::vector<Placed>* placed;
    Vector3d p_W, dir_W;
    double tree_start_m;  ///< distance along the ray at which Embree's ray starts
    double margin_m;
    // The ray in the frame of the last tested mesh.
    unsigned entry = RTC_INVALID_GEOMETRY_ID;
    TriangleRay ray_M{Vector3d::Zero(), Vector3d::UnitZ()};
    // The nearest hit so far. Among hits at the same distance, the one of the first mesh and
    // triangle, so that it does not depend on the traversal order.
    double best_m;
    unsigned best_entry = RTC_INVALID_GEOMETRY_ID;
    unsigned best_triangle = 0;
  };

  static void find_box(const RTCBoundsFunctionArguments* arguments) {
    const auto& boxes = *static_cast<const Boxes*>(arguments->geometryUserPtr);
    Eigen::AlignedBox3d box;
    for (const Vector3d& corner : corners(*boxes.mesh, arguments->primID))
      box.extend(boxes.X * corner);
    const auto low = [&](int axis) { return static_cast<float>(box.min()[axis] - boxes.margin_m); };
    const auto high = [&](int axis) {
      return static_cast<float>(box.max()[axis] + boxes.margin_m);
    };
    *arguments->bounds_o = {low(0), low(1), low(2), 0.0f, high(0), high(1), high(2), 0.0f};
  }

  /// Called if a ray meets the box of a triangle.
  static void look_at_triangle(const RTCIntersectFunctionNArguments* arguments) {
    if (arguments->N != 1 || arguments->valid[0] == 0) return;
    auto& cast = *static_cast<Cast*>(arguments->context);
    const unsigned instance = arguments->context->instID[0];
    const unsigned entry = instance != RTC_INVALID_GEOMETRY_ID ? instance : arguments->geomID;
    const Placed& placed = (*cast.placed)[entry];
    if (entry != cast.entry) {
      cast.ray_M = TriangleRay(placed.R_MW * cast.p_W + placed.p_MW, placed.R_MW * cast.dir_W);
      cast.entry = entry;
    }
    const auto [a, b, c] = corners(*placed.instance->mesh, arguments->primID);
    const std::optional<double> found_m = cast.ray_M.distance_m(a, b, c);
    if (!found_m || *found_m > cast.best_m) return;
    if (*found_m == cast.best_m && cast.best_entry != RTC_INVALID_GEOMETRY_ID &&
        std::pair(cast.best_entry, cast.best_triangle) < std::pair(entry, arguments->primID)) {
      return;
    }
    cast.best_m = *found_m;
    cast.best_entry = entry;
    cast.best_triangle = arguments->primID;
    // Skip boxes that start farther away; test those at the same distance.
    auto& ray = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
    ray.ray.tfar = static_cast<float>(cast.best_m - cast.tree_start_m + cast.margin_m);
    ray.hit.geomID = arguments->geomID;
  }

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::map<const TriangleMesh*, RTCScene> shared;
  std::vector<Placed> placed;
  std::deque<Boxes> boxes;  // geometries point to the elements
  Eigen::AlignedBox3d bounds_W;
  double margin_m = 0.0;

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    for (const auto& [mesh, mesh_scene] : shared) rtcReleaseScene(mesh_scene);
    if (device) rtcReleaseDevice(device);
  }

  RTCScene new_scene() {
    RTCScene result = rtcNewScene(device);
    // No ray may pass between two neighbouring boxes.
    rtcSetSceneFlags(result, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(result, RTC_BUILD_QUALITY_MEDIUM);
    return result;
  }

  /// Geometry of the mesh's triangles at X: boxes and a callback.
  RTCGeometry new_triangles(const TriangleMesh& mesh, const Pose& X, SurfaceMask mask) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    boxes.push_back({&mesh, X, margin_m});
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh.triangles.size()));
    rtcSetGeometryUserData(geometry, &boxes.back());
    rtcSetGeometryBoundsFunction(geometry, find_box, nullptr);
    rtcSetGeometryIntersectFunction(geometry, look_at_triangle);
    rtcSetGeometryMask(geometry, mask);
    rtcCommitGeometry(geometry);
    return geometry;
  }

  RTCScene scene_of(const TriangleMesh& mesh) {
    const auto found = shared.find(&mesh);
    if (found != shared.end()) return found->second;
    RTCGeometry geometry = new_triangles(mesh, Pose{}, kAllSurfaces);
    RTCScene result = new_scene();
    rtcAttachGeometry(result, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(result);
    shared.emplace(&mesh, result);
    return result;
  }

  RTCGeometry new_instance(const MeshInstance& instance) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, scene_of(*instance.mesh));
    const Eigen::Matrix3d R_WM = instance.X_WM.q.toRotationMatrix();
    float columns[12];
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        columns[3 * column + row] = static_cast<float>(R_WM(row, column));
      }
    }
    for (int row = 0; row < 3; ++row) columns[9 + row] = static_cast<float>(instance.X_WM.p[row]);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcSetGeometryMask(geometry, mask_of(instance.surface));
    rtcCommitGeometry(geometry);
    return geometry;
  }

  /// A mesh with a single instance is added to the scene directly, which saves its rays a
  /// transform.
  void add(const MeshInstance& instance, int mesh_index, bool stands_once) {
    RTCGeometry geometry =
        stands_once ? new_triangles(*instance.mesh, instance.X_WM, mask_of(instance.surface))
                    : new_instance(instance);
    const unsigned id = rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    VINEROW_DEMAND(id == placed.size());
    const Eigen::Matrix3d R_MW = instance.X_WM.q.toRotationMatrix().transpose();
    placed.push_back({&instance, mesh_index, R_MW, -(R_MW * instance.X_WM.p)});
  }
};

MeshRays::MeshRays(const WorldModel& world) : impl_(std::make_unique<Impl>()) {
  std::map<const TriangleMesh*, int> uses;
  double reach_m = 0.0;  // largest coordinate of a vertex, in the frame of the world or of its mesh
  for (const MeshInstance& instance : world.meshes) {
    if (!is_seen_by_rays(instance)) continue;
    ++uses[instance.mesh.get()];
    for (const Eigen::Vector3f& vertex : instance.mesh->vertices) {
      const Vector3d p_M = vertex.cast<double>();
      const Vector3d p_W = instance.X_WM * p_M;
      impl_->bounds_W.extend(p_W);
      reach_m = std::max({reach_m, p_M.cwiseAbs().maxCoeff(), p_W.cwiseAbs().maxCoeff()});
    }
  }
  if (uses.empty()) return;
  impl_->margin_m = calc_margin_m(reach_m);
  // Rays in the plane of a box's side enter it too, whatever the rounding.
  impl_->bounds_W.min().array() -= impl_->margin_m;
  impl_->bounds_W.max().array() += impl_->margin_m;
  impl_->device = rtcNewDevice("threads=1,set_affinity=0");
  if (!impl_->device) throw ConfigError("Embree could not be started: no device for ray casts");
  if (rtcGetDeviceProperty(impl_->device, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) == 0) {
    throw ConfigError(
        "this Embree was built without ray masks, which ray casts need "
        "(EMBREE_RAY_MASK=ON)");
  }
  impl_->scene = impl_->new_scene();
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    const MeshInstance& instance = world.meshes[i];
    if (!is_seen_by_rays(instance)) continue;
    impl_->add(instance, static_cast<int>(i), uses[instance.mesh.get()] == 1);
  }
  rtcCommitScene(impl_->scene);
}

MeshRays::~MeshRays() = default;

bool MeshRays::empty() const {
  return impl_->placed.empty();
}

std::optional<RayHit> MeshRays::cast(const Vector3d& p_W, const Vector3d& dir_W,
                                     double max_distance_m, SurfaceMask mask) const {
  if (impl_->placed.empty() || !p_W.allFinite() || !dir_W.allFinite() || !(max_distance_m >= 0.0)) {
    return std::nullopt;
  }
  // Embree's ray starts at the bounds of the meshes, so that a distant start costs no digits in
  // single precision.
  const std::optional<double> start_m = enter_m(impl_->bounds_W, p_W, dir_W, max_distance_m);
  if (!start_m) return std::nullopt;
  const Vector3d p_start_W = p_W + *start_m * dir_W;

  Impl::Cast cast;
  rtcInitIntersectContext(&cast);
  cast.placed = &impl_->placed;
  cast.p_W = p_W;
  cast.dir_W = dir_W;
  cast.tree_start_m = *start_m;
  cast.margin_m = impl_->margin_m;
  cast.best_m = max_distance_m;
  RTCRayHit ray;
  ray.ray.org_x = static_cast<float>(p_start_W.x());
  ray.ray.org_y = static_cast<float>(p_start_W.y());
  ray.ray.org_z = static_cast<float>(p_start_W.z());
  ray.ray.dir_x = static_cast<float>(dir_W.x());
  ray.ray.dir_y = static_cast<float>(dir_W.y());
  ray.ray.dir_z = static_cast<float>(dir_W.z());
  ray.ray.tnear = 0.0f;
  ray.ray.tfar = static_cast<float>(max_distance_m - *start_m + impl_->margin_m);
  ray.ray.mask = mask;
  ray.ray.time = 0.0f;
  ray.ray.id = 0;
  ray.ray.flags = 0;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &cast, &ray);
  if (cast.best_entry == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const Impl::Placed& placed = impl_->placed[cast.best_entry];
  const auto [a, b, c] = corners(*placed.instance->mesh, cast.best_triangle);
  const Vector3d normal_W = (placed.R_MW.transpose() * (b - a).cross(c - a)).normalized();
  RayHit hit;
  hit.distance_m = cast.best_m;
  hit.normal_W = normal_W.dot(dir_W) > 0.0 ? Vector3d(-normal_W) : normal_W;
  hit.surface = placed.instance->surface;
  hit.mesh = placed.mesh_index;
  return hit;
}

}  // namespace vinerow::physics
