#include "engine/metrics/clearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/parameter_table.h"
#include "engine/metrics/spread.h"

namespace vinerow::metrics {
namespace {

/// Classes of objects in a row.
constexpr SurfaceMask kRowMask = kPlantMask | mask_of(SurfaceClass::kWire);
constexpr Duration kTouchGap{500'000'000};
/// Largest motion of a point of the hull between two looks. Chosen.
constexpr double kLookEvery_m = 0.02;
/// A look searches this much farther than the minimum so far. More saves looks, but each searches a
/// wider space. Chosen.
constexpr double kBeyondMinimum_m = 0.15;
/// Largest number of looks in a tick. Chosen: 20 m of motion, more than any vehicle in one tick.
constexpr int kMaxLooks = 1000;

struct ClearanceParams {
  double search_radius_m = 3.0;
};

const ParameterTable<ClearanceParams>& clearance_table() {
  using P = ClearanceParams;
  static const ParameterTable<P> table =
      ParameterTable<P>().number("search_radius_m", "m", &P::search_radius_m, kPositive,
                                 "distance up to which plants are searched");
  return table;
}

class Clearance final : public Metric {
 public:
  Clearance(const ParameterSet& parameters, const MetricContext& context)
      : scene_(context.scene),
        vehicle_(context.vehicle_description),
        part_(context.part),
        radius_m_(clearance_table().read(parameters, "").search_radius_m),
        hull_reach_m_(vehicle_->collision_half_extents_m.norm()),
        min_clearance_m_(radius_m_) {}

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    contacts_ = ports.read<NamedValues>("contacts");
    // The metric's own name, so that a vehicle can have two metrics of this type.
    event_ = ports.write<Event>(part_.substr(part_.rfind('.') + 1) + "_event");
  }

  void step(Time now) override {
    const Pose X_WBox =
        truth_.value().X_WB * Pose{Eigen::Quaterniond::Identity(), vehicle_->collision_centre_B};
    const Pose from = before_.value_or(X_WBox);
    // Look at places between two ticks too: at 3 m/s ticks of 20 Hz are 15 cm apart.
    const int looks =
        std::clamp(static_cast<int>(std::ceil(moved_m(from, X_WBox) / kLookEvery_m)), 1, kMaxLooks);
    for (int k = 1; k < looks; ++k) {
      const double share = static_cast<double>(k) / looks;
      look(now, {from.q.slerp(share, X_WBox.q), from.p + share * (X_WBox.p - from.p)});
    }
    look(now, X_WBox);
    before_ = X_WBox;
  }

  std::map<std::string, double> results() const override {
    const double rigid = contacts_.has_value() ? contacts_.value().values[0] : 0.0;
    return {{"min_clearance_m", min_clearance_m_ < radius_m_ ? min_clearance_m_ : kNotMeasured},
            {"canopy_contact_count", canopy_touches_},
            {"contact_count", rigid + canopy_touches_}};
  }

 private:
  /// Upper bound of the motion of any point of the box: motion of its centre, plus its rotation
  /// times its reach.
  double moved_m(const Pose& from, const Pose& to) const {
    return (to.p - from.p).norm() + to.q.angularDistance(from.q) * hull_reach_m_;
  }

  void look(Time now, const Pose& X_WBox) {
    // Skip if the hull cannot be nearer than the minimum: d_now >= d_last - moved.
    if (looked_at_ && last_distance_m_ - moved_m(*looked_at_, X_WBox) > min_clearance_m_) return;
    looked_at_ = X_WBox;
    // A plant beyond the reach changes no result; then the reach is a lower bound of the distance.
    const double reach_m = std::min(radius_m_, min_clearance_m_ + kBeyondMinimum_m);
    last_distance_m_ =
        scene_->distance_to_box_m(X_WBox, vehicle_->collision_half_extents_m, reach_m, kRowMask);
    min_clearance_m_ = std::min(min_clearance_m_, last_distance_m_);
    if (last_distance_m_ > 0.0) return;
    const double canopy_m = scene_->distance_to_box_m(X_WBox, vehicle_->collision_half_extents_m,
                                                      radius_m_, mask_of(SurfaceClass::kCanopy));
    if (canopy_m > 0.0) return;
    if (!last_touch_ || now - *last_touch_ > kTouchGap) {
      ++canopy_touches_;
      event_.write(now, {Event::Level::kWarning, part_,
                         fmt::format("brushes the canopy with the hull's centre at x = {:.2f} m, "
                                     "y = {:.2f} m",
                                     X_WBox.p.x(), X_WBox.p.y())});
    }
    last_touch_ = now;
  }

  const SceneQuery* scene_;
  const VehicleDescription* vehicle_;
  std::string part_;
  double radius_m_;
  double hull_reach_m_;
  double min_clearance_m_;
  double last_distance_m_ = 0.0;   ///< at the last look, or a lower bound of it
  std::optional<Pose> before_;     ///< at the last tick
  std::optional<Pose> looked_at_;  ///< at the last look
  std::optional<Time> last_touch_;
  int canopy_touches_ = 0;
  SignalReader<Odometry> truth_;
  SignalReader<NamedValues> contacts_;
  SignalWriter<Event> event_;
};

}  // namespace

const std::vector<ResultSpec>& clearance_results() {
  using Range = ResultRange;
  static const std::vector<ResultSpec> results = {
      {"min_clearance_m", "m", Range::from_zero(), "min clearance from plants",
       "Smallest true distance from the vehicle's collision box to canopy, posts, trunks and "
       "wires, also between two ticks. Null if none of them came nearer than search_radius_m (3 "
       "m); a criterion on it is then not met.",
       ""},
      {"contact_count", "1", Range::count(), "contacts",
       "Number of contacts with canopy, posts, trunks, wires, obstacles, other vehicles, and "
       "terrain faces steeper than 45°. Contacts less than 0.5 s apart count as one; each starts "
       "with an event.",
       ""},
      {"canopy_contact_count", "1", Range::count(), "contacts with leaves",
       "Number of contacts with canopy. The path between two ticks is checked every 2 cm.", ""}};
  return results;
}

PartSpec clearance_spec() {
  PartSpec spec;
  spec.name = "clearance";
  spec.description =
      "Minimum distance from the hull to canopy, posts, trunks and wires, and the number of "
      "touches";
  clearance_table().add_to(spec);
  spec.reads = {"truth", "contacts"};
  spec.results = clearance_results();
  return spec;
}

std::unique_ptr<Metric> make_clearance(const ParameterSet& parameters,
                                       const MetricContext& context) {
  return std::make_unique<Clearance>(parameters, context);
}

}  // namespace vinerow::metrics
