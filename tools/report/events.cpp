#include "tools/report/events.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "engine/api/messages/event.h"
#include "tools/report/html.h"

namespace vinerow::tools::report {
namespace {

/// Limits of the notice on the first screen. Chosen.
constexpr std::size_t kMaxLines = 4, kMaxLetters = 160;
/// Limit on the rows of the chapter, so that it opens quickly; warnings and errors always stay.
constexpr std::size_t kMaxRows = 1000;

bool is_grave(const RunEvent& event) {
  return event.level != "info";
}

std::string level_name(Event::Level level) {
  if (level == Event::Level::kError) return "error";
  return level == Event::Level::kWarning ? "warning" : "info";
}

std::vector<RunEvent> of_file(const std::filesystem::path& file) {
  std::vector<RunEvent> events;
  std::ifstream in(file, std::ios::binary);
  for (std::string line; std::getline(in, line);) {
    const Json json = Json::parse(line, nullptr, false);
    if (!json.is_object()) continue;
    const auto text = [&](const char* key) {
      const auto found = json.find(key);
      return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
    };
    RunEvent event{number_of(json.value("t_s", Json())), text("level"), text("source"),
                   text("text")};
    if (event.level != "error" && event.level != "warning") event.level = "info";
    events.push_back(std::move(event));
  }
  return events;
}

std::vector<RunEvent> of_log(const record::LogReader& log) {
  std::vector<RunEvent> events;
  record::LogPass pass(log);
  for (const record::ChannelInfo& channel : log.info().channels) {
    const auto type = channel.metadata.find("vinerow_type");
    if (type == channel.metadata.end() || type->second != Event::kType) continue;
    pass.read<Event>(channel.topic, [&events](Time t, const Event& event) {
      events.push_back({t.s(), level_name(event.level), event.source, event.text});
    });
  }
  pass.run();
  std::stable_sort(events.begin(), events.end(),
                   [](const RunEvent& a, const RunEvent& b) { return a.t_s < b.t_s; });
  return events;
}

std::string badge(const std::string& level) {
  const char* style = level == "error" ? " failed" : level == "warning" ? " stopped" : "";
  return fmt::format("<span class=\"badge{}\">{}</span>", style, level);
}

/// Text cut after a whole word if possible, and never inside a multi-byte character.
std::string shortened(const std::string& text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  std::size_t end = text.rfind(' ', max_bytes);
  if (end == std::string::npos || end == 0) end = max_bytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + " …";
}

/// Text that unfolds on a click if it is long: the numbers of a planner can fill a screen.
std::string folded(const std::string& text) {
  constexpr std::size_t kFolds = 240;
  if (text.size() <= kFolds) return escaped(text);
  return fmt::format("<details><summary>{}</summary>{}</details>",
                     escaped(shortened(text, kMaxLetters)), escaped(text));
}

std::string time_text(double t_s) {
  return fmt::format("{:.2f}", t_s);
}

std::string row_of(const RunEvent& event) {
  return fmt::format(
      "<tr{}><td class=\"num\" title=\"{}\">{}</td><td>{}</td><td><code>{}</code></td><td "
      "class=\"words\">{}</td></tr>\n",
      is_grave(event) ? " class=\"grave\"" : "", event.t_s, time_text(event.t_s),
      badge(event.level), escaped(event.source), folded(event.text));
}

}  // namespace

std::vector<RunEvent> read_events(const RunFolder& run) {
  const std::filesystem::path file = run.path / "events.jsonl";
  if (std::filesystem::is_regular_file(file)) return of_file(file);
  return run.log ? of_log(*run.log) : std::vector<RunEvent>{};
}

std::string event_notice(const std::vector<RunEvent>& events) {
  std::vector<const RunEvent*> grave;
  long errors = 0;
  for (const RunEvent& event : events) {
    if (!is_grave(event)) continue;
    grave.push_back(&event);
    errors += event.level == "error" ? 1 : 0;
  }
  if (grave.empty()) return "";
  std::stable_partition(grave.begin(), grave.end(),
                        [](const RunEvent* event) { return event->level == "error"; });
  const long warnings = static_cast<long>(grave.size()) - errors;
  std::string count = errors > 0 ? counted(errors, "error") : "";
  if (warnings > 0) count += (count.empty() ? "" : ", ") + counted(warnings, "warning");
  std::string out = fmt::format(
      "<div class=\"notice{}\"><p><strong>{} during the run</strong> <a href=\"#events\">all "
      "events</a></p>\n<ul>\n",
      errors > 0 ? " grave" : "", count);
  for (std::size_t i = 0; i < grave.size() && i < kMaxLines; ++i) {
    out += fmt::format("<li><b>{} s</b> <code>{}</code> {}</li>\n", time_text(grave[i]->t_s),
                       escaped(grave[i]->source), escaped(shortened(grave[i]->text, kMaxLetters)));
  }
  if (grave.size() > kMaxLines) {
    out += fmt::format("<li>and {} more</li>\n", grave.size() - kMaxLines);
  }
  return out + "</ul></div>\n";
}

std::string event_table(const std::vector<RunEvent>& events) {
  if (events.empty()) return "";
  const auto grave = std::count_if(events.begin(), events.end(), is_grave);
  std::string rows;
  std::size_t shown = 0;
  for (const RunEvent& event : events) {
    if (!is_grave(event) && shown >= kMaxRows) continue;
    rows += row_of(event);
    ++shown;
  }
  std::string out;
  if (grave > 0 && static_cast<std::size_t>(grave) < events.size()) {
    out +=
        "<p><label><input type=\"checkbox\" class=\"grave-only\"/> warnings and errors "
        "only</label></p>\n";
  }
  out +=
      "<div class=\"scroll tall\"><table class=\"events\">\n<thead><tr><th class=\"num\">time, "
      "s</th><th>level</th><th>source</th><th>event</th></tr></thead>\n<tbody>\n" +
      rows + "</tbody></table></div>\n";
  if (shown < events.size()) {
    out += fmt::format("<p>Showing {} of {} events; all are in events.jsonl.</p>\n", shown,
                       events.size());
  }
  return out;
}

}  // namespace vinerow::tools::report
