#pragma once
/// A part that wants to know the ground where it works: a guidance that lands.

#include "engine/api/forward.h"

namespace vinerow {

/// What a Guidance is besides where it looks at the ground. It is told the ground that planners are
/// told: that of the vehicle's map where the map has one, else the true one.
class SeesGround {
 public:
  virtual ~SeesGround() = default;
  /// Once, before the first step. @param ground  outlives the part
  virtual void see_ground(const SceneQuery& ground) = 0;
};

}  // namespace vinerow
