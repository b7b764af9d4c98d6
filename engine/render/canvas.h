#pragma once
/// Antialiased 2-D drawing on an 8-bit picture: areas, lines, text.

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "engine/render/scene.h"

namespace vinerow::render {

using Rgb = std::array<int, 3>;  ///< 0 to 255, sRGB

/// Bytes of a colour with shares 0 to 1; others are clamped.
Rgb rgb_of(const Eigen::Vector3f& colour);

/// Blends a pixel; pixels outside the picture are ignored.
void blend(Image& image, int x, int y, const Rgb& colour, double alpha);

/// Corners of a rectangle.
std::vector<Eigen::Vector2d> rectangle(double left, double top, double right, double bottom);
/// Corners of a regular polygon that stands for a circle.
std::vector<Eigen::Vector2d> circle(const Eigen::Vector2d& at, double radius_px, int corners);

/// Canvas with points in pixels: x to the right, y down, (0, 0) is the upper left corner of the
/// picture.
class Canvas {
 public:
  Canvas(int width, int height, const Rgb& background);
  /// Draws over a picture.
  explicit Canvas(Image image) : image_(std::move(image)) {}

  void blend(int x, int y, const Rgb& colour, double alpha) {
    render::blend(image_, x, y, colour, alpha);
  }
  /// Even-odd rule, edges smoothed by 4 x 4 samples.
  void fill(const std::vector<Eigen::Vector2d>& polygon, const Rgb& colour, double alpha = 1.0);
  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width_px, const Rgb& colour,
            double alpha = 1.0);
  void outline(const std::vector<Eigen::Vector2d>& polygon, double width_px, const Rgb& colour,
               double alpha = 1.0);
  /// @param anchor  share of the text's width to the left of x: 0 starts at x, 0.5 is centred on x
  void text(const std::string& text, int size_px, const Eigen::Vector2d& at, const Rgb& colour,
            double anchor = 0.0);

  /// Copies a picture onto the canvas; parts outside the canvas are cut off.
  void paste(const Image& picture, int left, int top);

  const Image& image() const { return image_; }
  Image take() && { return std::move(image_); }

 private:
  Image image_;
};

}  // namespace vinerow::render
