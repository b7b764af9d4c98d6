#include "engine/render/ribbons.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/api/height_field.h"
#include "engine/math/angles.h"

namespace vinerow::render {

namespace {

constexpr double kLift_m = 0.04;
constexpr double kBias_m = 0.12;
constexpr double kNearW = 0.06;  // minimum clip w, m in front of the eye

std::uint8_t to_byte(float v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

/// Point of a line with its share of the line's alpha.
struct Draped {
  Eigen::Vector3d p_W;
  double fade;
};

/// Points along a segment, dense enough to follow the ground and never below it.
/// @param fade  of each point; empty: 1 everywhere
void drape(std::span<const Eigen::Vector3d> line, std::span<const float> fade,
           const HeightField* field, std::vector<Draped>& points) {
  points.clear();
  const auto fade_at = [&](std::size_t i) { return fade.empty() ? 1.0 : double{fade[i]}; };
  const auto add = [&](Eigen::Vector3d p, double share) {
    if (field != nullptr && field->contains(p.x(), p.y())) {
      p.z() = std::max(p.z(), field->height_m(p.x(), p.y()) + kLift_m);
    }
    points.push_back({p, share});
  };
  const double spacing = field != nullptr ? std::max(0.4, 0.5 * field->cell_m) : 1e9;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (!line[i].allFinite()) continue;
    if (i > 0 && line[i - 1].allFinite()) {
      const Eigen::Vector3d step = line[i] - line[i - 1];
      const int pieces = std::min(2000, static_cast<int>(step.norm() / spacing) + 1);
      for (int k = 1; k < pieces; ++k) {
        const double fraction = double{1} * k / pieces;
        add(line[i - 1] + step * fraction,
            fade_at(i - 1) + fraction * (fade_at(i) - fade_at(i - 1)));
      }
    }
    add(line[i], fade_at(i));
  }
}

/// The same in clip space.
struct Clipped {
  Eigen::Vector4d p;
  double fade;
};

class Builder {
 public:
  Builder(const Polyline& line, int width_px, int height_px)
      : half_size_(0.5 * width_px, 0.5 * height_px),
        half_width_(0.5 * line.width_px),
        dashed_(line.dashed) {
    for (int c = 0; c < 3; ++c) colour_[c] = to_byte(line.colour[c]);
    alpha_ = line.alpha;
  }

  void segment(const Clipped& a, const Clipped& b) {
    const Eigen::Vector2d pa = pixel(a.p);
    const Eigen::Vector2d pb = pixel(b.p);
    Eigen::Vector2d along = pb - pa;
    const double length = along.norm();
    if (length < 1e-6) return;
    along /= length;
    const Eigen::Vector2d side = half_width_ * Eigen::Vector2d(-along.y(), along.x());
    const double start = travelled_;
    travelled_ += length;
    quad(a, b, side, start);
    if (has_last_) joint(a, last_side_, side, start);
    last_side_ = side;
    has_last_ = true;
  }
  void interrupt() { has_last_ = false; }

  std::vector<RibbonVertex> vertices;

 private:
  Eigen::Vector2d pixel(const Eigen::Vector4d& clip) const {
    return (clip.head<2>() / clip.w()).cwiseProduct(half_size_);
  }
  void vertex(const Clipped& at, const Eigen::Vector2d& offset_px, double along_px) {
    RibbonVertex v{};
    const Eigen::Vector4d& clip = at.p;
    const Eigen::Vector2d xy = clip.head<2>() + offset_px.cwiseQuotient(half_size_) * clip.w();
    v.clip[0] = static_cast<float>(xy.x());
    v.clip[1] = static_cast<float>(xy.y());
    v.clip[2] = static_cast<float>(clip.z());
    v.clip[3] = static_cast<float>(clip.w());
    std::copy(colour_, colour_ + 3, v.colour);
    v.colour[3] = to_byte(alpha_ * static_cast<float>(at.fade));
    v.along_px = dashed_ ? static_cast<float>(along_px) : -1.0f;
    vertices.push_back(v);
  }
  void quad(const Clipped& a, const Clipped& b, const Eigen::Vector2d& side, double start) {
    const Eigen::Vector2d other = -side;
    vertex(a, side, start);
    vertex(a, other, start);
    vertex(b, side, travelled_);
    vertex(b, side, travelled_);
    vertex(a, other, start);
    vertex(b, other, travelled_);
  }
  /// Fills the outer gap of a bend.
  void joint(const Clipped& at, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
             double along_px) {
    const double turn = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
    if (std::abs(turn) < 0.02) return;
    const double sign = turn > 0.0 ? -1.0 : 1.0;
    const int steps = 1 + static_cast<int>(std::abs(turn) / 0.5);
    for (int k = 0; k < steps; ++k) {
      vertex(at, Eigen::Vector2d::Zero(), along_px);
      for (int end = 0; end < 2; ++end) {
        const Eigen::Rotation2Dd rotation(turn * (k + end) / steps);
        vertex(at, rotation * (sign * from), along_px);
      }
    }
  }

  Eigen::Vector2d half_size_;
  double half_width_;
  bool dashed_;
  std::uint8_t colour_[3];
  float alpha_ = 1.0f;
  double travelled_ = 0.0;
  bool has_last_ = false;
  Eigen::Vector2d last_side_ = {0, 0};
};

/// @param clip_of  from a point in W to clip space
template <class ClipOf>
void draw_piece(const std::vector<Draped>& points, ClipOf&& clip_of, Builder& builder) {
  const auto cut = [](Clipped& hidden, const Clipped& seen) {
    const double fraction = (kNearW - hidden.p.w()) / (seen.p.w() - hidden.p.w());
    hidden.p += (seen.p - hidden.p) * fraction;
    hidden.fade += (seen.fade - hidden.fade) * fraction;
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    Clipped a{clip_of(points[i].p_W), points[i].fade};
    Clipped b{clip_of(points[i + 1].p_W), points[i + 1].fade};
    if (a.p.w() < kNearW && b.p.w() < kNearW) {
      builder.interrupt();
      continue;
    }
    // Clip the part of the line behind the eye.
    if (a.p.w() < kNearW) {
      cut(a, b);
      builder.interrupt();
    }
    if (b.p.w() < kNearW) cut(b, a);
    builder.segment(a, b);
  }
}

}  // namespace

std::vector<RibbonVertex> make_ribbon(const Polyline& line, const HeightField* field,
                                      const Eigen::Matrix4d& clip_from_world, const Camera& camera,
                                      int width_px, int height_px) {
  Builder builder(line, width_px, height_px);
  const Eigen::Vector3d forward = camera.X_WC.q * Eigen::Vector3d::UnitZ();
  const auto clip_of = [&](const Eigen::Vector3d& p) {
    Eigen::Vector4d clip = clip_from_world * p.homogeneous();
    // Depth of a point nearer to the eye by the bias, at the same pixel.
    const double reach = (p - camera.X_WC.p).dot(forward);
    const double nearer =
        camera.orthographic ? kBias_m : std::min(kBias_m, 0.3 * std::max(reach, 0.0));
    const Eigen::Vector4d moved = clip_from_world * (p - forward * nearer).homogeneous();
    if (moved.w() > 0.0) clip.z() = moved.z() / moved.w() * clip.w();
    return clip;
  };
  std::vector<Draped> points;
  const std::size_t whole = line.points_W.size();
  const std::size_t piece = line.pairs ? 2 : std::max<std::size_t>(whole, 1);
  for (std::size_t first = 0; first < whole; first += piece) {
    const std::size_t count = std::min(piece, whole - first);
    const std::span<const float> fade =
        line.fade.empty() ? std::span<const float>() : std::span(line.fade).subspan(first, count);
    drape(std::span(line.points_W).subspan(first, count), fade, field, points);
    builder.interrupt();
    draw_piece(points, clip_of, builder);
  }
  return std::move(builder.vertices);
}

void transform(std::vector<RibbonVertex>& ribbon, const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix4f m = matrix.cast<float>();
  for (RibbonVertex& vertex : ribbon) {
    Eigen::Map<Eigen::Vector4f> clip(vertex.clip);
    clip = (m * clip).eval();
  }
}

void set_alpha(std::vector<RibbonVertex>& ribbon, float alpha) {
  for (RibbonVertex& vertex : ribbon) vertex.colour[3] = to_byte(alpha);
}

}  // namespace vinerow::render
