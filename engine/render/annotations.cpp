#include "engine/render/annotations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/render/cameras.h"
#include "engine/render/canvas.h"
#include "engine/render/caption.h"
#include "engine/render/scale_bar.h"

namespace vinerow::render {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr int kRingCorners = 32;
constexpr Rgb kLightInk = {248, 246, 238}, kDarkInk = {18, 22, 20};

/// Light text with a dark outline, legible on any background.
void write(Canvas& canvas, const std::string& text, int size_px, const Vector2d& at) {
  const double rim = std::max(1.0, 0.09 * size_px);
  for (int k = 0; k < 8; ++k) {
    const double angle = 0.25 * std::acos(-1.0) * k;
    canvas.text(text, size_px, at + rim * Vector2d(std::cos(angle), std::sin(angle)), kDarkInk);
  }
  canvas.text(text, size_px, at, kLightInk);
}

bool overlaps_any(const AlignedBox2d& box, const std::vector<AlignedBox2d>& others) {
  return std::any_of(others.begin(), others.end(),
                     [&](const AlignedBox2d& other) { return box.intersects(other); });
}

/// Objects larger than a ring by this factor are marked without a ring.
constexpr double kRinged = 2.5;

double pixels_per_metre(const Frame& frame, const Eigen::Vector3d& p_W) {
  if (frame.camera.orthographic) return frame.height / frame.camera.ortho_height_m;
  const double depth_m = (frame.camera.X_WC.inverse() * p_W).z();
  return 0.5 * frame.height / std::tan(0.5 * frame.camera.fov_rad) / std::max(0.1, depth_m);
}

/// Places a text to the right of an object, to the left, above or below, where no other text is.
/// @returns the text's box
AlignedBox2d place_of_text(const AlignedBox2d& there, double away_px, const Vector2d& size_px,
                           const Frame& frame, const std::vector<AlignedBox2d>& occupied) {
  const AlignedBox2d picture(Vector2d(0, 0), Vector2d(frame.width, frame.height));
  const Vector2d half = 0.5 * size_px;
  AlignedBox2d first;
  for (const Vector2d& side : {Vector2d(1, 0), Vector2d(-1, 0), Vector2d(0, -1), Vector2d(0, 1),
                               Vector2d(0.7, -1), Vector2d(0.7, 1)}) {
    const Vector2d centre = there.center() + side.cwiseProduct(half + 0.5 * there.sizes() +
                                                               Vector2d::Constant(away_px));
    const AlignedBox2d box(centre - half, centre + half);
    if (picture.contains(box) && !overlaps_any(box, occupied)) return box;
    if (first.isEmpty()) first = box;
  }
  return first;
}

/// Box of the visible part of an object, else of the whole object; its name is placed next to it.
AlignedBox2d box_at(const Vector2d& at, const AlignedBox2d& around,
                    const std::vector<AlignedBox2d>& vehicles) {
  for (const AlignedBox2d& seen : vehicles) {
    if (seen.contains(at)) return seen;
  }
  return around;
}

/// @param vehicles  boxes of the visible vehicles @returns boxes of the drawn markers
std::vector<AlignedBox2d> draw_markers(const Frame& frame,
                                       const std::vector<AlignedBox2d>& vehicles, Canvas& canvas) {
  std::vector<AlignedBox2d> occupied;
  const int text_px = caption_text_px(frame.height);
  const double radius = 0.75 * text_px, line_px = std::max(1.5, 0.14 * text_px);
  const Vector2d size(frame.width, frame.height), middle = 0.5 * size;
  struct Placed {
    Vector2d at;
    std::string text;
    Rgb colour;
    bool inside;
    bool ringed;
    AlignedBox2d there;
  };
  std::vector<Placed> placed;
  for (const Marker& marker : frame.markers) {
    Vector2d at;
    if (!project(frame.camera, frame.width, frame.height, marker.p_W, at)) continue;
    const bool inside = (at.array() >= 0.0).all() && (at.array() <= size.array()).all();
    std::string text = marker.text;
    if (!inside) {
      // Outside the picture: an arrow at the edge, and the distance next to the name.
      const Vector2d direction = at - middle;
      const Vector2d half_extent = middle - Vector2d::Constant(1.6 * text_px);
      const double share = std::min(half_extent.x() / std::max(1e-9, std::abs(direction.x())),
                                    half_extent.y() / std::max(1e-9, std::abs(direction.y())));
      const Vector2d edge = middle + share * direction;
      if (frame.camera.orthographic) {
        text += fmt::format(" {:.0f} m",
                            (at - edge).norm() * frame.camera.ortho_height_m / frame.height);
      }
      at = edge;
    }
    const double px_per_m = pixels_per_metre(frame, marker.p_W);
    const double away_px = inside ? std::max(radius, marker.radius_m * px_per_m) : radius;
    const bool ringed = away_px <= kRinged * radius;
    const AlignedBox2d around(at - Vector2d::Constant(away_px), at + Vector2d::Constant(away_px));
    const AlignedBox2d there = ringed ? around : box_at(at, around, vehicles);
    occupied.push_back(there);
    placed.push_back({at, text, rgb_of(marker.colour), inside, ringed, there});
  }
  for (const Placed& one : placed) {
    if (one.inside && !one.ringed) continue;
    if (one.inside) {
      canvas.outline(circle(one.at, radius, kRingCorners), line_px + 2.0, kDarkInk, 0.55);
      canvas.outline(circle(one.at, radius, kRingCorners), line_px, one.colour);
    } else {
      const Vector2d direction = (one.at - middle).normalized(),
                     side(-direction.y(), direction.x());
      const auto arrow = [&](double grow) {
        return std::vector<Vector2d>{
            one.at + (radius + grow) * direction,
            one.at - (0.6 * radius + grow) * direction + (radius + grow) * side,
            one.at - (0.6 * radius + grow) * direction - (radius + grow) * side};
      };
      canvas.fill(arrow(2.0), kDarkInk, 0.55);
      canvas.fill(arrow(0.0), one.colour);
    }
  }
  for (const Placed& one : placed) {
    const Vector2d text_size(text_width(one.text, text_px), 1.2 * text_px);
    const AlignedBox2d box = place_of_text(one.there, 0.4 * radius, text_size, frame, occupied);
    write(canvas, one.text, text_px, {box.min().x(), box.max().y() - 0.28 * text_px});
    occupied.push_back(box);
  }
  return occupied;
}

/// Draws the scale bar in the lower right. @returns its box
AlignedBox2d draw_scale(const Frame& frame, Canvas& canvas) {
  const int text_px = caption_text_px(frame.height);
  const double size = text_px / 17.0, px_per_m = frame.height / frame.camera.ortho_height_m;
  const Vector2d end(frame.width - 2.0 * text_px, frame.height - 2.0 * text_px);
  const double wanted_m = 0.16 * frame.width / px_per_m;
  // The first call draws outside the picture, only to measure the length.
  Canvas measured(1, 1, kDarkInk);
  const double left = draw_scale_bar(measured, end, wanted_m, px_per_m, kDarkInk, size);
  const AlignedBox2d box(Vector2d(left - 0.6 * text_px, end.y() - 47.0 * size),
                         Vector2d(frame.width - 1.15 * text_px, frame.height - 1.15 * text_px));
  canvas.fill(rectangle(box.min().x(), box.min().y(), box.max().x(), box.max().y()), kDarkInk, 0.5);
  draw_scale_bar(canvas, end, wanted_m, px_per_m, kLightInk, size);
  return box;
}

}  // namespace

void annotate(const Frame& frame, const std::vector<SeenMark>& seen, Image& image) {
  std::vector<AlignedBox2d> keep_clear;
  for (const SeenMark& mark : seen) {
    if (mark.box_px.isEmpty()) continue;
    keep_clear.emplace_back(mark.box_px.min().cast<double>(), mark.box_px.max().cast<double>());
  }
  const std::vector<AlignedBox2d> vehicles = keep_clear;
  Canvas canvas(std::move(image));
  if (frame.show_scale && frame.camera.orthographic) {
    keep_clear.push_back(draw_scale(frame, canvas));
  }
  const std::vector<AlignedBox2d> marked = draw_markers(frame, vehicles, canvas);
  keep_clear.insert(keep_clear.end(), marked.begin(), marked.end());
  image = std::move(canvas).take();
  draw_caption(frame.caption, image, frame.legend, keep_clear);
}

}  // namespace vinerow::render
