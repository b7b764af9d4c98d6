#include "tools/study/report_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/report/units.h"
#include "tools/study/numbers.h"
#include "tools/study/plots/band_plot.h"
#include "tools/study/plots/box_plot.h"
#include "tools/study/plots/heat_map.h"
#include "tools/study/plots/interval_plot.h"
#include "tools/study/plots/parallel_plot.h"
#include "tools/study/setting_numbers.h"

namespace vinerow::study {
namespace {

/// Column of the design: its distinct texts in the order of settings, and their values if all are
/// numbers.
struct Column {
  std::string name;
  std::string unit;  ///< from the key, if the factor sets a single parameter
  std::vector<std::string> texts;
  std::vector<double> numbers;  ///< by text; empty unless all are numbers
  std::vector<std::size_t> of;  ///< [setting] index into texts
};

/// Unit of a column: "m" for a factor lookahead that sets only rover.controller.lookahead_m.
std::string unit_of_column(const Design& design, const std::string& name) {
  std::string path = name;
  for (const scenario::Factor& factor : design.study().factors) {
    const auto& values = factor.levels.front().values;
    if (factor.name == name && factor.columns.size() == 1 && values.size() == 1) {
      path = values.front().path;
    }
  }
  return tools::report::unit_of(path.substr(path.rfind('.') + 1));
}

std::vector<Column> columns_of(const Design& design) {
  std::vector<Column> columns(design.columns().size());
  std::vector<std::map<std::string, std::size_t>> places(columns.size());
  for (std::size_t setting = 0; setting < design.settings(); ++setting) {
    const std::vector<std::string> texts = design.texts(setting);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto [place, is_new] = places[k].emplace(texts[k], columns[k].texts.size());
      if (is_new) columns[k].texts.push_back(texts[k]);
      columns[k].of.push_back(place->second);
    }
  }
  for (std::size_t k = 0; k < columns.size(); ++k) {
    columns[k].name = design.columns()[k];
    columns[k].unit = unit_of_column(design, columns[k].name);
    for (const std::string& text : columns[k].texts) {
      const std::optional<double> number = number_in(text);
      if (number) columns[k].numbers.push_back(*number);
    }
    if (columns[k].numbers.size() < columns[k].texts.size()) columns[k].numbers.clear();
  }
  // A column that does not vary explains nothing.
  std::erase_if(columns, [](const Column& column) { return column.texts.size() < 2; });
  return columns;
}

/// Quantity of a number such as "rover.cross_track_rms_m", whose ending gives the unit.
Quantity quantity_of(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
  Quantity quantity;
  quantity.label = tools::report::words_of(last);
  if (dot != std::string::npos) quantity.label += ", " + name.substr(0, dot);
  quantity.unit = tools::report::unit_of(last);
  if (name == "run.met" || last.ends_with("_share")) quantity.minimum = 0.0, quantity.maximum = 1.0;
  return quantity;
}

Quantity quantity_of(const Column& column) {
  Quantity quantity = quantity_of(column.name);
  quantity.unit = column.unit;
  return quantity;
}

/// Values of the factors as text: "lookahead_m = 1, pitch_m = 0.33".
std::string setting_text(const Design& design, std::size_t setting) {
  std::string words;
  const std::vector<std::string> texts = design.texts(setting);
  for (std::size_t k = 0; k < texts.size(); ++k) {
    words += fmt::format("{}{} = {}", k == 0 ? "" : ", ", design.columns()[k], texts[k]);
  }
  return words.empty() ? "the unchanged scenario" : words;
}

std::int64_t first_cell(const Design& design, std::size_t setting) {
  return static_cast<std::int64_t>(design.cell_of(setting, 0));
}

std::string title_of(const std::string& name) {
  return tools::report::sentence_case(quantity_of(name).label);
}

constexpr const char* kClick = "Click a mark for the command that repeats its run.";

std::string caption_of(const Design& design) {
  return fmt::format(
      "{} {}",
      design.seeds() > 1 ? "Mean over the seeds of each setting." : "One run of each setting.",
      kClick);
}

std::string map_over_two(const Results& results, const std::string& name, const Column& x,
                         const Column& y, const std::vector<SettingNumber>& settings) {
  HeatMap map;
  map.texts = {title_of(name), caption_of(results.design())};
  map.x = quantity_of(x), map.y = quantity_of(y), map.value = quantity_of(name);
  map.x_levels = x.texts, map.y_levels = y.texts;
  map.tiles.resize(x.texts.size() * y.texts.size());
  for (std::size_t setting = 0; setting < settings.size(); ++setting) {
    HeatTile& tile = map.tiles[y.of[setting] * x.texts.size() + x.of[setting]];
    const SettingNumber& number = settings[setting];
    tile.value = number.mean;
    tile.low = number.interval.low, tile.high = number.interval.high;
    if (number.values.empty()) tile.note = number.note;
    tile.cell = first_cell(results.design(), setting);
  }
  return heat_map(map);
}

std::string lines_over(const Results& results, const std::string& name, const Column& x,
                       const Column* group, const std::vector<SettingNumber>& settings) {
  BandPlot plot;
  plot.texts = {title_of(name), caption_of(results.design())};
  plot.x = quantity_of(x), plot.y = quantity_of(name);
  plot.spread_label = "95 % interval of the mean";
  plot.groups.resize(group ? group->texts.size() : 1);
  for (std::size_t k = 0; group && k < group->texts.size(); ++k) {
    plot.groups[k].label = fmt::format("{} = {}", group->name, group->texts[k]);
  }
  for (std::size_t setting = 0; setting < settings.size(); ++setting) {
    const SettingNumber& number = settings[setting];
    BandPoint point{x.numbers[x.of[setting]],
                    number.mean,
                    kNoValue,
                    kNoValue,
                    number.note,
                    first_cell(results.design(), setting)};
    if (std::isfinite(number.interval.low)) {
      point.low = number.interval.low, point.high = number.interval.high;
    }
    plot.groups[group ? group->of[setting] : 0].points.push_back(std::move(point));
  }
  return band_plot(plot);
}

std::string boxes_over(const std::string& name, const Column& x,
                       const std::vector<SettingNumber>& settings) {
  BoxPlot plot;
  plot.texts = {title_of(name), fmt::format("All runs at each level. {}", kClick)};
  plot.x = quantity_of(x), plot.y = quantity_of(name);
  for (const std::string& text : x.texts) plot.levels.push_back({text, {}});
  for (std::size_t setting = 0; setting < settings.size(); ++setting) {
    const SettingNumber& number = settings[setting];
    for (std::size_t k = 0; k < number.values.size(); ++k) {
      plot.levels[x.of[setting]].values.push_back(
          {number.values[k], static_cast<std::int64_t>(number.cells[k]), ""});
    }
  }
  return box_plot(plot);
}

}  // namespace

std::string number_figures(const Results& results, const std::string& name) {
  const std::vector<SettingNumber> settings = setting_numbers(results, name);
  const bool is_measured = std::any_of(settings.begin(), settings.end(),
                                       [](const auto& setting) { return !setting.values.empty(); });
  if (!is_measured) return "";
  const std::vector<Column> columns = columns_of(results.design());
  constexpr std::size_t kMaxGroups = 8, kMaxBoxes = 40;
  if (columns.size() == 1) {
    const Column& x = columns.front();
    if (!x.numbers.empty()) return lines_over(results, name, x, nullptr, settings);
    return boxes_over(name, x, settings);
  }
  const bool is_table = columns.size() == 2 && columns[0].texts.size() * columns[1].texts.size() ==
                                                   results.design().settings();
  if (is_table) {
    std::string figures = map_over_two(results, name, columns[1], columns[0], settings);
    // Lines over the numeric factor, preferably the second.
    for (const std::size_t over : {1, 0}) {
      const Column& group = columns[1 - over];
      if (columns[over].numbers.empty() || group.texts.size() > kMaxGroups) continue;
      return figures + lines_over(results, name, columns[over], &group, settings);
    }
    return figures;
  }
  std::string figures;
  for (const Column& column : columns) {
    if (column.texts.size() <= kMaxBoxes) figures += boxes_over(name, column, settings);
  }
  return figures;
}

std::string success_figure(const Results& results) {
  constexpr std::size_t kMaxRows = 60;
  const Design& design = results.design();
  if (design.seeds() < 2) return "";
  IntervalPlot plot;
  plot.texts = {"Runs that met all criteria", ""};
  plot.value = {"share of runs", "", 0.0, 1.0};
  plot.rows_title = "setting";
  plot.spread_label = "95 % interval (Wilson)";
  std::vector<std::pair<double, IntervalRow>> rows;
  for (std::size_t setting = 0; setting < design.settings(); ++setting) {
    const SettingCount count = count_setting(results, setting);
    IntervalRow row;
    row.label = setting_text(design, setting);
    row.cell = first_cell(design, setting);
    if (count.finished > 0) {
      const Interval interval = count.met_interval();
      row.value = count.met_share();
      row.low = interval.low, row.high = interval.high;
      row.note = fmt::format("{} of {} runs", count.met, count.finished);
    }
    rows.emplace_back(row.value, std::move(row));
  }
  if (rows.size() > kMaxRows) {
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    rows.resize(kMaxRows);
    plot.texts.caption = fmt::format(
        "The {} settings with the smallest share; all {} are in "
        "settings.csv. ",
        kMaxRows, design.settings());
  }
  plot.texts.caption += kClick;
  for (auto& [share, row] : rows) plot.rows.push_back(std::move(row));
  return interval_plot(plot);
}

std::string parallel_figure(const Results& results, const std::vector<std::string>& names) {
  const std::vector<Column> columns = columns_of(results.design());
  if (columns.size() < 2 || columns.size() + names.size() < 3) return "";
  ParallelPlot plot;
  plot.texts = {"All settings", fmt::format("One line per setting. {}", kClick)};
  plot.lines.resize(results.design().settings());
  for (const Column& column : columns) {
    ParallelAxis axis;
    axis.quantity = quantity_of(column);
    if (column.numbers.empty()) axis.levels = column.texts;
    plot.axes.push_back(std::move(axis));
    for (std::size_t setting = 0; setting < plot.lines.size(); ++setting) {
      const std::size_t level = column.of[setting];
      plot.lines[setting].values.push_back(column.numbers.empty() ? static_cast<double>(level)
                                                                  : column.numbers[level]);
    }
  }
  for (const std::string& name : names) {
    plot.axes.push_back({quantity_of(name), {}});
    const std::vector<SettingNumber> settings = setting_numbers(results, name);
    for (std::size_t setting = 0; setting < plot.lines.size(); ++setting) {
      plot.lines[setting].values.push_back(settings[setting].mean);
    }
  }
  for (std::size_t setting = 0; setting < plot.lines.size(); ++setting) {
    plot.lines[setting].cell = first_cell(results.design(), setting);
  }
  return parallel_plot(plot);
}

}  // namespace vinerow::study
