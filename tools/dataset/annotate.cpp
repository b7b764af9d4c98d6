#include "tools/dataset/annotate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vinerow::dataset {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNear_m = 0.05;  // nearer points have no place in the picture

/// A point as the picture shows it.
struct SeenPoint {
  Vector3d p_C = Vector3d::Zero();  ///< in the optical frame when its row is exposed
  std::optional<Vector2d> uv;       ///< px; nullopt outside the picture
};

/// Where points of W are in the picture.
class PictureView {
 public:
  PictureView(const Layers& layers, const Lens& lens, const CameraPath& camera)
      : layers_(layers), lens_(lens), camera_(camera), X_CW_(camera.X_WC().inverse()) {}

  /// At the stamp.
  Vector3d in_camera(const Vector3d& p_W) const { return X_CW_ * p_W; }
  Vector3d turned(const Vector3d& v_W) const { return X_CW_.q * v_W; }

  /// A point that stands still.
  SeenPoint point(const Vector3d& p_W) const {
    SeenPoint seen = point_on_body(p_W);
    if (camera_.readout_s == 0.0) return seen;
    // The row that shows it, and so the time, follow from each other. While the picture moves by
    // less than its height in a readout, each step brings them nearer; 1e-6 rows are far less than
    // what is written.
    constexpr int kMostSteps = 50;
    double row = 0.5 * (layers_.height - 1);
    for (int k = 0; k < kMostSteps; ++k) {
      const sensors::OpticalPlace at =
          camera_.motion.place_at(sensors::row_time_s(row, layers_.height, camera_.readout_s));
      seen.p_C = at.R_WC.transpose() * (p_W - at.p_W);
      const std::optional<Vector2d> uv = project(seen.p_C);
      seen.uv = uv && is_inside(*uv) ? uv : std::nullopt;
      if (!uv) break;
      // Beyond the picture nothing is read.
      const double next = std::clamp(uv->y(), -1.0, static_cast<double>(layers_.height));
      if (std::abs(next - row) < 1e-6) break;
      row = next;
    }
    return seen;
  }

  /// A point that moves with the camera, where it is at the stamp.
  SeenPoint point_on_body(const Vector3d& p_W) const {
    const Vector3d p_C = in_camera(p_W);
    const std::optional<Vector2d> uv = project(p_C);
    return {p_C, uv && is_inside(*uv) ? uv : std::nullopt};
  }

  /// Whether a pixel there, or one beside it, has this property: points of outlines are a little
  /// beside their things.
  template <class Is>
  bool near(const Vector2d& uv, Is&& is) const {
    const auto x = static_cast<int>(std::lround(uv.x())), y = static_cast<int>(std::lround(uv.y()));
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, layers_.height - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, layers_.width - 1); ++i) {
        if (is(static_cast<std::size_t>(j) * static_cast<std::size_t>(layers_.width) +
               static_cast<std::size_t>(i))) {
          return true;
        }
      }
    }
    return false;
  }
  bool shows(const Vector2d& uv, std::uint32_t thing) const {
    return near(uv, [&](std::size_t i) { return layers_.thing[i] == thing; });
  }
  /// Whether nothing is between the camera and a point of the ground.
  bool is_open(const Vector2d& uv, double z_m) const {
    constexpr double kSlack_m = 0.1;
    return near(uv, [&](std::size_t i) {
      return layers_.depth_mm[i] == 0 || 1e-3 * layers_.depth_mm[i] > z_m - kSlack_m;
    });
  }

 private:
  std::optional<Vector2d> project(const Vector3d& p_C) const {
    return p_C.z() < kNear_m ? std::nullopt : lens_.project(p_C);
  }
  bool is_inside(const Vector2d& uv) const {
    return uv.x() >= -0.5 && uv.y() >= -0.5 && uv.x() < layers_.width - 0.5 &&
           uv.y() < layers_.height - 0.5;
  }

  const Layers& layers_;
  const Lens& lens_;
  const CameraPath& camera_;
  Pose X_CW_;
};

KeyPoint key_point(const PictureView& view, const Vector3d& p_W, std::uint32_t thing) {
  const std::optional<Vector2d> uv = view.point(p_W).uv;
  if (!uv) return {};
  return {uv->x(), uv->y(), view.shows(*uv, thing) ? Seen::kSeen : Seen::kHidden};
}

Box3 box_around(const PictureView& view, const std::vector<Vector3d>& vertices_W, double turn_rad) {
  // Axes of the box in the optical frame: length, down, and the third.
  const Vector3d along(std::cos(turn_rad), 0.0, -std::sin(turn_rad));
  const Vector3d across(std::sin(turn_rad), 0.0, std::cos(turn_rad));
  Eigen::AlignedBox3d extent;
  for (const Vector3d& p_W : vertices_W) {
    const Vector3d p_C = view.in_camera(p_W);
    extent.extend(Vector3d(along.dot(p_C), p_C.y(), across.dot(p_C)));
  }
  const Vector3d middle = extent.center();
  Box3 box;
  box.bottom_C = middle.x() * along + middle.z() * across;
  box.bottom_C.y() = extent.max().y();
  box.length_m = extent.sizes().x();
  box.height_m = extent.sizes().y();
  box.width_m = extent.sizes().z();
  box.turn_rad = turn_rad;
  return box;
}

void add_shares(const PictureView& view, const std::vector<Vector3d>& vertices_W, bool is_on_body,
                Annotation& a) {
  int inside = 0, seen = 0;
  for (const Vector3d& p_W : vertices_W) {
    const auto uv = (is_on_body ? view.point_on_body(p_W) : view.point(p_W)).uv;
    if (!uv) continue;
    ++inside;
    if (view.shows(*uv, a.thing)) ++seen;
  }
  a.truncated = 1.0 - static_cast<double>(inside) / static_cast<double>(vertices_W.size());
  a.visible_share = inside > 0 ? static_cast<double>(seen) / inside : 0.0;
}

/// Extends a box by what the picture shows of a leg between two points of W.
void extend_by_leg(const PictureView& view, const Vector3d& from_W, const Vector3d& to_W,
                   Eigen::AlignedBox2d& box) {
  const auto pixel = [&](double share) { return view.point(from_W + share * (to_W - from_W)).uv; };
  const std::optional<Vector2d> from = pixel(0.0), to = pixel(1.0);
  for (const auto& uv : {from, to}) {
    if (uv) box.extend(*uv + Vector2d(0.5, 0.5));
  }
  if (from.has_value() == to.has_value()) return;
  // Where it leaves the picture, to far less than a pixel.
  double in = from ? 0.0 : 1.0, out = 1.0 - in;
  constexpr int kHalvings = 40;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (in + out);
    (pixel(middle) ? in : out) = middle;
  }
  box.extend(*pixel(in) + Vector2d(0.5, 0.5));
}

/// Around what the picture shows of a row's face, from the ground to the canopy's top.
Eigen::AlignedBox2d row_box(const PictureView& view, const PlantRow& row) {
  constexpr double kStep_m = 0.5;
  constexpr int kLevels = 4;
  Eigen::AlignedBox2d box;
  const auto place = [&](std::size_t k, double share, int level) -> Vector3d {
    const Vector3d line_W = row.line_W[k] + share * (row.line_W[k + 1] - row.line_W[k]);
    return line_W + row.canopy_top_m * level / kLevels * Vector3d::UnitZ();
  };
  for (std::size_t k = 0; k + 1 < row.line_W.size(); ++k) {
    const double length_m = (row.line_W[k + 1] - row.line_W[k]).norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(length_m / kStep_m)));
    for (int i = 0; i <= steps; ++i) {
      const double here = static_cast<double>(i) / steps, next = static_cast<double>(i + 1) / steps;
      for (int level = 0; level <= kLevels; ++level) {
        if (level < kLevels) {
          extend_by_leg(view, place(k, here, level), place(k, here, level + 1), box);
        }
        if (i < steps) extend_by_leg(view, place(k, here, level), place(k, next, level), box);
      }
    }
  }
  return box;
}

}  // namespace

std::vector<Annotation> annotate(const Layers& layers, const Lens& lens, const CameraPath& camera,
                                 ThingShapes& shapes, std::span<const VehicleShape> vehicles,
                                 std::span<const std::string> classes, int min_pixels) {
  // Pixels of each thing, column by column.
  std::map<std::uint32_t, std::vector<std::uint32_t>> pixels;
  for (int x = 0; x < layers.width; ++x) {
    for (int y = 0; y < layers.height; ++y) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(layers.width) +
                            static_cast<std::size_t>(x);
      if (layers.thing[i] <= sensors::ThingNumbers::kTerrain) continue;
      pixels[layers.thing[i]].push_back(static_cast<std::uint32_t>(x * layers.height + y));
    }
  }
  const PictureView view(layers, lens, camera);
  std::vector<Annotation> annotations;
  for (const auto& [thing, own] : pixels) {
    if (static_cast<int>(own.size()) < min_pixels) continue;
    const bool is_vehicle = thing >= shapes.vehicles();
    const ThingShape* const shape = is_vehicle ? nullptr : shapes.find(thing);
    if (!is_vehicle && shape == nullptr) continue;
    const std::string name = is_vehicle ? "vehicle" : shape->class_name;
    const auto place = std::find(classes.begin(), classes.end(), name);
    if (place == classes.end()) continue;
    Annotation a;
    a.thing = thing;
    a.class_index = static_cast<int>(place - classes.begin());
    a.mask = make_mask(own, layers.height);
    double turn_rad = 0.0;
    bool is_on_body = false;
    const std::vector<Vector3d>* vertices_W = nullptr;
    if (is_vehicle) {
      const VehicleShape& vehicle = vehicles[thing - shapes.vehicles()];
      const Vector3d forward_C = view.turned(vehicle.forward_W);
      turn_rad = std::atan2(-forward_C.z(), forward_C.x());
      vertices_W = &vehicle.vertices_W;
      is_on_body = vehicle.carries_camera;
    } else {
      vertices_W = &shape->vertices_W;
    }
    add_shares(view, *vertices_W, is_on_body, a);
    a.box = box_around(view, *vertices_W, turn_rad);
    if (shape != nullptr && shape->has_ends) {
      a.ends = {key_point(view, shape->foot_W, thing), key_point(view, shape->head_W, thing)};
    }
    annotations.push_back(std::move(a));
  }
  return annotations;
}

std::vector<RowAnnotation> annotate_rows(const Layers& layers, const Lens& lens,
                                         const CameraPath& camera,
                                         const std::vector<PlantRow>& rows) {
  const PictureView view(layers, lens, camera);
  std::vector<RowAnnotation> annotations;
  for (const PlantRow& row : rows) {
    RowAnnotation a;
    a.row = row.id;
    const Vector3d ends_W[] = {row.line_W.front(), row.line_W.back()};
    for (std::size_t k = 0; k < 2; ++k) {
      const auto [p_C, uv] = view.point(ends_W[k]);
      if (!uv) continue;
      a.ends[k] = {uv->x(), uv->y(), view.is_open(*uv, p_C.z()) ? Seen::kSeen : Seen::kHidden};
    }
    if (a.ends[0].seen == Seen::kOutside && a.ends[1].seen == Seen::kOutside) continue;
    const Eigen::AlignedBox2d box = row_box(view, row);
    a.left = box.min().x();
    a.top = box.min().y();
    a.width = box.sizes().x();
    a.height = box.sizes().y();
    annotations.push_back(a);
  }
  return annotations;
}

}  // namespace vinerow::dataset
