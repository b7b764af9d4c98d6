#include "worlds/mapping/photogrammetry/point_colour.h"

#include <algorithm>
#include <cmath>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/math/srgb.h"

namespace vinerow::mapping {
namespace {

const Eigen::Vector3f kGrass(0.075f, 0.12f, 0.03f);
const Eigen::Vector3f kSoil(0.19f, 0.125f, 0.075f);
const Eigen::Vector3f kWeed(0.06f, 0.16f, 0.03f);

/// In [0, 1), the same for the same cell of the lattice.
double lattice_value(std::int64_t i, std::int64_t j) {
  std::uint64_t h = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ull ^
                    static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4Full;
  h ^= h >> 29;
  h *= 0xBF58476D1CE4E5B9ull;
  h ^= h >> 32;
  return static_cast<double>(h >> 11) * 0x1.0p-53;
}

/// In [0, 1), blended between the lattice's corners.
double patches(double x, double y) {
  const double i = std::floor(x), j = std::floor(y), u = x - i, v = y - j;
  const auto column = static_cast<std::int64_t>(i), row = static_cast<std::int64_t>(j);
  const double low = (1 - u) * lattice_value(column, row) + u * lattice_value(column + 1, row);
  const double high =
      (1 - u) * lattice_value(column, row + 1) + u * lattice_value(column + 1, row + 1);
  return (1 - v) * low + v * high;
}

Eigen::Vector3f mean_colour(const MeshInstance& instance) {
  const auto& colours = instance.mesh->colours;
  if (colours.empty()) return instance.material.colour;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& colour : colours) sum += colour.cast<double>();
  return (sum / static_cast<double>(colours.size()))
      .cast<float>()
      .cwiseProduct(instance.material.colour);
}

}  // namespace

PointColour::PointColour(const WorldModel& world) {
  for (const MeshInstance& instance : world.meshes) {
    mesh_colours_.push_back(instance.mesh && instance.collides ? mean_colour(instance)
                                                               : instance.material.colour);
  }
  const double azimuth = world.daylight.sun_azimuth_rad;
  const double elevation = world.daylight.sun_elevation_rad;
  to_sun_W_ = {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
               std::sin(elevation)};
  constexpr int kSteps = 4096;
  for (int k = 0; k < kSteps; ++k) {
    const double value = srgb_from_linear(k / (kSteps - 1.0));
    encoded_.push_back(static_cast<std::uint8_t>(std::lround(255.0 * value)));
  }
}

std::array<std::uint8_t, 3> PointColour::lit(const Eigen::Vector3f& colour,
                                             const Eigen::Vector3d& normal_W, double grain) const {
  constexpr double kSky = 0.9, kSun = 1.8, kGrain = 0.3;
  const double light =
      (kSky * (0.75 + 0.25 * normal_W.z()) + kSun * std::max(0.0, normal_W.dot(to_sun_W_))) *
      (1.0 + kGrain * (2.0 * grain - 1.0));
  std::array<std::uint8_t, 3> rgb;
  const double max_index = static_cast<double>(encoded_.size() - 1);
  for (int c = 0; c < 3; ++c) {
    const double value = std::clamp(light * static_cast<double>(colour[c]), 0.0, 1.0);
    rgb[static_cast<std::size_t>(c)] = encoded_[static_cast<std::size_t>(value * max_index + 0.5)];
  }
  return rgb;
}

std::array<std::uint8_t, 3> PointColour::of(const RayHit& hit, const Eigen::Vector3d& p_W,
                                            double grain) const {
  if (hit.mesh >= 0 && hit.surface != SurfaceClass::kTerrain) {
    return lit(mesh_colours_[static_cast<std::size_t>(hit.mesh)], hit.normal_W, grain);
  }
  const double grass =
      0.6 * patches(p_W.x() / 1.3, p_W.y() / 1.3) + 0.4 * patches(p_W.x() / 0.21, p_W.y() / 0.21);
  const auto share = static_cast<float>(std::clamp(2.5 * (grass - 0.3), 0.0, 1.0));
  return lit(share * kGrass + (1.0f - share) * kSoil, hit.normal_W, grain);
}

std::array<std::uint8_t, 3> PointColour::of_weed(double grain) const {
  return lit(kWeed, Eigen::Vector3d::UnitZ(), grain);
}

}  // namespace vinerow::mapping
