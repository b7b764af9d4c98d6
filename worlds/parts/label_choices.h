#pragma once
/// Words of the parameter `label`: what cameras call a mesh that a scenario adds.

#include <array>
#include <optional>

#include "engine/api/parameter_table.h"
#include "engine/api/surface.h"

namespace vinerow::worlds {

inline constexpr std::array<Choice<std::optional<Label>>, 10> kLabelChoices = {
    {{"leaf", Label::kLeaf},
     {"wood", Label::kWood},
     {"bunch", Label::kBunch},
     {"fruit", Label::kFruit},
     {"post", Label::kPost},
     {"wire", Label::kWire},
     {"obstacle", Label::kObstacle},
     {"vehicle", Label::kVehicle},
     {"person", Label::kPerson},
     {"weed", Label::kWeed}}};

}  // namespace vinerow::worlds
