#pragma once
/// Pieces of HTML that every part of the report writes. All of it is well formed as XML, too.

#include <string>
#include <vector>

namespace vinerow::tools::report {

/// Text for content and attributes: & < > " are escaped, control characters left out, bytes that
/// are no UTF-8 become U+FFFD.
std::string escaped(const std::string& text);

/// A number for people: four significant digits, thousands apart, a true minus sign. "not measured"
/// where it is not finite.
std::string number_text(double value);

/// The same as a table's cell, its title holds every digit.
std::string number_cell(double value);

/// Seconds as "43 s" or "4 min 20 s". @param seconds  >= 0
std::string duration_text(double seconds);

/// "1 vehicle", "3 vehicles".
std::string counted(long count, const std::string& noun);

/// A table that scrolls where the page is narrow. Cells are HTML; those that begin with "<td" are
/// taken as they are.
std::string table(const std::vector<std::string>& heads,
                  const std::vector<std::vector<std::string>>& rows,
                  const std::string& css_class = "");

/// One entry of a legend. @param css_class  of its mark: "s0", "area s0", "limit"
std::string legend_key(const std::string& css_class, const std::string& label);

/// What a chapter of the page is called, and its content, nothing where that is empty.
std::string section(const std::string& id, const std::string& title, const std::string& content);

}  // namespace vinerow::tools::report
