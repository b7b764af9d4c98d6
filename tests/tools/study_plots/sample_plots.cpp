#include "tests/tools/study_plots/sample_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tools/report/page_style.h"
#include "tools/study/plots/band_plot.h"
#include "tools/study/plots/box_plot.h"
#include "tools/study/plots/click_script.h"
#include "tools/study/plots/heat_map.h"
#include "tools/study/plots/interval_plot.h"
#include "tools/study/plots/parallel_plot.h"
#include "tools/study/plots/plot_style.h"

namespace vinerow::study::testing {
namespace {

using tools::report::AxisScale;

/// Numbers from 0 to 1 without a pattern, the same every time.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) / 9007199254740992.0;
  }
  /// About normal: mean 0, variance 1.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += next();
    return sum;
  }

 private:
  std::uint64_t state_ = 20240501;
};

const Quantity kSuccess = {"share of runs without contact", "", 0.0, 1.0};
const Quantity kDeviation = {"largest cross-track error", "m", 0.0};
const Quantity kSpeed = {"row speed", "m/s", 0.0};
const Quantity kNoise = {"noise of the position", "m", 0.0};

std::string success_map(bool large) {
  HeatMap map;
  map.texts = {
      large ? "Success over speed and row spacing, finely" : "Success over speed and noise",
      "Each tile: the share of 20 runs that touched nothing. A click shows the command "
      "that repeats the first of them."};
  map.x = kSpeed;
  map.y = large ? Quantity{"row spacing", "m"} : kNoise;
  map.value = kSuccess;
  const int columns = large ? 60 : 7, rows = large ? 40 : 6;
  for (int x = 0; x < columns; ++x) {
    map.x_levels.push_back(large ? fmt::format("{:.2f}", 0.5 + 0.05 * x)
                                 : fmt::format("{:.1f}", 0.6 + 0.3 * x));
  }
  for (int y = 0; y < rows; ++y) {
    map.y_levels.push_back(large ? fmt::format("{:.2f}", 1.6 + 0.04 * y)
                                 : fmt::format("{:.2f}", 0.01 * std::pow(2.0, y)));
  }
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double u = static_cast<double>(x) / columns, v = static_cast<double>(y) / rows;
      HeatTile tile;
      tile.value = 1.0 / (1.0 + std::exp(9.0 * (u + (large ? 0.6 - v : v) - 0.9)));
      tile.low = std::max(0.0, tile.value - 0.14), tile.high = std::min(1.0, tile.value + 0.11);
      tile.cell = static_cast<std::int64_t>(20 * (y * columns + x));
      if (!large && x == 6 && y > 3)
        tile = {kNoValue, kNoValue, kNoValue, "no run was made", kNoCell};
      if (!large && x == 5 && y == 5) {
        tile = {kNoValue, kNoValue, kNoValue, "all 20 runs broke off: state not finite", tile.cell};
      }
      map.tiles.push_back(tile);
    }
  }
  return heat_map(map);
}

std::string controller_map() {
  HeatMap map;
  map.texts = {"Energy of controllers on each vehicle", ""};
  map.x = {"controller", ""};
  map.y = {"vehicle", ""};
  map.value = {"energy per hectare", "kJ"};
  map.x_levels = {"pure_pursuit", "stanley", "lateral_mpc_with_terminal_set", "time_varying_lqr"};
  map.y_levels = {"straddler_with_a_long_name_indeed_too_long", "diff_drive_rover", "tractor"};
  Numbers numbers;
  for (int i = 0; i < 12; ++i) {
    const double value = 900.0 + 4000.0 * numbers.next();
    map.tiles.push_back({value, 0.9 * value, 1.1 * value, "", i});
  }
  return heat_map(map);
}

std::string deviation_bands(Spread spread) {
  BandPlot plot;
  const bool band = spread == Spread::kBand;
  plot.texts = {band ? "Cross-track error over speed" : "Cross-track error over noise",
                "Mean of 20 runs at each level."};
  plot.x = band ? kSpeed : kNoise;
  plot.y = kDeviation;
  plot.spread = spread;
  plot.x_scale = band ? AxisScale::kLinear : AxisScale::kLogarithmic;
  plot.spread_label = "95 % interval of the mean";
  Numbers numbers;
  std::int64_t cell = 0;
  for (const char* name : {"pure_pursuit", "stanley", "lateral_mpc"}) {
    BandGroup group = {name, {}};
    const double gain = 0.05 + 0.04 * static_cast<double>(plot.groups.size());
    for (int i = 0; i < 8; ++i) {
      BandPoint point;
      point.x = band ? 0.5 + 0.25 * i : 0.005 * std::pow(2.0, i);
      point.value = (band ? gain * point.x * point.x : gain + 0.3 * std::sqrt(point.x)) +
                    0.02 * numbers.next();
      const double half = 0.015 + 0.04 * numbers.next();
      point.low = point.value - half, point.high = point.value + half;
      point.cell = cell++;
      group.points.push_back(point);
    }
    plot.groups.push_back(group);
  }
  return band_plot(plot);
}

std::string deviation_boxes(int levels, int count, bool long_names) {
  BoxPlot plot;
  plot.texts = {fmt::format("Cross-track error at {} levels", levels), "All runs of the study."};
  plot.x = {long_names ? "estimator" : "wind speed", long_names ? "" : "m/s"};
  plot.y = kDeviation;
  Numbers numbers;
  const std::vector<std::string> names = {"truth", "extended_kalman_filter", "particle_filter",
                                          "moving_horizon_with_ellipsoids", "dead_reckoning"};
  for (int i = 0; i < levels; ++i) {
    BoxLevel level;
    level.label = long_names ? names[static_cast<std::size_t>(i) % names.size()]
                             : fmt::format("{:.1f}", 0.5 * i);
    for (int k = 0; k < count; ++k) {
      const double value = 0.05 + 0.015 * i + 0.03 * std::abs(numbers.normal());
      level.values.push_back({numbers.next() > 0.97 ? 2.2 * value : value, 100 * i + k, ""});
    }
    plot.levels.push_back(level);
  }
  return box_plot(plot);
}

std::string all_settings(int count) {
  ParallelPlot plot;
  plot.texts = {fmt::format("{} settings at a glance", count), "Colours follow the last axis."};
  plot.axes = {{{"controller", ""}, {"pure_pursuit", "stanley", "lateral_mpc"}},
               {kSpeed, {}},
               {kNoise, {}},
               {{"friction", ""}, {}},
               {{"energy", "kJ/ha"}, {}},
               {kDeviation, {}},
               {kSuccess, {}}};
  Numbers numbers;
  for (int i = 0; i < count; ++i) {
    const double controller = std::floor(3.0 * numbers.next());
    const double speed = 0.5 + 0.25 * std::floor(8.0 * numbers.next());
    const double noise = 0.01 * std::pow(2.0, std::floor(6.0 * numbers.next()));
    const double friction = 0.5 + 0.4 * numbers.next();
    const double energy = 1200.0 + 700.0 * speed + 200.0 * numbers.normal();
    const double error = 0.03 + 0.05 * speed + 0.6 * noise + 0.03 * controller * numbers.next();
    const double success = 1.0 / (1.0 + std::exp(18.0 * (error - 0.24)));
    plot.lines.push_back(
        {{controller, speed, noise, friction, energy, error, success}, 20 * i, ""});
  }
  return parallel_plot(plot);
}

std::string small_parallel_plot() {
  ParallelPlot plot;
  plot.texts = {"Twelve settings", ""};
  plot.axes = {{{"cover of the soil", ""}, {"bare soil", "grass", "clover and rye, mown"}},
               {kSpeed, {}},
               {{"slip of the rear wheels in turns", "%"}, {}},
               {{"turn time", "s"}, {}}};
  Numbers numbers;
  for (int i = 0; i < 12; ++i) {
    const double speed = 0.5 + 0.5 * (i / 3);
    plot.lines.push_back({{static_cast<double>(i % 3), speed, 4.0 + 3.0 * (i % 3) + numbers.next(),
                           i == 4 ? kNoValue : 30.0 / speed + numbers.next()},
                          i,
                          i == 4 ? "the turn was not finished" : ""});
  }
  return parallel_plot(plot);
}

std::string success_rows() {
  IntervalPlot plot;
  plot.texts = {"Probability of success", "Wilson intervals of 20 runs at each setting."};
  plot.value = {"probability of a run without contact", "", 0.0, 1.0};
  plot.rows_title = "setting";
  plot.spread_label = "95 % interval";
  plot.reference = {0.9, "required: 0.9"};
  for (int i = 0; i < 10; ++i) {
    const double n = 20.0, p = i == 0 ? 1.0 : std::round(n * (1.0 - 0.011 * i * i)) / n, z = 1.96;
    const double middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    const double half =
        z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
    plot.rows.push_back(
        {fmt::format("{}, {:.1f} m/s, noise {:.2f} m", i % 2 == 0 ? "pure_pursuit" : "lateral_mpc",
                     0.6 + 0.3 * i, 0.01 * (i + 1)),
         p, middle - half, middle + half, "20 runs", 20 * i});
  }
  plot.rows.push_back({"lateral_mpc, 3.9 m/s, noise 0.11 m", kNoValue, kNoValue, kNoValue,
                       "no run was finished", 200});
  return interval_plot(plot);
}

std::string effect_rows() {
  IntervalPlot plot;
  plot.texts = {"What changes the cross-track error", "Difference of means, high less low level."};
  plot.value = {"effect on the largest cross-track error", "m"};
  plot.rows_title = "factor";
  plot.spread_label = "95 % interval";
  plot.reference = {0.0, "no effect"};
  plot.rows = {{"speed", 0.182, 0.151, 0.213, "", kNoCell},
               {"noise", 0.094, 0.06, 0.128, "", kNoCell},
               {"speed × noise", 0.021, -0.012, 0.054, "", kNoCell},
               {"friction", -0.035, -0.068, -0.002, "", kNoCell},
               {"slope", 0.004, -0.029, 0.037, "", kNoCell}};
  return interval_plot(plot);
}

std::string huge_values() {
  BandPlot plot;
  plot.texts = {"Numbers of any size", "Both axes are logarithmic."};
  plot.x = {"iterations", ""};
  plot.y = {"residual", "N²"};
  plot.x_scale = plot.y_scale = AxisScale::kLogarithmic;
  BandGroup group = {"", {}};
  for (int i = 0; i < 9; ++i) {
    group.points.push_back({std::pow(10.0, i), std::pow(10.0, -1.7 * i),
                            std::pow(10.0, -1.7 * i - 0.6), std::pow(10.0, -1.7 * i + 0.6), "", i});
  }
  plot.groups = {group};
  return band_plot(plot);
}

}  // namespace

std::string sample_page() {
  const auto figures = [](const std::string& content) {
    return "<div class=\"figures\">\n" + content + "</div>\n";
  };
  const std::string plots = success_map(false) + success_rows() + deviation_bands(Spread::kBand) +
                            deviation_bands(Spread::kWhiskers) + deviation_boxes(5, 20, true) +
                            effect_rows() + all_settings(5000) + small_parallel_plot() +
                            controller_map() + deviation_boxes(24, 120, false) + success_map(true) +
                            huge_values() + deviation_boxes(1, 20, false);
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
         "<title>sample of a study</title>\n<style>" +
         tools::report::page_style() + study_plot_style() +
         "</style></head>\n<body><main data-command=\"vinerow study cell study.yaml\">\n"
         "<section><h2>Plots</h2>\n" +
         figures(plots) + "</section>\n</main>\n<script>" + click_script() +
         "</script></body></html>\n";
}

}  // namespace vinerow::study::testing
