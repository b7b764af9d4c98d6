#include "engine/physics/mesh_rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <limits>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/profile.h"
#include "engine/math/box_tree.h"
#include "engine/physics/block_callbacks.h"
#include "engine/physics/box_ray.h"
#include "engine/physics/triangle_blocks.h"

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

using Corners = std::array<Vector3d, 3>;

Corners corners_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [i, j, k] = mesh.triangles[triangle];
  return {mesh.vertices[i].cast<double>(), mesh.vertices[j].cast<double>(),
          mesh.vertices[k].cast<double>()};
}

Corners corners_of(const TriangleBlock& block, std::uint32_t place) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) corners[k][axis] = block.corners_M[k][axis][place];
  }
  return corners;
}

/// Bound of the error of a ray in single precision if no coordinate exceeds reach_m. The roundings
/// of its start, its direction and the transform into the frame of an instance are some 10 units in
/// the last place (6e-8); the bound is three times that.
double calc_margin_m(double reach_m) {
  return 2e-6 * (reach_m + 1.0);
}

/// Embree's trees take 0.43 us a triangle to build; a ray without them takes 0.2 us more. The first
/// rays may cost a tenth of the trees.
constexpr std::uint64_t kTrianglesPerFirstRay = 4;

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

struct MeshRays::Impl {
  /// Embree's ray starts at the bounds of the meshes, so that a distant start costs no digits in
  /// single precision. @returns false if the ray misses them
  // Called for each ray, as hit_of(): out of line both take 0.05 of a scan's time.
  VINEROW_ALWAYS_INLINE bool begin(const SceneRay& ray, RayLane& lane) const {
    if (placed.empty() || !ray.p_W.allFinite() || !ray.dir_W.allFinite() ||
        !(ray.max_distance_m >= 0.0)) {
      return false;
    }
    if (!bounds_W.contains(ray.p_W)) {
      const std::optional<double> start_m =
          BoxRay(ray.p_W, ray.dir_W).enter_m(bounds_W, ray.max_distance_m);
      if (!start_m) return false;
      lane.tree_start_m = *start_m;
    }
    lane.p_W = ray.p_W;
    lane.dir_W = ray.dir_W;
    lane.best_m = ray.max_distance_m;
    return true;
  }

  /// One of the first rays, if Embree's trees are not needed for it: its hit is the same.
  /// @returns false if enough have been cast to make the trees worth building
  bool cast_without_trees(RayLane& lane, SurfaceMask mask) const {
    if (has_trees.load(std::memory_order_acquire)) return false;
    // Where the ray enters a box, widened against rounding; the search goes on to the hit so far.
    const auto distance_of = [&lane](double margin, const Vector3d& p, const Vector3d& dir) {
      return [&lane, margin, ray = BoxRay(p, dir)](const Eigen::AlignedBox3f& box) {
        Eigen::AlignedBox3d wide = box.cast<double>();
        wide.min().array() -= margin;
        wide.max().array() += margin;
        return ray.enter_m(wide, lane.best_m).value_or(kNever);
      };
    };
    bool is_complete = true;
    const auto distance_W = distance_of(0.0, lane.p_W, lane.dir_W);  // boxes_W are widened
    instances.search(distance_W, lane.best_m, [&](std::uint32_t item) {
      const PlacedMesh& place = placed[item];
      if ((mask & mask_of(place.instance->surface)) == 0) return;
      if (!is_complete || distance_W(boxes_W[item]) == kNever) return;
      if (!place.tree || first_rays.fetch_add(1, std::memory_order_relaxed) >= max_first_rays) {
        is_complete = false;
        return;
      }
      const auto distance_M =
          distance_of(margin_m, place.R_MW * lane.p_W + place.p_MW, place.R_MW * lane.dir_W);
      place.tree->get().search(distance_M, lane.best_m,
                               [&](std::uint32_t triangle) { lane.test(place, item, triangle); });
    });
    // What was hit so far is a hit: a search of Embree's trees goes on from there.
    return is_complete;
  }

  RayCast make_cast(RayLane* lanes) const {
    RayCast cast;
    rtcInitIntersectContext(&cast);
    cast.placed = &placed;
    cast.margin_m = margin_m;
    cast.lanes = lanes;
    return cast;
  }

  /// Where the processor lacks AVX, Embree ignores `valid` and takes part with all rays but those
  /// that end before they begin.
  static void leave_out(RTCRay8& rays, std::size_t i) {
    rays.org_x[i] = rays.org_y[i] = rays.org_z[i] = 0.0f;
    rays.dir_x[i] = rays.dir_y[i] = 0.0f;
    rays.dir_z[i] = 1.0f;
    rays.tnear[i] = 0.0f;
    rays.tfar[i] = -1.0f;
    rays.time[i] = 0.0f;
    rays.mask[i] = rays.id[i] = rays.flags[i] = 0;
  }

  /// Casts up to eight rays.
  /// @param search  of those that Embree's trees are needed for: (valid, cast, packet)
  template <class Search>
  void cast_packet(std::span<const SceneRay> rays, SurfaceMask mask, RayLanes& lanes,
                   const Search& search) {
    alignas(32) std::array<int, kPacket> valid{};  // -1: takes part
    RTCRayHit8 packet;
    RayCast cast = make_cast(lanes.data());
    cast.first_in_packet = kPacket;
    for (std::size_t i = 0; i < kPacket; ++i) {
      if (i >= rays.size() || !begin(rays[i], lanes[i]) || cast_without_trees(lanes[i], mask)) {
        leave_out(packet.ray, i);
        continue;
      }
      const SceneRay& ray = rays[i];
      valid[i] = -1;
      cast.first_in_packet = std::min(cast.first_in_packet, static_cast<unsigned>(i));
      const Vector3d p_start_W = ray.p_W + lanes[i].tree_start_m * ray.dir_W;
      packet.ray.org_x[i] = static_cast<float>(p_start_W.x());
      packet.ray.org_y[i] = static_cast<float>(p_start_W.y());
      packet.ray.org_z[i] = static_cast<float>(p_start_W.z());
      packet.ray.dir_x[i] = static_cast<float>(ray.dir_W.x());
      packet.ray.dir_y[i] = static_cast<float>(ray.dir_W.y());
      packet.ray.dir_z[i] = static_cast<float>(ray.dir_W.z());
      packet.ray.tnear[i] = 0.0f;
      packet.ray.tfar[i] =
          static_cast<float>(ray.max_distance_m - lanes[i].tree_start_m + margin_m);
      packet.ray.mask[i] = mask;
      packet.ray.time[i] = 0.0f;
      packet.ray.id[i] = static_cast<unsigned>(i);
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (cast.first_in_packet == kPacket) return;
    ensure_trees();
    cast.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    search(valid.data(), cast, packet);
  }

  /// Casts rays, eight at a time. @param use  called with (place of the ray, its lane)
  template <class Search, class Use>
  void cast_packets(std::span<const SceneRay> rays, SurfaceMask mask, const Search& search,
                    const Use& use) {
    for (std::size_t at = 0; at < rays.size(); at += kPacket) {
      const std::size_t count = std::min(kPacket, rays.size() - at);
      RayLanes lanes;
      cast_packet(rays.subspan(at, count), mask, lanes, search);
      for (std::size_t i = 0; i < count; ++i) use(at + i, lanes[i]);
    }
  }

  VINEROW_ALWAYS_INLINE std::optional<RayHit> hit_of(const RayLane& lane) const {
    if (!lane.has_hit()) return std::nullopt;
    const PlacedMesh& met = placed[lane.best_entry];
    // The block was read just now, unlike the mesh.
    const auto [a, b, c] =
        lane.best_block ? corners_of(*lane.best_block, lane.best_triangle - lane.best_block->first)
                        : corners_of(*met.instance->mesh, lane.best_triangle);
    const Vector3d normal_W = (met.R_MW.transpose() * (b - a).cross(c - a)).normalized();
    RayHit hit;
    hit.distance_m = lane.best_m;
    hit.normal_W = normal_W.dot(lane.dir_W) > 0.0 ? Vector3d(-normal_W) : normal_W;
    hit.surface = met.instance->surface;
    hit.mesh = met.mesh_index;
    hit.triangle = static_cast<int>(lane.best_triangle);
    return hit;
  }

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::map<const TriangleMesh*, RTCScene> shared;
  std::map<const TriangleMesh*, std::vector<TriangleBlock>> blocks;
  std::vector<PlacedMesh> placed;
  std::deque<BlockBoxes> boxes;                                 // geometries point to the elements
  std::map<const TriangleMesh*, Eigen::AlignedBox3d> moving_M;  ///< boxes of meshes that move
  Eigen::AlignedBox3d bounds_W;
  std::vector<Eigen::AlignedBox3f> boxes_W;  ///< of the instances, as bounds_W; of a world alone
  BoxTree<float, 3> instances;               ///< on them
  std::shared_ptr<MeshTrees> first_trees;    ///< may be null
  std::uint64_t max_first_rays = 0;
  mutable std::atomic<std::uint64_t> first_rays = 0;  ///< searches of a mesh without Embree
  double margin_m = 0.0;
  std::atomic<bool> has_trees = false;
  std::once_flag trees_once;

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
    std::vector<TriangleBlock>& of_mesh = blocks[&mesh];
    if (of_mesh.empty()) of_mesh = make_triangle_blocks(mesh);
    boxes.push_back({&of_mesh, X, margin_m});
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(of_mesh.size()));
    rtcSetGeometryUserData(geometry, &boxes.back());
    rtcSetGeometryBoundsFunction(geometry, find_block_box, nullptr);
    const BlockFunctions functions = block_functions();
    rtcSetGeometryIntersectFunction(geometry, functions.look);
    rtcSetGeometryOccludedFunction(geometry, functions.block);
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

  static void set_transform(RTCGeometry geometry, const MeshInstance& instance) {
    const Eigen::Matrix3d R_WM = instance.X_WM.q.toRotationMatrix();
    float columns[12];
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        columns[3 * column + row] = static_cast<float>(R_WM(row, column));
      }
    }
    for (int row = 0; row < 3; ++row) columns[9 + row] = static_cast<float>(instance.X_WM.p[row]);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  }

  RTCGeometry new_instance(const MeshInstance& instance) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, scene_of(*instance.mesh));
    set_transform(geometry, instance);
    rtcSetGeometryMask(geometry, mask_of(instance.surface));
    rtcCommitGeometry(geometry);
    return geometry;
  }

  void add(const MeshInstance& instance, int mesh_index, bool stands_once,
           const Lazy<MeshTrees::Tree>* tree = nullptr) {
    PlacedMesh entry{&instance,       mesh_index, stands_once, tree, Eigen::Matrix3d::Identity(),
                     Vector3d::Zero()};
    settle(entry);
    placed.push_back(entry);
  }

  /// Builds the trees at the first call. A mesh with a single instance is added to the scene
  /// directly, which saves its rays a transform. Thread safe.
  void ensure_trees() {
    if (has_trees.load(std::memory_order_acquire)) return;
    std::call_once(trees_once, [this] {
      const ProfileSpan span("trees of rays", "set-up");
      for (std::size_t i = 0; i < placed.size(); ++i) {
        const MeshInstance& instance = *placed[i].instance;
        RTCGeometry geometry = placed[i].stands_once ? new_triangles(*instance.mesh, instance.X_WM,
                                                                     mask_of(instance.surface))
                                                     : new_instance(instance);
        const unsigned id = rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        VINEROW_DEMAND(id == i);
      }
      rtcCommitScene(scene);
      has_trees.store(true, std::memory_order_release);
    });
  }

  /// Takes over where the instance is.
  static void settle(PlacedMesh& entry) {
    entry.R_MW = entry.instance->X_WM.q.toRotationMatrix().transpose();
    entry.p_MW = -(entry.R_MW * entry.instance->X_WM.p);
  }

  void open_device() {
    device = rtcNewDevice("threads=1,set_affinity=0");
    if (!device) throw ConfigError("Embree could not be started: no device for ray casts");
    if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) == 0) {
      throw ConfigError(
          "this Embree was built without ray masks, which ray casts need "
          "(EMBREE_RAY_MASK=ON)");
    }
    scene = new_scene();
  }

  /// Bounds of all instances, widened by the margin: rays in the plane of a box's side enter it
  /// too, whatever the rounding.
  void calc_bounds(const std::map<const TriangleMesh*, Eigen::AlignedBox3d>& boxes_M) {
    bounds_W.setEmpty();
    for (const PlacedMesh& entry : placed) {
      bounds_W.extend(box_W_of(entry, boxes_M));
    }
    bounds_W.min().array() -= margin_m;
    bounds_W.max().array() += margin_m;
  }

  static Eigen::AlignedBox3d box_W_of(
      const PlacedMesh& entry, const std::map<const TriangleMesh*, Eigen::AlignedBox3d>& boxes_M) {
    const Eigen::AlignedBox3d& box = boxes_M.at(entry.instance->mesh.get());
    Eigen::AlignedBox3d box_W;
    if (box.isEmpty()) return box_W;
    for (int corner = 0; corner < 8; ++corner) {
      box_W.extend(entry.instance->X_WM *
                   box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    }
    return box_W;
  }

  /// Boxes of the instances, widened as the bounds and by the rounding to single precision, which
  /// the margin exceeds.
  void calc_boxes(const std::map<const TriangleMesh*, Eigen::AlignedBox3d>& boxes_M) {
    for (const PlacedMesh& entry : placed) {
      Eigen::AlignedBox3d box = box_W_of(entry, boxes_M);
      if (!box.isEmpty()) {
        box.min().array() -= 2.0 * margin_m;
        box.max().array() += 2.0 * margin_m;
      }
      boxes_W.push_back(box.cast<float>());
    }
    instances = BoxTree<float, 3>(boxes_W);
  }
};

MeshRays::MeshRays(const WorldModel& world, bool (*is_met)(const MeshInstance&),
                   std::shared_ptr<MeshTrees> trees)
    : impl_(std::make_unique<Impl>()) {
  std::map<const TriangleMesh*, int> uses;
  std::map<const TriangleMesh*, Eigen::AlignedBox3d> boxes_M;
  double reach_m = 0.0;  // largest coordinate of a vertex, in the frame of the world or of its mesh
  for (const MeshInstance& instance : world.meshes) {
    if (!is_met(instance)) continue;
    ++uses[instance.mesh.get()];
    const auto [box, is_new] = boxes_M.try_emplace(instance.mesh.get());
    if (is_new) box->second = instance.mesh->bounds();
    if (box->second.isEmpty()) continue;
    // The corners of its box, not all vertices: leaves have many, and each mesh stands many times.
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d p_M = box->second.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      const Vector3d p_W = instance.X_WM * p_M;
      reach_m = std::max({reach_m, p_M.cwiseAbs().maxCoeff(), p_W.cwiseAbs().maxCoeff()});
    }
  }
  if (uses.empty()) return;
  impl_->margin_m = calc_margin_m(reach_m);
  impl_->open_device();
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    const MeshInstance& instance = world.meshes[i];
    if (!is_met(instance)) continue;
    triangles += instance.mesh->triangles.size();
    impl_->add(instance, static_cast<int>(i), uses[instance.mesh.get()] == 1,
               trees ? &trees->of(*instance.mesh) : nullptr);
  }
  impl_->first_trees = std::move(trees);
  impl_->max_first_rays = triangles / kTrianglesPerFirstRay;
  impl_->calc_bounds(boxes_M);
  impl_->calc_boxes(boxes_M);
}

MeshRays::MeshRays(std::span<const MeshInstance> meshes, double reach_m)
    : impl_(std::make_unique<Impl>()) {
  if (meshes.empty()) return;
  impl_->margin_m = calc_margin_m(reach_m);
  impl_->open_device();
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    impl_->moving_M.try_emplace(meshes[i].mesh.get(), meshes[i].mesh->bounds());
    impl_->add(meshes[i], static_cast<int>(i), false);
  }
  move();
}

void MeshRays::move() {
  if (impl_->placed.empty()) return;
  impl_->ensure_trees();
  for (std::size_t i = 0; i < impl_->placed.size(); ++i) {
    PlacedMesh& entry = impl_->placed[i];
    RTCGeometry geometry = rtcGetGeometry(impl_->scene, static_cast<unsigned>(i));
    Impl::set_transform(geometry, *entry.instance);
    rtcCommitGeometry(geometry);
    Impl::settle(entry);
  }
  impl_->calc_bounds(impl_->moving_M);
  rtcCommitScene(impl_->scene);
}

MeshRays::~MeshRays() = default;

void MeshRays::prepare() const {
  if (!empty()) impl_->ensure_trees();
}

bool MeshRays::empty() const {
  return impl_->placed.empty();
}

std::optional<RayHit> MeshRays::cast(const Vector3d& p_W, const Vector3d& dir_W,
                                     double max_distance_m, SurfaceMask mask) const {
  RayLane lane;
  if (!impl_->begin({p_W, dir_W, max_distance_m}, lane)) return std::nullopt;
  if (impl_->cast_without_trees(lane, mask)) return impl_->hit_of(lane);
  impl_->ensure_trees();
  RayCast cast = impl_->make_cast(&lane);
  const Vector3d p_start_W = p_W + lane.tree_start_m * dir_W;
  RTCRayHit ray;
  ray.ray.org_x = static_cast<float>(p_start_W.x());
  ray.ray.org_y = static_cast<float>(p_start_W.y());
  ray.ray.org_z = static_cast<float>(p_start_W.z());
  ray.ray.dir_x = static_cast<float>(dir_W.x());
  ray.ray.dir_y = static_cast<float>(dir_W.y());
  ray.ray.dir_z = static_cast<float>(dir_W.z());
  ray.ray.tnear = 0.0f;
  ray.ray.tfar = static_cast<float>(max_distance_m - lane.tree_start_m + impl_->margin_m);
  ray.ray.mask = mask;
  ray.ray.time = 0.0f;
  ray.ray.id = 0;
  ray.ray.flags = 0;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &cast, &ray);
  return impl_->hit_of(lane);
}

void MeshRays::cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                         SurfaceMask mask) const {
  VINEROW_DEMAND(hits.size() == rays.size());
  impl_->cast_packets(
      rays, mask,
      [this](const int* valid, RayCast& cast, RTCRayHit8& packet) {
        rtcIntersect8(valid, impl_->scene, &cast, &packet);
      },
      [&](std::size_t i, const RayLane& lane) { hits[i] = impl_->hit_of(lane); });
}

void MeshRays::find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                            SurfaceMask mask) const {
  VINEROW_DEMAND(blocked.size() == rays.size());
  impl_->cast_packets(
      rays, mask,
      [this](const int* valid, RayCast& cast, RTCRayHit8& packet) {
        rtcOccluded8(valid, impl_->scene, &cast, &packet.ray);
      },
      [&](std::size_t i, const RayLane& lane) { blocked[i] = lane.has_hit(); });
}

}  // namespace vinerow::physics
