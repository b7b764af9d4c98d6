#pragma once
/// Rigid bodies and contact on Bullet, double precision. The only class through which the rest
/// meets the engine.
///
/// Static geometry comes from the WorldModel: the height field and every mesh with `collides`
/// (canopy excepted: it is seen by rays and distances but does not push). Wires push and are known
/// to distances; rays miss them.
/// Dynamic bodies are added by vehicles and tests. README.md tells accuracy and limits.

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

/// A shape's place in the body frame.
struct PlacedShape {
  Shape shape;
  Pose X_BS;
};

/// How the forces on a body are read between two steps.
enum class ForceSampling : std::uint8_t {
  /// Samples of a smooth course, as from springs, tyres, rotors, wings: steps are velocity Verlet,
  /// second order, and springs keep their energy. A force that jumps acts half a step early.
  kSmooth,
  /// Constant over each step: exact for forces that really are. A spring sampled like this gains
  /// energy at the rate w^2 dt / 2.
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

/// What a wheel stands on.
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
  /// On a scene that is built already, and that others may use at the same time.
  /// @param scene  not null
  /// @param world  outlives this object: the scene's, or one that differs from it in wind alone
  PhysicsWorld(const PhysicsSettings& settings, std::shared_ptr<const StaticScene> scene,
               const WorldModel& world);
  ~PhysicsWorld();

  /// @throws ConfigError on a mass, inertia, shape or state out of range, naming the body
  BodyId add_body(const BodySpec& spec);
  BodyState state(BodyId body) const;
  /// Used at the start and by kinematic vehicles, which place their body themselves. A dynamic
  /// body forgets its contacts and the course of its forces.
  void set_state(BodyId body, const BodyState& state);
  /// A body that is placed by set_state each step and pushes nothing (kinematic fidelity). Its
  /// overlaps are reported as contacts.
  void set_kinematic(BodyId body, bool kinematic);
  bool is_kinematic(BodyId body) const;
  /// A parked body: at rest, meets other bodies as a post would, and static geometry not at all, so
  /// that it costs next to nothing. @param held  false: dynamic again, from rest
  void set_held(BodyId body, bool held);

  /// Accumulate until the next step. Forces in W at a point in W. Gravity is added by the world.
  void add_force_W(BodyId body, const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W);
  void add_central_force_W(BodyId body, const Eigen::Vector3d& f_W);
  void add_torque_W(BodyId body, const Eigen::Vector3d& tau_W);

  /// One step of exactly dt. Does not throw; a state that is not finite stays so, for the caller
  /// to find.
  void step(Duration dt);
  /// Mean acceleration of the centre of mass over the last step: gravity, forces added, contacts.
  Eigen::Vector3d acceleration_W(BodyId body) const;

  /// First rigid ground (terrain, obstacle, post, trunk) along a short ray: what a wheel asks
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
  const PhysicsSettings& settings() const;
  const WorldModel& world_model() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::physics
