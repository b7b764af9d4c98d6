#include "tools/report/time_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/axis.h"
#include "tools/report/html.h"
#include "tools/report/metric_table.h"
#include "tools/report/svg.h"
#include "tools/report/units.h"

namespace vinerow::tools::report {
namespace {

constexpr double kLabels = 150, kNote = 120, kRow = 26, kTimes = 42, kTop = 4, kBorder = 16;
/// Width for telephones, and height of a name above its bars, pixels.
constexpr double kNarrowChart = 360, kNameRow = 20;
constexpr double kSliver_px = 5.0;
/// Longer names do not fit beside the bars, and stand above them.
constexpr std::size_t kLettersBeside = 17;

std::string listed(const Json& names) {
  std::string out;
  for (const Json& name : names) {
    if (name.is_string()) out += (out.empty() ? "" : ", ") + name.get<std::string>();
  }
  return out;
}

/// CSS class of a phase's state.
std::string style_of(const std::string& state) {
  if (state == "succeeded") return "met";
  if (state == "failed") return "failed";
  if (state == "stopped") return "stopped";
  return "waits";
}

std::string who(const Json& phase) {
  return phase.value("kind", "") == "job" ? "job " + phase.value("job", "")
                                          : listed(list_in(phase, "vehicles"));
}

std::string span_text(const Json& phase) {
  const double begin_s = number_of(phase.value("begin_s", Json()));
  const double end_s = number_of(phase.value("end_s", Json()));
  if (!std::isfinite(begin_s)) return "did not start";
  return fmt::format("{} to {}", duration_text(begin_s),
                     std::isfinite(end_s) ? duration_text(end_s) : "the end");
}

struct Activity {
  const char* style;
  const char* label;
};

/// Style and text of a phase of a rotorcraft's reference.
Activity activity(ReferenceTrajectory::Phase phase) {
  using Phase = ReferenceTrajectory::Phase;
  switch (phase) {
    case Phase::kWait:
      return {"waits", "waits"};
    case Phase::kTakeOff:
      return {"lift", "takes off"};
    case Phase::kTransit:
      return {"transit", "on the way to the rows"};
    case Phase::kRow:
      return {"work", "in a row"};
    case Phase::kTurn:
      return {"turn", "turns between rows"};
    case Phase::kReturn:
      return {"transit", "on the way home"};
    case Phase::kLand:
      return {"lift", "lands"};
    case Phase::kDone:
      return {"", ""};
    case Phase::kHover:
      return {"work", "hovers"};
  }
  return {"", ""};
}

Activity activity(AirReference::Phase phase) {
  using Phase = AirReference::Phase;
  switch (phase) {
    case Phase::kWait:
      return {"waits", "waits"};
    case Phase::kLaunch:
      return {"lift", "is launched"};
    case Phase::kStraight:
      return {"work", "flies straight"};
    case Phase::kTurn:
      return {"turn", "turns"};
    case Phase::kLoiter:
      return {"transit", "circles"};
    case Phase::kLand:
      return {"lift", "lands"};
    case Phase::kDone:
      return {"", ""};
  }
  return {"", ""};
}

/// Extends the last bar, or adds a new one if the activity changes.
void extend(const Activity& now, double t_s, std::vector<TimeBar>& bars) {
  if (!bars.empty()) bars.back().to_s = t_s;
  const bool goes_on =
      !bars.empty() && bars.back().style == now.style && bars.back().tip == now.label;
  if (!goes_on) bars.push_back({t_s, t_s, now.style, now.label});
}

std::vector<TimeBar> bars_of(const VehicleLog& vehicle, const Track& track) {
  std::vector<TimeBar> bars;
  if (!vehicle.reference.t_s.empty()) {
    for (std::size_t i = 0; i < vehicle.reference.t_s.size(); ++i) {
      const auto phase = static_cast<ReferenceTrajectory::Phase>(vehicle.reference.phase[i]);
      extend(activity(phase), vehicle.reference.t_s[i], bars);
    }
  } else if (!vehicle.air_reference.empty()) {
    for (std::size_t i = 0; i < vehicle.air_reference.times.size(); ++i) {
      extend(activity(vehicle.air_reference.values[i].phase), vehicle.air_reference.times[i].s(),
             bars);
    }
  } else if (track.moves()) {
    for (std::size_t i = 0; i < track.t_s.size(); ++i) {
      extend(track.in_turn[i] ? Activity{"turn", "turns between rows"} : Activity{"work", "drives"},
             track.t_s[i], bars);
    }
  }
  std::erase_if(bars, [](const TimeBar& bar) { return bar.style.empty(); });
  return bars;
}

std::string draw_time_line(const std::vector<TimeRow>& rows, double end_s, const std::string& label,
                           double width) {
  const bool narrow = width < kWideChart;
  const bool above = narrow || std::any_of(rows.begin(), rows.end(), [](const TimeRow& row) {
                       return row.label.size() > kLettersBeside;
                     });
  const double name = above ? kNameRow - 4 : 0.0, row_height = kRow + name;
  const double bottom = kTop + row_height * static_cast<double>(rows.size());
  Svg svg(width, bottom + kTimes, "time", label);
  const bool has_notes =
      std::any_of(rows.begin(), rows.end(), [](const TimeRow& row) { return !row.note.empty(); });
  const Axis x({0.0, end_s}, above ? kBorder : kLabels,
               width - (has_notes && !above ? kNote : kBorder), narrow ? 5 : 10);
  for (const double tick : x.ticks()) {
    svg.line(x.px(tick), kTop, x.px(tick), bottom + 4, "grid");
    svg.text(x.px(tick), bottom + 18, x.text(tick), "tick mid");
  }
  svg.text(0.5 * (x.from_px() + x.to_px()), bottom + 36, "simulated time, s", "label mid");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TimeRow& row = rows[i];
    const double y = kTop + row_height * static_cast<double>(i) + name;
    svg.text(above ? x.from_px() : kLabels - 10, above ? y - 1 : y + 17, row.label,
             above ? "label" : "label end");
    svg.rect(x.from_px(), y + 4, x.to_px() - x.from_px(), kRow - 8, "lane");
    for (const TimeBar& bar : row.bars) {
      const double from = x.px(std::clamp(bar.from_s, 0.0, end_s));
      const double to = x.px(std::clamp(bar.to_s, 0.0, end_s));
      const double bar_width = std::max(to - from, row.bars.size() == 1 ? kSliver_px : 0.5);
      svg.rect(std::min(from, x.to_px() - bar_width), y + 4, bar_width, kRow - 8,
               "bar " + bar.style, bar.tip);
    }
    if (!has_notes) continue;
    svg.text(above ? x.to_px() : x.to_px() + 10, above ? y - 1 : y + 17, row.note,
             "note " + row.note_style + (above ? " end" : ""));
  }
  return svg.finish();
}

}  // namespace

std::string time_line(const std::vector<TimeRow>& rows, double end_s, const std::string& label) {
  if (rows.empty() || !(end_s > 0.0)) return "";
  return "<div class=\"wide-only\">" + draw_time_line(rows, end_s, label, kWideChart) +
         "</div>\n<div class=\"narrow-only\">" + draw_time_line(rows, end_s, label, kNarrowChart) +
         "</div>\n";
}

std::vector<TimeRow> phase_rows(const RunFolder& run) {
  std::vector<TimeRow> rows;
  for (const Json& phase : list_in(run.summary, "phases")) {
    TimeRow row;
    const std::string state = phase.value("state", "");
    row.label = phase.value("name", "");
    row.note = state;
    row.note_style = style_of(state);
    const double begin_s = number_of(phase.value("begin_s", Json()));
    double end_s = number_of(phase.value("end_s", Json()));
    if (!std::isfinite(end_s)) end_s = run.end_s();
    if (std::isfinite(begin_s)) {
      row.bars.push_back(
          {begin_s, end_s, row.note_style,
           fmt::format("{} ({}): {}, {}", row.label, who(phase), state, span_text(phase))});
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<TimeRow> activity_rows(const std::vector<VehicleLog>& vehicles,
                                   const std::vector<Track>& tracks) {
  std::vector<TimeRow> rows;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (tracks[i].empty()) continue;
    TimeRow row;
    row.label = vehicles[i].name;
    row.bars = bars_of(vehicles[i], tracks[i]);
    if (!row.bars.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

std::string activity_legend(const std::vector<TimeRow>& rows) {
  std::vector<std::pair<std::string, std::vector<std::string>>> labels;  // of a colour, in order
  for (const TimeRow& row : rows) {
    for (const TimeBar& bar : row.bars) {
      auto of_style = std::find_if(labels.begin(), labels.end(),
                                   [&](const auto& entry) { return entry.first == bar.style; });
      if (of_style == labels.end()) of_style = labels.insert(labels.end(), {bar.style, {}});
      auto& entries = of_style->second;
      if (std::find(entries.begin(), entries.end(), bar.tip) == entries.end())
        entries.push_back(bar.tip);
    }
  }
  std::string keys;
  for (const auto& [style, entries] : labels) {
    keys += legend_key("area " + style, fmt::format("{}", fmt::join(entries, " / ")));
  }
  return legend_line(keys);
}

std::string phase_table(const RunFolder& run) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& phase : list_in(run.summary, "phases")) {
    const std::string state = phase.value("state", "");
    const Json& criteria = list_in(phase, "criteria");
    const auto met = std::count_if(criteria.begin(), criteria.end(),
                                   [](const Json& c) { return c.value("met", false); });
    std::string product;
    if (const auto given = phase.find("product"); given != phase.end() && given->is_object()) {
      product = given->value("kind", "");
    }
    std::string numbers;
    if (const auto entries = phase.find("numbers");
        entries != phase.end() && entries->is_object()) {
      for (const auto& [name, value] : entries->items()) {
        numbers += fmt::format("<tr><td>{}</td>{}<td>{}</td></tr>", escaped(words_of(name)),
                               number_cell(number_of(value)), escaped(unit_of(name)));
      }
    }
    if (!numbers.empty()) {
      numbers = "<details><summary>numbers</summary><table><tbody>" + numbers +
                "</tbody></table></details>";
    }
    rows.push_back(
        {fmt::format("<strong>{}</strong>", escaped(phase.value("name", ""))), escaped(who(phase)),
         escaped(listed(list_in(phase, "after"))),
         fmt::format("<span class=\"badge {}\">{}</span>", style_of(state), escaped(state)),
         number_cell(number_of(phase.value("begin_s", Json()))),
         number_cell(number_of(phase.value("end_s", Json()))), escaped(phase.value("reason", "")),
         criteria.empty() ? "–" : fmt::format("{} of {}", met, criteria.size()),
         escaped(product.empty() ? "–" : product) + numbers});
  }
  if (rows.empty()) return "";
  return table({"phase", "vehicles or job", "after", "state", "start, s", "end, s", "reason",
                "criteria met", "product"},
               rows, "phases");
}

}  // namespace vinerow::tools::report
