#include "tools/report/svg.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/replay/page_text.h"
#include "tools/report/html.h"

namespace vinerow::tools::report {
namespace {

std::string class_of(const std::string& css_class) {
  return css_class.empty() ? "" : " class=\"" + css_class + "\"";
}

std::string more(const std::string& attributes) {
  return attributes.empty() ? "" : " " + attributes;
}

/// "/>", or the element's end with a tooltip.
std::string end_of(const std::string& element, const std::string& tip) {
  return tip.empty() ? "/>\n" : fmt::format("><title>{}</title></{}>\n", escaped(tip), element);
}

std::string points_text(const std::vector<Eigen::Vector2d>& points) {
  std::string out;
  for (const Eigen::Vector2d& p : points) {
    if (!out.empty()) out += ' ';
    out += px(p.x()) + ',' + px(p.y());
  }
  return out;
}

}  // namespace

std::string px(double value) {
  std::string text = fmt::format("{:.2f}", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

Svg::Svg(double width, double height, const std::string& css_class, const std::string& label,
         const std::string& attributes) {
  out_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" class=\"{}\" role=\"img\" "
      "aria-label=\"{}\"{}>\n",
      px(width), px(height), css_class, escaped(label), more(attributes));
}

void Svg::line(double x1, double y1, double x2, double y2, const std::string& css_class) {
  out_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"{}/>\n", px(x1), px(y1), px(x2),
                      px(y2), class_of(css_class));
}

void Svg::rect(double x, double y, double width, double height, const std::string& css_class,
               const std::string& tip, const std::string& attributes) {
  out_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}{}{}", px(x), px(y),
                      px(width), px(height), class_of(css_class), more(attributes),
                      end_of("rect", tip));
}

void Svg::circle(double x, double y, double radius, const std::string& css_class,
                 const std::string& tip, const std::string& attributes) {
  out_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}{}{}", px(x), px(y), px(radius),
                      class_of(css_class), more(attributes), end_of("circle", tip));
}

void Svg::polyline(const std::vector<Eigen::Vector2d>& points, const std::string& css_class,
                   const std::string& label) {
  if (points.size() < 2) return;
  out_ += fmt::format("<polyline{}{} points=\"{}\"/>\n", class_of(css_class),
                      label.empty() ? "" : " data-label=\"" + escaped(label) + "\"",
                      points_text(points));
}

void Svg::polygon(const std::vector<Eigen::Vector2d>& points, const std::string& css_class) {
  if (points.size() < 3) return;
  out_ += fmt::format("<polygon{} points=\"{}\"/>\n", class_of(css_class), points_text(points));
}

void Svg::text(double x, double y, const std::string& text, const std::string& css_class) {
  out_ += fmt::format("<text x=\"{}\" y=\"{}\"{}>{}</text>\n", px(x), px(y), class_of(css_class),
                      escaped(text));
}

void Svg::turned_text(double x, double y, double degrees, const std::string& text,
                      const std::string& css_class) {
  out_ += fmt::format("<text{} transform=\"translate({} {}) rotate({})\">{}</text>\n",
                      class_of(css_class), px(x), px(y), px(degrees), escaped(text));
}

void Svg::image(double x, double y, double width, double height, const std::string& png) {
  out_ += fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
      "style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>\n",
      px(x), px(y), px(width), px(height), base64(png));
}

void Svg::open_group(const std::string& attributes) {
  out_ += "<g " + attributes + ">\n";
}

void Svg::close_group() {
  out_ += "</g>\n";
}

std::string Svg::finish() {
  out_ += "</svg>\n";
  return std::move(out_);
}

double text_width_px(const std::string& text, double size_px) {
  std::size_t letters = 0;
  for (const char c : text) letters += (static_cast<unsigned char>(c) & 0xC0) != 0x80 ? 1 : 0;
  return 0.54 * size_px * static_cast<double>(letters);
}

}  // namespace vinerow::tools::report
