#include "tools/dataset/thing_shapes.h"

#include <algorithm>
#include <limits>

#include "engine/api/map.h"

namespace vinerow::dataset {
namespace {

using Eigen::Vector3d;

/// Mean of the vertices whose height is within 5 % of the thing's from this height.
Vector3d mean_near(const std::vector<Vector3d>& vertices, double z, double height_m) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const Vector3d& v : vertices) {
    if (std::abs(v.z() - z) > 0.05 * height_m) continue;
    sum += v;
    ++count;
  }
  return sum / count;
}

}  // namespace

std::string class_of(const MeshInstance& instance) {
  if (instance.surface == SurfaceClass::kTrunk && !instance.label) return "trunk";
  return to_string(instance.label.value_or(label_of(instance.surface)));
}

std::vector<Vector3d> vertices_of(const MeshInstance& instance) {
  std::vector<Vector3d> vertices;
  vertices.reserve(instance.mesh->vertices.size());
  for (const Eigen::Vector3f& v : instance.mesh->vertices) {
    vertices.push_back(instance.X_WM * v.cast<double>());
  }
  return vertices;
}

ThingShapes::ThingShapes(const WorldModel& world) : world_(world), numbers_(world.meshes) {}

const ThingShape* ThingShapes::find(std::uint32_t number) {
  const auto found = known_.find(number);
  if (found != known_.end()) return &found->second;
  const sensors::ThingNumbers::Thing thing = numbers_.thing(number);
  if (thing.mesh < 0) return nullptr;
  return &known_.emplace(number, make(thing)).first->second;
}

std::string ThingShapes::class_name(std::uint32_t number) const {
  if (number >= vehicles()) return "vehicle";
  const sensors::ThingNumbers::Thing thing = numbers_.thing(number);
  return thing.mesh < 0 ? "" : class_of(world_.meshes[static_cast<std::size_t>(thing.mesh)]);
}

ThingShape ThingShapes::make(const sensors::ThingNumbers::Thing& thing) const {
  const MeshInstance& instance = world_.meshes[static_cast<std::size_t>(thing.mesh)];
  const TriangleMesh& mesh = *instance.mesh;
  ThingShape shape;
  shape.class_name = class_of(instance);
  std::vector<std::uint32_t> used;
  for (std::uint32_t i = thing.first_triangle; i < thing.end_triangle; ++i) {
    used.insert(used.end(), mesh.triangles[i].begin(), mesh.triangles[i].end());
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const std::uint32_t i : used) {
    shape.vertices_W.push_back(instance.X_WM * mesh.vertices[i].cast<double>());
  }
  shape.has_ends = shape.class_name == "trunk" || shape.class_name == "post";
  if (!shape.has_ends) return shape;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector3d& v : shape.vertices_W) {
    low = std::min(low, v.z());
    high = std::max(high, v.z());
  }
  const Vector3d bottom = mean_near(shape.vertices_W, low, high - low);
  shape.head_W = mean_near(shape.vertices_W, high, high - low);
  shape.head_W.z() = high;
  shape.foot_W = bottom;
  shape.foot_W.z() = low;
  // Trunks and posts reach into the ground.
  if (!world_.terrain) return shape;
  const double ground = world_.terrain->height_m(bottom.x(), bottom.y());
  if (ground > low && ground < high) {
    const double share = (ground - bottom.z()) / std::max(shape.head_W.z() - bottom.z(), 1e-6);
    shape.foot_W = bottom + std::clamp(share, 0.0, 1.0) * (shape.head_W - bottom);
    shape.foot_W.z() = ground;
  }
  return shape;
}

}  // namespace vinerow::dataset
