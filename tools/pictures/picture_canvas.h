#pragma once
/// Canvas of the commands' pictures: that of the renderer's overlays.

#include "engine/render/canvas.h"

namespace vinerow::tools {

using render::Canvas;
using render::Rgb;

}  // namespace vinerow::tools
