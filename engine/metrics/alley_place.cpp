#include "engine/metrics/alley_place.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/plan_stretch.h"
#include "engine/api/world_model.h"
#include "engine/math/planar.h"
#include "engine/math/polyline.h"
#include "engine/metrics/extremes.h"
#include "engine/metrics/spread.h"
#include "engine/metrics/tenths.h"

namespace vinerow::metrics {
namespace {

using Eigen::Vector2d;

/// Height above the origin from which the ground is searched downwards. Chosen: finds the ground
/// even if the vehicle has sunk into it.
constexpr double kGroundFrom_m = 0.5;
/// Largest distance of an alley's row from its middle, in alley widths. Chosen: between the own
/// rows at half a width and the next ones at one and a half.
constexpr double kRowReach_widths = 0.75;

/// One side of an alley.
struct Wall {
  Polyline row;
  double half_canopy_m = 0.0;
  double top_m = 0.0;
  int hint = 0;

  /// Vector from p to the row's centre line; absent beyond its ends.
  std::optional<Vector2d> look(const Vector2d& p) {
    const Polyline::Nearest at = row.nearest(p, hint);
    hint = at.segment;
    if (row.is_end(at)) return std::nullopt;
    return Vector2d(at.point - p);
  }
};

struct Corridor {
  Polyline centre;
  Wall left, right;
  Tenths passed;
  int hint = 0;

  /// Distance to the left of the middle between the walls; absent if p is not between them.
  std::optional<double> offset_m(const Vector2d& p) {
    const std::optional<Vector2d> to_left = left.look(p);
    if (!to_left) return std::nullopt;
    const std::optional<Vector2d> to_right = right.look(p);
    if (!to_right || to_left->dot(*to_right) >= 0.0) return std::nullopt;
    const double clearance_left_m = to_left->norm() - left.half_canopy_m;
    const double clearance_right_m = to_right->norm() - right.half_canopy_m;
    return 0.5 * (clearance_right_m - clearance_left_m);
  }
  void pass(const Vector2d& p, double moved_m) {
    const Polyline::Nearest at = centre.nearest(p, hint);
    hint = at.segment;
    passed.look(centre.s_m(at) / centre.length_m(), moved_m / centre.length_m());
  }
};

/// Corridor between the rows on both sides of an alley; absent if one is missing.
std::optional<Corridor> make_corridor(const Alley& alley, const std::vector<PlantRow>& rows) {
  if (alley.line_W.size() < 2) return std::nullopt;
  Corridor corridor;
  corridor.centre = Polyline(from_above(alley.line_W));
  const double half_m = 0.5 * corridor.centre.length_m();
  if (!(half_m > 0.0)) return std::nullopt;
  const Vector2d along = corridor.centre.direction_at(half_m);
  const Vector2d middle = corridor.centre.point_at(half_m);
  double left_m = kRowReach_widths * alley.width_m, right_m = left_m;
  bool has_left = false, has_right = false;
  for (const PlantRow& row : rows) {
    if (row.line_W.size() < 2) continue;
    Wall wall{Polyline(from_above(row.line_W)), 0.5 * row.canopy_width_m, row.canopy_top_m};
    const Polyline::Nearest at = wall.row.nearest(middle);
    const bool is_left = cross(along, at.point - middle) > 0.0;
    double& nearest_m = is_left ? left_m : right_m;
    if (at.distance_m >= nearest_m) continue;
    nearest_m = at.distance_m;
    (is_left ? corridor.left : corridor.right) = std::move(wall);
    (is_left ? has_left : has_right) = true;
  }
  if (!has_left || !has_right) return std::nullopt;
  return corridor;
}

class AlleyPlace final : public Metric {
 public:
  explicit AlleyPlace(const MetricContext& context)
      : scene_(context.scene), flies_(context.vehicle_description->flies()) {
    if (context.world == nullptr) return;
    for (const Alley& alley : context.world->rows->alleys) {
      if (auto corridor = make_corridor(alley, context.world->rows->rows)) {
        corridors_.push_back(std::move(*corridor));
      }
    }
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    plan_.connect(ports);
  }

  void step(Time) override {
    plan_.take_over();
    const Eigen::Vector3d& p_W = truth_.value().X_WB.p;
    const Vector2d p = p_W.head<2>();
    const double moved_m = before_ ? (p - *before_).norm() : 0.0;
    before_ = p;
    const bool off_the_legs = plan_.has_plan() && !plan_.is_leg(plan_.find(p_W).segment);
    const int last = at_;
    at_ = -1;
    if (!off_the_legs) look(p_W, last, moved_m);
    if (last >= 0 && at_ != last) corridors_[last].passed.leave();
  }

  std::map<std::string, double> results() const override {
    const double count = static_cast<double>(offsets_m_.count);
    const auto passed = std::count_if(corridors_.begin(), corridors_.end(),
                                      [](const Corridor& c) { return c.passed.all(); });
    std::map<std::string, double> results = {
        {"alley_offset_mean_m", offsets_m_.count > 0 ? offset_sum_m_ / count : kNotMeasured},
        {"alley_offset_rms_m", offsets_m_.rms()},
        {"alley_offset_max_m", offsets_m_.max_or_nan()},
        {"alleys_passed", static_cast<double>(passed)}};
    if (flies_) {
      results["alley_height_min_m"] = height_m_.min_or_nan();
      results["alley_height_max_m"] = height_m_.max_or_nan();
    }
    return results;
  }

 private:
  /// @param last  corridor of the last tick, which is tried first; -1: none
  void look(const Eigen::Vector3d& p_W, int last, double moved_m) {
    const int count = static_cast<int>(corridors_.size());
    for (int k = last >= 0 ? -1 : 0; k < count; ++k) {
      const int index = k < 0 ? last : k;
      Corridor& corridor = corridors_[index];
      const std::optional<double> offset_m = corridor.offset_m(p_W.head<2>());
      if (!offset_m) continue;
      const std::optional<double> ground_m =
          scene_->ground_height_m(p_W.x(), p_W.y(), p_W.z() + kGroundFrom_m);
      if (!ground_m) return;
      const double height_m = p_W.z() - *ground_m;
      if (height_m > std::max(corridor.left.top_m, corridor.right.top_m)) return;
      offsets_m_.add(*offset_m);
      offset_sum_m_ += *offset_m;
      height_m_.add(height_m);
      corridor.pass(p_W.head<2>(), moved_m);
      at_ = index;
      return;
    }
  }

  const SceneQuery* scene_;
  bool flies_;
  std::vector<Corridor> corridors_;
  SignalReader<Odometry> truth_;
  PlanStretch plan_;
  std::optional<Vector2d> before_;  ///< at the last tick
  int at_ = -1;                     ///< corridor of this tick
  Spread offsets_m_;
  double offset_sum_m_ = 0.0;
  Extremes height_m_;
};

}  // namespace

const std::vector<ResultSpec>& alley_place_results() {
  using Range = ResultRange;
  static const std::vector<ResultSpec> results = {
      {"alley_offset_mean_m", "m", Range::any(), "mean offset from alley centre",
       "Mean signed distance from the middle between the two true canopy walls of the alley, "
       "positive to the left of the alley's own direction. It reveals a map that is displaced from "
       "the vineyard, which cross_track_* does not.",
       ""},
      {"alley_offset_rms_m", "m", Range::from_zero(), "RMS offset from alley centre",
       "Root mean square of the distance from the middle between the true canopy walls. A wall is "
       "the row's line moved by half the canopy width.",
       ""},
      {"alley_offset_max_m", "m", Range::from_zero(), "max offset from alley centre",
       "Largest distance from the middle between the true canopy walls of the alley.", ""},
      {"alley_height_min_m", "m", Range::any(), "min height between rows",
       "Smallest height of the origin of a flying vehicle above the true ground while it is "
       "between two true rows, on the legs and below the canopy's top.",
       ""},
      {"alley_height_max_m", "m", Range::any(), "max height between rows",
       "Largest height of the origin of a flying vehicle above the true ground while it is between "
       "two true rows, on the legs and below the canopy's top.",
       ""},
      {"alleys_passed", "1", Range::count(), "true alleys passed",
       "Number of true alleys passed from end to end, on the legs and below the canopy's top.",
       ""}};
  return results;
}

PartSpec alley_place_spec() {
  PartSpec spec;
  spec.name = "alley_place";
  spec.description =
      "Position between the true rows: distance from the middle between the walls of the alley, "
      "height above the true ground, alleys passed from end to end";
  spec.reads = {"truth", "plan (optional)"};
  spec.results = alley_place_results();
  return spec;
}

std::unique_ptr<Metric> make_alley_place(const ParameterSet&, const MetricContext& context) {
  return std::make_unique<AlleyPlace>(context);
}

}  // namespace vinerow::metrics
