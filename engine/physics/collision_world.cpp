#include "engine/physics/collision_world.h"

#include <algorithm>

#include "engine/api/height_field.h"
#include "engine/api/world_model.h"
#include "engine/physics/bullet_convert.h"
#include "engine/physics/mesh_gate.h"
#include "engine/physics/static_geometry.h"
#include "engine/physics/terrain_gate.h"

namespace vinerow::physics {
namespace {

/// Receives contact points from the narrow phase and filters them by ContactNormals.
class CheckedResult : public btManifoldResult {
 public:
  CheckedResult(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                const ContactNormals& normals)
      : btManifoldResult(a, b), normals_(normals) {
    // The base class leaves these unset, and shapes without parts never set them.
    setShapeIdentifiersA(-1, -1);
    setShapeIdentifiersB(-1, -1);
  }

  void addContactPoint(const btVector3& normal_B_W, const btVector3& p_B_W,
                       btScalar depth) override {
    // A and B are the sides of the manifold; parts and triangles are those of the pair, which may
    // be swapped.
    const btCollisionObject& a = *m_manifoldPtr->getBody0();
    const btCollisionObject& b = *m_manifoldPtr->getBody1();
    if (!a.isStaticObject() && !b.isStaticObject()) {
      btManifoldResult::addContactPoint(normal_B_W, p_B_W, depth);
      return;
    }
    const bool on_a = a.isStaticObject();
    const bool static_is_first = getBody0Wrap()->getCollisionObject()->isStaticObject();
    const btVector3 p_W = on_a ? p_B_W + normal_B_W * depth : p_B_W;
    const btVector3 normal_W = on_a ? -normal_B_W : normal_B_W;
    const std::optional<Eigen::Vector3d> corrected_W =
        normals_.correct((on_a ? a : b).getUserIndex(), static_is_first ? m_index0 : m_index1,
                         from_bullet(p_W), from_bullet(normal_W), depth);
    if (!corrected_W) return;
    const btVector3 n_W = to_bullet(*corrected_W);
    btManifoldResult::addContactPoint(on_a ? -n_W : n_W, on_a ? p_W + n_W * depth : p_W, depth);
  }

 private:
  const ContactNormals& normals_;
};

/// Bullet allocates and clears memory for 4096 pairs in advance: most of the time that a reset of a
/// session takes. Beyond these pools it takes memory as it needs it.
btDefaultCollisionConstructionInfo small_pools() {
  constexpr int kPairs = 128;
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = kPairs;
  info.m_defaultMaxCollisionAlgorithmPoolSize = kPairs;
  return info;
}

}  // namespace

/// Sets the distance up to which contact points are kept for this world; Bullet has it as a global.
class CollisionWorld::Dispatcher : public btCollisionDispatcher {
 public:
  Dispatcher(btCollisionConfiguration* configuration, double breaking_threshold_m,
             const ContactNormals& normals, const HeightField* terrain)
      : btCollisionDispatcher(configuration),
        breaking_threshold_m_(breaking_threshold_m),
        normals_(normals),
        terrain_(terrain) {
    setNearCallback(&Dispatcher::find_pair_contacts);
  }

  btPersistentManifold* getNewManifold(const btCollisionObject* a,
                                       const btCollisionObject* b) override {
    btPersistentManifold* manifold = btCollisionDispatcher::getNewManifold(a, b);
    manifold->setContactBreakingThreshold(breaking_threshold_m_);
    return manifold;
  }
  double breaking_threshold_m() const { return breaking_threshold_m_; }
  /// Takes the body's new pose: once per step, before its pairs.
  void follow(const btRigidBody& body) { mesh_gate_.follow(body); }

 private:
  /// Bullet's near callback with this file's result class.
  static void find_pair_contacts(btBroadphasePair& pair, btCollisionDispatcher& base,
                                 const btDispatcherInfo& info) {
    auto& dispatcher = static_cast<Dispatcher&>(base);
    auto* a = static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject);
    auto* b = static_cast<btCollisionObject*>(pair.m_pProxy1->m_clientObject);
    if (!dispatcher.needsCollision(a, b)) return;
    if (dispatcher.is_clear(*a, *b)) {
      if (pair.m_algorithm) {  // its contacts may still exist
        pair.m_algorithm->~btCollisionAlgorithm();
        dispatcher.freeCollisionAlgorithm(pair.m_algorithm);
        pair.m_algorithm = nullptr;
      }
      return;
    }
    const btCollisionObjectWrapper wrap_a(nullptr, a->getCollisionShape(), a,
                                          a->getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper wrap_b(nullptr, b->getCollisionShape(), b,
                                          b->getWorldTransform(), -1, -1);
    if (!pair.m_algorithm) {
      pair.m_algorithm =
          dispatcher.findAlgorithm(&wrap_a, &wrap_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    }
    if (!pair.m_algorithm) return;
    CheckedResult result(&wrap_a, &wrap_b, dispatcher.normals_);
    pair.m_algorithm->processCollision(&wrap_a, &wrap_b, info, &result);
  }

  /// True if one of the pair is the height field or a static mesh, and the other certainly does not
  /// touch it.
  bool is_clear(const btCollisionObject& a, const btCollisionObject& b) {
    const double margin_m = 2.0 * breaking_threshold_m_;
    if (a.isStaticObject() && mesh_gate_.is_clear(a, b, margin_m)) return true;
    if (b.isStaticObject() && mesh_gate_.is_clear(b, a, margin_m)) return true;
    if (!terrain_) return false;
    const auto is_terrain = [](const btCollisionObject& object) {
      return object.getCollisionShape()->getShapeType() == TERRAIN_SHAPE_PROXYTYPE;
    };
    if (is_terrain(a)) return is_clear_of_terrain(*terrain_, b, margin_m);
    return is_terrain(b) && is_clear_of_terrain(*terrain_, a, margin_m);
  }

  double breaking_threshold_m_;
  const ContactNormals& normals_;
  const HeightField* terrain_;
  MeshGate mesh_gate_;
};

CollisionWorld::CollisionWorld(const PhysicsSettings& settings, const StaticScene& scene)
    : configuration_(small_pools()),
      dispatcher_(std::make_unique<Dispatcher>(
          &configuration_, settings.contact_breaking_threshold_m, scene.normals(),
          scene.world().terrain ? &*scene.world().terrain : nullptr)),
      statics_(scene.geometry().make_objects()),
      world_(std::make_unique<btCollisionWorld>(dispatcher_.get(), &broadphase_, &configuration_)) {
  solver_info_.m_numIterations = settings.solver_iterations;
  solver_info_.m_linearSlop = settings.linear_slop_m;
  // Overlaps are removed by moving the bodies, not by a velocity, so a push-out adds no energy.
  solver_info_.m_splitImpulse = 1;
  solver_info_.m_splitImpulsePenetrationThreshold = 0.0;
  solver_info_.m_restitutionVelocityThreshold = settings.restitution_threshold_mps;
  // Two friction directions make sticking hold in every direction, not only along the last slip.
  solver_info_.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS;
  for (const auto& object : statics_) {
    world_->addCollisionObject(object.get(), btBroadphaseProxy::StaticFilter,
                               btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
  }
  manifolds_.reserve(256);
  pushing_.reserve(256);
}

CollisionWorld::~CollisionWorld() {
  for (btRigidBody* body : bodies_) world_->removeCollisionObject(body);
  for (const auto& object : statics_) world_->removeCollisionObject(object.get());
}

void CollisionWorld::add_body(btRigidBody& body) {
  world_->addCollisionObject(&body, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter);
  bodies_.push_back(&body);
  movable_.reserve(bodies_.size());
}

void CollisionWorld::ignore_statics(btRigidBody& body, bool ignore) {
  constexpr int kMoving = btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter;
  body.getBroadphaseHandle()->m_collisionFilterMask =
      ignore ? kMoving : btBroadphaseProxy::AllFilter;
  // Removes the body's pairs and finds them again.
  world_->refreshBroadphaseProxy(&body);
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
    dispatcher_->follow(*body);
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
    if (body->hasContactResponse() && !body->isStaticObject()) movable_.push_back(body);
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
