#pragma once
/// HTML elements used by all parts of the report, beyond page_text.h.

#include <string>
#include <vector>

#include "tools/replay/page_text.h"

namespace vinerow::tools::report {

/// Digits of a number with thin spaces between thousands, if the integer has at least this many.
std::string grouped(const std::string& digits, std::size_t least = 5);

/// Number for people: four significant digits, separated thousands, minus sign U+2212. "not
/// measured" if it is not finite.
std::string number_text(double value);

/// The same as a table cell, whose title has all digits.
std::string number_cell(double value);

/// Seconds as "43 s" or "4 min 20 s". @param seconds  >= 0
std::string duration_text(double seconds);

/// "1 vehicle", "3 vehicles".
std::string counted(long count, const std::string& noun);

/// Table that scrolls on a narrow page. Cells are HTML; a cell that begins with "<td" is inserted
/// unchanged.
std::string table(const std::vector<std::string>& heads,
                  const std::vector<std::vector<std::string>>& rows,
                  const std::string& css_class = "");

/// Entry of a legend. @param css_class  class of its mark: "s0", "area s0", "limit"
std::string legend_key(const std::string& css_class, const std::string& label);

/// Legend from such entries.
std::string legend_line(const std::string& keys);

/// Number on the first screen or of a payload. @param value,what  HTML
std::string card(const std::string& value, const std::string& what);

/// Figure around HTML. @param css_class  "plot", "plot wide-chart" @param title  "": none
std::string figure(const std::string& css_class, const std::string& title,
                   const std::string& content, const std::string& caption);

/// Chapter of the page with its title; empty if the content is empty.
std::string section(const std::string& id, const std::string& title, const std::string& content);

}  // namespace vinerow::tools::report
