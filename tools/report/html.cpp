#include "tools/report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vinerow::tools::report {

std::string grouped(const std::string& digits, std::size_t least) {
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  if (whole < least) return digits;
  std::string out;
  for (std::size_t k = 0; k < whole; ++k) {
    if (k > 0 && (whole - k) % 3 == 0) out += "\u202f";  // narrow, no-break
    out += digits[k];
  }
  return out + digits.substr(whole);
}

std::string number_text(double value) {
  if (!std::isfinite(value)) return "not measured";
  const double size = std::abs(value);
  std::string digits;
  if (size != 0.0 && (size < 1e-4 || size >= 1e9)) {
    digits = fmt::format("{:.3e}", size);
  } else {
    digits = size >= 1000.0 ? fmt::format("{:.0f}", size) : fmt::format("{:.4g}", size);
  }
  return (value < 0.0 ? "−" : "") + grouped(digits);
}

std::string number_cell(double value) {
  return std::isfinite(value)
             ? fmt::format("<td class=\"num\" title=\"{}\">{}</td>", value, number_text(value))
             : "<td class=\"num none\">not measured</td>";
}

std::string duration_text(double seconds) {
  if (seconds < 59.5) return fmt::format("{:.{}f} s", seconds, seconds < 9.95 ? 1 : 0);
  const auto whole = static_cast<std::int64_t>(std::lround(seconds));
  if (whole >= 3600) return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
  return fmt::format("{} min {} s", whole / 60, whole % 60);
}

std::string counted(long count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string table(const std::vector<std::string>& heads,
                  const std::vector<std::vector<std::string>>& rows, const std::string& css_class) {
  std::string out = "<div class=\"scroll\"><table" +
                    (css_class.empty() ? "" : " class=\"" + css_class + "\"") + ">\n";
  if (!heads.empty()) {
    out += "<thead><tr>";
    for (const std::string& head : heads) out += "<th>" + head + "</th>";
    out += "</tr></thead>\n";
  }
  out += "<tbody>\n";
  for (const auto& row : rows) {
    out += "<tr>";
    for (const std::string& cell : row) {
      out += cell.starts_with("<td") ? cell : "<td>" + cell + "</td>";
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string legend_key(const std::string& css_class, const std::string& label) {
  return fmt::format("<span><i class=\"key {}\"></i>{}</span>", css_class, escaped(label));
}

std::string legend_line(const std::string& keys) {
  return "<p class=\"legend\">" + keys + "</p>\n";
}

std::string card(const std::string& value, const std::string& what) {
  return fmt::format("<div class=\"card\"><b>{}</b><span>{}</span></div>\n", value, what);
}

std::string figure(const std::string& css_class, const std::string& title,
                   const std::string& content, const std::string& caption) {
  return fmt::format("<figure class=\"{}\">\n{}{}<figcaption>{}</figcaption>\n</figure>\n",
                     css_class, title.empty() ? "" : "<h4>" + escaped(title) + "</h4>\n", content,
                     caption);
}

std::string section(const std::string& id, const std::string& title, const std::string& content) {
  if (content.empty()) return "";
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, escaped(title),
                     content);
}

}  // namespace vinerow::tools::report
