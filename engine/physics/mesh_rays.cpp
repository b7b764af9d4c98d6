#include "engine/physics/mesh_rays.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/physics/check_world.h"

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

/// Distance along the ray to the triangle's plane, and the plane's normal (not unit).
double calc_plane_distance(const TriangleMesh& mesh, std::uint32_t triangle, const Vector3d& p_M,
                           const Vector3d& dir_M, Vector3d& normal_M) {
  const auto& [i, j, k] = mesh.triangles[triangle];
  const Vector3d a = mesh.vertices[i].cast<double>();
  const Vector3d b = mesh.vertices[j].cast<double>();
  const Vector3d c = mesh.vertices[k].cast<double>();
  normal_M = (b - a).cross(c - a);
  return (a - p_M).dot(normal_M) / dir_M.dot(normal_M);
}

}  // namespace

struct MeshRays::Impl {
  /// One mesh instance, in the order of Embree's geometry ids.
  struct Entry {
    const MeshInstance* instance;
    int mesh_index;
    Eigen::Matrix3d R_MW;
    Vector3d p_MW;
  };

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::map<const TriangleMesh*, RTCScene> shared;
  std::vector<Entry> entries;

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    for (const auto& [mesh, mesh_scene] : shared) rtcReleaseScene(mesh_scene);
    if (device) rtcReleaseDevice(device);
  }

  RTCScene new_scene() {
    RTCScene result = rtcNewScene(device);
    // No ray may slip through between two neighbouring triangles.
    rtcSetSceneFlags(result, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(result, RTC_BUILD_QUALITY_MEDIUM);
    return result;
  }

  /// Triangles with vertices at X * (where the mesh has them).
  RTCGeometry new_triangles(const TriangleMesh& mesh, const Pose& X, SurfaceMask mask) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Copies: a shared buffer would have to be readable 4 bytes past its end.
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              3 * sizeof(std::uint32_t), mesh.triangles.size());
    const Eigen::Matrix3d R = X.q.toRotationMatrix();
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const Vector3d p = R * mesh.vertices[v].cast<double>() + X.p;
      for (int axis = 0; axis < 3; ++axis) vertices[3 * v + axis] = static_cast<float>(p[axis]);
    }
    std::memcpy(triangles, mesh.triangles.data(),
                mesh.triangles.size() * sizeof(mesh.triangles[0]));
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

  /// A mesh that stands once goes straight into the scene, which saves its rays a change of frame.
  void add(const MeshInstance& instance, int mesh_index, bool stands_once) {
    RTCGeometry geometry =
        stands_once ? new_triangles(*instance.mesh, instance.X_WM, mask_of(instance.surface))
                    : new_instance(instance);
    const unsigned id = rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    VINEROW_DEMAND(id == entries.size());
    const Eigen::Matrix3d R_MW = instance.X_WM.q.toRotationMatrix().transpose();
    entries.push_back({&instance, mesh_index, R_MW, -(R_MW * instance.X_WM.p)});
  }
};

MeshRays::MeshRays(const WorldModel& world) : impl_(std::make_unique<Impl>()) {
  std::map<const TriangleMesh*, int> uses;
  for (const MeshInstance& instance : world.meshes) {
    if (is_seen_by_rays(instance)) ++uses[instance.mesh.get()];
  }
  if (uses.empty()) return;
  // One thread: the tree, and with it which of two equal hits is taken, is the same every time.
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
  return impl_->entries.empty();
}

std::optional<RayHit> MeshRays::cast(const Vector3d& p_W, const Vector3d& dir_W,
                                     double max_distance_m, SurfaceMask mask) const {
  if (impl_->entries.empty()) return std::nullopt;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray;
  ray.ray.org_x = static_cast<float>(p_W.x());
  ray.ray.org_y = static_cast<float>(p_W.y());
  ray.ray.org_z = static_cast<float>(p_W.z());
  ray.ray.dir_x = static_cast<float>(dir_W.x());
  ray.ray.dir_y = static_cast<float>(dir_W.y());
  ray.ray.dir_z = static_cast<float>(dir_W.z());
  ray.ray.tnear = 0.0f;
  // A little longer than asked for: the end is decided below, in double.
  ray.ray.tfar = static_cast<float>(max_distance_m * (1.0 + 1e-5) + 1e-3);
  ray.ray.mask = mask;
  ray.ray.time = 0.0f;
  ray.ray.id = 0;
  ray.ray.flags = 0;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const bool in_instance = ray.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const Impl::Entry& entry = impl_->entries[in_instance ? ray.hit.instID[0] : ray.hit.geomID];
  Vector3d normal_M;
  const Vector3d dir_M = entry.R_MW * dir_W;
  const double distance_m = calc_plane_distance(*entry.instance->mesh, ray.hit.primID,
                                                entry.R_MW * p_W + entry.p_MW, dir_M, normal_M);
  RayHit hit;
  // Along a ray that grazes the plane the two may part; then Embree's point, which is on the
  // triangle, is the better one.
  const double single_m = ray.ray.tfar;
  hit.distance_m =
      std::abs(distance_m - single_m) <= 1e-3 * (1.0 + single_m) ? distance_m : single_m;
  if (hit.distance_m < 0.0) hit.distance_m = 0.0;
  if (hit.distance_m > max_distance_m) return std::nullopt;
  const Vector3d normal_W = (entry.R_MW.transpose() * normal_M).normalized();
  hit.normal_W = normal_W.dot(dir_W) > 0.0 ? Vector3d(-normal_W) : normal_W;
  hit.surface = entry.instance->surface;
  hit.mesh = entry.mesh_index;
  return hit;
}

}  // namespace vinerow::physics
