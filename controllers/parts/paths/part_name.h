#pragma once
/// Name of a controller in errors.

#include <string>

#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// "drone.controller (quadrotor_mpc)"
inline std::string part_name(const ControllerContext& context, const std::string& type) {
  return context.part + " (" + type + ")";
}

}  // namespace vinerow::controllers
