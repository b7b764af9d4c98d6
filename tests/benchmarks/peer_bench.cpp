/// What we do against what the libraries below us do alone, alternately in one process: the ratio
/// does not depend on the machine's speed.

#include <benchmark/benchmark.h>
#include <btBulletDynamicsCommon.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <ctime>

#include "engine/api/map.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "engine/physics/check_world.h"
#include "engine/physics/static_scene.h"
#include "tests/benchmarks/bench_worlds.h"
#include "tests/benchmarks/driving_rover.h"

// clang-format off: after the header that it needs
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletDynamics/Vehicle/btRaycastVehicle.h>
// clang-format on

namespace vinerow::peer_bench {
namespace {

double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Calls both in turn. @param ours,peer  do `count` pieces of work each
template <class Ours, class Peer>
void compare(benchmark::State& state, double count, const char* unit, double units_per_s,
             const Ours& ours, const Peer& peer) {
  double ours_s = 0.0, peer_s = 0.0, pieces = 0.0;
  for (auto _ : state) {
    const double start_s = cpu_s();
    ours();
    const double middle_s = cpu_s();
    peer();
    peer_s += cpu_s() - middle_s;
    ours_s += middle_s - start_s;
    pieces += count;
  }
  state.counters[std::string("ours_") + unit] = units_per_s * ours_s / pieces;
  state.counters[std::string("peer_") + unit] = units_per_s * peer_s / pieces;
  state.counters["ratio"] = ours_s / peer_s;
}

constexpr Duration kStep{1'000'000};
constexpr int kSteps = 1000;
/// Sign of a force that drives Bullet's vehicle along its x axis.
constexpr double kForward = -1.0;

/// Bullet's own vehicle: a box on four rays with springs, on Bullet's height field.
class BulletVehicle {
 public:
  explicit BulletVehicle(const HeightField& field)
      : terrain_shape_(field.columns, field.rows, field.heights_m.data(), -1.0, 1.0, 2, true),
        chassis_shape_(btVector3(0.4, 0.25, 0.15)),
        terrain_(btRigidBody::btRigidBodyConstructionInfo(0.0, nullptr, &terrain_shape_)) {
    terrain_shape_.setLocalScaling({field.cell_m, field.cell_m, 1.0});
    world_.setGravity({0.0, 0.0, -9.81});
    world_.addRigidBody(&terrain_);
    btVector3 inertia;
    constexpr double kMass_kg = 60.0;
    chassis_shape_.calculateLocalInertia(kMass_kg, inertia);
    chassis_ = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(kMass_kg, nullptr, &chassis_shape_, inertia));
    chassis_->setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0.0, 0.0, 0.8)));
    chassis_->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(chassis_.get());
    // Sags by 25 mm of its 200 mm; nearly critically damped.
    tuning_.m_suspensionStiffness = 100.0;
    tuning_.m_suspensionCompression = tuning_.m_suspensionDamping = 8.0;
    caster_ = std::make_unique<btDefaultVehicleRaycaster>(&world_);
    vehicle_ = std::make_unique<btRaycastVehicle>(tuning_, chassis_.get(), caster_.get());
    vehicle_->setCoordinateSystem(1, 2, 0);
    for (const double x : {0.25, -0.25}) {
      for (const double y : {0.28, -0.28}) {
        vehicle_->addWheel({x, y, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, 0.2, 0.15, tuning_,
                           x > 0.0);
      }
    }
    world_.addVehicle(vehicle_.get());
    // Circles, as the rover drives.
    for (const int front : {0, 1}) vehicle_->setSteeringValue(0.2, front);
  }
  ~BulletVehicle() {
    world_.removeVehicle(vehicle_.get());
    world_.removeRigidBody(chassis_.get());
    world_.removeRigidBody(&terrain_);
  }

  void step() {
    // Towards the rover's speed.
    const btVector3 forward_W = chassis_->getWorldTransform().getBasis().getColumn(0);
    const double speed_mps = forward_W.dot(chassis_->getLinearVelocity());
    for (int wheel = 0; wheel < 4; ++wheel) {
      vehicle_->applyEngineForce(kForward * 40.0 * (0.6 - speed_mps), wheel);
    }
    world_.stepSimulation(kStep.s(), 0);
  }
  double height_m() const { return chassis_->getWorldTransform().getOrigin().z(); }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btHeightfieldTerrainShape terrain_shape_;
  btBoxShape chassis_shape_;
  btRigidBody terrain_;
  std::unique_ptr<btRigidBody> chassis_;
  btRaycastVehicle::btVehicleTuning tuning_;
  std::unique_ptr<btVehicleRaycaster> caster_;
  std::unique_ptr<btRaycastVehicle> vehicle_;
};

/// A step of 1 ms with one rover: our tyres with slip, friction ellipse and motors against Bullet's
/// raycast vehicle.
void step_of_a_rover_against_bullet(benchmark::State& state) {
  const WorldModel model = bench::rolling_field();
  bench::DrivingRover rover(model, kStep);
  BulletVehicle peer(*model.terrain);
  compare(
      state, kSteps, "us", 1e6,
      [&] {
        for (int k = 0; k < kSteps; ++k) rover.step();
      },
      [&] {
        for (int k = 0; k < kSteps; ++k) peer.step();
      });
  // It drives on the ground and has not fallen through.
  state.counters["peer_height_m"] = peer.height_m();
}
BENCHMARK(step_of_a_rover_against_bullet)->Unit(benchmark::kMillisecond);

/// Embree's own triangles in single precision, and the terrain as triangles.
class EmbreeScene {
 public:
  /// @param has  whether a mesh is in the scene
  EmbreeScene(const WorldModel& world, bool (&has)(const MeshInstance&))
      : device_(rtcNewDevice("threads=1")) {
    scene_ = rtcNewScene(device_);
    for (const MeshInstance& instance : world.meshes) {
      if (!has(instance)) continue;
      std::vector<Eigen::Vector3f> vertices;
      for (const Eigen::Vector3f& vertex : instance.mesh->vertices) {
        vertices.push_back((instance.X_WM * vertex.cast<double>()).cast<float>());
      }
      add(vertices, instance.mesh->triangles);
    }
    const HeightField& field = *world.terrain;
    std::vector<Eigen::Vector3f> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (int j = 0; j < field.rows; ++j) {
      for (int i = 0; i < field.columns; ++i) {
        vertices.emplace_back(static_cast<float>(field.corner_W.x() + i * field.cell_m),
                              static_cast<float>(field.corner_W.y() + j * field.cell_m),
                              field.heights_m[static_cast<std::size_t>(j * field.columns + i)]);
        if (i + 1 == field.columns || j + 1 == field.rows) continue;
        const auto a = static_cast<std::uint32_t>(j * field.columns + i);
        const auto above = a + static_cast<std::uint32_t>(field.columns);
        triangles.push_back({a, a + 1, above + 1});
        triangles.push_back({a, above + 1, above});
      }
    }
    add(vertices, triangles);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  bool hits(const Eigen::Vector3d& p, const Eigen::Vector3d& dir, double max_distance_m) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(p.x());
    ray.ray.org_y = static_cast<float>(p.y());
    ray.ray.org_z = static_cast<float>(p.z());
    ray.ray.dir_x = static_cast<float>(dir.x());
    ray.ray.dir_y = static_cast<float>(dir.y());
    ray.ray.dir_z = static_cast<float>(dir.z());
    ray.ray.tfar = static_cast<float>(max_distance_m);
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

  /// Number of rays that hit something. @param rays  a multiple of 8, neighbours in packets
  int count_hits(std::span<const SceneRay> rays) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(32) const int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
    int hits = 0;
    for (std::size_t first = 0; first < rays.size(); first += 8) {
      RTCRayHit8 packet{};
      for (std::size_t k = 0; k < 8; ++k) {
        const SceneRay& ray = rays[first + k];
        packet.ray.org_x[k] = static_cast<float>(ray.p_W.x());
        packet.ray.org_y[k] = static_cast<float>(ray.p_W.y());
        packet.ray.org_z[k] = static_cast<float>(ray.p_W.z());
        packet.ray.dir_x[k] = static_cast<float>(ray.dir_W.x());
        packet.ray.dir_y[k] = static_cast<float>(ray.dir_W.y());
        packet.ray.dir_z[k] = static_cast<float>(ray.dir_W.z());
        packet.ray.tfar[k] = static_cast<float>(ray.max_distance_m);
        packet.ray.mask[k] = ~0u;
        packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect8(valid, scene_, &context, &packet);
      for (const unsigned geometry : packet.hit.geomID) hits += geometry != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
  }

 private:
  void add(const std::vector<Eigen::Vector3f>& vertices,
           const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                       sizeof(Eigen::Vector3f), vertices.size());
    std::copy(vertices.begin(), vertices.end(), static_cast<Eigen::Vector3f*>(to));
    to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                 sizeof(triangles[0]), triangles.size());
    std::copy(triangles.begin(), triangles.end(), static_cast<std::array<std::uint32_t, 3>*>(to));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_;
  RTCScene scene_;
};

/// 4 m rays in all horizontal directions from alleys of Parcel F: ours, exact in double precision,
/// against Embree's triangles.
void ray_of_4m_against_embree(benchmark::State& state) {
  const std::shared_ptr<const WorldModel> model = bench::make_world("vineyard");
  const physics::StaticScene scene(model);
  scene.prepare();
  const EmbreeScene peer(*model, physics::is_seen_by_rays);
  const auto& line = model->rows->alleys[7].line_W;
  RandomStream random(1, "", "rays");
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> rays;
  for (int i = 0; i < 4096; ++i) {
    const double share = random.uniform(0.1, 0.9), angle = random.uniform(0.0, 6.28);
    Eigen::Vector3d p = line.front() + share * (line.back() - line.front());
    p.z() = model->terrain->height_m(p.x(), p.y()) + 1.0;
    rays.emplace_back(p, Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
  }
  std::int64_t our_hits = 0, peer_hits = 0, count = 0;
  // Often enough in turn that each finds its trees in the cache.
  constexpr int kTurns = 25;
  compare(
      state, kTurns * static_cast<double>(rays.size()), "ns", 1e9,
      [&] {
        for (int turn = 0; turn < kTurns; ++turn) {
          for (const auto& [p, dir] : rays) {
            our_hits += scene.queries().cast_ray(p, dir, 4.0, kAllSurfaces).has_value();
          }
          count += static_cast<std::int64_t>(rays.size());
        }
      },
      [&] {
        for (int turn = 0; turn < kTurns; ++turn) {
          for (const auto& [p, dir] : rays) peer_hits += peer.hits(p, dir, 4.0);
        }
      });
  state.counters["our_hits"] = static_cast<double>(our_hits) / static_cast<double>(count);
  state.counters["peer_hits"] = static_cast<double>(peer_hits) / static_cast<double>(count);
}
BENCHMARK(ray_of_4m_against_embree)->Unit(benchmark::kMillisecond);

/// The rays of a picture of 640 x 480 pixels among leaves, 60 deg wide, in packets of 4 x 2 pixels:
/// ours, exact in double precision, against Embree's triangles. Nothing is made of the hits.
void picture_among_leaves_against_embree(benchmark::State& state) {
  const std::shared_ptr<const WorldModel> model = bench::vineyard_in_leaf();
  const physics::StaticScene scene(model);
  const RayScene& ours = scene.light();
  const EmbreeScene peer(*model, physics::is_seen_by_light);
  const Pose X_WB = bench::place_in_alley(*model);
  constexpr int kWidth = 640, kHeight = 480, kBlockWidth = 4, kBlockHeight = 2;
  const double per_pixel = 2.0 * std::tan(rad_from_deg(30.0)) / kWidth;
  std::vector<SceneRay> rays;
  for (int y = 0; y < kHeight; y += kBlockHeight) {
    for (int x = 0; x < kWidth; x += kBlockWidth) {
      for (int k = 0; k < kBlockWidth * kBlockHeight; ++k) {
        const double right = per_pixel * (x + k % kBlockWidth + 0.5 - 0.5 * kWidth);
        const double down = per_pixel * (y + k / kBlockWidth + 0.5 - 0.5 * kHeight);
        const Eigen::Vector3d dir_B = Eigen::Vector3d(1.0, -right, -down).normalized();
        rays.push_back({X_WB.p, X_WB.q * dir_B, 1000.0});
      }
    }
  }
  std::vector<std::optional<RayHit>> hits(rays.size());
  ours.cast_rays(rays, hits);
  state.counters["our_hits"] = static_cast<double>(
      std::count_if(hits.begin(), hits.end(), [](const auto& hit) { return hit.has_value(); }));
  state.counters["peer_hits"] = peer.count_hits(rays);
  int peer_hits = 0;
  compare(
      state, 1.0, "ms", 1e3, [&] { ours.cast_rays(rays, hits); },
      [&] { benchmark::DoNotOptimize(peer_hits += peer.count_hits(rays)); });
}
BENCHMARK(picture_among_leaves_against_embree)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vinerow::peer_bench
