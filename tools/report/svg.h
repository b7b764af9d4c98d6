#pragma once
/// SVG writer, element by element. Colours come from the page's style by class, so they follow the
/// light, dark and print styles.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace vinerow::tools::report {

/// Width of a picture as wide as the page, pixels.
inline constexpr double kWideChart = 1000;

/// Coordinate as text, to a hundredth of a pixel, without trailing zeros.
std::string px(double value);

class Svg {
 public:
  /// @param attributes  further attributes of the root, as text, like `data-x0="1"`
  Svg(double width, double height, const std::string& css_class, const std::string& label,
      const std::string& attributes = "");

  void line(double x1, double y1, double x2, double y2, const std::string& css_class);
  /// @param attributes  further attributes, as text, like `data-cell="1"`
  void rect(double x, double y, double width, double height, const std::string& css_class,
            const std::string& tip = "", const std::string& attributes = "");
  void circle(double x, double y, double radius, const std::string& css_class,
              const std::string& tip = "", const std::string& attributes = "");
  /// Fewer than two points draw nothing.
  void polyline(const std::vector<Eigen::Vector2d>& points, const std::string& css_class,
                const std::string& label = "");
  void polygon(const std::vector<Eigen::Vector2d>& points, const std::string& css_class);
  /// @param css_class  "mid" and "end" set the text anchor
  void text(double x, double y, const std::string& text, const std::string& css_class = "");
  /// Text turned about its anchor. @param degrees  clockwise
  void turned_text(double x, double y, double degrees, const std::string& text,
                   const std::string& css_class = "");
  /// Embedded picture, without smoothing of its pixels. @param png  content of a PNG file
  void image(double x, double y, double width, double height, const std::string& png);
  void open_group(const std::string& attributes);
  void close_group();
  /// Any other well-formed element.
  void raw(const std::string& element) { out_ += element; }

  /// The whole element. Call once.
  std::string finish();

 private:
  std::string out_;
};

/// Approximate width of a text at a font size, for layouts that need not be exact.
double text_width_px(const std::string& text, double size_px);

}  // namespace vinerow::tools::report
