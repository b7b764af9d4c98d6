#include "vehicles/parts/landing_foot.h"

#include <algorithm>

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

/// A leg that leans further than this from the ground's normal does not stand on its foot.
constexpr double kMinFacing = 0.2;

}  // namespace

void LandingFootParams::validate(const std::string& who) const {
  landing_foot_table().validate(*this, who);
}

const ParameterTable<LandingFootParams>& landing_foot_table() {
  using P = LandingFootParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("gear_stiffness_N_per_m", "N/m", &P::stiffness_N_per_m, kPositive,
                  "stiffness of a leg with its foot, along and across")
          .number("gear_damping_Ns_per_m", "N s/m", &P::damping_Ns_per_m, between(0.0, 1e5),
                  "damping of a leg with its foot")
          .number("gear_friction", "", &P::friction, between(0.0, 10.0),
                  "Coulomb coefficient of feet on ground");
  return table;
}

std::optional<FootContact> press_foot(const LandingFootParams& params,
                                      const physics::PhysicsWorld& world,
                                      const physics::BodyState& body, const Vector3d& foot_B,
                                      LandingFootState& state) {
  const bool stood = state.stands;
  state.stands = false;
  const Vector3d down_W = body.X_WB.q * -Vector3d::UnitZ();
  const Vector3d arm_W = body.X_WB.q * foot_B;
  const double preload_m = params.static_load_N / params.stiffness_N_per_m;
  const auto hit = world.probe_ground(body.X_WB.p + arm_W - params.leg_m * down_W, down_W,
                                      params.leg_m + preload_m);
  if (!hit) return std::nullopt;
  const double facing = -hit->normal_W.dot(down_W);
  if (facing < kMinFacing) return std::nullopt;

  FootContact contact;
  contact.normal_W = hit->normal_W;
  contact.surface = hit->surface;
  const double above_m = hit->distance_m - params.leg_m;  // negative: the leg is pushed in
  contact.p_W = body.X_WB.p + arm_W + above_m * down_W;
  const Vector3d v_W = body.v_WB_W + body.w_WB_W.cross(contact.p_W - body.X_WB.p);
  const double sinking_mps = -v_W.dot(contact.normal_W);
  const double normal_N = std::max(0.0, params.stiffness_N_per_m * (preload_m - above_m) * facing +
                                            params.damping_Ns_per_m * sinking_mps);

  state.stands = true;
  if (!stood) state.anchor_W = contact.p_W;
  const auto across = [&contact](const Vector3d& x) {
    return Vector3d(x - contact.normal_W.dot(x) * contact.normal_W);
  };
  const Vector3d stretch_W = across(contact.p_W - state.anchor_W);
  const Vector3d pull_W =
      -params.stiffness_N_per_m * stretch_W - params.damping_Ns_per_m * across(v_W);
  const double max_N = params.friction * normal_N, pull_N = pull_W.norm();
  contact.force_W = normal_N * contact.normal_W;
  if (pull_N <= max_N) {
    contact.force_W += pull_W;
  } else {
    // It slides: the anchor follows at the distance that friction can hold.
    const Vector3d friction_W = pull_W * (max_N / pull_N);
    contact.force_W += friction_W;
    state.anchor_W = contact.p_W + friction_W / params.stiffness_N_per_m;
  }
  return contact;
}

}  // namespace vinerow::vehicles
