#pragma once
/// Place of a vehicle in the alley where it started.

#include "engine/api/forward.h"
#include "engine/math/polyline.h"
#include "engine/math/pose.h"

namespace vinerow::tasks {

class AlleyTrack {
 public:
  struct Place {
    double along_m = 0.0;      ///< from the alley's first point in the direction of travel
    double lateral_m = 0.0;    ///< from the centre line, positive to the left
    double heading_rad = 0.0;  ///< relative to the centre line, positive to the left
  };

  AlleyTrack() = default;
  /// The alley nearest to the vehicle, in the direction that it heads.
  /// @param who  for errors @throws ConfigError if the world has no alley
  AlleyTrack(const RowMap& rows, const Pose& X_WB, const std::string& who);
  /// The alley next to it, to the side of `step` (-1, 1 in the world's order; the other side at the
  /// edge of the block), in the opposite direction. @throws ConfigError if there is only one
  AlleyTrack neighbour(const RowMap& rows, int step, const std::string& who) const;

  Place place(const Pose& X_WB) const;
  double length_m() const { return line_.length_m(); }
  double width_m() const { return width_m_; }

 private:
  AlleyTrack(const RowMap& rows, int index, bool reversed);

  Polyline line_;
  double width_m_ = 0.0;
  int index_ = 0;
  bool reversed_ = false;
};

}  // namespace vinerow::tasks
