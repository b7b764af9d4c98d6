#pragma once
/// What a picture shows, as plain data: the world, the vehicles' links, and lines drawn over it.

#include <memory>
#include <string>
#include <vector>

#include "engine/api/vehicle.h"
#include "engine/api/world_model.h"
#include "engine/core/result.h"

namespace vinerow::render {

/// A vehicle at one instant.
struct VehicleDrawing {
  const std::vector<VehicleLink>* links = nullptr;
  std::vector<Pose> X_WL;  ///< same order
};

/// A line over the ground or in the air (trail, plan, sensor ray), drawn as a ribbon of constant pixel width.
struct Polyline {
  std::vector<Eigen::Vector3d> points_W;
  Eigen::Vector3f colour = {1, 1, 0};
  float width_px = 3.0f;
  float alpha = 1.0f;
  bool dashed = false;
};

struct Camera {
  Pose X_WC;               ///< x right, y down, z forward (optical frame)
  double fov_rad = 0.96;   ///< vertical
  bool orthographic = false;
  double ortho_height_m = 50.0;  ///< of the picture, for orthographic cameras
};

struct Frame {
  Camera camera;
  std::vector<VehicleDrawing> vehicles;
  std::vector<Polyline> lines;
  std::vector<std::string> caption;  ///< lower left, first line larger
  int width = 1280;
  int height = 720;
  int samples = 4;
};

struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< top row first
};

/// Draws frames of one world. Geometry is uploaded once.
class Renderer {
 public:
  virtual ~Renderer() = default;
  virtual Image draw(const Frame& frame) = 0;
};

/// @returns the renderer, or why there is none ("libOSMesa.so.8 cannot be loaded: ...")
Result<std::unique_ptr<Renderer>> make_renderer(const WorldModel& world);

/// @throws std::runtime_error when the file cannot be written
void write_png(const std::string& file, const Image& image);

/// Digest of the pixels.
std::string image_digest(const Image& image);

}  // namespace vinerow::render
