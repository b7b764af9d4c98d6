#include <vinerow/api/plugin.h>

#include "alley_centring.h"

namespace {

void register_parts(vinerow::Registry& registry) {
  registry.add_controller(alley_centring_spec(), make_alley_centring);
}

}  // namespace

VINEROW_PLUGIN(register_parts)
