#pragma once
/// Colours and sizes that the command's pictures share.

#include "tools/pictures/picture_canvas.h"

namespace vinerow::tools {

inline constexpr Rgb kPaper = {250, 249, 245}, kInk = {38, 44, 46}, kFaint = {120, 124, 122};
inline constexpr Rgb kBoundary = {30, 34, 36};  ///< a parcel's edge on maps of the ground

// All in pixels.
inline constexpr int kPictureWidth = 1600;
inline constexpr int kTallestPlan = 1500;   ///< of one that is drawn from above
inline constexpr int kNarrowMargin = 28;    ///< around what ends at the ground that it shows
inline constexpr int kNumberedMargin = 44;  ///< around what has numbers at its ends

}  // namespace vinerow::tools
