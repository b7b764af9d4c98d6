#include "tools/report/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/report/html.h"
#include "tools/report/metric_table.h"
#include "tools/report/papers.h"
#include "tools/report/units.h"

namespace vinerow::tools::report {
namespace {

/// Requirement and its phase. A requirement with two limits is two criteria in the summary.
struct Judged {
  std::vector<Json> criteria;  ///< one or two, of one metric
  std::string phase;

  bool is_met() const {
    return std::all_of(criteria.begin(), criteria.end(),
                       [](const Json& criterion) { return criterion.value("met", false); });
  }
  /// The missed criterion, or the first if all are met.
  const Json& decisive() const {
    const auto missed = std::find_if(criteria.begin(), criteria.end(), [](const Json& criterion) {
      return !criterion.value("met", false);
    });
    return missed == criteria.end() ? criteria.front() : *missed;
  }
};

void add_criteria(const Json& list, const std::string& phase, std::vector<Judged>& all) {
  for (const Json& criterion : list) {
    const std::string name = criterion.value("name", "");
    const auto same = std::find_if(all.begin(), all.end(), [&](const Judged& judged) {
      const Json& first = judged.criteria.front();
      return !name.empty() && judged.phase == phase && judged.criteria.size() == 1 &&
             first.value("name", "") == name &&
             first.value("kind", "") != criterion.value("kind", "");
    });
    if (same == all.end()) {
      all.push_back({{criterion}, phase});
    } else {
      same->criteria.push_back(criterion);
    }
  }
}

std::vector<Judged> all_criteria(const RunFolder& run) {
  std::vector<Judged> all;
  add_criteria(list_in(run.summary, "criteria"), "", all);
  for (const Json& phase : list_in(run.summary, "phases")) {
    add_criteria(list_in(phase, "criteria"), phase.value("name", ""), all);
  }
  return all;
}

/// Limit as text: "at most 5", "at least 5", "−1 to 1", "exactly 4".
std::string limit_text(const Judged& judged) {
  const auto limit = [](const Json& c) { return number_of(c.value("limit", Json())); };
  const Json& first = judged.criteria.front();
  if (judged.criteria.size() == 1) {
    return (first.value("kind", "") == "max" ? "at most " : "at least ") +
           number_text(limit(first));
  }
  const double a = limit(first), b = limit(judged.criteria.back());
  if (a == b) return "exactly " + number_text(a);
  return number_text(std::min(a, b)) + " to " + number_text(std::max(a, b));
}

bool is_share(const std::string& name) {
  return name.ends_with("_share");
}

std::string value_text(const std::string& name, double value) {
  if (!std::isfinite(value)) return "not measured";
  if (is_share(name)) return number_text(100.0 * value) + " %";
  const std::string unit = unit_of(name);
  return number_text(value) + (unit.empty() || unit == "°" ? unit : " " + unit);
}

std::string metric_part(const std::string& metric) {
  const std::size_t dot = metric.find('.');
  return dot == std::string::npos ? metric : metric.substr(dot + 1);
}

/// Sentence on a missed requirement: "rover: largest wheel slip is 12 %, at most 5 % is allowed".
std::string failure(const Judged& judged) {
  const Json& c = judged.decisive();
  const std::string metric = c.value("metric", ""), name = metric_part(metric);
  const double value = number_of(c.value("value", Json()));
  const double limit = number_of(c.value("limit", Json()));
  const bool is_max = c.value("kind", "") == "max";
  const bool flag =
      limit == 1.0 && !is_max && (name == "finished" || name == "estimate_consistent");
  const std::string where = judged.phase.empty() ? "" : " (phase " + judged.phase + ")";
  if (flag && value == 0.0) return criterion_title(metric) + ": no" + where;
  if (!std::isfinite(value)) return criterion_title(metric) + " was not measured" + where;
  return fmt::format("{} is {}, {} {} is {}{}", criterion_title(metric), value_text(name, value),
                     is_max ? "at most" : "at least", value_text(name, limit),
                     is_max ? "allowed" : "required", where);
}

/// Failed phases as text: "phases scout, spray"; "" if none failed.
std::string failed_phases(const RunFolder& run) {
  std::vector<std::string> names;
  for (const Json& phase : list_in(run.summary, "phases")) {
    if (phase.value("state", "") == "failed") names.push_back(phase.value("name", ""));
  }
  if (names.empty()) return "";
  return fmt::format("phase{} {}", names.size() == 1 ? "" : "s", fmt::join(names, ", "));
}

/// One sentence for each phase that did not succeed, in the order of the summary.
std::vector<std::string> phase_failures(const RunFolder& run) {
  std::vector<std::string> phase_fault;
  for (const Json& phase : list_in(run.summary, "phases")) {
    const std::string state = phase.value("state", ""), reason = phase.value("reason", "");
    if (state != "failed" && state != "blocked" && state != "stopped") continue;
    phase_fault.push_back(fmt::format("phase {} {}{}", phase.value("name", ""),
                                      state == "blocked" ? "could not start" : state,
                                      reason.empty() ? "" : ": " + reason));
  }
  return phase_fault;
}

std::string sentence_of(const std::vector<std::string>& parts) {
  constexpr std::size_t kMax = 3;
  std::string out;
  for (std::size_t i = 0; i < parts.size() && i < kMax; ++i) {
    out += (i == 0 ? "" : "; ") + parts[i];
  }
  if (parts.size() > kMax) out += fmt::format("; and {} more below", parts.size() - kMax);
  return sentence_case(out) + ".";
}

}  // namespace

std::string criterion_title(const std::string& metric) {
  const std::size_t dot = metric.find('.');
  if (dot == std::string::npos) return metric_meaning(metric).title;
  return metric.substr(0, dot) + ": " + metric_meaning(metric.substr(dot + 1)).title;
}

Verdict make_verdict(const RunFolder& run) {
  Verdict verdict;
  const std::vector<Judged> criteria = all_criteria(run);
  std::vector<std::string> faults;
  for (const Json& crash : list_in(run.summary, "crashes")) {
    faults.push_back(fmt::format(
        "{} {} after {}: {}", crash.value("vehicle", ""), crash.value("kind", "crashed"),
        duration_text(number_of(crash.value("time_s", Json()))), crash.value("text", "")));
  }
  for (std::string& phase_fault : phase_failures(run)) faults.push_back(std::move(phase_fault));
  std::size_t missed = 0;
  for (const Judged& judged : criteria) {
    if (judged.is_met()) continue;
    ++missed;
    faults.push_back(failure(judged));
  }
  const bool broke_off = run.number("exit_status") == 3.0;
  const bool failed = run.number("exit_status") == 1.0 || missed > 0;
  if (broke_off) {
    const std::string error = run.text("error");  // begins with the time: "t = 20.050000 s: ..."
    verdict = {Verdict::Kind::kBrokenOff, "The simulation broke off",
               (error.starts_with("t = ") ? "At " + error : sentence_case(error)) + ".", ""};
  } else if (failed) {
    verdict.kind = Verdict::Kind::kFailed;
    const std::string phases = failed_phases(run);
    verdict.headline = "Failed";
    if (!phases.empty()) {
      verdict.headline = "Failed in " + phases;
    } else if (missed > 0) {
      verdict.headline += fmt::format(": {} of {} missed", missed,
                                      counted(static_cast<long>(criteria.size()), "requirement"));
    }
    verdict.sentence =
        faults.empty() ? sentence_case(run.text("status")) + "." : sentence_of(faults);
  } else if (criteria.empty()) {
    verdict = {Verdict::Kind::kOpen, "The run is complete",
               "The scenario has no requirements, so there is no verdict.", ""};
  } else {
    verdict.kind = Verdict::Kind::kMet;
    verdict.headline = criteria.size() == 1
                           ? "The one requirement is met"
                           : fmt::format("All {} requirements met", criteria.size());
    const auto finished = run.summary.find("finished");
    const bool done = finished != run.summary.end() && finished->is_boolean() && *finished;
    verdict.sentence =
        done ? "Every vehicle finished its task, and every measured value is within its limit."
             : "The time ran out before every vehicle finished its task.";
  }
  return verdict;
}

std::string verdict_box(const Verdict& verdict) {
  const char* kinds[] = {"met", "failed", "broken", "open"};
  const char* marks[] = {"✓", "✗", "!", "–"};
  const auto k = static_cast<std::size_t>(verdict.kind);
  return fmt::format(
      "<div class=\"verdict {}\"><span class=\"mark\">{}</span><div><strong>{}</strong>"
      "<p>{}</p>{}</div></div>\n",
      kinds[k], marks[k], escaped(verdict.headline), escaped(verdict.sentence),
      verdict.remark.empty() ? "" : "<p class=\"remark\">" + escaped(verdict.remark) + "</p>");
}

std::string criteria_table(const RunFolder& run) {
  std::vector<std::vector<std::string>> rows;
  for (const Judged& judged : all_criteria(run)) {
    const Json& c = judged.decisive();
    const std::string metric = c.value("metric", ""), name = metric_part(metric);
    const MetricMeaning meaning = metric_meaning(name);
    const std::string unit = unit_of(name);
    const std::string source =
        meaning.source.empty() ? "" : fmt::format(" ({})", escaped(meaning.source));
    // A name of the user's own; others repeat metric and limit.
    const std::string own = c.value("name", metric);
    const std::string title =
        escaped(own.starts_with(metric) ? sentence_case(criterion_title(metric))
                                        : fmt::format("{} ({})", own, criterion_title(metric))) +
        (judged.phase.empty() ? "" : " <em>in " + escaped(judged.phase) + "</em>");
    rows.push_back(
        {judged.is_met() ? "<span class=\"badge met\">met</span>"
                         : "<span class=\"badge failed\">failed</span>",
         fmt::format("<td class=\"what\"><details><summary>{}</summary><p>{}{} "
                     "<code>{}</code></p></details></td>",
                     title, escaped(meaning.definition), with_citations(source), escaped(metric)),
         number_cell(number_of(c.value("value", Json()))), escaped(unit),
         fmt::format("<td class=\"num\">{}</td>", limit_text(judged))});
  }
  if (rows.empty()) return "<p>The scenario has no criteria.</p>\n";
  return "<p class=\"hint\">Click a requirement to see its definition.</p>\n" +
         table({"", "requirement", "<span class=\"num\">value</span>", "unit",
                "<span class=\"num\">limit</span>"},
               rows, "criteria");
}

std::string metrics_table(const RunFolder& run) {
  const auto metrics = run.summary.find("metrics");
  if (metrics == run.summary.end() || !metrics->is_object() || metrics->empty()) return "";
  std::string out;
  for (const auto& [vehicle, values] : metrics->items()) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, value] : values.items()) {
      const MetricMeaning meaning = metric_meaning(name);
      rows.push_back({"<code>" + escaped(name) + "</code>", number_cell(number_of(value)),
                      escaped(unit_of(name)), escaped(meaning.definition),
                      with_citations(escaped(meaning.source))});
    }
    out += fmt::format("<details><summary>All {} metrics of {}</summary>\n{}</details>\n",
                       rows.size(), escaped(vehicle),
                       table({"metric", "value", "unit", "meaning", "source"}, rows, "metrics"));
  }
  return out;
}

}  // namespace vinerow::tools::report
