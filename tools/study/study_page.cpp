#include "tools/study/study_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/report/html.h"
#include "tools/report/page_style.h"
#include "tools/study/effects.h"
#include "tools/study/numbers.h"
#include "tools/study/plots/click_script.h"
#include "tools/study/plots/plot_style.h"
#include "tools/study/report_plots.h"
#include "tools/study/setting_numbers.h"
#include "tools/study/shell_word.h"
#include "tools/study/tables.h"

namespace vinerow::study {
namespace {

using tools::escaped;
using tools::report::counted;
using tools::report::number_text;
using tools::report::section;
using tools::report::table;

constexpr std::size_t kMaxDrawn = 8;

/// Shell command that repeats a cell, without the cell's number.
std::string repeat_command(const OpenStudy& open) {
  return "vinerow study repeat " + shell_quoted(open.study.file.string());
}

/// Outcome of all cells, with the first reason of each kind of failure.
std::string outcome(const OpenStudy& open, const Results& results) {
  const std::map<CellState, std::size_t> counts = results.counts();
  std::size_t failed = 0;
  std::vector<std::vector<std::string>> rows;
  for (const auto& [state, count] : counts) {
    if (is_finished(state) && !has_numbers(state)) failed += count;
    std::string reasons;
    constexpr std::size_t kShown = 3;
    std::size_t shown = 0;
    for (std::size_t cell = 0; cell < open.design.cells() && shown < kShown; ++cell) {
      if (results.state(cell) != state || results.reason(cell).empty()) continue;
      reasons += fmt::format("{}<span data-cell=\"{}\">cell {}</span>: {}", shown ? "<br/>" : "",
                             cell, cell, escaped(results.reason(cell)));
      ++shown;
    }
    rows.push_back({to_string(state), std::to_string(count), reasons});
  }
  std::string words = fmt::format("<p><a href=\"cells.csv\">{}</a> of {}: {} with {} each.",
                                  counted(static_cast<long>(open.design.cells()), "run"),
                                  escaped(open.study.scenario.filename().string()),
                                  counted(static_cast<long>(open.design.settings()), "setting"),
                                  counted(static_cast<long>(open.design.seeds()), "seed"));
  if (failed > 0) {
    words += fmt::format(
        " <strong>{} did not run to the end and are in no number "
        "below.</strong>",
        counted(static_cast<long>(failed), "run"));
  }
  if (results.seeds_change_nothing()) {
    words +=
        " <strong>All runs of a setting have the same digest: the seed changes nothing, and "
        "intervals over the seeds say nothing.</strong>";
  }
  return words + "</p>\n" + table({"state", "runs", "first reason"}, rows);
}

std::string interval_cell(const SettingNumber& number) {
  if (number.values.empty()) return "";
  std::string text = number_text(number.mean);
  if (std::isfinite(number.interval.low)) {
    text += " ± " + number_text(0.5 * (number.interval.high - number.interval.low));
  }
  return text;
}

std::string settings_table(const OpenStudy& open, const Results& results,
                           const std::vector<std::string>& names) {
  constexpr std::size_t kMaxRows = 200;
  std::vector<std::string> heads = {"setting"};
  for (const std::string& column : open.design.columns()) heads.push_back(escaped(column));
  heads.insert(heads.end(), {"runs", "met"});
  std::vector<std::vector<SettingNumber>> numbers;
  for (const std::string& name : names) {
    heads.push_back(escaped(name));
    numbers.push_back(setting_numbers(results, name));
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t setting = 0; setting < std::min(kMaxRows, open.design.settings()); ++setting) {
    std::vector<std::string> row = {fmt::format("<td><span data-cell=\"{}\">{}</span></td>",
                                                open.design.cell_of(setting, 0), setting)};
    for (const std::string& text : open.design.texts(setting)) row.push_back(escaped(text));
    const SettingCount count = count_setting(results, setting);
    row.push_back(std::to_string(count.finished - count.failed));
    row.push_back(std::to_string(count.met));
    for (const auto& number : numbers) row.push_back(interval_cell(number[setting]));
    rows.push_back(std::move(row));
  }
  std::string words = "<p>Mean over the seeds ± half the width of its 95 % interval. ";
  if (rows.size() < open.design.settings()) {
    words += fmt::format("The first {} of {}. ", rows.size(), open.design.settings());
  }
  return words + "All numbers are in <a href=\"settings.csv\">settings.csv</a>.</p>\n" +
         table(heads, rows);
}

/// Table of the factors' influence on each number: shares of the variance between settings.
std::string effects_table(const Results& results, const std::vector<std::string>& names) {
  const scenario::Study& study = results.design().study();
  constexpr std::size_t kMaxLevels = 60;
  std::vector<int> level_counts;
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < study.factors.size(); ++k) {
    const std::size_t count = study.factors[k].levels.size();
    if (count < 2 || count > kMaxLevels) continue;
    used.push_back(k);
    level_counts.push_back(static_cast<int>(count));
  }
  if (used.size() < 2) return "";
  std::vector<std::string> heads = {"number"};
  for (const std::size_t k : used) heads.push_back(escaped(study.factors[k].name));
  for (std::size_t a = 0; a < used.size(); ++a) {
    for (std::size_t b = a + 1; b < used.size(); ++b) {
      heads.push_back(escaped(study.factors[used[a]].name) + " × " +
                      escaped(study.factors[used[b]].name));
    }
  }
  std::vector<std::vector<std::string>> rows;
  bool full = true;
  for (const std::string& name : names) {
    std::vector<SettingMean> means;
    const std::vector<SettingNumber> numbers = setting_numbers(results, name);
    for (std::size_t setting = 0; setting < numbers.size(); ++setting) {
      if (numbers[setting].values.empty()) continue;
      const std::vector<std::size_t> levels = results.design().levels(setting);
      SettingMean mean{{}, numbers[setting].mean};
      for (const std::size_t k : used) mean.levels.push_back(static_cast<int>(levels[k]));
      means.push_back(std::move(mean));
    }
    if (means.size() < 2) continue;
    const Effects effects = calc_effects(level_counts, means);
    full = full && effects.full_factorial;
    std::vector<std::string> row = {escaped(name)};
    for (const MainEffect& effect : effects.factors) {
      row.push_back(fmt::format("{:.1f} %", 100.0 * effect.share));
    }
    for (const Interaction& interaction : effects.interactions) {
      row.push_back(fmt::format("{:.1f} %", 100.0 * interaction.share));
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) return "";
  std::string words =
      "<p>Share of the variance between the means of the settings that a factor explains alone, "
      "and that two factors explain in addition as a pair (η²; Montgomery, Design and Analysis of "
      "Experiments, section 5.3).";
  if (!full) {
    words +=
        " Settings are missing, so the factors are correlated and the shares may add up to more "
        "than 100 %.";
  }
  return words + "</p>\n" + table(heads, rows);
}

/// Table that compares each level of a factor with its first, at equal other factors and seed.
std::string differences_table(const Results& results, const std::vector<std::string>& names) {
  const Design& design = results.design();
  const scenario::Study& study = design.study();
  constexpr std::size_t kMaxLevels = 12;
  Numbers numbers(results);
  std::vector<std::vector<std::string>> rows;
  std::size_t stride = design.settings();
  for (const scenario::Factor& factor : study.factors) {
    const std::size_t count = factor.levels.size();
    stride /= count;  // between settings that differ only in this factor
    if (count < 2 || count > kMaxLevels) continue;
    for (std::size_t level = 1; level < count; ++level) {
      for (const std::string& name : names) {
        std::vector<double> first, other;
        for (std::size_t setting = 0; setting < design.settings(); ++setting) {
          if (setting / stride % count != 0) continue;
          for (std::size_t k = 0; k < design.seeds(); ++k) {
            const double a = numbers.value(design.cell_of(setting, k), name);
            const double b = numbers.value(design.cell_of(setting + level * stride, k), name);
            if (!std::isfinite(a) || !std::isfinite(b)) continue;
            first.push_back(a);
            other.push_back(b);
          }
        }
        if (first.size() < 2) continue;
        const PairedDifference difference = paired_difference(first, other, kConfidence);
        const auto text_of = [&](std::size_t k) {
          std::string text;
          for (const std::string& one : factor.levels[k].texts)
            text += (text.empty() ? "" : ", ") + one;
          return escaped(text);
        };
        rows.push_back(
            {escaped(factor.name), text_of(level), text_of(0), escaped(name),
             number_text(difference.mean),
             number_text(difference.interval.low) + " to " + number_text(difference.interval.high),
             fmt::format("{:.2g}", difference.p_value), std::to_string(difference.count)});
      }
    }
  }
  if (rows.empty()) return "";
  return "<p>Each level minus the first level, run by run at equal other factors and seed. "
         "The interval is that of Student's t (95 %); with many rows some are far "
         "from 0 by chance.</p>\n" +
         table({"factor", "level", "minus", "number", "mean difference", "95 % interval", "p",
                "pairs"},
               rows);
}

}  // namespace

std::vector<std::string> drawn_numbers(const OpenStudy& open, const Results& results) {
  std::vector<std::string> names = open.study.metrics;
  if (names.empty()) {
    const std::vector<std::size_t> first(open.study.factors.size(), 0);
    const scenario::Scenario scenario =
        open.source.load(open.registry, open.design.overrides_of(first));
    for (const scenario::Criterion& criterion : scenario.criteria) {
      if (std::find(names.begin(), names.end(), criterion.metric) == names.end()) {
        names.push_back(criterion.metric);
      }
    }
  }
  if (names.empty()) names = results.names();
  for (const scenario::DerivedColumn& column : open.study.derived) names.push_back(column.name);
  if (names.size() > kMaxDrawn) names.resize(kMaxDrawn);
  return names;
}

std::string study_page(const OpenStudy& open, const Results& results) {
  const std::vector<std::string> names = drawn_numbers(open, results);
  std::string plots = success_figure(results);
  for (const std::string& name : names) plots += number_figures(results, name);
  plots += parallel_figure(results, names);
  if (!plots.empty()) plots = "<div class=\"figures\">\n" + plots + "</div>\n";
  std::string page = tools::page_head(open.study.name + ": study",
                                      tools::report::page_style() + study_plot_style());
  page += fmt::format("<main data-command=\"{}\">\n<h1>{}</h1>\n", escaped(repeat_command(open)),
                      escaped(open.study.name));
  if (!open.study.description.empty()) {
    page += fmt::format("<p>{}</p>\n", escaped(open.study.description));
  }
  page += section("outcome", "Runs", outcome(open, results));
  page += section("plots", "Plots", plots);
  page += section("effects", "Effects", effects_table(results, names));
  page += section("differences", "Differences", differences_table(results, names));
  page += section("settings", "Settings", settings_table(open, results, names));
  return page + "</main>\n<script>//<![CDATA[\n" + click_script() +
         "\n//]]></script>\n</body>\n</html>\n";
}

}  // namespace vinerow::study
