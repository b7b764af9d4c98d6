#pragma once
/// Where the drawn pixels of a picture lie, and how they become the picture's pixels.
///
/// Pictures are supersampled instead of multisampled: with leaves, llvmpipe takes as long for 4
/// samples as for 4 pixels, and supersampling also smooths alpha-tested edges and textures.

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

namespace vinerow::render {

/// Square patterns have n x n drawn pixels in each pixel, whose mean it is.
///
/// The pattern of two samples a pixel is staggered: drawn pixels lie in the pixels' middles and on
/// their corners. A pixel is half its middle and an eighth of each corner. Four pixels share a
/// corner, so a pixel is made of five samples; near-horizontal and near-vertical edges have as many
/// steps as with 2 x 2. Error of a picture between rows of vines against 3 x 3 samples: rms 5.5 of
/// 255 levels, with 2 x 2 4.2, with one sample 10.0. The ground has a sample in the pixels' middles
/// alone; on the corners too the error would be 5.3, in 1.14 of the time. Source: "HRAA:
/// High-Resolution Antialiasing Through Multisampling", NVIDIA technical brief, 2001 (Quincunx).
///
/// The staggered rows, half a pixel apart, are an ordinary grid under a shear by half a pixel a
/// row: drawn column a and row j (from below) lie at x = a + j/2 - H, y = j/2 (pixels, from the
/// lower left corner of a picture of H rows). With W + H + 1 columns and 2 H + 1 rows, whose outer
/// triangles are not used, clip coordinates become
///   x' = (W x - H y) / (W + H + 1),   y' = 2 H y / (2 H + 1).
class SamplePattern {
 public:
  /// @param width,height  of the picture
  /// @param samples  1, 2 (staggered), 4 or 9 per pixel; else the nearest square. Pictures so large
  /// that OpenGL cannot stagger them have 4 instead of 2.
  SamplePattern(int width, int height, int samples);
  SamplePattern() = default;

  int width() const { return width_; }
  int height() const { return height_; }
  bool staggered() const { return staggered_; }
  /// Of the drawn pixels.
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Distance of neighbouring drawn pixels, in pixels of the picture.
  double spacing_px() const;
  /// Addition to the levels of detail that OpenGL chooses for textures. It takes the larger
  /// distance of drawn neighbours, which in the staggered pattern is a pixel.
  double lod_bias() const { return lod_bias_; }
  /// The middles of the pixels alone, where textures are read as finely as here.
  SamplePattern middles() const {
    SamplePattern pattern(width_, height_, 1);
    pattern.lod_bias_ = std::log2(spacing_px());
    return pattern;
  }
  /// Clip space of the drawn pixels from the picture's.
  Eigen::Matrix4d drawn_from_clip() const;

  struct Tap {
    std::ptrdiff_t offset;  ///< to the pixel's first drawn pixel, in drawn pixels
    unsigned weight;        ///< a power of two
  };
  /// What a pixel is made of.
  const std::vector<Tap>& taps() const { return taps_; }
  unsigned weight_sum() const { return weight_sum_; }
  /// Index of the first drawn pixel of pixel (x, y), x from the left and y from the top; drawn rows
  /// are stored from below, as OpenGL does.
  std::size_t first_of(int x, int y) const;
  struct Columns {
    int begin, end;
  };
  /// Drawn columns outside of which no pixel has samples in these drawn rows.
  Columns used_columns(int first_row, int rows) const;
  /// Drawn pixels from a pixel to the next one in its row.
  int stride() const { return staggered_ ? 1 : scale_; }

 private:
  int width_ = 0, height_ = 0;
  int scale_ = 1;
  double lod_bias_ = 0.0;
  bool staggered_ = false;
  int columns_ = 0, rows_ = 0;
  unsigned weight_sum_ = 0;
  std::vector<Tap> taps_;
};

}  // namespace vinerow::render
