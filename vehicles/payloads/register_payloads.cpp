#include "vehicles/payloads/register_payloads.h"

#include "vehicles/payloads/canopy_camera.h"
#include "vehicles/payloads/sprayer.h"

namespace vinerow::vehicles {

void register_payloads(Registry& registry) {
  registry.add_payload(canopy_camera_spec(), make_canopy_camera);
  registry.add_payload(sprayer_spec(), make_sprayer);
}

}  // namespace vinerow::vehicles
