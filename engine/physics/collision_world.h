#pragma once
/// Bullet's collision detection and contact solver, without its world's bookkeeping.
///
/// btDiscreteDynamicsWorld walks all collision objects several times a step (islands, activation,
/// bounding boxes): with thousands of posts and trunks that costs more than the physics. Here only
/// moving bodies are touched: update their boxes, let the broad phase find pairs, run the narrow
/// phase, give all manifolds to one sequential-impulse solve.
///
/// Determinism: one thread; the solver gets the manifolds in the order of their objects' numbers
/// (what m_deterministicOverlappingPairs is for, but without its heap allocation each step).

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "engine/physics/settings.h"
#include "engine/physics/static_scene.h"

namespace vinerow::physics {

class CollisionWorld {
 public:
  /// @param scene  outlives this object
  CollisionWorld(const PhysicsSettings& settings, const StaticScene& scene);
  ~CollisionWorld();
  CollisionWorld(const CollisionWorld&) = delete;
  CollisionWorld& operator=(const CollisionWorld&) = delete;

  /// @param body  outlives this object; its user index is kept
  void add_body(btRigidBody& body);
  /// Drops contact points of before, e.g. after the body was placed elsewhere.
  void forget_contacts(btRigidBody& body);

  /// Lets a body meet moving bodies alone, or everything again.
  void ignore_statics(btRigidBody& body, bool ignore);

  /// Finds contacts at the poses the bodies have now. @returns true if some contact may push
  bool find_contacts();
  /// Changes the bodies' velocities (and, to undo overlaps, poses) so that contacts hold.
  void solve_contacts(double dt_s);

  int manifold_count() const;
  const btPersistentManifold& manifold(int index) const;

 private:
  class Dispatcher;

  btDefaultCollisionConfiguration configuration_;
  std::unique_ptr<Dispatcher> dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btContactSolverInfo solver_info_;
  std::vector<std::unique_ptr<btCollisionObject>> statics_;
  std::unique_ptr<btCollisionWorld> world_;
  std::vector<btRigidBody*> bodies_;
  std::vector<btCollisionObject*> movable_;       ///< scratch of solve_contacts
  std::vector<btPersistentManifold*> manifolds_;  ///< with points, of the last find_contacts
  std::vector<btPersistentManifold*> pushing_;    ///< those of them that push, in solving order
};

}  // namespace vinerow::physics
