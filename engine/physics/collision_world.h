#pragma once
/// Bullet's collision detection and contact solver, without its world's bookkeeping.
///
/// btDiscreteDynamicsWorld visits all collision objects several times a step (islands, activation,
/// bounding boxes). With thousands of posts and trunks that costs more than the physics. This class
/// handles only moving bodies: it updates their boxes, lets the broad phase find pairs, runs the
/// narrow phase, and passes all manifolds to one sequential-impulse solve.
///
/// Determinism: one thread; the solver gets the manifolds in the order of their objects' numbers.
/// m_deterministicOverlappingPairs gives the same order, but allocates heap memory each step.

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
  /// Removes the body's old contact points, e.g. after it was moved.
  void forget_contacts(btRigidBody& body);

  /// If `ignore` is true, the body collides only with moving bodies; if false, with everything.
  void ignore_statics(btRigidBody& body, bool ignore);

  /// Finds contacts at the bodies' current poses. @returns true if a contact may push
  bool find_contacts();
  /// Changes the bodies' velocities (and, to remove overlaps, their poses) so that contacts hold.
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
  std::vector<btPersistentManifold*> manifolds_;  ///< manifolds with points, from the last
                                                  ///< find_contacts
  std::vector<btPersistentManifold*> pushing_;    ///< manifolds that push, in solving order
};

}  // namespace vinerow::physics
