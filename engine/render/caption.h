#pragma once
/// Text in a translucent rounded panel at the lower left of a picture, by FreeType on the CPU.

#include <array>
#include <string>
#include <vector>

#include "engine/render/scene.h"

namespace vinerow::render {

/// The first line is bold and larger; sizes follow the picture's height. UTF-8. Where the fonts
/// (DejaVu Sans, Debian package fonts-dejavu-core) are absent the picture stays as it is.
/// @param legend  below the lines, each text behind a square of its colour, in as many rows as the
///   picture's width asks for
/// @returns whether the text was drawn
bool draw_caption(const std::vector<std::string>& lines, Image& image,
                  const std::vector<LegendEntry>& legend = {});

/// One line of text, without a panel. @param x,baseline  pixels, where it begins
/// @param rgb  0 to 255 @returns its width in pixels; 0 where the fonts are absent, or drawn
/// outside
double draw_text(const std::string& text, int size_px, double x, double baseline,
                 const std::array<int, 3>& rgb, Image& image);
/// How wide draw_text() makes it.
double text_width(const std::string& text, int size_px);

}  // namespace vinerow::render
