#include "engine/physics/physics_world.h"

#include <fmt/format.h>

#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/physics/body.h"
#include "engine/physics/bullet_convert.h"
#include "engine/physics/collision_world.h"
#include "engine/physics/static_scene.h"

namespace vinerow::physics {
namespace {

const PhysicsSettings& checked(const PhysicsSettings& settings) {
  if (settings.step.ns <= 0) {
    throw ConfigError(fmt::format("physics: step = {} ns, must be > 0", settings.step.ns));
  }
  if (settings.solver_iterations < 1) {
    throw ConfigError(fmt::format("physics: solver_iterations = {}, must be 1 or more",
                                  settings.solver_iterations));
  }
  return settings;
}

/// Non-owning pointer to a world that its owner keeps alive.
std::shared_ptr<const StaticScene> scene_of(const WorldModel& world) {
  return std::make_shared<const StaticScene>(
      std::shared_ptr<const WorldModel>(std::shared_ptr<const void>(), &world));
}

}  // namespace

struct PhysicsWorld::Impl {
  PhysicsSettings settings;
  std::shared_ptr<const StaticScene> scene;
  const WorldModel& world;
  Eigen::Vector3d gravity_W;
  std::vector<std::unique_ptr<Body>> bodies;
  CollisionWorld collisions;  // declared after the bodies: destroyed before them
  int bodies_with_shape = 0;
  std::vector<Contact> contacts;
  std::string terrain_name = "terrain";

  Impl(const PhysicsSettings& the_settings, std::shared_ptr<const StaticScene> the_scene,
       const WorldModel& the_world)
      : settings(the_settings),
        scene(std::move(the_scene)),
        world(the_world),
        gravity_W(0.0, 0.0, -the_settings.gravity_mps2),
        collisions(the_settings, *scene) {
    contacts.reserve(256);
  }

  Body& body(BodyId id) {
    VINEROW_ASSERT(id.index >= 0 && id.index < static_cast<int>(bodies.size()));
    return *bodies[id.index];
  }

  void read_contacts() {
    contacts.clear();
    for (int m = 0; m < collisions.manifold_count(); ++m) {
      const btPersistentManifold& manifold = collisions.manifold(m);
      const int index0 = manifold.getBody0()->getUserIndex2();
      const int index1 = manifold.getBody1()->getUserIndex2();
      // Body 0 is `body` unless it is static or the other one has the smaller number.
      const bool first = index0 >= 0 && (index1 < 0 || index0 < index1);
      const btCollisionObject& other = first ? *manifold.getBody1() : *manifold.getBody0();
      for (int k = 0; k < manifold.getNumContacts(); ++k) {
        const btManifoldPoint& point = manifold.getContactPoint(k);
        const double impulse_Ns = is_pushing(manifold) ? point.getAppliedImpulse() : 0.0;
        if (point.getDistance() > 0.0 && !(impulse_Ns > 0.0)) continue;
        Contact contact;
        contact.body = {first ? index0 : index1};
        contact.other = {first ? index1 : index0};
        contact.p_W = 0.5 * from_bullet(point.getPositionWorldOnA() + point.getPositionWorldOnB());
        contact.normal_W = from_bullet(point.m_normalWorldOnB) * (first ? 1.0 : -1.0);
        contact.depth_m = -point.getDistance();
        contact.impulse_Ns = impulse_Ns;
        contact.mesh = contact.other.index < 0 ? other.getUserIndex() : -1;
        contact.surface = contact.other.index >= 0 ? SurfaceClass::kVehicle
                          : contact.mesh < 0       ? SurfaceClass::kTerrain
                                                   : world.meshes[contact.mesh].surface;
        contacts.push_back(contact);
      }
    }
  }

  static bool is_pushing(const btPersistentManifold& manifold) {
    return manifold.getBody0()->hasContactResponse() && manifold.getBody1()->hasContactResponse();
  }
};

PhysicsWorld::PhysicsWorld(const PhysicsSettings& settings, const WorldModel& world)
    : PhysicsWorld(checked(settings), scene_of(world), world) {}

PhysicsWorld::PhysicsWorld(const PhysicsSettings& settings,
                           std::shared_ptr<const StaticScene> scene, const WorldModel& world)
    : impl_(std::make_unique<Impl>(checked(settings), std::move(scene), world)) {}

PhysicsWorld::~PhysicsWorld() = default;

BodyId PhysicsWorld::add_body(const BodySpec& spec) {
  const BodyId id{static_cast<int>(impl_->bodies.size())};
  impl_->bodies.push_back(std::make_unique<Body>(spec, id.index));
  if (btRigidBody* bullet = impl_->bodies.back()->bullet()) {
    impl_->collisions.add_body(*bullet);
    ++impl_->bodies_with_shape;
  }
  return id;
}

BodyState PhysicsWorld::state(BodyId body) const {
  return impl_->body(body).state();
}

void PhysicsWorld::set_state(BodyId body, const BodyState& state) {
  Body& changed = impl_->body(body);
  changed.set_state(state);
  if (changed.bullet() && !changed.is_kinematic()) {
    impl_->collisions.forget_contacts(*changed.bullet());
  }
}

void PhysicsWorld::set_kinematic(BodyId body, bool kinematic) {
  impl_->body(body).set_kinematic(kinematic);
}

void PhysicsWorld::set_held(BodyId body, bool held) {
  Body& changed = impl_->body(body);
  changed.set_held(held);
  if (changed.bullet()) impl_->collisions.ignore_statics(*changed.bullet(), held);
}

bool PhysicsWorld::is_kinematic(BodyId body) const {
  return impl_->body(body).is_kinematic();
}

void PhysicsWorld::add_force_W(BodyId body, const Eigen::Vector3d& f_W,
                               const Eigen::Vector3d& p_W) {
  Body& pushed = impl_->body(body);
  pushed.add_force(f_W, (p_W - pushed.position_W()).cross(f_W));
}

void PhysicsWorld::add_central_force_W(BodyId body, const Eigen::Vector3d& f_W) {
  impl_->body(body).add_force(f_W, Eigen::Vector3d::Zero());
}

void PhysicsWorld::add_torque_W(BodyId body, const Eigen::Vector3d& tau_W) {
  impl_->body(body).add_force(Eigen::Vector3d::Zero(), tau_W);
}

void PhysicsWorld::step(Duration dt) {
  const double dt_s = dt.s();
  for (const auto& body : impl_->bodies) body->start_step(impl_->gravity_W, dt_s);
  bool solved = false;
  if (impl_->bodies_with_shape > 0) {
    solved = impl_->collisions.find_contacts();
    if (solved) impl_->collisions.solve_contacts(dt_s);
    impl_->read_contacts();
  }
  for (const auto& body : impl_->bodies) body->end_step(dt_s, solved);
}

Eigen::Vector3d PhysicsWorld::acceleration_W(BodyId body) const {
  return impl_->body(body).acceleration_W();
}

std::optional<GroundHit> PhysicsWorld::probe_ground(const Eigen::Vector3d& p_W,
                                                    const Eigen::Vector3d& dir_W,
                                                    double max_distance_m) const {
  const std::optional<RayHit> hit = impl_->scene->queries().probe_rigid(p_W, dir_W, max_distance_m);
  if (!hit) return std::nullopt;
  return GroundHit{hit->distance_m, hit->normal_W, hit->surface};
}

std::span<const Contact> PhysicsWorld::contacts() const {
  return impl_->contacts;
}

const std::string& PhysicsWorld::contact_name(const Contact& contact) const {
  if (contact.other.index >= 0) return body_name(contact.other);
  if (contact.mesh >= 0) return impl_->world.meshes[contact.mesh].name;
  return impl_->terrain_name;
}

int PhysicsWorld::body_count() const {
  return static_cast<int>(impl_->bodies.size());
}

const std::string& PhysicsWorld::body_name(BodyId body) const {
  return impl_->body(body).name();
}

const SceneQuery& PhysicsWorld::scene() const {
  return impl_->scene->queries();
}

const RayScene& PhysicsWorld::light_scene() const {
  return impl_->scene->light();
}

const PhysicsSettings& PhysicsWorld::settings() const {
  return impl_->settings;
}

const WorldModel& PhysicsWorld::world_model() const {
  return impl_->world;
}

}  // namespace vinerow::physics
