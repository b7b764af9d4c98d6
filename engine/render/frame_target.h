#pragma once
/// Render target with colour, depth and stencil buffers for the drawn pixels of a picture.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/render/gl.h"
#include "engine/render/sample_pattern.h"
#include "engine/render/scene.h"
#include "engine/render/texture_units.h"

namespace vinerow::render {

/// Area of one stencil value in the picture.
struct SeenMark {
  double share = 0.0;          ///< of the picture
  Eigen::AlignedBox2i box_px;  ///< in the picture; empty if not visible
};

class FrameTarget {
 public:
  /// Along a side of a square of pixels over which the sky changes little: its clouds come from a
  /// texture whose pixels are larger.
  static constexpr int kSkyPixels = 4;

  explicit FrameTarget(const Gl& gl) : gl_(gl) {}

  /// Binds and clears the buffers; recreates them if their size changed.
  /// @throws std::runtime_error if the implementation cannot make them
  void begin(const SamplePattern& pattern);
  /// Binds the buffers for albedo and normal of leaves, which share the depth buffer.
  void begin_foliage() const;
  /// Binds the buffers for the ground's colours, with a pixel for each of the picture's. All of
  /// them must be drawn; the colours are in texture unit kUnitGroundSeen. @pre the pattern is
  /// staggered
  void begin_ground();
  /// Binds the buffer for the sky's colours, with a pixel for kSkyPixels x kSkyPixels of the
  /// picture's; they are in texture unit kUnitSkySeen.
  void begin_sky();
  /// Binds the buffers of begin() again. Depth, albedo and normal of leaves are in texture units
  /// kUnitDepth, kUnitAlbedo and kUnitNormal.
  void resume() const;
  /// The picture: means of drawn pixels, taken over squared sRGB values, which approximates the
  /// mean of linear light.
  Image read();
  /// Areas of the stencil values 1, 2, ... count; clears the stencil.
  std::vector<SeenMark> take_marks(std::size_t count) const;

 private:
  void make();
  void make_ground();
  void make_sky();
  /// A texture of colours that is read with interpolation, attached to the bound framebuffer.
  GLuint attach_colours(TextureUnit unit, int width, int height) const;
  void release();
  /// Reads what the drawn pixels have where the picture's pixels are.
  /// @param drawn  of all drawn pixels, as SamplePattern::first_of() counts them
  void read_drawn(GLenum layout, std::size_t bytes_per_pixel,
                  std::vector<std::uint8_t>& drawn) const;
  /// Whether any drawn pixel of a row of the picture has a stencil value.
  bool has_marks(const std::vector<std::uint8_t>& stencil, int y) const;
  /// Sums of squares of a row's pixels, RGBA.
  void sum_row(int y, std::vector<std::uint32_t>& sums) const;

  const Gl& gl_;
  SamplePattern pattern_;
  GLuint framebuffer_ = 0, colour_ = 0, depth_ = 0;
  GLuint foliage_framebuffer_ = 0, albedo_ = 0, normal_ = 0;
  GLuint ground_framebuffer_ = 0, ground_ = 0, ground_depth_ = 0;
  GLuint sky_framebuffer_ = 0, sky_ = 0;
  std::vector<std::uint8_t> drawn_;  ///< RGBA of the drawn pixels; kept, because new pages are slow
};

}  // namespace vinerow::render
