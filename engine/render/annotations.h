#pragma once
/// What is written over a picture once its pixels are there: markers, scale, caption.

#include <vector>

#include "engine/render/frame_target.h"
#include "engine/render/scene.h"

namespace vinerow::render {

/// @param seen  where the frame's vehicles are seen: the caption goes to a corner where it hides
/// none
void annotate(const Frame& frame, const std::vector<SeenMark>& seen, Image& image);

}  // namespace vinerow::render
