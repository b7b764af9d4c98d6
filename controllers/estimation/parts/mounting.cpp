#include "controllers/estimation/parts/mounting.h"

namespace vinerow::controllers {

Pose mounting_of(const EstimatorContext& context, const std::string& sensor) {
  for (const SensorMounting& mounting : context.sensors) {
    if (mounting.name == sensor) return mounting.X_BS;
  }
  return {};
}

Eigen::Vector3d antenna_of(const EstimatorContext& context, const std::string& receiver,
                           const std::optional<Eigen::Vector3d>& given_B) {
  return given_B.value_or(mounting_of(context, receiver).p);
}

}  // namespace vinerow::controllers
