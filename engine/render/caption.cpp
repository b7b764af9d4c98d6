#include "engine/render/caption.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "engine/render/canvas.h"

namespace vinerow::render {

namespace {

std::string font_folder() {
  const char* folder = std::getenv("VINEROW_FONTS");
  return folder != nullptr ? folder : "/usr/share/fonts/truetype/dejavu";
}

/// FreeType's handles, released in the right order.
class Fonts {
 public:
  Fonts() {
    if (FT_Init_FreeType(&library_) != 0) {
      library_ = nullptr;
      return;
    }
    plain_ = open("/DejaVuSans.ttf");
    bold_ = open("/DejaVuSans-Bold.ttf");
  }
  Fonts(const Fonts&) = delete;
  Fonts& operator=(const Fonts&) = delete;
  ~Fonts() {
    if (library_ != nullptr) FT_Done_FreeType(library_);  // also releases the faces
  }
  FT_Face plain() const { return plain_; }
  FT_Face bold() const { return bold_ != nullptr ? bold_ : plain_; }

 private:
  FT_Face open(const char* name) const {
    FT_Face face = nullptr;
    return FT_New_Face(library_, (font_folder() + name).c_str(), 0, &face) == 0 ? face : nullptr;
  }
  FT_Library library_ = nullptr;
  FT_Face plain_ = nullptr;
  FT_Face bold_ = nullptr;
};

/// Next code point of UTF-8 text; an invalid byte is returned as it is.
char32_t next_code_point(const std::string& text, std::size_t& at) {
  const auto byte = static_cast<unsigned char>(text[at++]);
  const int more = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : byte >= 0xC0 ? 1 : 0;
  if (more == 0 || at + more > text.size()) return byte;
  char32_t code = byte & (0x3F >> more);
  for (int i = 0; i < more; ++i) code = code << 6 | (static_cast<unsigned char>(text[at++]) & 0x3F);
  return code;
}

/// Draws (or, without an image, measures) one line. @returns its width in pixels
double draw_line(FT_Face face, int size_px, const std::string& text, double x, int baseline,
                 Image* image, const Rgb& ink = {248, 246, 238}) {
  FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size_px));
  const double start = x;
  FT_UInt previous = 0;
  for (std::size_t at = 0; at < text.size();) {
    const FT_UInt glyph = FT_Get_Char_Index(face, next_code_point(text, at));
    FT_Vector kerning{};
    if (previous != 0) FT_Get_Kerning(face, previous, glyph, FT_KERNING_DEFAULT, &kerning);
    x += kerning.x / 64.0;
    previous = glyph;
    if (FT_Load_Glyph(face, glyph, image != nullptr ? FT_LOAD_RENDER : FT_LOAD_DEFAULT) != 0)
      continue;
    if (image != nullptr) {
      const FT_GlyphSlot slot = face->glyph;
      for (unsigned row = 0; row < slot->bitmap.rows; ++row) {
        for (unsigned column = 0; column < slot->bitmap.width; ++column) {
          const unsigned char cover = slot->bitmap.buffer[row * slot->bitmap.pitch + column];
          if (cover == 0) continue;
          blend(*image,
                static_cast<int>(std::lround(x)) + slot->bitmap_left + static_cast<int>(column),
                baseline - slot->bitmap_top + static_cast<int>(row), ink, cover / 255.0);
        }
      }
    }
    x += face->glyph->advance.x / 64.0;
  }
  return x - start;
}

void draw_panel(Image& image, int x0, int y0, int x1, int y1, double radius) {
  constexpr Rgb kShade = {18, 24, 20};
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      // Distance to the rectangle shrunk by the radius: gives rounded, smooth corners.
      const double dx = std::max({x0 + radius - (x + 0.5), x + 0.5 - (x1 - radius), 0.0});
      const double dy = std::max({y0 + radius - (y + 0.5), y + 0.5 - (y1 - radius), 0.0});
      const double cover = std::clamp(radius - std::hypot(dx, dy) + 0.5, 0.0, 1.0);
      blend(image, x, y, kShade, 0.58 * cover);
    }
  }
}

/// Row of legend entries, with the start of each in pixels.
struct LegendPlace {
  int row = 0;
  double x = 0.0;
};
struct LegendLayout {
  std::vector<LegendPlace> places;
  int rows = 0;
  double width = 0.0;
};

LegendLayout lay_out(const std::vector<LegendEntry>& legend, FT_Face face, int size_px,
                     double max_width) {
  LegendLayout layout;
  double x = 0.0;
  for (const LegendEntry& entry : legend) {
    const double width = size_px + draw_line(face, size_px, entry.text, 0.0, 0, nullptr);
    if (layout.rows == 0 || x + width > max_width) {
      ++layout.rows;
      x = 0.0;
    }
    layout.places.push_back({layout.rows - 1, x});
    layout.width = std::max(layout.width, x + width);
    x += width + 1.2 * size_px;
  }
  return layout;
}

/// Draws a square as high as small letters, and the text after it.
void draw_entry(const LegendEntry& entry, FT_Face face, int size_px, double x, int baseline,
                Image& image) {
  const int side = static_cast<int>(std::lround(0.62 * size_px));
  const int left = static_cast<int>(std::lround(x));
  const Rgb colour = rgb_of(entry.colour);
  for (int dy = 0; dy < side; ++dy) {
    for (int dx = 0; dx < side; ++dx) blend(image, left + dx, baseline - 1 - dy, colour, 1.0);
  }
  draw_line(face, size_px, entry.text, x + size_px, baseline, &image);
}

/// The text, or as much of it as fits, with an ellipsis.
std::string fit_line(FT_Face face, int size_px, const std::string& text, double max_width) {
  std::string fitted = text;
  std::size_t length = text.size();
  while (length > 0 && draw_line(face, size_px, fitted, 0.0, 0, nullptr) > max_width) {
    // Step back to the start of a UTF-8 character.
    do --length;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80);
    fitted = text.substr(0, length) + "…";
  }
  return fitted;
}

/// Upper left corner of a panel.
Eigen::Vector2i free_corner(const Image& image, const Eigen::Vector2i& panel, int margin,
                            const std::vector<Eigen::AlignedBox2d>& keep_clear) {
  const int left = margin, right = image.width - margin - panel.x();
  const int top = margin, bottom = image.height - margin - panel.y();
  const Eigen::Vector2i first(left, bottom);
  for (const Eigen::Vector2i& at : {first, Eigen::Vector2i(right, bottom),
                                    Eigen::Vector2i(left, top), Eigen::Vector2i(right, top)}) {
    const Eigen::AlignedBox2d box(at.cast<double>(), (at + panel).cast<double>());
    const bool covers =
        std::any_of(keep_clear.begin(), keep_clear.end(),
                    [&](const Eigen::AlignedBox2d& other) { return box.intersects(other); });
    if (!covers) return at;
  }
  return first;
}

}  // namespace

int caption_text_px(int picture_height) {
  constexpr double kShare = 0.03;
  constexpr int kMin_px = 11;
  return std::max(kMin_px, static_cast<int>(std::lround(picture_height * kShare)));
}

bool draw_caption(const std::vector<std::string>& lines, Image& image,
                  const std::vector<LegendEntry>& legend,
                  const std::vector<Eigen::AlignedBox2d>& keep_clear) {
  if (lines.empty() && legend.empty()) return false;
  const Fonts fonts;
  if (fonts.plain() == nullptr) return false;
  const int small = caption_text_px(image.height);
  const int large = static_cast<int>(std::lround(small * 1.2));
  const int gap = static_cast<int>(std::lround(small * 0.45));
  const int padding = static_cast<int>(std::lround(small * 0.7));
  const int margin = static_cast<int>(std::lround(small * 0.8));
  const double max_width = image.width - 2.0 * (margin + padding);

  double width = 0.0;
  std::vector<std::string> fitted;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const FT_Face face = i == 0 ? fonts.bold() : fonts.plain();
    const int size_px = i == 0 ? large : small;
    fitted.push_back(fit_line(face, size_px, lines[i], max_width));
    width = std::max(width, draw_line(face, size_px, fitted.back(), 0.0, 0, nullptr));
  }
  const LegendLayout layout = lay_out(legend, fonts.plain(), small, max_width);
  width = std::max(width, layout.width);
  const int count = static_cast<int>(lines.size()) + layout.rows;
  const int panel_width = static_cast<int>(width) + 2 * padding;
  const int panel_height = 2 * padding + large + (count - 1) * (small + gap) - small / 5;
  const Eigen::Vector2i corner =
      free_corner(image, {panel_width, panel_height}, margin, keep_clear);
  const int x0 = corner.x(), y0 = corner.y();
  draw_panel(image, x0, y0, x0 + panel_width, y0 + panel_height, 0.55 * small);
  int baseline = y0 + padding + large - large / 5;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const bool first = i == 0;
    draw_line(first ? fonts.bold() : fonts.plain(), first ? large : small, fitted[i], x0 + padding,
              baseline, &image);
    baseline += small + gap;
  }
  for (std::size_t i = 0; i < legend.size(); ++i) {
    const LegendPlace& place = layout.places[i];
    draw_entry(legend[i], fonts.plain(), small, x0 + padding + place.x,
               baseline + place.row * (small + gap), image);
  }
  return true;
}

double draw_text(const std::string& text, int size_px, double x, double baseline, const Rgb& rgb,
                 Image& image) {
  const Fonts fonts;
  if (fonts.plain() == nullptr) return 0.0;
  return draw_line(fonts.plain(), size_px, text, x, static_cast<int>(std::lround(baseline)), &image,
                   rgb);
}

double text_width(const std::string& text, int size_px) {
  const Fonts fonts;
  if (fonts.plain() == nullptr) return 0.0;
  return draw_line(fonts.plain(), size_px, text, 0.0, 0, nullptr);
}

}  // namespace vinerow::render
