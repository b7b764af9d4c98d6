#include "engine/sim/metrics/clearance.h"

#include <algorithm>
#include <cmath>

#include "engine/api/messages/commands.h"
#include "engine/api/parameter_table.h"

namespace vinerow {
namespace {

constexpr Duration kTouchGap{500'000'000};

struct ClearanceParams {
  double search_radius_m = 3.0;
};

const ParameterTable<ClearanceParams>& clearance_table() {
  using P = ClearanceParams;
  static const ParameterTable<P> table =
      ParameterTable<P>().number("search_radius_m", "m", &P::search_radius_m, kPositive,
                                 "farther plants are not looked for");
  return table;
}

class Clearance final : public Metric {
 public:
  Clearance(const ParameterSet& parameters, const MetricContext& context)
      : scene_(context.scene),
        vehicle_(context.vehicle_description),
        radius_m_(clearance_table().read(parameters, "").search_radius_m),
        hull_reach_m_(vehicle_->collision_half_extents_m.norm()),
        min_clearance_m_(radius_m_) {}

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    contacts_ = ports.read<NamedValues>("contacts");
  }

  void step(Time now) override {
    const Pose X_WBox =
        truth_.value().X_WB * Pose{Eigen::Quaterniond::Identity(), vehicle_->collision_centre_B};
    if (has_last_) {
      // No point of the box moved farther than its centre plus the turn of its reach.
      const double moved_m =
          (X_WBox.p - last_.p).norm() + X_WBox.q.angularDistance(last_.q) * hull_reach_m_;
      if (last_distance_m_ - moved_m > min_clearance_m_) return;
    }
    last_ = X_WBox;
    has_last_ = true;
    last_distance_m_ = scene_->distance_to_box_m(X_WBox, vehicle_->collision_half_extents_m,
                                                 radius_m_, kPlantMask);
    min_clearance_m_ = std::min(min_clearance_m_, last_distance_m_);
    if (last_distance_m_ > 0.0) return;
    const double canopy_m = scene_->distance_to_box_m(X_WBox, vehicle_->collision_half_extents_m,
                                                      radius_m_, mask_of(SurfaceClass::kCanopy));
    if (canopy_m > 0.0) return;
    if (!touched_canopy_ || now - last_touch_ > kTouchGap) ++canopy_touches_;
    touched_canopy_ = true;
    last_touch_ = now;
  }

  std::map<std::string, double> results() const override {
    const double rigid = contacts_.has_value() ? contacts_.value().values[0] : 0.0;
    return {{"min_clearance_m", min_clearance_m_},
            {"canopy_contact_count", canopy_touches_},
            {"contact_count", rigid + canopy_touches_}};
  }

 private:
  const SceneQuery* scene_;
  const VehicleDescription* vehicle_;
  double radius_m_;
  double hull_reach_m_;
  double min_clearance_m_;
  double last_distance_m_ = 0.0;
  Pose last_;
  bool has_last_ = false;
  bool touched_canopy_ = false;
  Time last_touch_;
  int canopy_touches_ = 0;
  SignalReader<Odometry> truth_;
  SignalReader<NamedValues> contacts_;
};

}  // namespace

PartSpec clearance_spec() {
  PartSpec spec;
  spec.name = "clearance";
  spec.description =
      "Minimum distance from the hull to canopy, posts and trunks, and the number of touches";
  spec.parameters = clearance_table().specs();
  spec.reads = {"truth", "contacts"};
  spec.writes = {"min_clearance_m", "contact_count", "canopy_contact_count"};
  return spec;
}

std::unique_ptr<Metric> make_clearance(const ParameterSet& parameters,
                                       const MetricContext& context) {
  return std::make_unique<Clearance>(parameters, context);
}

}  // namespace vinerow
