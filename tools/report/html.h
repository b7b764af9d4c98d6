#pragma once
/// HTML elements used by all parts of the report. All output is well-formed XML too.

#include <string>
#include <vector>

namespace vinerow::tools::report {

/// Text for content and attributes. Escapes & < > ", drops control characters, and replaces invalid
/// UTF-8 bytes by U+FFFD.
std::string escaped(const std::string& text);

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

/// Chapter of the page with its title; empty if the content is empty.
std::string section(const std::string& id, const std::string& title, const std::string& content);

}  // namespace vinerow::tools::report
