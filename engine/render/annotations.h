#pragma once
/// Annotations drawn over a finished picture: markers, scale, caption.

#include <vector>

#include "engine/render/frame_target.h"
#include "engine/render/scene.h"

namespace vinerow::render {

/// @param seen  places of the frame's vehicles in the picture; the caption is placed in a corner
/// where it hides none of them
void annotate(const Frame& frame, const std::vector<SeenMark>& seen, Image& image);

}  // namespace vinerow::render
