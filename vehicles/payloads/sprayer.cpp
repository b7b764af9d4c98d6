#include "vehicles/payloads/sprayer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/api/map.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "vehicles/parts/wind_probe.h"
#include "vehicles/payloads/canopy_patches.h"
#include "vehicles/payloads/section_switch.h"
#include "vehicles/payloads/sprayer_params.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

constexpr double kMlPerL = 1000.0;
constexpr double kM2PerHa = 1e4;
/// Largest angle between a row and the heading for the row to be adjacent.
constexpr double kMaxRowAngle_rad = rad_from_deg(60.0);

/// Points of low discrepancy in the unit cube.
class QuasiRandom {
 public:
  explicit QuasiRandom(RandomStream& random) {
    for (int i : {2, 1, 0}) at_[i] = random.uniform();
  }
  const Vector3d& next() {
    constexpr std::array<double, 3> kSteps = {0.8191725133961645, 0.6710436067037893,
                                              0.5497004779019703};
    for (int i = 0; i < 3; ++i) {
      at_[i] += kSteps[static_cast<std::size_t>(i)];
      if (at_[i] >= 1.0) at_[i] -= 1.0;
    }
    return at_;
  }

 private:
  Vector3d at_;
};

struct Nozzle {
  Vector3d p_B;
  Eigen::Matrix3d axes_B;  ///< first column: direction of the cone's axis
  QuasiRandom portions;
};

struct Side {
  std::vector<Nozzle> nozzles;
  bool open = false;
};

class Sprayer final : public Payload {
 public:
  Sprayer(const ParameterSet& parameters, const PayloadContext& context)
      : name_(context.name),
        part_(context.part),
        params_(read_sprayer(parameters, context.part)),
        period_(context.period),
        scene_(*context.scene),
        leaves_(params_.leaf_area_density_m2pm3 ? LeafAreaDensity(*params_.leaf_area_density_m2pm3)
                                                : LeafAreaDensity(*context.world)),
        switch_(params_, *context.map),
        wind_(*context.world, *context.scene, context.random("wind")),
        patches_(
            make_canopy_patches(*context.world, params_.step_m, params_.band_m, context.shelf)),
        coverage_(patches_->empty_coverage()),
        worked_(static_cast<std::size_t>(patches_->step_count()), 0),
        tank_l_(params_.tank_l) {
    if (context.map->rows.empty()) {
      throw ConfigError(fmt::format(
          "{}: the vehicle's map has no rows, must have at least one: sections open beside rows",
          context.part));
    }
    note_ = doubt_reach(context.map->alleys);
    coverage_.quantity = "deposit";
    coverage_.unit = "ml/m2";
    coverage_.wanted = params_.wanted_ml_per_m2;
    RandomStream random = context.random();
    const double ground_z_B = -context.vehicle_description->height_above_ground_m;
    for (const int side : {1, -1}) {
      for (std::size_t i = 0; i < params_.nozzle_heights_m.size(); ++i) {
        const double up = params_.nozzle_elevation_rad[i];
        const Vector3d p_B(params_.boom_x_m, side * params_.nozzle_offset_m,
                           ground_z_B + params_.nozzle_heights_m[i]);
        Eigen::Matrix3d axes_B;
        axes_B.col(0) = Vector3d(0.0, side * std::cos(up), std::sin(up));
        axes_B.col(1) = Vector3d::UnitX();
        axes_B.col(2) = axes_B.col(0).cross(axes_B.col(1));
        (side > 0 ? left_ : right_).nozzles.push_back({p_B, axes_B, QuasiRandom(random)});
      }
    }
    reported_.names = {"left_on", "right_on", "flow_lps", "tank_l", "sprayed_l", "canopy_l"};
    reported_.values.assign(reported_.names.size(), 0.0);
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    switch_.connect(ports);
    writer_ = ports.write<NamedValues>(name_);
    event_ = ports.write<Event>(name_ + "_event");
  }

  void step(Time now) override {
    if (!note_.empty()) event_.write(now, {Event::Level::kWarning, part_, note_});
    note_.clear();
    const Sections sections = switch_.step(now);
    left_.open = sections.left && !empty_;
    right_.open = sections.right && !empty_;
    double used_l = 0.0;
    if (truth_.has_value()) used_l = spray(now, truth_.value());
    reported_.values = {left_.open ? 1.0 : 0.0,
                        right_.open ? 1.0 : 0.0,
                        used_l / period_.s(),
                        tank_l_,
                        sprayed_l_,
                        fate_.canopy_ml / kMlPerL};
    writer_.write(now, reported_);
  }

  std::map<std::string, double> results() const override {
    const CanopyNumbers all = calc_canopy_numbers(*patches_, coverage_);
    const CanopyNumbers worked = calc_canopy_numbers(*patches_, coverage_, worked_);
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    return {
        {"litres_sprayed", sprayed_l_},
        {"litres_canopy", fate_.canopy_ml / kMlPerL},
        {"litres_ground", fate_.ground_ml / kMlPerL},
        {"litres_lost", fate_.lost_ml / kMlPerL},
        {"litres_off_row", off_row_l_},
        {"litres_left", tank_l_},
        {"litres_per_ha", treated_m2_ > 0.0 ? sprayed_l_ / treated_m2_ * kM2PerHa : nothing},
        {"on_target_share", sprayed_l_ > 0.0 ? fate_.canopy_ml / kMlPerL / sprayed_l_ : nothing},
        // The double nearest to the decimal: periods have whole nanoseconds.
        {"spray_time_s", sprayed_periods_ * static_cast<double>(period_.ns) / 1e9},
        {"covered_share", all.covered_share},
        {"deposit_mean_ml_per_m2", all.mean},
        {"worked_share", all.area_m2 > 0.0 ? worked.area_m2 / all.area_m2 : nothing},
        {"worked_covered_share", worked.covered_share},
        {"worked_deposit_mean_ml_per_m2", worked.mean},
        {"worked_deposit_cv", worked.variation}};
  }

  const CanopyCoverage* coverage() const override { return &coverage_; }

 private:
  /// A sentence if no row is in reach from the middle of any alley, else "".
  std::string doubt_reach(const std::vector<Alley>& alleys) const {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Alley& alley : alleys) nearest_m = std::min(nearest_m, 0.5 * alley.width_m);
    if (alleys.empty() || params_.row_reach_m >= nearest_m) return "";
    return fmt::format(
        "row_reach_m = {:g} m reaches no row from the middle of an alley, where the nearest one is "
        "{:.3g} m away: the sections open only where the vehicle is nearer to a row",
        params_.row_reach_m, nearest_m);
  }

  /// @returns litres of this tick
  double spray(Time now, const Odometry& truth) {
    const Vector3d v_W = truth.X_WB.q * truth.v_WB_B;
    const Vector3d boom_W = truth.X_WB * Vector3d(params_.boom_x_m, 0.0, 0.0);
    // Eddies go on passing while nothing is sprayed.
    const Vector3d wind_W =
        wind_.calm() ? Vector3d(Vector3d::Zero()) : wind_.sample(now, boom_W, v_W, period_);
    if (!left_.open && !right_.open) return 0.0;

    const double nozzle_l = params_.nozzle_flow_lps * period_.s();
    const auto nozzles = [](const Side& side) { return side.open ? side.nozzles.size() : 0u; };
    const double wanted_l = nozzle_l * static_cast<double>(nozzles(left_) + nozzles(right_));
    const double share = std::min(1.0, tank_l_ / wanted_l);
    const double portion_ml = kMlPerL * share * nozzle_l / params_.rays_per_nozzle;
    for (Side* side : {&left_, &right_}) {
      if (!side->open) continue;
      for (Nozzle& nozzle : side->nozzles) {
        for (int ray = 0; ray < params_.rays_per_nozzle; ++ray) {
          emit(nozzle, truth.X_WB, v_W, wind_W, portion_ml);
        }
      }
    }
    const double used_l = share * wanted_l;
    sprayed_l_ += used_l;
    tank_l_ = std::max(0.0, tank_l_ - used_l);
    sprayed_periods_ += share;
    account_rows(truth, boom_W, v_W, share * nozzle_l);
    if (share < 1.0 || tank_l_ <= 0.0) run_dry(now, boom_W);
    return used_l;
  }

  void emit(Nozzle& nozzle, const Pose& X_WB, const Vector3d& v_W, const Vector3d& wind_W,
            double portion_ml) {
    const Vector3d& at = nozzle.portions.next();
    const double inner = std::cos(params_.hollow_half_angle_rad);
    const double outer = std::cos(params_.spray_half_angle_rad);
    const double along = inner + at.x() * (outer - inner);
    const double across = std::sqrt(std::max(0.0, 1.0 - along * along));
    const double around_rad = 2.0 * kPi * at.y();
    const Vector3d direction_B = nozzle.axes_B * Vector3d(along, across * std::cos(around_rad),
                                                          across * std::sin(around_rad));
    const Vector3d p_W = X_WB * nozzle.p_B - at.z() * period_.s() * v_W;
    const SprayJet jet(params_.spray, p_W, X_WB.q * direction_B, v_W, wind_W);
    const SprayFate fate =
        trace_spray(scene_, leaves_, params_.spray, jet, portion_ml,
                    [this](const Vector3d& hit_W, double ml) { put(hit_W, ml); });
    fate_.canopy_ml += fate.canopy_ml;
    fate_.ground_ml += fate.ground_ml;
    fate_.lost_ml += fate.lost_ml;
  }

  void put(const Vector3d& p_W, double ml) {
    std::array<PatchShare, 4> shares;
    const int count = patches_->spread(p_W, shares);
    for (int k = 0; k < count; ++k) {
      const PatchShare& to = shares[static_cast<std::size_t>(k)];
      CanopyPatch& patch = coverage_.patches[static_cast<std::size_t>(to.patch)];
      patch.amount += to.share * ml / patch.area_m2;
    }
  }

  /// Which true rows were beside an open section, and what was sprayed beside none.
  void account_rows(const Odometry& truth, const Vector3d& boom_W, const Vector3d& v_W,
                    double nozzle_l) {
    const AdjacentRows adjacent =
        patches_->rows().adjacent(boom_W.head<2>(), yaw_from_quaternion(truth.X_WB.q),
                                  params_.row_reach_m, kMaxRowAngle_rad, 0.0);
    const auto account = [&](const Side& side, const std::optional<RowPlace>& row) {
      if (!side.open) return;
      if (!row) {
        off_row_l_ += nozzle_l * static_cast<double>(side.nozzles.size());
        return;
      }
      treated_m2_ +=
          std::abs(v_W.head<2>().dot(row->direction_W)) * period_.s() * std::abs(row->lateral_m);
      const int faced = row->lateral_m >= 0.0 ? 1 : -1;
      worked_[static_cast<std::size_t>(patches_->step_of(row->row, faced, row->along_m))] = 1;
    };
    account(left_, adjacent.left);
    account(right_, adjacent.right);
  }

  void run_dry(Time now, const Vector3d& boom_W) {
    empty_ = true;
    tank_l_ = 0.0;
    event_.write(now,
                 {Event::Level::kWarning, part_,
                  fmt::format("the tank is empty after {:.4g} l at ({:.1f}, {:.1f}) m: nozzles "
                              "stay off",
                              sprayed_l_, boom_W.x(), boom_W.y())});
  }

  std::string name_;
  std::string part_;
  std::string note_;  ///< not yet reported
  SprayerParams params_;
  Duration period_;
  const SceneQuery& scene_;
  LeafAreaDensity leaves_;
  SectionSwitch switch_;
  WindProbe wind_;
  std::shared_ptr<const CanopyPatches> patches_;
  CanopyCoverage coverage_;
  std::vector<std::uint8_t> worked_;  // steps of rows and sides
  Side left_, right_;
  SignalReader<Odometry> truth_;
  SignalWriter<NamedValues> writer_;
  SignalWriter<Event> event_;
  NamedValues reported_;

  double tank_l_;
  bool empty_ = false;
  double sprayed_l_ = 0.0;
  SprayFate fate_;  // of all portions
  double off_row_l_ = 0.0;
  double treated_m2_ = 0.0;
  double sprayed_periods_ = 0.0;
};

std::vector<ResultSpec> sprayer_results() {
  using Range = ResultRange;
  return {{"litres_sprayed", "l", Range::from_zero(), "spray used", "Volume that left the nozzles.",
           ""},
          {"litres_canopy", "l", Range::from_zero(), "spray on canopy",
           "Sprayed volume that was deposited on canopy.", ""},
          {"litres_ground", "l", Range::from_zero(), "spray on ground",
           "Sprayed volume that reached the ground.", ""},
          {"litres_lost", "l", Range::from_zero(), "spray drift",
           "Sprayed volume that drifted away.", ""},
          {"litres_off_row", "l", Range::from_zero(), "spray beside no row",
           "Volume sprayed by sections that had no true row beside them.", ""},
          {"litres_left", "l", Range::from_zero(), "spray left in tank", "Volume left in the tank.",
           ""},
          {"litres_per_ha", "l/ha", Range::from_zero(), "application rate",
           "Sprayed volume divided by the treated ground area: distance driven along a row times "
           "the distance to it.",
           ""},
          {"on_target_share", "1", Range::share(), "spray on target",
           "Fraction of the sprayed volume that was deposited on canopy.", ""},
          {"spray_time_s", "s", Range::from_zero(), "spraying time",
           "Time with at least one section open.", ""},
          {"covered_share", "1", Range::share(), "canopy receiving target dose",
           "Fraction of the whole canopy surface that received the target dose.", ""},
          {"deposit_mean_ml_per_m2", "ml/m²", Range::from_zero(), "mean deposit",
           "Mean deposit over the whole canopy surface.", ""},
          {"worked_share", "1", Range::share(), "canopy worked",
           "Fraction of the canopy surface beside which a section was open.", ""},
          {"worked_covered_share", "1", Range::share(), "worked canopy receiving dose",
           "Fraction of the worked canopy surface that received the target dose.", ""},
          {"worked_deposit_mean_ml_per_m2", "ml/m²", Range::from_zero(),
           "mean deposit on worked canopy", "Mean deposit over the worked canopy surface.", ""},
          {"worked_deposit_cv", "1", Range::from_zero(), "unevenness of deposit",
           "Coefficient of variation of the deposit over the worked canopy surface.", ""}};
}

}  // namespace

PartSpec sprayer_spec() {
  PartSpec spec;
  spec.name = "sprayer";
  spec.results = sprayer_results();
  spec.description =
      "Air-assisted sprayer with nozzles on both sides: sections open beside the rows of the map; "
      "deposit on the true canopy, drift with the wind";
  add_sprayer_parameters(spec);
  spec.default_rate_Hz = 20.0;
  spec.reads = {"truth", "estimate", "plan (if switching: legs)"};
  spec.writes = {"<name>", "<name>_event"};
  return spec;
}

std::unique_ptr<Payload> make_sprayer(const ParameterSet& parameters,
                                      const PayloadContext& context) {
  return std::make_unique<Sprayer>(parameters, context);
}

}  // namespace vinerow::vehicles
