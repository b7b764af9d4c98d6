#include "engine/playback/log_scene.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "engine/api/map.h"
#include "engine/api/messages/camera.h"
#include "engine/api/vehicle.h"
#include "engine/api/world_model.h"
#include "engine/math/srgb.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::playback {
namespace {

using Eigen::Vector3d;
using record::SceneEntity;
using record::SceneTriangles;

constexpr const char* kWorldFrame = "map";
constexpr std::array<double, 4> kGround = {0.46, 0.44, 0.30, 1.0};
constexpr std::array<double, 4> kCanopy = {0.25, 0.47, 0.16, 1.0};

/// Classes of solid objects in a world, in the order in which they are left out if there are too
/// many points.
struct SolidClass {
  SurfaceClass surface;
  std::array<double, 4> colour;
};
constexpr std::array<SolidClass, 4> kSolids = {{
    {SurfaceClass::kTrunk, {0.36, 0.26, 0.18, 1.0}},
    {SurfaceClass::kWire, {0.55, 0.55, 0.56, 1.0}},
    {SurfaceClass::kPost, {0.48, 0.40, 0.32, 1.0}},
    {SurfaceClass::kObstacle, {0.80, 0.45, 0.15, 1.0}},
}};

void add_mesh(const TriangleMesh& mesh, const Pose& X_WM, SceneTriangles& out) {
  const auto first = static_cast<std::uint32_t>(out.points.size());
  for (const Eigen::Vector3f& v : mesh.vertices) out.points.push_back(X_WM * v.cast<double>());
  for (const auto& triangle : mesh.triangles) {
    const bool sound = std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t index) {
      return index < mesh.vertices.size();
    });
    if (!sound) continue;
    for (const std::uint32_t index : triangle) out.indices.push_back(first + index);
  }
}

/// Adds two triangles, counter-clockwise seen from outside.
void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
              SceneTriangles& out) {
  out.indices.insert(out.indices.end(), {a, b, c, a, c, d});
}

void add_box(const Eigen::AlignedBox3d& box, SceneTriangles& out) {
  const auto first = static_cast<std::uint32_t>(out.points.size());
  for (int corner = 0; corner < 8; ++corner) {
    out.points.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  // Bits 0, 1, 2 of a corner's index: x, y, z is at its maximum.
  constexpr std::uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : kFaces) {
    add_quad(first + f[0], first + f[1], first + f[2], first + f[3], out);
  }
}

/// False for levels of detail such as "trunk/x#lod0" for which a coarser mesh exists.
bool is_coarsest(const MeshInstance& instance, const std::set<std::string_view>& names) {
  const std::size_t mark = instance.name.find("#lod");
  if (mark == std::string::npos || mark + 5 != instance.name.size()) return true;
  std::string next = instance.name;
  ++next.back();
  return !names.contains(next);
}

class GroundMaker {
 public:
  GroundMaker(const HeightField& field, const SceneLimits& limits)
      : field_(field), half_(std::max<std::size_t>(limits.ground_samples / 2, 4)) {}

  SceneTriangles make(const Eigen::AlignedBox2d& focus_W) {
    const Eigen::AlignedBox2d all(
        field_.corner_W, field_.corner_W + Eigen::Vector2d(field_.width_m(), field_.depth_m()));
    const Eigen::AlignedBox2d inner = all.intersection(focus_W);
    // Lowers the coarse surface, which would hide the fine one where it is higher.
    constexpr double kBelow_m = 0.15;
    if (inner.isEmpty()) {
      add(all, {}, 0.0);
    } else {
      add(inner, {}, 0.0);
      add(all, inner, kBelow_m);
    }
    return std::move(out_);
  }

 private:
  /// Adds samples of an area, except inside `hole`.
  void add(const Eigen::AlignedBox2d& area, const Eigen::AlignedBox2d& hole, double below_m) {
    const Eigen::Vector2d size = area.sizes();
    const double cell_m =
        std::max(field_.cell_m, std::sqrt(size.x() * size.y() / static_cast<double>(half_)));
    const int columns = std::max(1, static_cast<int>(std::ceil(size.x() / cell_m)));
    const int rows = std::max(1, static_cast<int>(std::ceil(size.y() / cell_m)));
    const auto first = static_cast<std::uint32_t>(out_.points.size());
    const auto place = [&](int i, int j) {
      return Eigen::Vector2d(area.min() +
                             Eigen::Vector2d(size.x() * i / columns, size.y() * j / rows));
    };
    for (int j = 0; j <= rows; ++j) {
      for (int i = 0; i <= columns; ++i) {
        const Eigen::Vector2d p = place(i, j);
        out_.points.emplace_back(p.x(), p.y(), field_.height_m(p.x(), p.y()) - below_m);
      }
    }
    const auto index = [&](int i, int j) {
      return first + static_cast<std::uint32_t>(j * (columns + 1) + i);
    };
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        if (!hole.isEmpty() && hole.contains(place(i, j)) && hole.contains(place(i + 1, j + 1))) {
          continue;
        }
        add_quad(index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1), out_);
      }
    }
  }

  const HeightField& field_;
  std::size_t half_;
  SceneTriangles out_;
};

/// Adds a row as a bar of its canopy's width and height that follows the ground.
void add_row_bar(const WorldModel& world, const PlantRow& row, double step_m, SceneTriangles& out) {
  const auto ground_m = [&](const Vector3d& p) {
    return world.terrain ? world.terrain->height_m(p.x(), p.y()) : p.z();
  };
  std::optional<std::uint32_t> before;
  const auto add_section = [&](const Vector3d& p, const Vector3d& along) {
    Vector3d left(-along.y(), along.x(), 0.0);
    left *= 0.5 * row.canopy_width_m / std::max(left.norm(), 1e-9);
    const double base_m = ground_m(p) + row.canopy_base_m, top_m = ground_m(p) + row.canopy_top_m;
    const auto first = static_cast<std::uint32_t>(out.points.size());
    const Vector3d right = p - left, at_left = p + left;
    out.points.emplace_back(right.x(), right.y(), base_m);
    out.points.emplace_back(at_left.x(), at_left.y(), base_m);
    out.points.emplace_back(at_left.x(), at_left.y(), top_m);
    out.points.emplace_back(right.x(), right.y(), top_m);
    if (before) {
      const std::uint32_t b = *before;
      for (std::uint32_t k = 0; k < 4; ++k) {
        const std::uint32_t next = (k + 1) % 4;
        add_quad(b + k, b + next, first + next, first + k, out);
      }
    } else {
      add_quad(first, first + 3, first + 2, first + 1, out);
    }
    before = first;
  };
  for (std::size_t i = 0; i + 1 < row.line_W.size(); ++i) {
    const Vector3d from = row.line_W[i], to = row.line_W[i + 1];
    const int steps =
        std::max(1, static_cast<int>(std::ceil((to - from).head<2>().norm() / step_m)));
    for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
      add_section(from + (to - from) * k / steps, to - from);
    }
  }
  if (before) add_quad(*before, *before + 1, *before + 2, *before + 3, out);
}

double row_line_length_m(const PlantRow& row) {
  double sum_m = 0.0;
  for (std::size_t i = 0; i + 1 < row.line_W.size(); ++i) {
    sum_m += (row.line_W[i + 1] - row.line_W[i]).norm();
  }
  return sum_m;
}

SceneTriangles canopy_of(const WorldModel& world, const SceneLimits& limits) {
  SceneTriangles canopy;
  canopy.colour = kCanopy;
  std::size_t points = 0;
  const auto is_hull = [](const MeshInstance& instance) {
    return instance.mesh && instance.surface == SurfaceClass::kCanopy && instance.collides;
  };
  for (const MeshInstance& instance : world.meshes) {
    if (is_hull(instance)) points += instance.mesh->vertices.size();
  }
  if (points > 0 && points <= limits.canopy_points) {
    for (const MeshInstance& instance : world.meshes) {
      if (is_hull(instance)) add_mesh(*instance.mesh, instance.X_WM, canopy);
    }
    return canopy;
  }
  double row_length_m = 0.0;
  for (const PlantRow& row : world.rows->rows) row_length_m += row_line_length_m(row);
  // Four points for each section of a bar.
  const double step_m =
      std::max(2.0, 4.0 * row_length_m / static_cast<double>(limits.canopy_points));
  for (const PlantRow& row : world.rows->rows) add_row_bar(world, row, step_m, canopy);
  return canopy;
}

/// Meshes of one class, without foliage and with only the coarsest level of detail.
SceneTriangles solids_of(const WorldModel& world, const SolidClass& kind) {
  std::set<std::string_view> names;
  for (const MeshInstance& instance : world.meshes) names.insert(instance.name);
  SceneTriangles solids;
  solids.colour = kind.colour;
  for (const MeshInstance& instance : world.meshes) {
    if (!instance.mesh || instance.surface != kind.surface || !instance.visible) continue;
    if (is_coarsest(instance, names)) add_mesh(*instance.mesh, instance.X_WM, solids);
  }
  return solids;
}

/// sRGB value of a linear intensity.
double srgb_of(double linear) {
  return srgb_from_linear(std::clamp(linear, 0.0, 1.0));
}

std::array<double, 4> colour_of(const VehicleLink& link) {
  Eigen::Vector3f colour = link.material.colour;
  if (!link.mesh->colours.empty()) {
    // Vertex colours are represented by their mean.
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& tint : link.mesh->colours) mean += tint;
    colour = colour.cwiseProduct(mean / static_cast<float>(link.mesh->colours.size()));
  }
  return {srgb_of(colour.x()), srgb_of(colour.y()), srgb_of(colour.z()), 1.0};
}

void add_entity(const std::string& id, SceneTriangles triangles,
                std::vector<SceneEntity>& entities) {
  if (triangles.indices.empty()) return;
  entities.push_back({id, kWorldFrame, {}});
  entities.back().triangles.push_back(std::move(triangles));
}

}  // namespace

std::vector<SceneEntity> world_scene(const WorldModel& world, const SceneLimits& limits) {
  std::vector<SceneEntity> entities;
  if (world.terrain) {
    constexpr double kHeadland_m = 15.0;
    Eigen::AlignedBox2d focus;
    for (const PlantRow& row : world.rows->rows) {
      for (const Vector3d& p : row.line_W) focus.extend(p.head<2>());
    }
    if (!focus.isEmpty()) {
      const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kHeadland_m);
      focus = Eigen::AlignedBox2d(focus.min() - margin, focus.max() + margin);
    }
    SceneTriangles ground = GroundMaker(*world.terrain, limits).make(focus);
    ground.colour = kGround;
    add_entity("ground", std::move(ground), entities);
  } else {
    add_entity("ground", solids_of(world, {SurfaceClass::kTerrain, kGround}), entities);
  }
  add_entity("canopy", canopy_of(world, limits), entities);

  std::vector<SceneTriangles> solids;
  std::size_t points = 0;
  for (const SolidClass& kind : kSolids) {
    solids.push_back(solids_of(world, kind));
    points += solids.back().points.size();
  }
  for (std::size_t k = 0; k < kSolids.size(); ++k) {
    if (points > limits.solid_points) {
      points -= solids[k].points.size();
      continue;
    }
    add_entity(to_string(kSolids[k].surface), std::move(solids[k]), entities);
  }
  return entities;
}

std::vector<SceneEntity> vehicle_scene(const std::string& vehicle,
                                       const std::vector<VehicleLink>& links,
                                       const SceneLimits& limits) {
  std::vector<SceneEntity> entities;
  std::size_t points = 0;
  for (const VehicleLink& link : links) {
    if (!link.mesh || link.mesh->triangles.empty()) continue;
    SceneTriangles shape;
    shape.colour = colour_of(link);
    if (points + link.mesh->vertices.size() <= limits.vehicle_points) {
      add_mesh(*link.mesh, Pose{}, shape);
    } else {
      add_box(link.mesh->bounds(), shape);
    }
    points += shape.points.size();
    const std::string frame = vehicle + "/" + link.name;
    entities.push_back({frame, frame, {}});
    entities.back().triangles.push_back(std::move(shape));
  }
  return entities;
}

std::string sensor_frame(const std::string& vehicle, const std::string& sensor,
                         const std::vector<VehicleLink>& links) {
  const bool is_link = std::any_of(links.begin(), links.end(),
                                   [&](const VehicleLink& link) { return link.name == sensor; });
  return fmt::format("{}/{}{}", vehicle, sensor, is_link ? "_sensor" : "");
}

namespace {

/// End of the name of a camera's optical frame.
constexpr const char* kOptical = "_optical";

/// Signals of pictures are in the optical frame of their camera (ROS REP 103).
bool is_optical(const SignalBase& signal) {
  const std::string_view type = signal.type();
  return type == Picture::kType || type == CameraInfo::kType;
}

std::string writer_of(const VehicleRuntime& vehicle, const std::string& sensor) {
  return fmt::format("{}.sensors.{}", vehicle.name(), sensor);
}

}  // namespace

std::vector<record::StaticTransform> sensor_transforms(const Simulation& simulation) {
  // x to the right, y down, z along the axis, in S with x along the axis and z up.
  Pose X_SC;
  X_SC.q = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  std::vector<record::StaticTransform> transforms;
  for (const auto& vehicle : simulation.vehicles()) {
    for (const SensorMounting& sensor : vehicle->mountings()) {
      const std::string frame =
          sensor_frame(vehicle->name(), sensor.name, vehicle->vehicle().links());
      transforms.push_back({vehicle->name() + "/base_link", frame, sensor.X_BS});
      const std::string writer = writer_of(*vehicle, sensor.name);
      const auto& signals = simulation.bus().signals();
      const bool is_camera = std::any_of(signals.begin(), signals.end(), [&](const auto& signal) {
        return signal->writer() == writer && is_optical(*signal);
      });
      if (is_camera) transforms.push_back({frame, frame + kOptical, X_SC});
    }
  }
  return transforms;
}

std::map<std::string, std::string> frames_of_readings(const Simulation& simulation) {
  std::map<std::string, std::string> frames;
  for (const auto& vehicle : simulation.vehicles()) {
    for (const SensorMounting& sensor : vehicle->mountings()) {
      const std::string signal = vehicle->name() + "/" + sensor.name;
      const std::string frame =
          sensor_frame(vehicle->name(), sensor.name, vehicle->vehicle().links());
      frames[signal] = frames[signal + "_truth"] = frame;
      const std::string writer = writer_of(*vehicle, sensor.name);
      for (const auto& other : simulation.bus().signals()) {
        if (other->writer() == writer && is_optical(*other)) {
          frames[other->name()] = frame + kOptical;
        }
      }
    }
  }
  for (const auto& signal : simulation.bus().signals()) {
    const auto source = frames.find(signal->frame_source());
    if (source != frames.end()) frames[signal->name()] = source->second;
  }
  return frames;
}

}  // namespace vinerow::playback
