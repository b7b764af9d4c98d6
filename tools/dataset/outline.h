#pragma once
/// Masks as polygons.

#include <Eigen/Core>
#include <vector>

#include "tools/dataset/mask.h"

namespace vinerow::dataset {

/// One closed polygon along the edges of a mask's pixels, in pixels from the picture's upper left
/// corner. By the even-odd rule it holds exactly the mask's pixels: pieces that do not touch, and
/// holes, are joined to the rest by a line that runs there and back, as Ultralytics joins the
/// polygons of one thing. @param picture_height  in pixels
std::vector<Eigen::Vector2i> outline_of(const Mask& mask, int picture_height);

}  // namespace vinerow::dataset
