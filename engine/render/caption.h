#pragma once
/// Text in a translucent rounded panel in a corner of a picture, drawn by FreeType on the CPU.

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "engine/render/scene.h"

namespace vinerow::render {

/// Text size of captions and other annotations for a picture height. Pages show pictures at half
/// their width, so text is twice as large as the smallest legible size.
int caption_text_px(int picture_height);

/// Draws a caption. The first line is bold and larger; sizes scale with the picture's height. Text
/// is UTF-8. Without the fonts (DejaVu Sans, Debian package fonts-dejavu-core) the picture is not
/// changed. A line wider than the picture ends with an ellipsis.
/// @param legend  drawn below the lines: each text after a square of its colour, in as many rows as
/// the picture's width requires
/// @param keep_clear  boxes in pixels that the panel should not cover. The panel takes the first
/// corner without overlap of lower left, lower right, upper left, upper right, else lower left.
/// @returns true if the text was drawn
bool draw_caption(const std::vector<std::string>& lines, Image& image,
                  const std::vector<LegendEntry>& legend = {},
                  const std::vector<Eigen::AlignedBox2d>& keep_clear = {});

/// Draws one line of text without a panel. @param x,baseline  start of the text in pixels
/// @param rgb  0 to 255 @returns its width in pixels; 0 without the fonts or outside the picture
double draw_text(const std::string& text, int size_px, double x, double baseline,
                 const std::array<int, 3>& rgb, Image& image);
/// Width of a text in draw_text(), in pixels.
double text_width(const std::string& text, int size_px);

}  // namespace vinerow::render
