#pragma once
/// Rigid bodies and contact on Bullet, double precision. The only class through which the rest
/// meets the engine.
///
/// Static geometry comes from the WorldModel: the height field and every mesh with `collides`
/// (canopy excepted: it is seen by rays and distances but does not push). Dynamic bodies are added
/// by vehicles and tests.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/api/scene_query.h"
#include "engine/api/world_model.h"
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

struct BodySpec {
  std::string name;      ///< for contacts and errors, e.g. "rover"
  double mass_kg = 1.0;  ///< > 0
  Eigen::Matrix3d inertia_B =
      Eigen::Matrix3d::Identity();  ///< about the centre of mass, kg m2, positive definite
  Pose X_WB;                        ///< B's origin is the centre of mass
  Eigen::Vector3d v_WB_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_W = Eigen::Vector3d::Zero();
  std::vector<PlacedShape> shapes;  ///< empty: collides with nothing
  double friction = 0.6;
  double restitution = 0.0;
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
  Eigen::Vector3d normal_W;  ///< from other to body
  double depth_m;            ///< > 0: overlapping
  double impulse_Ns;
  int mesh = -1;  ///< index into WorldModel::meshes; -1: height field or another body
};

/// What a wheel stands on.
struct GroundHit {
  double distance_m = 0.0;                              ///< along the probe
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< unit, against the probe
  SurfaceClass surface = SurfaceClass::kTerrain;
};

class PhysicsWorld {
 public:
  /// @throws ConfigError on a mesh without triangles or a mass that is not > 0
  PhysicsWorld(const PhysicsSettings& settings, const WorldModel& world);
  ~PhysicsWorld();

  BodyId add_body(const BodySpec& spec);
  BodyState state(BodyId body) const;
  /// Used at the start and by kinematic vehicles, which place their body themselves.
  void set_state(BodyId body, const BodyState& state);
  /// A body that is placed by set_state each step and pushes nothing (kinematic fidelity).
  void set_kinematic(BodyId body, bool kinematic);

  /// Accumulate until the next step. Forces in W at a point in W. Gravity is added by the world.
  void add_force_W(BodyId body, const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W);
  void add_central_force_W(BodyId body, const Eigen::Vector3d& f_W);
  void add_torque_W(BodyId body, const Eigen::Vector3d& tau_W);

  /// One step of exactly dt.
  void step(Duration dt);

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
