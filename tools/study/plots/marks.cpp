#include "tools/study/plots/marks.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/report/html.h"

namespace vinerow::study {
namespace {

constexpr double kRadius_px = 4.2;

/// Corners of a regular polygon. @param first_rad  angle of the first corner, 0: right, clockwise
std::vector<Eigen::Vector2d> corners(int count, double first_rad, double radius_px, double x,
                                     double y) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double angle_rad = first_rad + 2.0 * std::numbers::pi * i / count;
    points.emplace_back(x + radius_px * std::cos(angle_rad), y + radius_px * std::sin(angle_rad));
  }
  return points;
}

void draw_shape(Shape shape, double x, double y, const std::string& css_class,
                tools::report::Svg& svg) {
  constexpr double kUp_rad = -0.5 * std::numbers::pi, kDown_rad = 0.5 * std::numbers::pi;
  switch (shape) {
    case Shape::kCircle:
      svg.circle(x, y, kRadius_px, css_class);
      break;
    case Shape::kSquare:
      svg.rect(x - 3.8, y - 3.8, 7.6, 7.6, css_class);
      break;
    case Shape::kTriangle:
      svg.polygon(corners(3, kUp_rad, 5.6, x, y), css_class);
      break;
    case Shape::kDiamond:
      svg.polygon(corners(4, kUp_rad, 5.6, x, y), css_class);
      break;
    case Shape::kDownTriangle:
      svg.polygon(corners(3, kDown_rad, 5.6, x, y), css_class);
      break;
  }
}

}  // namespace

std::string cell_attribute(std::int64_t cell) {
  return cell < 0 ? "" : fmt::format("data-cell=\"{}\"", cell);
}

std::string tip_text(std::initializer_list<std::string> lines, std::int64_t cell) {
  std::string tip;
  const auto add = [&](const std::string& line) {
    if (!line.empty()) tip += (tip.empty() ? "" : "\n") + line;
  };
  for (const std::string& line : lines) add(line);
  if (cell >= 0) add(fmt::format("cell {}", cell));
  return tip;
}

std::string group_class(std::size_t group) {
  return fmt::format("s{}", group % 8);
}

Shape group_shape(std::size_t group) {
  return static_cast<Shape>(group % 5);
}

const char* shape_letter(Shape shape) {
  constexpr std::array<const char*, 5> kLetters = {"●", "■", "▲", "◆", "▼"};
  return kLetters[static_cast<std::size_t>(shape)];
}

void draw_marker(Shape shape, double x, double y, const std::string& css_class,
                 const std::string& tip, std::int64_t cell, double reach_px,
                 tools::report::Svg& svg) {
  const std::string attribute = cell_attribute(cell);
  svg.open_group("class=\"mark\"" + (attribute.empty() ? "" : " " + attribute));
  if (!tip.empty()) svg.raw("<title>" + tools::escaped(tip) + "</title>\n");
  if (reach_px > kRadius_px) svg.circle(x, y, reach_px, "reach");
  draw_shape(shape, x, y, "dot " + css_class, svg);
  svg.close_group();
}

}  // namespace vinerow::study
