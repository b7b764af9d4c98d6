#include "engine/run/junit.h"

#include <fmt/format.h>

#include <vector>

#include "engine/sim/judge.h"

namespace vinerow::run {
namespace {

/// Text in XML 1.0, with escaped markup and without control characters that XML does not allow.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\n':
        result += "&#10;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20) result += c;
    }
  }
  return result;
}

struct Case {
  std::string class_name, name;
  double time_s = 0.0;
  std::string element;  ///< "failure", "error", "skipped"; "" = passed
  std::string message;
};

Case case_of(const PhaseReport& phase) {
  Case result{"phases", phase.name, 0.0, "", phase.reason};
  if (phase.begin && phase.end) result.time_s = (*phase.end - *phase.begin).s();
  if (phase.state == PhaseState::kFailed) {
    result.element = "failure";
  } else if (phase.state != PhaseState::kSucceeded) {
    result.element = "skipped";
    result.message = fmt::format("{}: {}", to_string(phase.state), phase.reason);
  }
  return result;
}

Case case_of(const CriterionResult& criterion) {
  Case result{"criteria", criterion.name, 0.0, "", ""};
  if (!criterion.met) {
    result.element = "failure";
    result.message = sentence_of(criterion);
  }
  return result;
}

std::vector<Case> cases_of(const std::string& scenario, const RunResult& result) {
  std::vector<Case> cases;
  for (const PhaseReport& phase : result.phases) cases.push_back(case_of(phase));
  for (const CriterionResult& criterion : result.criteria) cases.push_back(case_of(criterion));
  Case run{"run", scenario, result.simulated_s, "", result.error};
  if (result.status == RunStatus::kBrokenOff) run.element = "error";
  // Without a mission a crash has no phase to fail.
  if (result.phases.empty() && !result.crashes.empty()) run.element = "failure";
  cases.push_back(run);
  return cases;
}

}  // namespace

std::string junit_xml(const std::string& scenario, const RunResult& result) {
  const std::vector<Case> cases = cases_of(scenario, result);
  const auto count = [&](const char* element) {
    int n = 0;
    for (const Case& c : cases) n += c.element == element ? 1 : 0;
    return n;
  };
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  xml += fmt::format(
      "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" "
      "time=\"{:.3f}\">\n",
      escaped(scenario), cases.size(), count("failure"), count("error"), count("skipped"),
      result.simulated_s);
  for (const Case& c : cases) {
    xml += fmt::format("    <testcase classname=\"{}.{}\" name=\"{}\" time=\"{:.3f}\"",
                       escaped(scenario), c.class_name, escaped(c.name), c.time_s);
    xml += c.element.empty()
               ? "/>\n"
               : fmt::format("><{} message=\"{}\"/></testcase>\n", c.element, escaped(c.message));
  }
  return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace vinerow::run
