#pragma once
/// The commands' pictures are drawn with what the renderer writes over its own.

#include "engine/render/canvas.h"

namespace vinerow::tools {

using render::Canvas;
using render::Rgb;

}  // namespace vinerow::tools
