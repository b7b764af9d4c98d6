#pragma once
/// Colours and sizes shared by the command's pictures.

#include "tools/pictures/picture_canvas.h"

namespace vinerow::tools {

inline constexpr Rgb kPaper = {250, 249, 245}, kInk = {38, 44, 46}, kFaint = {120, 124, 122};
inline constexpr Rgb kBoundary = {30, 34, 36};  ///< a parcel's edge on maps of the ground

// All in pixels.
inline constexpr int kPictureWidth = 1600;
inline constexpr int kTallestPlan = 1500;   ///< largest height of a top view
inline constexpr int kNarrowMargin = 28;    ///< margin without numbers
inline constexpr int kNumberedMargin = 44;  ///< margin with numbers at the row ends

}  // namespace vinerow::tools
