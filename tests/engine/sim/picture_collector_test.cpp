/// What goes with a survey's pictures: where the camera truly was, and where its vehicle thought
/// it.

#include "engine/sim/picture_collector.h"

#include <gtest/gtest.h>

#include "engine/math/angles.h"
#include "engine/sensors/register_sensors.h"

namespace vinerow::picture_collector_test {
namespace {

using Eigen::Vector3d;

scenario::NamedPart camera() {
  Registry registry;
  sensors::register_sensors(registry);
  const PartSpec& spec = registry.spec(PartKind::kSensor, "camera_trigger");
  ParameterSet parameters(spec.parameters, "camera_trigger");
  parameters.set("position_m", std::vector<double>{0.2, 0.0, -0.1});
  scenario::NamedPart part;
  part.name = "camera";
  part.part.type = "camera_trigger";
  part.part.parameters = parameters;
  return part;
}

struct Bench {
  Bench() : collector(bus, "plane", camera()) {
    Ports ports(bus, "plane", "test");
    shots = ports.write<CameraShot>("camera");
    estimates = ports.write<Odometry>("estimate");
  }
  void shoot(Time t, int index) {
    CameraShot shot;
    shot.index = index;
    shot.X_WS.p = {100.0 + index, 0, 95};
    shots.write(t, shot);
    collector.look();
  }
  SignalBus bus;
  PictureCollector collector;
  SignalWriter<CameraShot> shots;
  SignalWriter<Odometry> estimates;
};

TEST(PictureCollector, TellsWhereTheEstimateHasTheCameraAtTheShot) {
  Bench bench;
  Odometry estimate;
  estimate.X_WB = {quaternion_from_rpy({0.0, 0.0, 0.5 * kPi}), {99.0, 2.0, 94.0}};
  estimate.v_WB_B = {12.0, 0.0, 0.0};  // north
  bench.estimates.write(Time{1'000'000'000}, estimate);
  bench.shoot(Time{1'010'000'000}, 0);
  const PictureSet& pictures = *bench.collector.product().pictures;
  ASSERT_EQ(pictures.X_WS.size(), 1u);
  EXPECT_EQ(pictures.X_WS[0].p, Vector3d(100, 0, 95));
  ASSERT_EQ(pictures.estimated_W.size(), 1u);
  // 0.2 m ahead of the body, which is north, and 10 ms at 12 m/s.
  EXPECT_NEAR((pictures.estimated_W[0] - Vector3d(99.0, 2.0 + 0.2 + 0.12, 93.9)).norm(), 0.0, 1e-9);
  // The stamp of a late shot counts, not the time of its arrival.
  bench.estimates.write(Time{2'000'000'000}, estimate);
  bench.shoot(Time{1'900'000'000}, 1);
  EXPECT_NEAR((pictures.estimated_W[1] - Vector3d(99.0, 2.2 - 1.2, 93.9)).norm(), 0.0, 1e-9);
}

TEST(PictureCollector, HasNothingToTellWhereNobodyKnewThePlaceOfAPicture) {
  Bench bench;
  bench.shoot(Time{1}, 0);
  bench.estimates.write(Time{2}, Odometry{});
  bench.shoot(Time{3}, 1);
  EXPECT_EQ(bench.collector.count(), 2);
  EXPECT_TRUE(bench.collector.product().pictures->estimated_W.empty());
}

}  // namespace
}  // namespace vinerow::picture_collector_test
