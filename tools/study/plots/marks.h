#pragma once
/// Marks on plots that represent a cell of the study: click_script() shows the cell's command.

#include <cstdint>
#include <initializer_list>
#include <string>

#include "tools/report/svg.h"

namespace vinerow::study {

/// Marks without a cell.
inline constexpr std::int64_t kNoCell = -1;

/// Attribute `data-cell="5"`; "" without a cell.
std::string cell_attribute(std::int64_t cell);

/// Tooltip of the non-empty lines, and "cell 5" if there is a cell.
std::string tip_text(std::initializer_list<std::string> lines, std::int64_t cell);

/// Shape of the marks of a group; groups also differ in colour.
enum class Shape { kCircle, kSquare, kTriangle, kDiamond, kDownTriangle };

/// CSS class of a group by index: 8 colours and 5 shapes give 40 distinct groups.
std::string group_class(std::size_t group);
Shape group_shape(std::size_t group);
/// Shape as a character, for legends: "●".
const char* shape_letter(Shape shape);

/// Draws a mark about 9 px wide that also reacts to the pointer nearby.
/// @param reach_px  distance from its centre; 0 if marks are close together
void draw_marker(Shape shape, double x, double y, const std::string& css_class,
                 const std::string& tip, std::int64_t cell, double reach_px,
                 tools::report::Svg& svg);

}  // namespace vinerow::study
