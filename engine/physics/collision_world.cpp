#include "engine/physics/collision_world.h"

#include <algorithm>

namespace vinerow::physics {

/// Sets the distance up to which contact points are kept, per world: Bullet has it as a global.
class CollisionWorld::Dispatcher : public btCollisionDispatcher {
 public:
  Dispatcher(btCollisionConfiguration* configuration, double breaking_threshold_m)
      : btCollisionDispatcher(configuration), breaking_threshold_m_(breaking_threshold_m) {}

  btPersistentManifold* getNewManifold(const btCollisionObject* a,
                                       const btCollisionObject* b) override {
    btPersistentManifold* manifold = btCollisionDispatcher::getNewManifold(a, b);
    manifold->setContactBreakingThreshold(breaking_threshold_m_);
    return manifold;
  }
  double breaking_threshold_m() const { return breaking_threshold_m_; }

 private:
  double breaking_threshold_m_;
};

CollisionWorld::CollisionWorld(const PhysicsSettings& settings, const WorldModel& world)
    : dispatcher_(
          std::make_unique<Dispatcher>(&configuration_, settings.contact_breaking_threshold_m)),
      statics_(world),
      world_(std::make_unique<btCollisionWorld>(dispatcher_.get(), &broadphase_, &configuration_)) {
  solver_info_.m_numIterations = settings.solver_iterations;
  solver_info_.m_linearSlop = settings.linear_slop_m;
  // Overlaps are undone by moving the bodies, never by a velocity: a push-out adds no energy.
  solver_info_.m_splitImpulse = 1;
  solver_info_.m_splitImpulsePenetrationThreshold = 0.0;
  solver_info_.m_restitutionVelocityThreshold = settings.restitution_threshold_mps;
  // Two directions make sticking hold in every direction, not only along the last slip.
  solver_info_.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS;
  for (const auto& object : statics_.objects()) {
    world_->addCollisionObject(object.get(), btBroadphaseProxy::StaticFilter,
                               btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
  }
  manifolds_.reserve(256);
  pushing_.reserve(256);
}

CollisionWorld::~CollisionWorld() {
  for (btRigidBody* body : bodies_) world_->removeCollisionObject(body);
  for (const auto& object : statics_.objects()) world_->removeCollisionObject(object.get());
}

void CollisionWorld::add_body(btRigidBody& body) {
  world_->addCollisionObject(&body, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter);
  bodies_.push_back(&body);
  movable_.reserve(bodies_.size());
}

void CollisionWorld::forget_contacts(btRigidBody& body) {
  for (int i = 0; i < dispatcher_->getNumManifolds(); ++i) {
    btPersistentManifold* manifold = dispatcher_->getManifoldByIndexInternal(i);
    if (manifold->getBody0() == &body || manifold->getBody1() == &body) {
      manifold->clearManifold();
    }
  }
}

bool CollisionWorld::find_contacts() {
  for (btRigidBody* body : bodies_) {
    btVector3 low, high;
    body->getCollisionShape()->getAabb(body->getWorldTransform(), low, high);
    const btVector3 margin(dispatcher_->breaking_threshold_m(), dispatcher_->breaking_threshold_m(),
                           dispatcher_->breaking_threshold_m());
    broadphase_.setAabb(body->getBroadphaseHandle(), low - margin, high + margin,
                        dispatcher_.get());
  }
  broadphase_.calculateOverlappingPairs(dispatcher_.get());
  dispatcher_->dispatchAllCollisionPairs(broadphase_.getOverlappingPairCache(),
                                         world_->getDispatchInfo(), dispatcher_.get());

  manifolds_.clear();
  pushing_.clear();
  for (int i = 0; i < dispatcher_->getNumManifolds(); ++i) {
    btPersistentManifold* manifold = dispatcher_->getManifoldByIndexInternal(i);
    if (manifold->getNumContacts() == 0) continue;
    manifolds_.push_back(manifold);
  }
  // Insertion sort: stable, in place, and the list is short and nearly sorted.
  const auto before = [](const btPersistentManifold* a, const btPersistentManifold* b) {
    const int a0 = a->getBody0()->getWorldArrayIndex(), b0 = b->getBody0()->getWorldArrayIndex();
    return a0 != b0 ? a0 < b0
                    : a->getBody1()->getWorldArrayIndex() < b->getBody1()->getWorldArrayIndex();
  };
  for (std::size_t i = 1; i < manifolds_.size(); ++i) {
    for (std::size_t j = i; j > 0 && before(manifolds_[j], manifolds_[j - 1]); --j) {
      std::swap(manifolds_[j], manifolds_[j - 1]);
    }
  }
  for (btPersistentManifold* manifold : manifolds_) {
    if (dispatcher_->needsResponse(manifold->getBody0(), manifold->getBody1())) {
      pushing_.push_back(manifold);
    }
  }
  return !pushing_.empty();
}

void CollisionWorld::solve_contacts(double dt_s) {
  movable_.clear();
  for (btRigidBody* body : bodies_) {
    if (body->hasContactResponse()) movable_.push_back(body);
  }
  solver_info_.m_timeStep = dt_s;
  solver_.solveGroup(movable_.data(), static_cast<int>(movable_.size()), pushing_.data(),
                     static_cast<int>(pushing_.size()), nullptr, 0, solver_info_, nullptr,
                     dispatcher_.get());
}

int CollisionWorld::manifold_count() const {
  return static_cast<int>(manifolds_.size());
}

const btPersistentManifold& CollisionWorld::manifold(int index) const {
  return *manifolds_[index];
}

}  // namespace vinerow::physics
