#pragma once
/// Render target with colour, depth and stencil buffers, larger than the picture by an integer
/// factor.
///
/// It supersamples instead of multisampling: with leaves, llvmpipe takes as long for 4 samples as
/// for 4 pixels, and supersampling also smooths alpha-tested edges and textures.

#include <Eigen/Geometry>
#include <vector>

#include "engine/render/gl.h"
#include "engine/render/scene.h"

namespace vinerow::render {

/// Area of one stencil value in the picture.
struct SeenMark {
  double share = 0.0;          ///< of the picture
  Eigen::AlignedBox2i box_px;  ///< in the picture; empty if not visible
};

class FrameTarget {
 public:
  explicit FrameTarget(const Gl& gl) : gl_(gl) {}

  /// Binds and clears the buffers; recreates them if the size changed.
  /// @param scale  drawn pixels per pixel of the picture, along each side
  /// @throws std::runtime_error if the implementation cannot make them
  void begin(int width, int height, int scale);
  /// The picture: means of scale x scale pixels. The mean is taken over squared sRGB values, which
  /// approximates the mean of linear light.
  Image read() const;
  /// Areas of the stencil values 1, 2, ... count; clears the stencil.
  std::vector<SeenMark> take_marks(std::size_t count) const;

 private:
  void make();
  void release();

  const Gl& gl_;
  int width_ = 0;
  int height_ = 0;
  int scale_ = 1;
  GLuint framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

}  // namespace vinerow::render
