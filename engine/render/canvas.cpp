#include "engine/render/canvas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/render/caption.h"

namespace vinerow::render {

using Eigen::Vector2d;

Rgb rgb_of(const Eigen::Vector3f& colour) {
  Rgb rgb;
  for (std::size_t c = 0; c < 3; ++c) {
    const float share = std::clamp(colour[static_cast<Eigen::Index>(c)], 0.0f, 1.0f);
    rgb[c] = static_cast<int>(std::lround(255.0f * share));
  }
  return rgb;
}

void blend(Image& image, int x, int y, const Rgb& colour, double alpha) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::uint8_t* pixel = &image.rgb[(static_cast<std::size_t>(y) * image.width + x) * 3];
  for (std::size_t c = 0; c < 3; ++c) {
    pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + (colour[c] - pixel[c]) * alpha));
  }
}

std::vector<Vector2d> rectangle(double left, double top, double right, double bottom) {
  return {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
}

std::vector<Vector2d> circle(const Vector2d& at, double radius_px, int corners) {
  std::vector<Vector2d> points;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / corners;
    points.push_back(at + radius_px * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

Canvas::Canvas(int width, int height, const Rgb& background) {
  image_.width = width;
  image_.height = height;
  for (int k = 0; k < width * height; ++k) {
    for (const int value : background) image_.rgb.push_back(static_cast<std::uint8_t>(value));
  }
}

void Canvas::fill(const std::vector<Vector2d>& polygon, const Rgb& colour, double alpha) {
  constexpr int kSamples = 4;
  double top = 1e9, bottom = -1e9;
  for (const Vector2d& p : polygon) {
    top = std::min(top, p.y());
    bottom = std::max(bottom, p.y());
  }
  std::vector<int> cover(static_cast<std::size_t>(image_.width));
  std::vector<double> crossings;
  const int last = std::min(image_.height - 1, static_cast<int>(std::floor(bottom)));
  for (int y = std::max(0, static_cast<int>(std::floor(top))); y <= last; ++y) {
    std::fill(cover.begin(), cover.end(), 0);
    for (int s = 0; s < kSamples; ++s) {
      const double line_y = y + (s + 0.5) / kSamples;
      crossings.clear();
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        if ((a.y() <= line_y) == (b.y() <= line_y)) continue;
        crossings.push_back(a.x() + (line_y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
      }
      std::sort(crossings.begin(), crossings.end());
      for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
        const double max_sample = kSamples * static_cast<double>(image_.width);
        const int first =
            static_cast<int>(std::ceil(std::clamp(kSamples * crossings[k] - 0.5, 0.0, max_sample)));
        const int end = static_cast<int>(
            std::ceil(std::clamp(kSamples * crossings[k + 1] - 0.5, 0.0, max_sample)));
        for (int i = first; i < end; ++i) ++cover[static_cast<std::size_t>(i / kSamples)];
      }
    }
    for (int x = 0; x < image_.width; ++x) {
      const int count = cover[static_cast<std::size_t>(x)];
      if (count > 0) blend(x, y, colour, alpha * count / (kSamples * kSamples));
    }
  }
}

void Canvas::line(const Vector2d& a, const Vector2d& b, double width_px, const Rgb& colour,
                  double alpha) {
  if ((b - a).norm() < 1e-9) return;
  const Vector2d d = (b - a).normalized(), side = 0.5 * width_px * Vector2d(-d.y(), d.x());
  fill({a + side, b + side, b - side, a - side}, colour, alpha);
}

void Canvas::outline(const std::vector<Vector2d>& polygon, double width_px, const Rgb& colour,
                     double alpha) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if ((b - a).norm() < 1e-9) continue;
    const Vector2d cap = 0.5 * width_px * (b - a).normalized();
    line(a - cap, b + cap, width_px, colour, alpha);
  }
}

void Canvas::paste(const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* p = &picture.rgb[(static_cast<std::size_t>(y) * picture.width + x) * 3];
      blend(left + x, top + y, {p[0], p[1], p[2]}, 1.0);
    }
  }
}

void Canvas::text(const std::string& text, int size_px, const Vector2d& at, const Rgb& colour,
                  double anchor) {
  const double left = anchor > 0.0 ? anchor * text_width(text, size_px) : 0.0;
  draw_text(text, size_px, at.x() - left, at.y(), colour, image_);
}

}  // namespace vinerow::render
