#include "engine/sensors/mounting.h"

#include "engine/api/parameter_table.h"

namespace vinerow::sensors {

const ParameterTable<MountingParams>& mounting_table() {
  using P = MountingParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .numbers("position_m", "m", &P::position_m, between(-100.0, 100.0),
                   "position of the sensor in the body frame (x forward, y left, z up)")
          .numbers("rotation_deg", "deg", &P::rotation_rad, between(-360.0, 360.0),
                   "roll, pitch, yaw of the sensor in the body frame; it looks along its x axis", 3,
                   kDegrees);
  return table;
}

Pose MountingParams::X_BS() const {
  return {quaternion_from_rpy({rotation_rad.x(), rotation_rad.y(), rotation_rad.z()}), position_m};
}

}  // namespace vinerow::sensors
