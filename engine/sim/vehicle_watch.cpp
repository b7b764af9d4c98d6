#include "engine/sim/vehicle_watch.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/may_fail.h"
#include "engine/core/error.h"
#include "engine/io/files/plain_zeros.h"
#include "engine/sim/spawn.h"

namespace vinerow {
namespace {

/// Contacts closer than this in time are one touch.
constexpr Duration kContactGap{500'000'000};
/// Limits of a plausible state; beyond them the simulation has diverged.
constexpr double kMaxDistance_m = 1e6;
constexpr double kMaxSpeed_mps = 1e3;

bool is_finite(const Odometry& state) {
  return state.X_WB.p.allFinite() && state.X_WB.q.coeffs().allFinite() &&
         state.v_WB_B.allFinite() && state.w_WB_B.allFinite();
}

/// True for ground, contact with which is not reported: wheels roll on it, and a belly may scrape
/// over a bump. A face steeper than 45 deg is not ground, whatever its class: a vehicle would need
/// a friction coefficient above 1 to stay on it, which no tyre has on soil. This separates fences,
/// walls and steps in the terrain's mesh from the terrain.
bool is_ground(const physics::Contact& contact) {
  constexpr double kSteepestNormal_z = 0.70710678118654752;  // cos 45 deg
  return contact.surface == SurfaceClass::kTerrain &&
         std::abs(contact.normal_W.z()) >= kSteepestNormal_z;
}

/// Name of the touched object: "a post", or "obstacle 'crate'" if the scenario names it.
std::string name_of(const physics::Contact& contact, const WorldModel& world) {
  if (contact.surface == SurfaceClass::kTerrain) return "a wall of the terrain";
  if (contact.surface != SurfaceClass::kObstacle) {
    return fmt::format("a {}", to_string(contact.surface));
  }
  if (contact.mesh < 0) return "an obstacle";
  std::string name = world.meshes.at(static_cast<std::size_t>(contact.mesh)).name;
  constexpr std::string_view kPrefix = "obstacle/";
  if (name.starts_with(kPrefix)) name.erase(0, kPrefix.size());
  return name.empty() ? "an obstacle" : fmt::format("obstacle '{}'", name);
}

/// Extent of the height field and the meshes of class terrain, or of all colliding meshes in a
/// world without terrain.
Eigen::AlignedBox2d find_ground_extent(const WorldModel& world) {
  Eigen::AlignedBox2d terrain, rigid;
  if (world.terrain) {
    const HeightField& field = *world.terrain;
    terrain.extend(field.corner_W);
    terrain.extend(field.corner_W + Eigen::Vector2d(field.width_m(), field.depth_m()));
  }
  for (const MeshInstance& instance : world.meshes) {
    if (!instance.collides) continue;
    Eigen::AlignedBox2d& box = instance.surface == SurfaceClass::kTerrain ? terrain : rigid;
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      box.extend((instance.X_WM * v.cast<double>()).head<2>());
    }
  }
  return terrain.isEmpty() ? rigid : terrain;
}

}  // namespace

VehicleWatch::VehicleWatch(const scenario::VehicleConfig& config, const RunContext& run,
                           const Vehicle& vehicle, int first_body, int end_body)
    : config_(config),
      run_(run),
      vehicle_(vehicle),
      first_body_(first_body),
      end_body_(end_body),
      progress_(vehicle.description()) {}

void VehicleWatch::begin(Time now) {
  if (now.ns > 0) {
    contacts_.values = {0.0, 0.0};
    publish_contacts(now);
  }
  progress_ = ProgressWatch(vehicle_.description());
  progress_seen_ = now;
}

void VehicleWatch::check(Time now, const VehicleParts& parts) {
  Odometry state;
  vehicle_.read_truth(state);
  if (!is_finite(state)) fail(now, "its state is no longer finite");
  if (state.X_WB.p.cwiseAbs().maxCoeff() > kMaxDistance_m) {
    fail(now, fmt::format("it is farther than {:g} m from the origin", kMaxDistance_m));
  }
  if (state.v_WB_B.norm() > kMaxSpeed_mps) {
    fail(now,
         fmt::format("its speed of {:g} m/s exceeds {:g} m/s", state.v_WB_B.norm(), kMaxSpeed_mps));
  }
  demand_ground(now, state.X_WB);
  watch_contacts(now);
  watch_crash(now, parts);
}

void VehicleWatch::demand_ground(Time now, const Pose& X_WB) const {
  const Eigen::Vector3d& p = X_WB.p;
  if (run_.world.terrain && run_.world.terrain->contains(p.x(), p.y())) return;
  const SceneQuery& scene = run_.physics.scene();
  if (scene.ground_height_m(p.x(), p.y(), p.z())) return;
  // A hole in a mesh that is smaller than the vehicle does not count as an edge.
  const VehicleDescription& description = vehicle_.description();
  const Eigen::Vector3d& half = description.collision_half_extents_m;
  for (const double side : {-1.0, 1.0}) {
    for (const double end : {-1.0, 1.0}) {
      const Eigen::Vector3d corner =
          X_WB * Eigen::Vector3d(description.collision_centre_B +
                                 Eigen::Vector3d(end * half.x(), side * half.y(), 0.0));
      if (scene.ground_height_m(corner.x(), corner.y(), corner.z())) return;
    }
  }
  const Eigen::AlignedBox2d box = find_ground_extent(run_.world);
  fail(now,
       fmt::format("it left the terrain at x = {:.2f} m, y = {:.2f} m: the ground of world '{}' "
                   "extends from x = {:.1f} to {:.1f} m, y = {:.1f} to {:.1f} m{}",
                   p.x(), p.y(), run_.world.name, box.min().x(), box.max().x(), box.min().y(),
                   box.max().y(), larger_ground_hint(run_.scenario.world.parameters)));
}

void VehicleWatch::fail(Time now, const std::string& text) const {
  throw SimulationError(fmt::format("{} ({})", config_.name, config_.vehicle.type), now, text);
}

void VehicleWatch::set_crash(Time now, EndKind kind, const std::string& text) {
  crash_ = Crash{config_.name, now, io::plain_zeros(text), kind};
  run_.emit(Event::Level::kError, config_.name,
            fmt::format("{}: {}", to_string(kind), crash_->text));
}

void VehicleWatch::watch_crash(Time now, const VehicleParts& parts) {
  if (crash_) return;
  if (!vehicle_.crash().empty()) {
    set_crash(now, EndKind::kCrashed, std::string(vehicle_.crash()));
    return;
  }
  if (parts.tasks.empty()) return;
  for (const MayFail* part : parts.may_fail) {
    if (part->failure().empty()) continue;
    set_crash(now, EndKind::kGaveUp, std::string(part->failure()));
    return;
  }
}

void VehicleWatch::watch_contacts(Time now) {
  const physics::Contact* touched = nullptr;
  for (const physics::Contact& contact : run_.physics.contacts()) {
    // Between two vehicles a contact is listed once, from either side.
    const auto is_ours = [this](physics::BodyId body) {
      return body.index >= first_body_ && body.index < end_body_;
    };
    if (!is_ours(contact.body) && !is_ours(contact.other)) continue;
    if (contact.depth_m >= 0.0 && !is_ground(contact)) touched = &contact;
  }
  const bool was_touching = contacts_.values[1] != 0.0;
  if (!touched && !was_touching) return;
  const double touches_before = contacts_.values[0];
  contacts_.values[1] = touched ? 1.0 : 0.0;
  if (touched) {
    if (now - last_contact_ > kContactGap) {
      contacts_.values[0] += 1.0;
      run_.emit(Event::Level::kWarning, config_.name,
                fmt::format("touches {} at x = {:.2f} m, y = {:.2f} m",
                            name_of(*touched, run_.world), touched->p_W.x(), touched->p_W.y()));
    }
    last_contact_ = now;
  }
  const bool is_touching = touched != nullptr;
  if (is_touching != was_touching || contacts_.values[0] != touches_before) {
    publish_contacts(now);
  }
}

void VehicleWatch::check_progress(Time now, const Eigen::Vector3d& p_W,
                                  const std::vector<double>& actuators) {
  std::string reason = progress_.update(now, p_W, actuators, now - progress_seen_);
  progress_seen_ = now;
  if (reason.empty()) return;
  reason += fmt::format(", at x = {:.2f} m, y = {:.2f} m", p_W.x(), p_W.y());
  set_crash(now, EndKind::kStuck, reason);
}

}  // namespace vinerow
