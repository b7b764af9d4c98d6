#pragma once
/// Where a frame is drawn: colour, depth and stencil, larger than the picture by a whole factor,
/// and reading back.
///
/// Several full pixels for one (supersampling) instead of multisampling: with leaves, llvmpipe
/// takes as long for 4 samples as for 4 pixels, and pixels smooth alpha-tested edges and textures
/// too.

#include <Eigen/Geometry>
#include <vector>

#include "engine/render/gl.h"
#include "engine/render/scene.h"

namespace vinerow::render {

/// Where a mark of the stencil is.
struct SeenMark {
  double share = 0.0;          ///< of the picture
  Eigen::AlignedBox2i box_px;  ///< in the picture; empty where it is nowhere
};

class FrameTarget {
 public:
  explicit FrameTarget(const Gl& gl) : gl_(gl) {}

  /// Makes buffers if sizes differ from before, binds and clears them.
  /// @param scale  pixels drawn for one of the picture, along each side
  /// @throws std::runtime_error if the implementation cannot make them
  void begin(int width, int height, int scale);
  /// The picture: means of scale x scale pixels, taken of squares of the screen's values, which is
  /// nearly the mean of light.
  Image read() const;
  /// Where the stencil holds 1, 2, ... count; clears it.
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
