#include "tools/report/plot_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "tools/report/page_style.h"
#include "tools/report/svg.h"
#include "tools/report/units.h"

namespace vinerow::tools {
namespace {

constexpr std::size_t kNotFound = std::string_view::npos;

/// Text between two delimiters; "" if they do not occur.
std::string_view between(std::string_view text, std::string_view open, std::string_view close) {
  const std::size_t from = text.find(open);
  if (from == kNotFound) return {};
  const std::size_t to = text.find(close, from + open.size());
  return to == kNotFound ? std::string_view()
                         : text.substr(from + open.size(), to - from - open.size());
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != kNotFound; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// Adds the colours that a rule declares, by name: "--ink".
void add_colours(std::string_view declarations, std::map<std::string, std::string>& colours) {
  while (!declarations.empty()) {
    const std::string_view declaration = declarations.substr(0, declarations.find(';'));
    declarations.remove_prefix(std::min(declaration.size() + 1, declarations.size()));
    const std::size_t name = declaration.find("--"), colon = declaration.find(':');
    if (name == kNotFound || colon == kNotFound || colon < name) continue;
    const std::size_t value = declaration.find_first_not_of(' ', colon + 1);
    if (value == kNotFound) continue;
    colours[std::string(declaration.substr(name, colon - name))] = declaration.substr(value);
  }
}

struct Rule {
  std::string selector;  ///< ends with the space before the brace
  std::string body;      ///< including the braces
};

/// Rules for all media. Rules inside "@media ... { }" are for telephones, dark pages or paper.
std::vector<Rule> rules_of_all_media(std::string_view style) {
  std::vector<Rule> rules;
  int depth = 0;
  std::size_t begin = 0, open = 0;
  for (std::size_t i = 0; i < style.size(); ++i) {
    if (style[i] == '{' && depth++ == 0) open = i;
    if (style[i] != '}' || --depth != 0) continue;
    begin = std::min(style.find_first_not_of(" \n", begin), open);
    if (style[begin] != '@') {
      rules.push_back({std::string(style.substr(begin, open - begin)),
                       std::string(style.substr(open, i + 1 - open))});
    }
    begin = i + 1;
  }
  return rules;
}

/// Classes that give curves their colour: "ref", "--ink" for ".ref { --c: var(--ink); }".
std::vector<std::pair<std::string, std::string>> curve_colours(const std::vector<Rule>& rules) {
  std::vector<std::pair<std::string, std::string>> colours;
  for (const Rule& rule : rules) {
    const std::string_view name(rule.selector);
    const std::string_view colour = between(rule.body, "--c: var(", ")");
    // ".key.limit " is not the class of a curve.
    if (!name.starts_with('.') || name.find('.', 1) != kNotFound || colour.empty()) continue;
    colours.emplace_back(name.substr(1, name.find(' ') - 1), colour);
  }
  return colours;
}

/// Selector for programs with little CSS support: "text.end" for ".end:is(text)".
std::string plain_selector(std::string selector) {
  for (const char* kind : {"text", "rect"}) {
    const std::string suffix = fmt::format(":is({})", kind);
    const std::size_t at = selector.find(suffix);
    if (at == kNotFound) continue;
    selector.erase(at, suffix.size());
    const std::size_t dot = selector.rfind('.', at);
    if (dot != kNotFound) selector.insert(dot, kind);
  }
  return selector;
}

/// The page's rules for pictures, with colours instead of variables.
std::string plain_style(const std::string& more_style) {
  const std::string style = report::page_style() + more_style;
  const std::vector<Rule> rules = rules_of_all_media(style);
  std::map<std::string, std::string> colours;
  for (const Rule& rule : rules) {
    if (rule.selector == ":root ") add_colours(between(rule.body, "{", "}"), colours);
  }
  const auto own_colours = curve_colours(rules);
  std::string plain;
  for (const Rule& rule : rules) {
    if (!rule.selector.starts_with("svg")) continue;
    std::string selector = plain_selector(rule.selector), body = rule.body;
    for (const auto& [name, value] : colours) {
      body = replaced(body, fmt::format("var({})", name), value);
    }
    if (selector == "svg ") {
      // A file has its own size.
      for (const char* of_page : {"display: block;", "width: 100%;", "height: auto;"}) {
        body = replaced(body, of_page, "");
      }
    }
    if (body.find("var(--c)") == kNotFound) {
      plain += selector + body + "\n";
      continue;
    }
    // The class of a curve gives its colour.
    selector.erase(selector.find_last_not_of(' ') + 1);
    for (const auto& [css_class, colour] : own_colours) {
      plain += fmt::format("{}.{} {}\n", selector, css_class,
                           replaced(body, "var(--c)", colours.at(colour)));
    }
  }
  return plain;
}

/// Adds the legend above a picture, entry by entry. @param y  position of its first line, px
/// @returns its height, px
double add_legend(std::string_view legend, double width, double y, std::string& out) {
  constexpr double kKey_px = 24, kGap_px = 16, kLine_px = 19, kSize_px = 13;
  double x = 10, used = 0;
  for (std::size_t at = 0; (at = legend.find("<span>", at)) != kNotFound;) {
    const std::size_t end = legend.find("</span>", at);
    if (end == kNotFound) break;
    const std::string_view entry = legend.substr(at + 6, end - at - 6);
    at = end;
    const std::string classes(between(entry, "<i class=\"key ", "\""));
    const std::size_t words_at = entry.rfind('>');
    const std::string words(words_at == kNotFound ? entry : entry.substr(words_at + 1));
    const double wide =
        (classes.empty() ? 0 : kKey_px + 6) + report::text_width_px(words, kSize_px);
    if (used == 0) used = kLine_px;
    if (x > 10 && x + wide > width) {
      x = 10;
      used += kLine_px;
    }
    const double middle = y + used - kLine_px + 9;
    if (classes == "area row") {
      out += fmt::format(
          "<g class=\"row\" stroke-width=\"6\"><polyline points=\"{:g},{:g} {:g},{:g}\"/></g>\n",
          x + 3, middle, x + kKey_px - 3, middle);
    } else if (classes.starts_with("area ")) {
      out += fmt::format(
          "<rect x=\"{:g}\" y=\"{:g}\" width=\"24\" height=\"10\" class=\"{}\"/>\n", x, middle - 5,
          classes.starts_with("area s") && classes != "area span" ? "band " + classes.substr(5)
                                                                  : classes.substr(5));
    } else if (!classes.empty()) {
      out +=
          fmt::format("<line x1=\"{:g}\" y1=\"{:g}\" x2=\"{:g}\" y2=\"{:g}\" class=\"line {}\"/>\n",
                      x, middle, x + kKey_px, middle, classes);
    }
    out += fmt::format("<text x=\"{:g}\" y=\"{:g}\" class=\"tick\">{}</text>\n",
                       classes.empty() ? x : x + kKey_px + 6, middle + 4, words);
    x += wide + kGap_px;
  }
  return used;
}

/// Unique file stem from heading and label, such as "rover_wheel_slip".
std::string plot_name(const std::string& label, std::set<std::string>& taken) {
  std::string name;
  for (const char c : label) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    const bool capital = c >= 'A' && c <= 'Z';
    if (letter || capital) {
      name += capital ? static_cast<char>(c - 'A' + 'a') : c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  constexpr std::size_t kLongest = 100;
  name = name.substr(0, kLongest);
  name.erase(name.find_last_not_of('_') + 1);
  if (name.empty()) name = "plot";
  std::string own = name;
  for (int i = 2; !taken.insert(own).second; ++i) own = fmt::format("{}_{}", name, i);
  return own + ".svg";
}

/// End of an element <svg>, which may contain others.
std::size_t end_of_svg(std::string_view page, std::size_t begin) {
  int depth = 0;
  std::size_t at = begin;
  while (true) {
    const std::size_t open = page.find("<svg", at), close = page.find("</svg>", at);
    if (close == kNotFound) return kNotFound;
    if (open < close) {
      ++depth;
      at = open + 4;
    } else {
      at = close + 6;
      if (--depth == 0) return at;
    }
  }
}

/// Complete SVG file of a picture. @param title  as in the page, escaped
std::string complete_picture(std::string_view svg, std::string_view before,
                             const std::string& title, const std::string& style) {
  const std::size_t head_end = svg.find('>');
  const std::string_view head = svg.substr(0, head_end);
  double width = 0, height = 0;
  const std::string box(between(head, "viewBox=\"", "\""));
  if (std::sscanf(box.c_str(), "0 0 %lf %lf", &width, &height) != 2) return "";
  std::string above;
  constexpr double kTitle_px = 26;
  const double legend_px =
      add_legend(between(before, "<p class=\"legend\">", "</p>"), width, kTitle_px, above);
  const double top = kTitle_px + legend_px + 4;
  // The strip with title and legend is above the picture's own y = 0.
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 "
      "{2:g} "
      "{0:g} {1:g}\" class=\"{3}\">\n<title>{4}</title>\n<style>\n{5}</style>\n"
      "<rect x=\"0\" y=\"{2:g}\" width=\"{0:g}\" height=\"{1:g}\" fill=\"#ffffff\"/>\n"
      "<g transform=\"translate(0 {2:g})\">\n<text x=\"10\" y=\"18\" font-size=\"15\" "
      "font-weight=\"bold\">{4}</text>\n{6}</g>\n{7}\n",
      width, height + top, -top, between(head, "class=\"", "\""), title, style, above,
      svg.substr(head_end + 1));
}

}  // namespace

std::vector<PlotFile> plot_files_of(const std::string& page, const std::string& more_style) {
  const std::string style = plain_style(more_style);
  std::vector<PlotFile> files;
  std::set<std::string> taken;
  constexpr std::string_view kPicture = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=";
  // Do not search the script after the chapters.
  const std::string_view text = std::string_view(page).substr(0, page.find("</main>"));
  for (std::size_t at = 0; (at = text.find(kPicture, at)) != kNotFound;) {
    const std::size_t end = end_of_svg(text, at);
    if (end == kNotFound) break;
    const std::string_view svg = text.substr(at, end - at);
    const std::size_t figure = text.rfind("<figure", at);
    // A figure that is already closed belongs to another picture.
    const std::string_view before =
        figure == kNotFound || text.substr(figure, at - figure).find("</figure>") != kNotFound
            ? std::string_view()
            : text.substr(figure, at - figure);
    // The nearest heading in the same section names the vehicle.
    const std::size_t heading = text.rfind("<h3>", at), section = text.rfind("<section", at);
    const bool owned = heading != kNotFound && (section == kNotFound || heading > section);
    const std::string owner(owned ? between(text.substr(heading), "<h3>", "</h3>") : "");
    const std::string label(between(svg, "aria-label=\"", "\""));
    const std::string title = owner.empty() ? report::sentence_case(label) : owner + ": " + label;
    std::string picture = complete_picture(svg, before, title, style);
    at = end;
    if (!picture.empty()) files.push_back({plot_name(owner + " " + label, taken), picture});
  }
  return files;
}

}  // namespace vinerow::tools
