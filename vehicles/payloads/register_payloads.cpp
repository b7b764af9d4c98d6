#include "vehicles/payloads/register_payloads.h"

#include "vehicles/payloads/canopy_camera.h"
#include "vehicles/payloads/sprayer.h"

namespace vinerow {

void register_payloads(Registry& registry) {
  registry.add_payload(vehicles::canopy_camera_spec(), vehicles::make_canopy_camera);
  registry.add_payload(vehicles::sprayer_spec(), vehicles::make_sprayer);
}

}  // namespace vinerow
