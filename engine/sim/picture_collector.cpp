#include "engine/sim/picture_collector.h"

namespace vinerow {

PictureCollector::PictureCollector(SignalBus& bus, const std::string& vehicle,
                                   const io::NamedPart& camera)
    : shots_(bus.subscribe<CameraShot>(vehicle + "/" + camera.name, "mission")),
      pictures_(std::make_shared<PictureSet>()) {
  pictures_->camera = read_survey_camera(camera.part.parameters);
  pictures_->source = vehicle + "/" + camera.name;
}

void PictureCollector::look() {
  if (!shots_.is_newer_than(seen_)) return;
  const CameraShot& shot = shots_.value();
  // The signal is repeated at the sensor's rate; its index tells pictures apart.
  if (shot.index < 0 || shot.index == last_index_) return;
  last_index_ = shot.index;
  pictures_->X_WS.push_back(shot.X_WS);
}

Product PictureCollector::product() const {
  Product product;
  product.kind = ProductKind::kPictures;
  product.pictures = pictures_;
  return product;
}

}  // namespace vinerow
