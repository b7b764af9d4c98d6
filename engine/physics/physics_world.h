#pragma once
/// Rigid bodies and contact on Bullet, in double precision. All other code uses the engine through
/// this class.
///
/// Static geometry comes from the WorldModel: the height field and every mesh with `collides`. The
/// canopy does not push, but rays and distances include it. Wires push and are included in
/// distances; rays miss them. Vehicles and tests add dynamic bodies. README.md documents accuracy
/// and limits.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/core/time.h"
#include "engine/physics/settings.h"

namespace vinerow::physics {

struct BoxShape {
  Eigen::Vector3d half_extents_m;
};
struct SphereShape {
  double radius_m;
};
/// Axis along y of the shape's frame.
struct CylinderShape {
  double radius_m;
  double half_width_m;
};
struct HullShape {
  std::vector<Eigen::Vector3d> points_B;
};
struct NoShape {};
using Shape = std::variant<NoShape, BoxShape, SphereShape, CylinderShape, HullShape>;

/// A shape and its pose in the body frame.
struct PlacedShape {
  Shape shape;
  Pose X_BS;
};

/// Interpolation of the forces on a body between two steps.
enum class ForceSampling : std::uint8_t {
  /// Samples of a smooth function of time, as from springs, tyres, rotors, wings: steps are
  /// velocity Verlet, second order, and springs keep their energy. A force that jumps acts half a
  /// step early.
  kSmooth,
  /// Constant over each step: exact for forces that really are constant. A spring sampled like this
  /// gains energy at the rate w^2 dt / 2.
  kHeld,
};

struct BodySpec {
  std::string name;      ///< for contacts and errors, e.g. "rover"
  double mass_kg = 1.0;  ///< > 0
  Eigen::Matrix3d inertia_B =
      Eigen::Matrix3d::Identity();  ///< about the centre of mass, kg m2, positive definite
  Pose X_WB;                        ///< B's origin is the centre of mass
  Eigen::Vector3d v_WB_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_W = Eigen::Vector3d::Zero();
  std::vector<PlacedShape> shapes;  ///< empty: collides with nothing
  /// Coulomb coefficient against static geometry; between two bodies the product of both. >= 0
  double friction = 0.6;
  /// Rebound speed / impact speed against static geometry; between two bodies the product. 0..1
  double restitution = 0.0;
  ForceSampling force_sampling = ForceSampling::kSmooth;
};

struct BodyId {
  int index = -1;
};

struct BodyState {
  Pose X_WB;
  Eigen::Vector3d v_WB_W;
  Eigen::Vector3d w_WB_W;
};

/// One contact point of the last step.
struct Contact {
  BodyId body;
  BodyId other;          ///< index -1: static geometry
  SurfaceClass surface;  ///< of the other side (kVehicle for bodies)
  Eigen::Vector3d p_W;
  Eigen::Vector3d normal_W;  ///< unit, from other to body
  double depth_m;            ///< > 0: overlapping
  double impulse_Ns;         ///< along the normal; 0 for kinematic bodies
  int mesh = -1;             ///< index into WorldModel::meshes; -1: height field or another body
};

/// Ground under a wheel.
struct GroundHit {
  double distance_m = 0.0;                              ///< along the probe
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< unit, against the probe
  SurfaceClass surface = SurfaceClass::kTerrain;
};

class StaticScene;

class PhysicsWorld {
 public:
  /// @param world  outlives this object, which reads its heights and meshes in place
  /// @throws ConfigError on bad geometry, e.g. "mesh 'x' has no triangles"
  PhysicsWorld(const PhysicsSettings& settings, const WorldModel& world);
  /// Uses an existing scene, which other worlds may use at the same time.
  /// @param scene  not null
  /// @param world  outlives this object: the scene's world, or one that differs from it only in
  /// wind
  PhysicsWorld(const PhysicsSettings& settings, std::shared_ptr<const StaticScene> scene,
               const WorldModel& world);
  ~PhysicsWorld();

  /// @throws ConfigError that names the body if a mass, inertia, shape or state is out of range
  BodyId add_body(const BodySpec& spec);
  BodyState state(BodyId body) const;
  /// For the start, and for kinematic vehicles, which place their body themselves. A dynamic body
  /// loses its contacts and the load of its previous step.
  void set_state(BodyId body, const BodyState& state);
  /// Makes a body kinematic: set_state places it each step and it pushes nothing. Its overlaps are
  /// reported as contacts.
  void set_kinematic(BodyId body, bool kinematic);
  bool is_kinematic(BodyId body) const;
  /// Makes a body parked: at rest; other bodies collide with it as with a post. It does not collide
  /// with static geometry, so it costs almost nothing.
  /// @param held  false: dynamic again, from rest
  void set_held(BodyId body, bool held);

  /// Accumulated until the next step. Forces in W at a point in W. The world adds gravity.
  void add_force_W(BodyId body, const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W);
  void add_central_force_W(BodyId body, const Eigen::Vector3d& f_W);
  void add_torque_W(BodyId body, const Eigen::Vector3d& tau_W);

  /// One step of exactly dt. Does not throw. A non-finite state stays non-finite, so that the
  /// caller can detect it.
  void step(Duration dt);
  /// Mean acceleration of the centre of mass over the last step: gravity, added forces, contacts.
  Eigen::Vector3d acceleration_W(BodyId body) const;

  /// First rigid ground (terrain, obstacle, post, trunk) along a short ray, queried by each wheel
  /// several times a step. About 50 ns on a height field away from meshes. No heap.
  /// @param dir_W  unit, usually close to -z
  std::optional<GroundHit> probe_ground(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                                        double max_distance_m) const;

  std::span<const Contact> contacts() const;
  /// Name of the other side: a body's, a mesh instance's, or "terrain".
  const std::string& contact_name(const Contact& contact) const;
  int body_count() const;
  const std::string& body_name(BodyId body) const;

  /// Rays and distances against the static geometry.
  const SceneQuery& scene() const;
  /// Surfaces as light meets them. Built at the first call.
  const RayScene& light_scene() const;
  const PhysicsSettings& settings() const;
  const WorldModel& world_model() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::physics
