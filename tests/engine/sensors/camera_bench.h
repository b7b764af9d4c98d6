#pragma once
/// A camera sensor in a small world, for its tests.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "engine/api/messages/camera.h"
#include "engine/math/angles.h"
#include "engine/physics/static_scene.h"
#include "tests/engine/physics/small_worlds.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"

namespace vinerow::sensors::camera_test {

using Eigen::Vector3d;
using Eigen::Vector3f;
namespace small = physics::test;

/// A camera on a vehicle that is where the test says.
class CameraBench {
 public:
  CameraBench(std::shared_ptr<const WorldModel> world, const test::SensorValues& values,
              std::function<VehicleScene&()> vehicles = {})
      : scene_(world), world_(world) {
    SensorContext context = bench_.context(10.0);
    context.vehicles = std::move(vehicles);
    context.scene = &scene_.queries();
    context.light = [this]() -> const RayScene& { return scene_.light(); };
    context.world = world_.get();
    const ParameterSet parameters = test::sensor_parameters("camera", values);
    sensor_ = test::sensor_registry().make_sensor("camera", parameters, context);
    bench_.connect(*sensor_);
  }

  void step(const Odometry& state) {
    bench_.truth.write(now_, state);
    sensor_->step(now_);
    now_ = now_ + Duration{100'000'000};
  }
  void step(const Pose& X_WB) {
    Odometry state;
    state.X_WB = X_WB;
    step(state);
  }

  template <class T>
  const T& value(const std::string& name) {
    return static_cast<const Signal<T>&>(*bench_.bus.find(name)).value();
  }
  const Picture& picture(const char* layer = "") {
    return value<Picture>(std::string("rover/s") + layer);
  }
  const RayScene& light() const { return scene_.light(); }
  const WorldModel& world() const { return *world_; }
  SignalBus& bus() { return bench_.bus; }

 private:
  physics::StaticScene scene_;
  std::shared_ptr<const WorldModel> world_;
  test::SensorBench bench_;
  std::unique_ptr<Sensor> sensor_;
  Time now_{0};
};

inline std::uint32_t number(const Picture& picture, int x, int y) {
  const std::size_t bytes = Picture::bytes_per_pixel(picture.format);
  const std::size_t at = bytes * (static_cast<std::size_t>(y) * picture.width + x);
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < bytes; ++k) value |= std::uint32_t{picture.data[at + k]} << (8 * k);
  return value;
}

/// 120 x 90 pixels, 60 degrees wide, without noise.
inline const test::SensorValues kSmall = {{"width_px", std::int64_t{120}},
                                          {"height_px", std::int64_t{90}},
                                          {"horizontal_fov_deg", 60.0},
                                          {"noise", false}};

inline test::SensorValues with(test::SensorValues values, const test::SensorValues& more) {
  values.insert(values.end(), more.begin(), more.end());
  return values;
}

inline Pose at(double x, double y, double z, double pitch_deg = 0.0) {
  return {quaternion_from_rpy({0.0, rad_from_deg(pitch_deg), 0.0}), {x, y, z}};
}

/// Level ground at z = 0, 40 m wide.
inline std::shared_ptr<WorldModel> flat_world() {
  auto world = std::make_shared<WorldModel>();
  world->terrain = small::make_flat(0.0, 81, 0.5);
  return world;
}

inline MeshInstance box(const char* name, const Vector3d& middle, const Vector3f& half,
                        SurfaceClass surface, const Vector3f& colour = {0.5f, 0.5f, 0.5f}) {
  MeshInstance instance = small::make_instance(name, small::make_box_mesh(half), middle, surface);
  instance.material.colour = colour;
  return instance;
}

/// Direction of a pixel's middle in W, by the pinhole's formula.
inline Vector3d direction_W(const CameraInfo& info, const Pose& X_WS, double u, double v) {
  const Vector3d C((u - info.cx_px) / info.fx_px, (v - info.cy_px) / info.fy_px, 1.0);
  return (X_WS.q * Vector3d(C.z(), -C.x(), -C.y())).normalized();
}

}  // namespace vinerow::sensors::camera_test
