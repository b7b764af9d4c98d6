#include "engine/sim/picture_collector.h"

#include <algorithm>

#include "engine/api/parameter_table.h"
#include "engine/sensors/mounting.h"

namespace vinerow {

Eigen::Vector3d estimated_place(const Odometry& estimate, double later_s,
                                const Eigen::Vector3d& p_B) {
  // Constant velocity, without rotation: shots and estimates are only a few milliseconds apart.
  return estimate.X_WB * p_B + later_s * (estimate.X_WB.q * estimate.v_WB_B);
}

Eigen::Vector3d place_of_sensor(const ParameterSet& parameters) {
  const auto& own = parameters.specs();
  const std::vector<ParameterSpec> of_mounting = sensors::mounting_table().specs();
  const bool has_mounting =
      std::all_of(of_mounting.begin(), of_mounting.end(), [&](const ParameterSpec& wanted) {
        return std::any_of(own.begin(), own.end(),
                           [&](const ParameterSpec& spec) { return spec.name == wanted.name; });
      });
  if (!has_mounting) return Eigen::Vector3d::Zero();
  return sensors::mounting_table().read(parameters, parameters.owner()).X_BS().p;
}

PictureCollector::PictureCollector(SignalBus& bus, const std::string& vehicle,
                                   const scenario::NamedPart& camera)
    : shots_(bus.subscribe<CameraShot>(vehicle + "/" + camera.name, "mission")),
      estimate_(bus.subscribe_optional<Odometry>(vehicle + "/estimate", "mission")),
      p_BS_(place_of_sensor(camera.part.parameters)),
      pictures_(std::make_shared<PictureSet>()) {
  pictures_->camera = read_survey_camera(camera.part.parameters);
  pictures_->source = vehicle + "/" + camera.name;
}

void PictureCollector::look() {
  if (!shots_.is_newer_than(seen_)) return;
  const CameraShot& shot = shots_.value();
  // The signal is repeated at the sensor's rate; the index identifies a new picture.
  if (shot.index < 0 || shot.index == last_index_) return;
  last_index_ = shot.index;
  pictures_->X_WS.push_back(shot.X_WS);
  // A set with a picture before the first estimate stores no estimates at all.
  const bool knows = estimate_.has_value();
  if (!knows) has_all_estimates_ = false;
  if (has_all_estimates_) {
    pictures_->estimated_W.push_back(
        estimated_place(estimate_.value(), (shots_.stamp() - estimate_.stamp()).s(), p_BS_));
  } else {
    pictures_->estimated_W.clear();
  }
}

Product PictureCollector::product() const {
  Product product;
  product.kind = ProductKind::kPictures;
  product.pictures = pictures_;
  return product;
}

}  // namespace vinerow
