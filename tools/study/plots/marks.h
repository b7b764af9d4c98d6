#pragma once
/// Marks on plots that stand for a cell of the study: click_script() shows the cell's command.

#include <cstdint>
#include <initializer_list>
#include <string>

#include "tools/report/svg.h"

namespace vinerow::study {

/// A mark that stands for no cell.
inline constexpr std::int64_t kNoCell = -1;

/// The attribute `data-cell="5"`; "" where there is no cell.
std::string cell_attribute(std::int64_t cell);

/// The lines that are not empty, one below the other, and "cell 5" where there is a cell.
std::string tip_text(std::initializer_list<std::string> lines, std::int64_t cell);

/// Groups of a plot differ in colour and in the shape of their marks.
enum class Shape { kCircle, kSquare, kTriangle, kDiamond, kDownTriangle };

/// Of the group with that index, from 0 on: 8 colours and 5 shapes give 40 that differ.
std::string group_class(std::size_t group);
Shape group_shape(std::size_t group);
/// The shape as a letter, for legends: "●".
const char* shape_letter(Shape shape);

/// A mark about 9 px wide that also answers to the pointer beside it.
/// @param reach_px  from its centre; 0 where marks lie close together
void draw_marker(Shape shape, double x, double y, const std::string& css_class,
                 const std::string& tip, std::int64_t cell, double reach_px,
                 tools::report::Svg& svg);

}  // namespace vinerow::study
