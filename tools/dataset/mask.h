#pragma once
/// Masks of things as run lengths, the way COCO stores them: pixels column by column, beginning
/// with those outside.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vinerow::dataset {

struct Mask {
  /// Lengths of runs outside, inside, outside, ... of the pixels column by column; the first may be
  /// 0, the last run outside is left out.
  std::vector<std::uint32_t> runs;
  int left = 0, top = 0, width = 0, height = 0;  ///< pixels; smallest box
  int area = 0;                                  ///< pixels
};

/// @param pixels  x * picture_height + y of each pixel, ascending, not empty
Mask make_mask(std::span<const std::uint32_t> pixels, int picture_height);

/// The string `counts` of COCO: the runs of all pixels, each from the third on as its difference to
/// the last but one, in groups of five bits with the lowest first, as characters from '0'.
/// (COCO's maskApi, Lin et al. 2014.) @param pixels  of the picture
std::string coco_counts(const Mask& mask, std::uint32_t pixels);

}  // namespace vinerow::dataset
