#pragma once
/// The pictures that a vehicle's camera takes during a phase, as a product: where it truly was,
/// which they show, and where the vehicle thought it was, which is written into them.

#include <memory>
#include <string>

#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/product.h"
#include "engine/api/signal.h"
#include "engine/scenario/scenario.h"

namespace vinerow {

/// Where an estimate tells a place on the body to be, a short time later or before.
/// @param p_B  of the place, in B
Eigen::Vector3d told_place(const Odometry& estimate, double later_s, const Eigen::Vector3d& p_B);
/// Where a sensor sits on its vehicle, in B; the origin where its type does not say.
Eigen::Vector3d place_of_sensor(const ParameterSet& parameters);

class PictureCollector {
 public:
  /// @param camera  a sensor whose type gives pictures: it writes CameraShot and has the parameters
  ///   of survey_camera_parameters()
  PictureCollector(SignalBus& bus, const std::string& vehicle, const scenario::NamedPart& camera);

  /// "plane/camera"
  const std::string& source() const { return pictures_->source; }
  /// Looks for a picture taken since the last call. Called at every instant.
  void look();
  /// Those of this phase so far.
  Product product() const;
  int count() const { return static_cast<int>(pictures_->X_WS.size()); }

 private:
  SignalReader<CameraShot> shots_;
  SignalReader<Odometry> estimate_;
  Eigen::Vector3d p_BS_;
  std::uint64_t seen_ = 0;
  std::int32_t last_index_ = -1;
  bool told_all_ = true;
  std::shared_ptr<PictureSet> pictures_;
};

}  // namespace vinerow
