#pragma once
/// Base class of satellite receivers: an antenna and its position on the ellipsoid.

#include "engine/api/messages/sensors.h"
#include "engine/api/world_model.h"
#include "engine/math/geo.h"
#include "engine/sensors/mounted_sensor.h"

namespace vinerow::sensors {

class SatelliteReceiver : public MountedSensor<GnssFix> {
 protected:
  SatelliteReceiver(const ParameterSet& parameters, const SensorContext& context)
      : MountedSensor(parameters, context), frame_(context.world->origin) {}

  /// Position and velocity of the antenna, without error.
  GnssFix exact_fix() const {
    GnssFix exact;
    exact.valid = true;
    exact.p_W = X_WS().p;
    exact.v_W = v_WS();
    locate(exact);
    return exact;
  }

  /// Sets latitude, longitude and altitude to those of p_W.
  void locate(GnssFix& fix) const {
    const Geodetic g = frame_.to_geodetic(fix.p_W);
    fix.latitude_rad = g.latitude_rad;
    fix.longitude_rad = g.longitude_rad;
    fix.altitude_m = g.altitude_m;
  }

 private:
  LocalFrame frame_;
};

}  // namespace vinerow::sensors
