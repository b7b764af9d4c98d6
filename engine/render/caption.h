#pragma once
/// Text in a translucent rounded panel in a corner of a picture, by FreeType on the CPU.

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "engine/render/scene.h"

namespace vinerow::render {

/// Size of a caption's text, and of what else is written over a picture of that height. Pages show
/// pictures at half their width: what is read there must be twice as large as what can just be
/// read.
int caption_text_px(int picture_height);

/// The first line is bold and larger; sizes follow the picture's height. UTF-8. Where the fonts
/// (DejaVu Sans, Debian package fonts-dejavu-core) are absent the picture stays as it is. A line
/// wider than the picture ends with an ellipsis.
/// @param legend  below the lines, each text behind a square of its colour, in as many rows as the
///   picture's width asks for
/// @param keep_clear  boxes in pixels that the panel should not cover: it goes to the first corner
///   of lower left, lower right, upper left, upper right where it covers none, else lower left
/// @returns whether the text was drawn
bool draw_caption(const std::vector<std::string>& lines, Image& image,
                  const std::vector<LegendEntry>& legend = {},
                  const std::vector<Eigen::AlignedBox2d>& keep_clear = {});

/// One line of text, without a panel. @param x,baseline  pixels, where it begins
/// @param rgb  0 to 255 @returns its width in pixels; 0 where the fonts are absent, or drawn
/// outside
double draw_text(const std::string& text, int size_px, double x, double baseline,
                 const std::array<int, 3>& rgb, Image& image);
/// How wide draw_text() makes it.
double text_width(const std::string& text, int size_px);

}  // namespace vinerow::render
