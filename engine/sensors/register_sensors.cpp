#include "engine/sensors/register_sensors.h"

#include "engine/sensors/air_data.h"
#include "engine/sensors/barometer.h"
#include "engine/sensors/camera/camera.h"
#include "engine/sensors/camera_trigger.h"
#include "engine/sensors/encoders.h"
#include "engine/sensors/gnss.h"
#include "engine/sensors/gnss_heading.h"
#include "engine/sensors/gps.h"
#include "engine/sensors/imu.h"
#include "engine/sensors/ins.h"
#include "engine/sensors/lidar.h"
#include "engine/sensors/lidar_3d.h"
#include "engine/sensors/magnetometer.h"
#include "engine/sensors/ultrasound.h"
#include "engine/sensors/wheel_odometry.h"

namespace vinerow::sensors {

void register_sensors(Registry& registry) {
  registry.add_sensor(air_data_spec(), make_air_data);
  registry.add_sensor(barometer_spec(), make_barometer);
  registry.add_sensor(camera_spec(), make_camera);
  registry.add_sensor(camera_trigger_spec(), make_camera_trigger);
  registry.add_sensor(encoders_spec(), make_encoders);
  registry.add_sensor(gnss_spec(), make_gnss);
  registry.add_sensor(gnss_heading_spec(), make_gnss_heading);
  registry.add_sensor(gps_spec(), make_gps);
  registry.add_sensor(imu_spec(), make_imu);
  registry.add_sensor(ins_spec(), make_ins);
  registry.add_sensor(lidar_spec(), make_lidar);
  registry.add_sensor(lidar_3d_spec(), make_lidar_3d);
  registry.add_sensor(magnetometer_spec(), make_magnetometer);
  registry.add_sensor(ultrasound_spec(), make_ultrasound);
  registry.add_sensor(wheel_odometry_spec(), make_wheel_odometry);
}

}  // namespace vinerow::sensors
