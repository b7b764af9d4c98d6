#include "vehicles/urdf_rover/urdf_rover_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/io/meshes/mesh_file.h"
#include "engine/math/angles.h"
#include "engine/math/decomposition.h"
#include "vehicles/parts/mesh_builder.h"
#include "vehicles/parts/moments_of_inertia.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Lean of an axle (camber, toe) up to which it counts as straight across.
constexpr double kMinAcross = 0.98;
constexpr double kDensityGuess_kgpm3 = 300.0;
/// Offset of a hub ahead of or behind its steering axis, over the radius, above which it is a
/// castor.
constexpr double kMaxTrail = 0.3;

std::vector<Pose> link_poses(const io::UrdfModel& urdf) {
  std::vector<Pose> X_RL(urdf.links.size());
  for (const io::UrdfJoint& joint : urdf.joints) {
    X_RL[static_cast<std::size_t>(joint.child_link)] =
        X_RL[static_cast<std::size_t>(joint.parent_link)] * joint.X_PJ;
  }
  return X_RL;
}

io::MeshFile load_shape_mesh(const io::UrdfShape& shape) {
  // URDF reads every mesh as it is, z up; the up axis of a COLLADA file is ignored.
  io::MeshFileOptions options;
  options.up_axis = io::UpAxis::kZ;
  options.scale = shape.mesh_scale;
  return io::load_mesh(shape.mesh_file, options);
}

/// Corners of the shape's box, in the shape's frame.
Eigen::AlignedBox3d shape_bounds(const io::UrdfShape& shape) {
  Vector3d half = Vector3d::Zero();
  switch (shape.kind) {
    case io::UrdfShapeKind::kMesh:
      return load_shape_mesh(shape).bounds();
    case io::UrdfShapeKind::kBox:
      half = 0.5 * shape.size_m;
      break;
    case io::UrdfShapeKind::kCylinder:
      half = {shape.radius_m, shape.radius_m, 0.5 * shape.length_m};
      break;
    case io::UrdfShapeKind::kSphere:
      half = Vector3d::Constant(shape.radius_m);
      break;
  }
  return {-half, half};
}

void extend(Eigen::AlignedBox3d& box, const Eigen::AlignedBox3d& part, const Pose& X) {
  for (int i = 0; i < 8; ++i) {
    box.extend(X * part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
}

void append_visual(const io::UrdfShape& shape, const Pose& X_ML, MeshBuilder& builder) {
  const Pose X_MS = X_ML * shape.X_LS;
  const Eigen::Vector3f given = shape.colour.value_or(Eigen::Vector3f(0.6f, 0.6f, 0.6f));
  const auto channel = [&](int i) {
    return static_cast<unsigned>(std::lround(255.0f * std::clamp(given[i], 0.0f, 1.0f)));
  };
  const Eigen::Vector3f colour =
      colour_from_srgb((channel(0) << 16) | (channel(1) << 8) | channel(2));
  builder.place(X_MS).colour(colour);
  const Pose y_along_z{Eigen::Quaterniond(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitX())),
                       Vector3d::Zero()};
  switch (shape.kind) {
    case io::UrdfShapeKind::kBox:
      builder.box(0.5 * shape.size_m, 0.0);
      break;
    case io::UrdfShapeKind::kCylinder:
      builder.place(X_MS * y_along_z).cylinder(shape.radius_m, 0.5 * shape.length_m, 32);
      break;
    case io::UrdfShapeKind::kSphere: {
      std::vector<Eigen::Vector2d> arc;
      for (int i = -8; i <= 8; ++i) {
        const double angle = kPi / 16.0 * i;
        arc.emplace_back(std::max(0.0, shape.radius_m * std::cos(angle)),
                         shape.radius_m * std::sin(angle));
      }
      builder.lathe(arc, 24);
      break;
    }
    case io::UrdfShapeKind::kMesh:
      for (const io::MeshPart& part : load_shape_mesh(shape).parts) {
        if (!shape.colour) builder.colour(part.material.colour);
        builder.append(*part.mesh);
      }
      break;
  }
}

/// @throws ConfigError if there is no joint of that name
std::size_t find_joint(const io::UrdfModel& urdf, const std::string& name) {
  std::vector<std::string> known;
  for (const io::UrdfJoint& joint : urdf.joints) known.push_back(joint.name);
  const auto at = std::find(known.begin(), known.end(), name);
  if (at != known.end()) return static_cast<std::size_t>(at - known.begin());
  throw ConfigError(fmt::format("{}: no joint '{}'{} (joints: {})", urdf.file.string(), name,
                                did_you_mean(name, known), join(known)));
}

/// Indices of the wheel joints, left ones first, each side from front to rear.
std::vector<std::size_t> find_wheel_joints(const io::UrdfModel& urdf, const std::vector<Pose>& X_RL,
                                           const UrdfRoverOptions& options) {
  const std::string file = urdf.file.string();
  std::vector<std::size_t> found;
  const auto child = [&](std::size_t joint) {
    return static_cast<std::size_t>(urdf.joints[joint].child_link);
  };
  if (options.left_joints.empty() && options.right_joints.empty()) {
    for (std::size_t i = 0; i < urdf.joints.size(); ++i) {
      const io::UrdfJoint& joint = urdf.joints[i];
      const double across = std::abs((X_RL[child(i)].q * joint.axis_J).y());
      if (joint.kind == io::UrdfJointKind::kContinuous && across > kMinAcross) found.push_back(i);
    }
    if (found.empty()) {
      throw ConfigError(fmt::format(
          "{}: no wheel joints: none of {} joints is continuous with its axis across the robot; "
          "name them in left_wheel_joints and right_wheel_joints",
          file, urdf.joints.size()));
    }
  } else {
    for (const auto* names : {&options.left_joints, &options.right_joints}) {
      for (const std::string& name : *names) {
        const std::size_t index = find_joint(urdf, name);
        const double across = std::abs((X_RL[child(index)].q * urdf.joints[index].axis_J).y());
        if (across <= kMinAcross) {
          throw ConfigError(fmt::format(
              "{}: the axis of wheel joint '{}' does not point across the robot (along y)", file,
              name));
        }
        found.push_back(index);
      }
    }
  }
  const auto y = [&](std::size_t i) { return X_RL[child(i)].p.y(); };
  const auto x = [&](std::size_t i) { return X_RL[child(i)].p.x(); };
  std::stable_sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
    if ((y(a) > 0.0) != (y(b) > 0.0)) return y(a) > 0.0;
    return x(a) > x(b);
  });
  const auto left =
      std::count_if(found.begin(), found.end(), [&](std::size_t i) { return y(i) > 0.0; });
  const auto right = static_cast<std::ptrdiff_t>(found.size()) - left;
  if (left < 2 || right < 2) {
    throw ConfigError(fmt::format(
        "{}: {} wheels on the left and {} on the right, must be at least 2 on each side", file,
        left, right));
  }
  return found;
}

/// Radius and half width of a wheel about its joint's axis, from collision shapes, else visuals.
void measure_wheel(const io::UrdfLink& link, const Vector3d& axis_L, UrdfWheel& wheel) {
  for (const auto* shapes : {&link.collisions, &link.visuals}) {
    for (const io::UrdfShape& shape : *shapes) {
      if (shape.kind == io::UrdfShapeKind::kCylinder || shape.kind == io::UrdfShapeKind::kSphere) {
        wheel.radius_m = std::max(wheel.radius_m, shape.radius_m);
        const double length = shape.kind == io::UrdfShapeKind::kSphere ? 0.0 : shape.length_m;
        wheel.half_width_m = std::max(wheel.half_width_m, 0.5 * length);
      } else if (shape.kind == io::UrdfShapeKind::kMesh) {
        for (const io::MeshPart& part : load_shape_mesh(shape).parts) {
          for (const Eigen::Vector3f& vertex : part.mesh->vertices) {
            const Vector3d p_L = shape.X_LS * Vector3d(vertex.cast<double>());
            const double along = axis_L.dot(p_L);
            wheel.radius_m = std::max(wheel.radius_m, (p_L - along * axis_L).norm());
            wheel.half_width_m = std::max(wheel.half_width_m, std::abs(along));
          }
        }
      }
    }
    if (wheel.radius_m > 0.0) return;
  }
}

/// Index of the joint above a wheel joint that turns about the vertical, or -1.
int find_upright_joint(const io::UrdfModel& urdf, const std::vector<Pose>& X_RL,
                       std::size_t wheel_joint) {
  int link = urdf.joints[wheel_joint].parent_link;
  while (urdf.links[static_cast<std::size_t>(link)].parent_joint >= 0) {
    const int index = urdf.links[static_cast<std::size_t>(link)].parent_joint;
    const io::UrdfJoint& joint = urdf.joints[static_cast<std::size_t>(index)];
    const bool turns =
        joint.kind == io::UrdfJointKind::kRevolute || joint.kind == io::UrdfJointKind::kContinuous;
    const Vector3d axis = X_RL[static_cast<std::size_t>(joint.child_link)].q * joint.axis_J;
    if (turns && std::abs(axis.z()) > kMinAcross) return index;
    link = joint.parent_link;
  }
  return -1;
}

/// Finds the steering joint of each wheel. @throws ConfigError
void find_steering_joints(const io::UrdfModel& urdf, const std::vector<Pose>& X_RL,
                          const std::vector<std::size_t>& wheel_joints,
                          const UrdfRoverOptions& options, std::vector<UrdfWheel>& wheels) {
  const std::string file = urdf.file.string();
  std::vector<int> wanted;
  for (const std::string& name : options.steering_joints) {
    wanted.push_back(static_cast<int>(find_joint(urdf, name)));
  }
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const int joint = find_upright_joint(urdf, X_RL, wheel_joints[i]);
    if (joint < 0) continue;
    const io::UrdfJoint& found = urdf.joints[static_cast<std::size_t>(joint)];
    if (options.steering_joints.empty()) {
      const double trail_m =
          std::abs(X_RL[static_cast<std::size_t>(urdf.joints[wheel_joints[i]].child_link)].p.x() -
                   X_RL[static_cast<std::size_t>(found.child_link)].p.x());
      if (trail_m > kMaxTrail * wheels[i].radius_m) {
        throw ConfigError(fmt::format(
            "{}: wheel joint '{}' trails {:.3f} m behind joint '{}': castors are not supported; if "
            "it is steered by a motor, name its joint in steering_joints",
            file, wheels[i].joint, trail_m, found.name));
      }
    } else if (std::erase(wanted, joint) == 0) {
      continue;  // held fast
    }
    wheels[i].steering_joint = joint;
  }
  if (wanted.empty()) return;
  throw ConfigError(fmt::format(
      "{}: steering joint '{}' carries no wheel, or does not turn about the vertical (z)", file,
      urdf.joints[static_cast<std::size_t>(wanted.front())].name));
}

/// Axles, positions and limits of the steering. @param model  its wheels are named
/// @throws ConfigError unless the two front wheels of four, or all of them, steer
std::optional<UrdfSteering> read_steering(const io::UrdfModel& urdf, const UrdfRoverModel& model) {
  std::vector<std::string> steered;
  UrdfSteering steering;
  for (const UrdfWheel& wheel : model.wheels) {
    // Two of four are on each axle, so each hub counts by half.
    (wheel.name[0] == 'f' ? steering.front_m : steering.rear_m) +=
        (wheel.name[0] == 'f' ? 0.5 : -0.5) * wheel.hub_B.x();
    if (wheel.steering_joint < 0) continue;
    steered.push_back(wheel.name);
    const auto& limits = urdf.joints[static_cast<std::size_t>(wheel.steering_joint)].limits;
    if (!limits || !(limits->lower < 0.0 && limits->upper > 0.0)) continue;
    const double max_rad = std::min(-limits->lower, limits->upper);
    steering.max_wheel_steer_rad =
        std::min(max_rad, steering.max_wheel_steer_rad.value_or(max_rad));
  }
  if (steered.empty()) return std::nullopt;
  steering.axles = steered.size() == 4 ? 2 : 1;
  const bool fits = model.wheels.size() == 4 &&
                    (steered.size() == 4 || steered == std::vector<std::string>{"fl", "fr"});
  if (fits) return steering;
  throw ConfigError(
      fmt::format("{}: {} of {} wheels steer ({}), must be the two front ones of four, or all four",
                  urdf.file.string(), steered.size(), model.wheels.size(), join(steered)));
}

void name_wheels(std::vector<UrdfWheel>& wheels) {
  std::size_t count[2] = {0, 0};
  for (const UrdfWheel& wheel : wheels) ++count[wheel.left ? 0 : 1];
  const bool four = count[0] == 2 && count[1] == 2;
  std::size_t index[2] = {0, 0};
  for (UrdfWheel& wheel : wheels) {
    const std::size_t at = index[wheel.left ? 0 : 1]++;
    const char side = wheel.left ? 'l' : 'r';
    wheel.name =
        four ? fmt::format("{}{}", at == 0 ? 'f' : 'r', side) : fmt::format("{}{}", side, at + 1);
  }
}

/// Mass, centre and inertia of all links as one body.
void merge_masses(const io::UrdfModel& urdf, const std::vector<Pose>& X_RL, UrdfRoverModel& model) {
  Vector3d moment = Vector3d::Zero();
  for (std::size_t i = 0; i < urdf.links.size(); ++i) {
    model.mass_kg += urdf.links[i].mass_kg;
    moment += urdf.links[i].mass_kg * (X_RL[i] * urdf.links[i].com_L);
  }
  if (!(model.mass_kg > 0.0)) {
    throw ConfigError(fmt::format("{}: the links' masses sum to {} kg, must be > 0",
                                  urdf.file.string(), model.mass_kg));
  }
  model.com_root = moment / model.mass_kg;
  for (std::size_t i = 0; i < urdf.links.size(); ++i) {
    const io::UrdfLink& link = urdf.links[i];
    const std::string fault = find_fault_in_moments(
        fmt::format("{}: link '{}': the principal inertia in kg m2", urdf.file.string(), link.name),
        decompose_symmetric<3>(link.inertia_L).values);
    if (!fault.empty()) throw ConfigError(fault);
    const Matrix3d R = X_RL[i].q.toRotationMatrix();
    const Vector3d d = X_RL[i] * link.com_L - model.com_root;
    model.inertia_B += R * link.inertia_L * R.transpose() +
                       link.mass_kg * (d.squaredNorm() * Matrix3d::Identity() - d * d.transpose());
  }
}

/// Assignment of a link to the body, a wheel, or the knuckle of a steered wheel.
struct Carrier {
  int wheel = -1;  ///< -1: the body
  bool is_knuckle = false;
};

std::vector<Carrier> find_carriers(const io::UrdfModel& urdf,
                                   const std::vector<std::size_t>& wheel_joints,
                                   const std::vector<UrdfWheel>& wheels) {
  std::vector<Carrier> carriers(urdf.links.size());
  for (std::size_t i = 1; i < urdf.links.size(); ++i) {
    const auto joint = static_cast<std::size_t>(urdf.links[i].parent_joint);
    carriers[i] = carriers[static_cast<std::size_t>(urdf.joints[joint].parent_link)];
    for (std::size_t wheel = 0; wheel < wheels.size(); ++wheel) {
      if (wheel_joints[wheel] == joint) carriers[i] = {static_cast<int>(wheel), false};
      if (wheels[wheel].steering_joint == static_cast<int>(joint)) {
        carriers[i] = {static_cast<int>(wheel), true};
      }
    }
  }
  return carriers;
}

/// Notes the meshes larger than any vehicle of a vineyard, or the robot if no mesh is.
/// @throws ConfigError with the notes if its hull is too large for any start
void note_doubtful_units(const io::UrdfModel& urdf, UrdfRoverModel& model) {
  // A grape harvester is 6 m long and 4 m high; a tractor with its trailer 12 m long.
  const Vector3d max_m = Vector3d::Constant(20.0);
  Eigen::AlignedBox3d all = model.bounds_B;
  for (const VehicleLink& link : model.links) all.extend(link.mesh->bounds());
  if ((all.sizes().array() <= max_m.array()).all()) return;
  for (const io::UrdfLink& link : urdf.links) {
    for (const auto* shapes : {&link.visuals, &link.collisions}) {
      for (const io::UrdfShape& shape : *shapes) {
        if (shape.kind != io::UrdfShapeKind::kMesh) continue;
        const std::string doubt =
            io::doubt_unit(shape.mesh_file, load_shape_mesh(shape).bounds(), max_m,
                           "give its <mesh> in the URDF scale=\"0.001 0.001 0.001\"");
        if (!doubt.empty() &&
            std::find(model.notes.begin(), model.notes.end(), doubt) == model.notes.end()) {
          model.notes.push_back(doubt);
        }
      }
    }
  }
  if (model.notes.empty()) {
    model.notes.push_back(io::doubt_unit(urdf.file, all, max_m, "write it in metres"));
  }
  constexpr double kTooLarge_m = 100.0;
  if (model.bounds_B.sizes().maxCoeff() <= kTooLarge_m) return;
  throw ConfigError(join(model.notes, "; "));
}

/// Collision shapes, bounds and drawn links. The knuckles' collision shapes are left out as those
/// of the wheels are: they stay inside the wheels' reach.
void build_shapes(const io::UrdfModel& urdf, const std::vector<Pose>& X_RL,
                  const std::vector<std::size_t>& wheel_joints, UrdfRoverModel& model) {
  const Pose X_BR{Eigen::Quaterniond::Identity(), -model.com_root};
  const std::vector<Carrier> carriers = find_carriers(urdf, wheel_joints, model.wheels);
  MeshBuilder body;
  std::vector<MeshBuilder> wheels(model.wheels.size()), knuckles(model.wheels.size());
  for (std::size_t i = 0; i < urdf.links.size(); ++i) {
    const io::UrdfLink& link = urdf.links[i];
    const auto& drawn = link.visuals.empty() ? link.collisions : link.visuals;
    const Pose X_BL = X_BR * X_RL[i];
    if (carriers[i].wheel >= 0) {
      const auto index = static_cast<std::size_t>(carriers[i].wheel);
      const Pose X_HB{Eigen::Quaterniond::Identity(), -model.wheels[index].hub_B};
      for (const io::UrdfShape& visual : drawn) {
        append_visual(visual, X_HB * X_BL,
                      carriers[i].is_knuckle ? knuckles[index] : wheels[index]);
      }
      continue;
    }
    for (const io::UrdfShape& visual : drawn) append_visual(visual, X_BL, body);
    for (const io::UrdfShape& collision : link.collisions) {
      const Eigen::AlignedBox3d box = shape_bounds(collision);
      const Pose X_BS = X_BL * collision.X_LS;
      extend(model.bounds_B, box, X_BS);
      const Pose centre = X_BS * Pose{Eigen::Quaterniond::Identity(), box.center()};
      model.shapes.push_back({physics::BoxShape{0.5 * box.sizes()}, centre});
    }
  }
  Material material;
  material.name = urdf.name;
  material.colour = {1.0f, 1.0f, 1.0f};
  material.roughness = 0.7f;
  model.links.push_back({"body", std::make_shared<TriangleMesh>(body.take()), material});
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    model.links.push_back({"wheel_" + model.wheels[i].name,
                           std::make_shared<TriangleMesh>(wheels[i].take()), material});
  }
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    auto mesh = std::make_shared<TriangleMesh>(knuckles[i].take());
    if (mesh->vertices.empty()) continue;
    model.links.push_back({"knuckle_" + model.wheels[i].name, std::move(mesh), material});
    model.knuckles.push_back(i);
  }
}

}  // namespace

UrdfRoverModel read_urdf_rover(const io::UrdfModel& urdf, const UrdfRoverOptions& options) {
  UrdfRoverModel model;
  const std::vector<Pose> X_RL = link_poses(urdf);
  const std::vector<std::size_t> wheel_joints = find_wheel_joints(urdf, X_RL, options);
  merge_masses(urdf, X_RL, model);
  const Pose X_BR{Eigen::Quaterniond::Identity(), -model.com_root};

  double track = 0.0;
  for (const std::size_t joint_index : wheel_joints) {
    const io::UrdfJoint& joint = urdf.joints[joint_index];
    const auto link_index = static_cast<std::size_t>(joint.child_link);
    const io::UrdfLink& link = urdf.links[link_index];
    UrdfWheel wheel;
    wheel.joint = joint.name;
    wheel.hub_B = X_BR * X_RL[link_index].p;
    wheel.left = X_RL[link_index].p.y() > 0.0;
    measure_wheel(link, joint.axis_J, wheel);
    if (options.wheel_radius_m) wheel.radius_m = *options.wheel_radius_m;
    if (!(wheel.radius_m > 0.0)) {
      throw ConfigError(fmt::format(
          "{}: wheel link '{}' has no cylinder, sphere or mesh to take a radius from; give "
          "wheel_radius_m",
          urdf.file.string(), link.name));
    }
    const Vector3d off_axis = link.com_L - joint.axis_J.dot(link.com_L) * joint.axis_J;
    wheel.spin_inertia_kgm2 =
        joint.axis_J.dot(link.inertia_L * joint.axis_J) + link.mass_kg * off_axis.squaredNorm();
    if (!(wheel.spin_inertia_kgm2 > 1e-6)) {
      // A wheel without inertia cannot be driven: take a light solid disc of its size.
      const double width = std::max(2.0 * wheel.half_width_m, 0.25 * wheel.radius_m);
      const double mass = kDensityGuess_kgpm3 * kPi * wheel.radius_m * wheel.radius_m * width;
      wheel.spin_inertia_kgm2 = 0.5 * mass * wheel.radius_m * wheel.radius_m;
    }
    model.wheels.push_back(wheel);
    track += std::abs(X_RL[link_index].p.y());
  }
  name_wheels(model.wheels);
  find_steering_joints(urdf, X_RL, wheel_joints, options, model.wheels);
  model.steering = read_steering(urdf, model);
  model.track_m = 2.0 * track / static_cast<double>(model.wheels.size());
  const auto [rear, front] = std::minmax_element(
      model.wheels.begin(), model.wheels.end(),
      [](const UrdfWheel& a, const UrdfWheel& b) { return a.hub_B.x() < b.hub_B.x(); });
  model.wheel_base_m = model.steering ? model.steering->front_m + model.steering->rear_m
                                      : front->hub_B.x() - rear->hub_B.x();

  for (const UrdfWheel& wheel : model.wheels) {
    const Vector3d half(wheel.radius_m, wheel.half_width_m, wheel.radius_m);
    extend(model.bounds_B, {-half, half}, Pose{Eigen::Quaterniond::Identity(), wheel.hub_B});
    model.height_above_ground_m =
        std::max(model.height_above_ground_m, wheel.radius_m - wheel.hub_B.z());
  }
  build_shapes(urdf, X_RL, wheel_joints, model);
  note_doubtful_units(urdf, model);
  for (const std::string& note : urdf.notes) {
    model.notes.push_back(fmt::format("{}: {}", urdf.file.string(), note));
  }
  return model;
}

}  // namespace vinerow::vehicles
