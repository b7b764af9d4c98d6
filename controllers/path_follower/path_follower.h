#pragma once
/// Controller `path_follower`: curvature feed-forward, dynamic lookahead, speed profile, slip
/// estimation.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec path_follower_spec();

/// @throws ConfigError if the vehicle has no left and right wheel speeds
std::unique_ptr<Controller> make_path_follower(const ParameterSet& parameters,
                                               const ControllerContext& context);

}  // namespace vinerow::controllers
