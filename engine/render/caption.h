#pragma once
/// Text in a translucent rounded panel at the lower left of a picture, by FreeType on the CPU.

#include <string>
#include <vector>

#include "engine/render/scene.h"

namespace vinerow::render {

/// The first line is bold and larger; sizes follow the picture's height. UTF-8. Where the fonts
/// (DejaVu Sans, Debian package fonts-dejavu-core) are absent the picture stays as it is.
/// @returns whether the text was drawn
bool draw_caption(const std::vector<std::string>& lines, Image& image);

}  // namespace vinerow::render
