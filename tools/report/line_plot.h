#pragma once
/// Line plot over time or distance: axes with units, ticks, limits, bands, shaded spans.

#include <limits>
#include <string>
#include <vector>

#include "tools/report/axis.h"
#include "tools/report/decimate.h"

namespace vinerow::tools::report {

/// Value that marks a gap in a line.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct PlotLine {
  std::string label;
  Samples samples;
  std::string style;  ///< classes of the page's style: "s0" to "s7" colours; "ref" dashed and dark
};

/// The area between two lines over the same x.
struct PlotBand {
  std::string label;
  std::vector<double> x, low, high;
  std::string style;
};

/// Shaded range of x.
struct PlotSpan {
  double from = 0.0, to = 0.0;
};

/// Level that must not be passed.
struct PlotLimit {
  double y = 0.0;
  std::string label;
};

struct LinePlot {
  std::string title;
  std::string x_label = "time, s";
  std::string y_label;  ///< with its unit
  std::string caption;  ///< one or two sentences, HTML
  std::vector<PlotLine> lines;
  std::vector<PlotBand> bands;
  std::vector<PlotSpan> spans;
  std::string spans_label;  ///< legend text of the shaded spans
  std::vector<PlotLimit> limits;
  double min_span = 1e-3;  ///< smallest span of the y axis, in y's unit
  double maximum = std::numeric_limits<double>::infinity();  ///< upper end of y: 100 for per cent

  /// Whether there is nothing to draw.
  bool empty() const;
};

/// Size and margins of a plot, in pixels.
struct PlotFrame {
  double width = 640, height = 300, left = 70, right = 16, top = 12, bottom = 46;
};

/// Ranges that contain every line of a plot. Limits are included if they are less than 3 spans of
/// the lines outside, bands up to one span, so that a distant one does not flatten the lines.
Range x_range(const LinePlot& plot);
Range y_range(const LinePlot& plot);

/// Plot as SVG, without title, legend and caption. @pre !plot.empty()
std::string draw(const LinePlot& plot, const PlotFrame& frame = {});

/// <figure> with title, legend, plot and caption; "" if the plot is empty.
std::string figure(const LinePlot& plot, const PlotFrame& frame = {});

}  // namespace vinerow::tools::report
