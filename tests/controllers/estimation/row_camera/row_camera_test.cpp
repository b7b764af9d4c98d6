/// The estimator `row_camera` between signals that a test writes by hand, without pictures.

#include <gtest/gtest.h>

#include <vector>

#include "engine/api/map.h"
#include "engine/api/messages/camera.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/sensors.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/mission.h"

namespace vinerow::test::row_camera_test {
namespace {

/// Yaw after turning to the left by 0.4 rad in a second, as a unit with this mounting measures it.
double yaw_by_unit(const Eigen::Quaterniond& q_BI) {
  SensorMounting camera, unit;
  camera.name = "camera";
  camera.type = "camera";
  unit.name = "imu";
  unit.X_BS.q = q_BI;
  RowMap map;
  PlantRow row;
  row.line_W = {{0, 2, 0}, {20, 2, 0}};
  map.rows.push_back(row);
  const VehicleDescription rover = make_rover_description();
  EstimatorContext context;
  context.vehicle = "rover";
  context.part = "rover.estimator";
  context.period = Duration{25'000'000};
  context.vehicle_description = &rover;
  context.sensors = {camera, unit};
  context.map = &map;
  const Values values = {{"camera", std::string("camera")},
                         {"imu", std::string("imu")},
                         {"start_std_m", 0.0},
                         {"start_yaw_std_deg", 0.0}};
  const PartSpec& spec = parts().spec(PartKind::kEstimator, "row_camera");
  const auto estimator =
      parts().make_estimator("row_camera", make_parameters(spec, values), context);

  SignalBus bus;
  Ports world(bus, "rover", "test");
  SignalWriter<Odometry> truth = world.write<Odometry>("truth");
  SignalWriter<ImuSample> imu = world.write<ImuSample>("imu");
  world.write<NamedValues>("wheels");
  world.write<Picture>("camera_semantic");
  world.write<CameraInfo>("camera_info");
  const SignalReader<Odometry> estimate = world.read<Odometry>("estimate");
  Ports ports(bus, "rover", "rover.estimator");
  estimator->connect(ports);
  truth.write(Time{}, Odometry{});
  ImuSample sample;
  sample.w_WS_S = q_BI.conjugate() * Eigen::Vector3d(0, 0, 0.4);
  Time now;
  for (int i = 0; i <= 40; ++i) {
    imu.write(now, sample);
    estimator->step(now);
    now = now + context.period;
  }
  return yaw_from_quaternion(estimate.value().X_WB.q);
}

TEST(RowCamera, KnowsHowTheInertialUnitIsMounted) {
  EXPECT_NEAR(yaw_by_unit(Eigen::Quaterniond::Identity()), 0.4, 1e-9);
  EXPECT_NEAR(yaw_by_unit(quaternion_from_rpy({kPi, 0, 0})), 0.4, 1e-9);        // upside down
  EXPECT_NEAR(yaw_by_unit(quaternion_from_rpy({0.5 * kPi, 0, 1})), 0.4, 1e-9);  // on its side
}

}  // namespace
}  // namespace vinerow::test::row_camera_test
