#pragma once
/// The pictures that a vehicle's camera takes during a phase, as a product.

#include <memory>
#include <string>

#include "engine/api/messages/sensors.h"
#include "engine/api/product.h"
#include "engine/api/signal.h"
#include "engine/io/scenario.h"

namespace vinerow {

class PictureCollector {
 public:
  /// @param camera  a sensor whose type gives pictures: it writes CameraShot and has the parameters
  ///   of survey_camera_parameters()
  PictureCollector(SignalBus& bus, const std::string& vehicle, const io::NamedPart& camera);

  /// "plane/camera"
  const std::string& source() const { return pictures_->source; }
  /// Looks for a picture taken since the last call. Called at every instant.
  void look();
  /// Those of this phase so far.
  Product product() const;
  int count() const { return static_cast<int>(pictures_->X_WS.size()); }

 private:
  SignalReader<CameraShot> shots_;
  std::uint64_t seen_ = 0;
  std::int32_t last_index_ = -1;
  std::shared_ptr<PictureSet> pictures_;
};

}  // namespace vinerow
