#pragma once
/// Collector of the pictures that a vehicle's camera takes during a phase, as a product. It stores
/// the true camera poses, from which the pictures are rendered, and the estimated positions, which
/// are written into the files.

#include <memory>
#include <string>

#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/product.h"
#include "engine/api/signal.h"
#include "engine/scenario/scenario.h"

namespace vinerow {

/// Estimated position in W of a point on the body, extrapolated over a short time.
/// @param later_s  from the estimate to the wanted time; may be negative
/// @param p_B  position of the point in B
Eigen::Vector3d estimated_place(const Odometry& estimate, double later_s,
                                const Eigen::Vector3d& p_B);
/// Position of a sensor on its vehicle, in B; the origin if its type has no such parameters.
Eigen::Vector3d place_of_sensor(const ParameterSet& parameters);

class PictureCollector {
 public:
  /// @param camera  sensor whose type produces pictures: it writes CameraShot and has the
  ///   parameters of survey_camera_parameters()
  PictureCollector(SignalBus& bus, const std::string& vehicle, const scenario::NamedPart& camera);

  /// "plane/camera"
  const std::string& source() const { return pictures_->source; }
  /// Adds a picture taken since the last call, if there is one. Called at every instant.
  void look();
  /// Pictures of this phase so far.
  Product product() const;
  int count() const { return static_cast<int>(pictures_->X_WS.size()); }

 private:
  SignalReader<CameraShot> shots_;
  SignalReader<Odometry> estimate_;
  Eigen::Vector3d p_BS_;
  std::uint64_t seen_ = 0;
  std::int32_t last_index_ = -1;
  bool has_all_estimates_ = true;
  std::shared_ptr<PictureSet> pictures_;
};

}  // namespace vinerow
