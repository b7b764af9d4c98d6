#include "engine/sensors/camera/scene_look.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::sensors {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3f kLuminance(0.2126f, 0.7152f, 0.0722f);

/// Air scatters about as the fourth power of the wavelength, here against red, 668 nm.
constexpr float kRedEdgeAir = 0.75f, kNirAir = 0.40f;

/// Reflectance in the near infrared and at the red edge, where a surface's colour does not show it.
/// Leaves: PROSPECT-D (Feret et al., Remote Sens. Environ. 193, 2017) gives 0.28 and 0.46 for
/// green, 0.41 to 0.44 and 0.47 to 0.50 for yellow, red and brown ones. Grass: 0.23 and 0.49 of a
/// sample of ECOSTRESS, here with gaps. Dry soil (PROSAIL's): 0.32 red, 0.35, 0.40. Others are
/// chosen, bark so that its NDVI is 0.2 to 0.3.
struct Infrared {
  float red_edge, nir;
};

/// 1 for green plants, 0 for yellow and brown ones: from the colour, since chlorophyll takes red
/// light. @param full  difference of green and red, as a share of their sum, of a green plant
float greenness(const Vector3f& rgb, float full) {
  const float sum = rgb.x() + rgb.y();
  return sum > 0.0f ? std::clamp((rgb.y() - rgb.x()) / (full * sum), 0.0f, 1.0f) : 0.0f;
}

Infrared infrared_of(const Vector3f& rgb, Label label) {
  // The ground's grass has soil and straw among it.
  constexpr float kLeaf = 1.0f / 3.0f, kGrass = 1.0f / 6.0f;
  const float green = greenness(rgb, label == Label::kGround ? kGrass : kLeaf);
  const auto blend = [&](float dead, float alive) { return dead + green * (alive - dead); };
  switch (label) {
    case Label::kLeaf:
    case Label::kWeed:
      // No leaf is darker in the infrared than in red.
      return {std::max(blend(0.42f, 0.28f), rgb.x()),
              std::max(blend(0.48f, 0.46f), 1.08f * rgb.x())};
    case Label::kGround: {
      // Soil reflects more with the wavelength, and about evenly from red on; grass as leaves with
      // gaps.
      const float soil_edge = 1.1f * rgb.x(), soil_nir = 1.25f * rgb.x();
      return {soil_edge + green * (0.20f - soil_edge), soil_nir + green * (0.42f - soil_nir)};
    }
    case Label::kBunch:
    case Label::kFruit:
      return {0.30f, 0.45f};
    case Label::kWood:
      return {1.2f * rgb.x() + 0.01f, 1.5f * rgb.x() + 0.02f};
    default:
      return {rgb.x(), rgb.x()};
  }
}

/// Point of a triangle by the shares of its corners.
Vector3f shares_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t,
                   const Vector3d& p_M) {
  const Vector3d a = mesh.vertices[t[0]].cast<double>();
  const Vector3d ab = mesh.vertices[t[1]].cast<double>() - a;
  const Vector3d ac = mesh.vertices[t[2]].cast<double>() - a, ap = p_M - a;
  const double bb = ab.dot(ab), bc = ab.dot(ac), cc = ac.dot(ac);
  const double pb = ap.dot(ab), pc = ap.dot(ac), area = bb * cc - bc * bc;
  if (!(area > 0.0)) return {1.0f, 0.0f, 0.0f};
  const double v = std::clamp((cc * pb - bc * pc) / area, 0.0, 1.0);
  const double w = std::clamp((bb * pc - bc * pb) / area, 0.0, 1.0 - v);
  return {static_cast<float>(1.0 - v - w), static_cast<float>(v), static_cast<float>(w)};
}

bool has_texture(const MeshInstance& instance) {
  const std::string& name = instance.material.texture;
  return !name.empty() && !name.starts_with("builtin:") && !instance.material.leaf_cards &&
         instance.mesh->uvs.size() == instance.mesh->vertices.size();
}

/// Of the texture's own length unit, how much a metre of the triangle takes.
double texture_per_m(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vector3f ab = mesh.vertices[t[1]] - mesh.vertices[t[0]];
  const Vector3f ac = mesh.vertices[t[2]] - mesh.vertices[t[0]];
  const Eigen::Vector2f du = mesh.uvs[t[1]] - mesh.uvs[t[0]], dv = mesh.uvs[t[2]] - mesh.uvs[t[0]];
  const double area_m2 = ab.cross(ac).norm();
  const double area = std::abs(static_cast<double>(du.x() * dv.y() - du.y() * dv.x()));
  return area_m2 > 0.0 ? std::sqrt(area / area_m2) : 0.0;
}

}  // namespace

SceneLook::SceneLook(const WorldModel& world, Channel channel)
    : channel_(channel), light_(imaging::make_light(world.daylight)), turf_(world) {
  for (const MeshInstance& instance : world.meshes) {
    if (!instance.mesh || !has_texture(instance)) continue;
    const std::string& file = instance.material.texture;
    if (textures_.contains(file)) continue;
    const Result<imaging::Pixels> pixels = imaging::read_image(file);
    if (!pixels) throw ConfigError("texture " + pixels.reason());
    textures_.emplace(file, *pixels);
  }
  sun_ = light_.sun_irradiance.cast<float>();
  sky_ = light_.sky_irradiance.cast<float>();
  ground_ = light_.ground_irradiance.cast<float>();
  const auto grey = [&](const Vector3f& weights) {
    for (Vector3f* light : {&sun_, &sky_, &ground_}) light->setConstant(weights.dot(*light));
  };
  switch (channel) {
    case Channel::kColour:
      return;
    case Channel::kMono:
      grey(kLuminance);
      return;
    case Channel::kBlue:
      grey(Vector3f::UnitZ());
      return;
    case Channel::kGreen:
      grey(Vector3f::UnitY());
      return;
    case Channel::kRed:
      grey(Vector3f::UnitX());
      return;
    case Channel::kRedEdge:
      air_share_ = kRedEdgeAir;
      break;
    case Channel::kNir:
      air_share_ = kNirAir;
      break;
  }
  grey(Vector3f::UnitX());
  // Clouds scatter all bands alike.
  const Vector3f cloud = light_.cloud_irradiance.cast<float>();
  sky_ = air_share_ * sky_ + Vector3f::Constant((1.0f - air_share_) * cloud.x());
  // What the ground throws back is mostly from grass.
  const Infrared grass = infrared_of({0.07f, 0.10f, 0.04f}, Label::kGround);
  ground_ = (channel == Channel::kNir ? grass.nir : grass.red_edge) *
            (sun_ * static_cast<float>(light_.sun_direction_W.z()) + sky_);
}

Vector3f SceneLook::in_band(const Vector3f& rgb, Label label) const {
  const auto all = [](float value) { return Vector3f(value, value, value); };
  switch (channel_) {
    case Channel::kColour:
      return rgb;
    case Channel::kMono:
      return all(kLuminance.dot(rgb));
    case Channel::kBlue:
      return all(rgb.z());
    case Channel::kGreen:
      return all(rgb.y());
    case Channel::kRed:
      return all(rgb.x());
    case Channel::kRedEdge:
      return all(infrared_of(rgb, label).red_edge);
    case Channel::kNir:
      return all(infrared_of(rgb, label).nir);
  }
  return rgb;
}

SeenSurface SceneLook::surface(const SceneRay& ray, const RayHit& hit,
                               std::span<const MeshInstance> meshes, double footprint_m) const {
  SeenSurface seen;
  const Vector3d p_W = ray.p_W + hit.distance_m * ray.dir_W;
  Vector3d normal_W = hit.normal_W;
  constexpr float kGrey = 0.5f;  // of what is no mesh
  Vector3f rgb(kGrey, kGrey, kGrey);
  bool is_textured = false;
  if (hit.mesh < 0) {
    seen.label = label_of(hit.surface);
  } else {
    const MeshInstance& instance = meshes[static_cast<std::size_t>(hit.mesh)];
    const TriangleMesh& mesh = *instance.mesh;
    seen.label = instance.label.value_or(label_of(instance.surface));
    rgb = instance.material.colour;
    const auto& triangle = mesh.triangles[static_cast<std::size_t>(hit.triangle)];
    const bool has_colours = !mesh.colours.empty(), has_normals = !mesh.normals.empty();
    // Vehicles' textures are not among them.
    const auto texture =
        has_texture(instance) ? textures_.find(instance.material.texture) : textures_.end();
    is_textured = texture != textures_.end();
    if (has_colours || has_normals || is_textured) {
      const Eigen::Matrix3d R_WM = instance.X_WM.q.toRotationMatrix();
      const Vector3f share = shares_of(mesh, triangle, R_WM.transpose() * (p_W - instance.X_WM.p));
      if (has_colours) {
        Vector3f colour = Vector3f::Zero();
        for (int i = 0; i < 3; ++i) colour += share[i] * mesh.colours[triangle[i]];
        rgb = rgb.cwiseProduct(colour);
      }
      if (is_textured) {
        Eigen::Vector2f uv = Eigen::Vector2f::Zero();
        for (int i = 0; i < 3; ++i) uv += share[i] * mesh.uvs[triangle[i]];
        const double spot = footprint_m * texture_per_m(mesh, triangle);
        rgb = rgb.cwiseProduct(texture->second.colour(uv.x(), uv.y(), spot));
      }
      if (has_normals) {
        Vector3f normal_M = Vector3f::Zero();
        for (int i = 0; i < 3; ++i) normal_M += share[i] * mesh.normals[triangle[i]];
        const Vector3d smooth_W = R_WM * normal_M.cast<double>();
        const double length = smooth_W.norm();
        if (length > 0.5) normal_W = smooth_W / length;
        if (normal_W.dot(ray.dir_W) > 0.0) normal_W = -normal_W;
      }
    }
  }
  if (seen.label == Label::kGround && !is_textured)
    rgb = turf_.albedo(p_W.x(), p_W.y(), footprint_m);
  seen.normal_W = normal_W.cast<float>();
  seen.albedo = in_band(rgb, seen.label);
  if (seen.label == Label::kLeaf || seen.label == Label::kWeed) {
    // Blades let through about as much as they reflect, yellower.
    const Vector3f through =
        channel_ == Channel::kColour ? Vector3f(1.1f, 1.0f, 0.5f) : Vector3f(0.9f, 0.9f, 0.9f);
    seen.passed = seen.albedo.cwiseProduct(through);
  }
  return seen;
}

Vector3f SceneLook::radiance(const SeenSurface& surface, float sun) const {
  const auto towards_sun =
      static_cast<float>(surface.normal_W.cast<double>().dot(light_.sun_direction_W));
  const auto ambient = [&](float up) {
    return Vector3f(ground_ + (0.5f + 0.5f * up) * (sky_ - ground_));
  };
  const float up = surface.normal_W.z();
  Vector3f in_front = ambient(up), behind = ambient(-up);
  (towards_sun > 0.0f ? in_front : behind) += std::abs(towards_sun) * sun * sun_;
  constexpr float kOneOverPi = 0.31830989f;
  return kOneOverPi * (surface.albedo.cwiseProduct(in_front) + surface.passed.cwiseProduct(behind));
}

Vector3f SceneLook::far_radiance(const Vector3d& dir_W) const {
  using Sky = imaging::Atmosphere;
  constexpr float kOneOverPi = 0.31830989f;
  if (dir_W.z() < 0.0) {
    // Land beyond the world: grass and woods, paler towards the horizon.
    const Vector3f land = in_band({0.075f, 0.085f, 0.045f}, Label::kGround);
    const Vector3f lit =
        kOneOverPi *
        land.cwiseProduct(sun_ * static_cast<float>(light_.sun_direction_W.z()) + sky_);
    const auto near = static_cast<float>(std::min(1.0, -dir_W.z() / 0.05));
    return far_radiance({dir_W.x(), dir_W.y(), 0.0}) * (0.6f * (1.0f - near)) +
           lit * (0.4f + 0.6f * near);
  }
  // The table is symmetric about the sun's azimuth; elevations are finer near the horizon.
  const Vector3d& sun_W = light_.sun_direction_W;
  const double level = dir_W.head<2>().norm() * sun_W.head<2>().norm();
  const double cosine =
      level > 0.0 ? std::clamp(dir_W.head<2>().dot(sun_W.head<2>()) / level, -1.0, 1.0) : 1.0;
  const double azimuth = std::acos(cosine) / kPi * (Sky::kAzimuths - 1);
  const double elevation = std::asin(std::min(1.0, dir_W.z()));
  const double row = std::sqrt(elevation / (0.5 * kPi)) * (Sky::kElevations - 1);
  const int a = std::min(static_cast<int>(azimuth), Sky::kAzimuths - 2);
  const int e = std::min(static_cast<int>(row), Sky::kElevations - 2);
  const auto da = static_cast<float>(azimuth - a), de = static_cast<float>(row - e);
  const auto at = [&](int i, int j) -> const Vector3f& {
    return light_.atmosphere.sky[static_cast<std::size_t>(j * Sky::kAzimuths + i)];
  };
  Vector3f sky = (1.0f - de) * ((1.0f - da) * at(a, e) + da * at(a + 1, e)) +
                 de * ((1.0f - da) * at(a, e + 1) + da * at(a + 1, e + 1));
  // The disc has a radius of 0.267 degrees; its radiance is the irradiance over its solid angle.
  constexpr double kDiscCosine = 0.99998914;
  const float disc = dir_W.dot(sun_W) > kDiscCosine ? 1.0f / 6.8e-5f : 0.0f;
  switch (channel_) {
    case Channel::kColour:
      break;
    case Channel::kMono:
      sky.setConstant(kLuminance.dot(sky));
      break;
    case Channel::kBlue:
      sky.setConstant(sky.z());
      break;
    case Channel::kGreen:
      sky.setConstant(sky.y());
      break;
    default:
      sky.setConstant(air_share_ * sky.x() +
                      (1.0f - air_share_) *
                          static_cast<float>(imaging::cloud_radiance(light_, dir_W.z()).x()));
      break;
  }
  return sky + disc * sun_;
}

Vector3f SceneLook::white() const {
  constexpr float kOneOverPi = 0.31830989f;
  return kOneOverPi * (sun_ * static_cast<float>(light_.sun_direction_W.z()) + sky_);
}

}  // namespace vinerow::sensors
