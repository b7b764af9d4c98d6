#pragma once
/// Interface of parts that need the ground of the work area: a guidance that lands.

#include "engine/api/forward.h"

namespace vinerow {

/// Additional base class of a Guidance that queries the ground. It gets the same ground as
/// planners: the ground of the vehicle's map, or the true ground if the map does not contain any.
class SeesGround {
 public:
  virtual ~SeesGround() = default;
  /// Called once, before the first step. @param ground  outlives the part
  virtual void see_ground(const SceneQuery& ground) = 0;
};

}  // namespace vinerow
