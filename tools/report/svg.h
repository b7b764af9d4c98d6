#pragma once
/// Writes one SVG picture, element by element. Colours come from the page's style by class, so that
/// they follow light, dark and print.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace vinerow::tools::report {

/// Pixels of a picture as wide as the page.
inline constexpr double kWideChart = 1000;

/// A place on the picture as text, to a hundredth of a pixel, without trailing zeros.
std::string px(double value);

class Svg {
 public:
  /// @param attributes  further ones of the root, as text, like `data-x0="1"`
  Svg(double width, double height, const std::string& css_class, const std::string& label,
      const std::string& attributes = "");

  void line(double x1, double y1, double x2, double y2, const std::string& css_class);
  /// @param attributes  further ones, as text, like `data-cell="1"`
  void rect(double x, double y, double width, double height, const std::string& css_class,
            const std::string& tip = "", const std::string& attributes = "");
  void circle(double x, double y, double radius, const std::string& css_class,
              const std::string& tip = "", const std::string& attributes = "");
  /// Fewer than two points draw nothing.
  void polyline(const std::vector<Eigen::Vector2d>& points, const std::string& css_class,
                const std::string& label = "");
  void polygon(const std::vector<Eigen::Vector2d>& points, const std::string& css_class);
  /// @param css_class  "mid" and "end" anchor it there
  void text(double x, double y, const std::string& text, const std::string& css_class = "");
  /// The same turned about its anchor. @param degrees  clockwise
  void turned_text(double x, double y, double degrees, const std::string& text,
                   const std::string& css_class = "");
  /// A picture inside the picture, its pixels kept square-edged. @param png  of a PNG file
  void image(double x, double y, double width, double height, const std::string& png);
  void open_group(const std::string& attributes);
  void close_group();
  /// Anything else, well formed.
  void raw(const std::string& element) { out_ += element; }

  /// The whole element. Call once.
  std::string finish();

 private:
  std::string out_;
};

/// About how wide a text is at a size, for layouts that need not be exact.
double text_width_px(const std::string& text, double size_px);

}  // namespace vinerow::tools::report
