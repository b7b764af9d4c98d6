#pragma once
/// A plot of lines over time or distance: axes with units, ticks, limits, bands, shaded stretches.

#include <limits>
#include <string>
#include <vector>

#include "tools/report/axis.h"
#include "tools/report/decimate.h"

namespace vinerow::tools::report {

/// A value where a line has a gap.
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

/// A stretch of x that is shaded.
struct PlotSpan {
  double from = 0.0, to = 0.0;
};

/// A level that must not be passed.
struct PlotLimit {
  double y = 0.0;
  std::string label;
};

struct LinePlot {
  std::string title;
  std::string x_label = "time, s";
  std::string y_label;  ///< with its unit
  std::string caption;  ///< a sentence or two, HTML
  std::vector<PlotLine> lines;
  std::vector<PlotBand> bands;
  std::vector<PlotSpan> spans;
  std::string spans_label;  ///< what the shaded stretches are
  std::vector<PlotLimit> limits;
  double least_span = 1e-3;  ///< of y: what is less is no event, in y's unit
  double most = std::numeric_limits<double>::infinity();  ///< of y: 100 for a share in per cent

  /// Whether there is anything to draw.
  bool empty() const;
};

/// The places where plots of a picture's size draw, in its pixels.
struct PlotFrame {
  double width = 640, height = 300, left = 70, right = 16, top = 12, bottom = 46;
};

/// Ranges that hold every line of a plot. Limits count where they lie less than `3 x` the lines'
/// own span outside of it, bands as far as that span, so that a far one does not flatten the lines.
Range x_range(const LinePlot& plot);
Range y_range(const LinePlot& plot);

/// The plot as SVG, without title, legend and caption. @pre !plot.empty()
std::string draw(const LinePlot& plot, const PlotFrame& frame = {});

/// <figure> with title, legend, plot and caption; nothing where the plot is empty.
std::string figure(const LinePlot& plot, const PlotFrame& frame = {});

}  // namespace vinerow::tools::report
