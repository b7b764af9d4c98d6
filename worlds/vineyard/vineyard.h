#pragma once
/// World `vineyard`: parametric vine rows on sloping ground. Its meshes are written to files once
/// and read through assimp. The default is Parcel F of the Barolo vineyard in Mammarella et al.,
/// "Cooperation of unmanned systems for agricultural applications: A case study in a vineyard",
/// Biosystems Engineering 2022, section 3: 16 rows of 118 m, 2.5 m apart, a vine each 0.9 m, 30 m
/// of relief.

#include "engine/api/registry.h"

namespace vinerow::worlds {

void register_vineyard(Registry& registry);

}  // namespace vinerow::worlds
