#include "tools/vinerow/reference_pages.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <type_traits>
#include <vector>

#include "engine/api/messages.h"
#include "engine/sim/separation.h"
#include "tools/export/markdown.h"

namespace vinerow::tools {
namespace {

std::string opening(const std::string& title, const std::string& text) {
  return fmt::format("# {}\n\n{} `vinerow docs` writes this page; do not edit it by hand.\n", title,
                     text);
}

std::string result_table(const std::vector<ResultSpec>& results, const std::string& prefix) {
  std::string table = "\n| name | unit | values | meaning | source |\n|---|---|---|---|---|\n";
  for (const ResultSpec& result : results) {
    const std::string range = result.range.text();
    table += fmt::format("| {} | {} | {} | **{}.** {} | {} |\n",
                         markdown_code(prefix + result.name), markdown_text(result.unit),
                         range.empty() ? "any" : range, markdown_text(result.title),
                         markdown_text(result.definition), markdown_text(result.source));
  }
  return table;
}

void add_results(const Registry& registry, PartKind kind, const std::string& prefix,
                 std::string& page) {
  for (const std::string& name : registry.names(kind)) {
    const PartSpec& spec = registry.spec(kind, name);
    if (spec.results.empty()) continue;
    page += fmt::format("\n### {} {}\n\n{}.\n", to_string(kind), markdown_code(name),
                        markdown_text(spec.description));
    page += result_table(spec.results, prefix);
  }
}

/// Signal name of a port: "plan" for "plan (optional)"; empty for a sentence.
std::string signal_in(const std::string& port) {
  const std::string name = port.substr(0, port.find_first_of(" :,"));
  return name == port || port.ends_with("(optional)") ? name : "";
}

struct SignalUse {
  std::set<std::string> writers, readers;
};

std::string listed(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + markdown_code(name);
  return list;
}

template <class T>
std::string type_text();

/// Adds a table row for each field of a message.
struct FieldRows {
  std::string& rows;

  template <class T>
  void operator()(const FieldInfo& info, const T&) const {
    rows += fmt::format("| {} | {} | {} | {} |\n", markdown_code(info.name), type_text<T>(),
                        markdown_text(info.unit), markdown_text(info.words));
  }
};

template <class T>
std::string type_text() {
  if constexpr (std::is_same_v<T, bool>) {
    return "boolean";
  } else if constexpr (std::is_same_v<T, std::string>) {
    return "text";
  } else if constexpr (std::is_same_v<T, Pose>) {
    return "pose";
  } else if constexpr (std::is_same_v<T, Eigen::Vector3d>) {
    return "3-vector";
  } else if constexpr (std::is_same_v<T, Eigen::Quaterniond>) {
    return "quaternion";
  } else if constexpr (std::is_enum_v<T>) {
    return "enumeration";
  } else if constexpr (std::is_floating_point_v<T>) {
    return "number";
  } else if constexpr (std::is_integral_v<T>) {
    return "whole number";
  } else if constexpr (HasFields<T>) {
    return std::string("`") + std::string(T::kType) + "`";
  } else {
    return "list of " + type_text<typename T::value_type>();
  }
}

void add_options(const CLI::App& command, std::string& page) {
  std::string rows;
  for (const ShownOption& option : shown_options(command)) {
    rows += fmt::format("| {} | {} | {} | {} |\n", markdown_code(option.name),
                        markdown_code(option.value),
                        option.is_required ? "required" : markdown_code(option.default_value),
                        markdown_text(option.description));
  }
  if (!rows.empty()) {
    page += "\n| argument or option | value | default | meaning |\n|---|---|---|---|\n" + rows;
  }
}

void add_command(const CLI::App& command, const std::string& name, std::string& page) {
  page += fmt::format("\n## {}\n\n{}.\n", markdown_code("vinerow " + name),
                      markdown_text(command.get_description()));
  add_options(command, page);
  if (!command.get_footer().empty()) {
    page += fmt::format("\n```text\n{}\n```\n", command.get_footer());
  }
  for (const CLI::App* action : command.get_subcommands(nullptr)) {
    add_command(*action, name + " " + action->get_name(), page);
  }
}

}  // namespace

std::vector<ShownOption> shown_options(const CLI::App& command) {
  std::vector<ShownOption> shown;
  for (const CLI::Option* option : command.get_options()) {
    // Hidden options have no group.
    const bool is_repeated = option == command.get_help_ptr() && command.get_parent();
    if (option->get_group().empty() || is_repeated) continue;
    shown.push_back(
        {option->get_positional() ? option->get_name(true) : option->get_name(false, true),
         option->get_items_expected_max() > 0 ? option->get_type_name() : "",
         option->get_default_str(), option->get_description(), option->get_positional(),
         option->get_required()});
  }
  return shown;
}

std::string metrics_page(const Registry& registry) {
  std::string page = opening(
      "Metrics",
      "`summary.json` holds `metrics.<vehicle>.<name>`; criteria in a scenario name a metric as "
      "`<vehicle>.<name>`. A metric that does not apply, or that had nothing to measure, is "
      "`null`, and a criterion on it is not met. Deviation metrics sample at the controller's "
      "rate. Relative accuracy alone is easily gamed (coarse waypoints, a tiny lookahead): read it "
      "next to the mean deviation, the maximum deviation and the time. `summary.json` also holds "
      "`estimation.<vehicle>` (its `estimator`, `null` without one, and `truth`, what the "
      "estimator takes from the truth) and `planning.<vehicle>` (counters of the planner: nodes, "
      "iterations, clearance).");
  page += "\n## Of vehicles\n";
  add_results(registry, PartKind::kMetric, "", page);
  page += "\n### Several vehicles\n\nEvery run with more than one vehicle has this metric.\n";
  page += result_table(separation_results(), "");
  page += "\n## Of payloads\n\nThe payload's name in the scenario is the first part of the name.\n";
  add_results(registry, PartKind::kPayload, "<payload>_", page);
  page +=
      "\n## Of jobs\n\n`phases.<phase>.numbers` in `summary.json`; criteria of the phase name "
      "them without an owner.\n";
  add_results(registry, PartKind::kJob, "", page);
  return page;
}

std::string signals_page(const Registry& registry) {
  std::map<std::string, SignalUse> signals;
  for (const PartKind kind : kAllPartKinds) {
    for (const std::string& name : registry.names(kind)) {
      const PartSpec& spec = registry.spec(kind, name);
      for (const std::string& port : spec.writes) {
        if (const std::string signal = signal_in(port); !signal.empty()) {
          signals[signal].writers.insert(name);
        }
      }
      for (const std::string& port : spec.reads) {
        if (const std::string signal = signal_in(port); !signal.empty()) {
          signals[signal].readers.insert(name);
        }
      }
    }
  }
  std::string page = opening(
      "Signals",
      "Signals of a vehicle by the parts that write and read them. In a log the topic is "
      "`/<vehicle>/<signal>`. `<name>` is the part's own name in the scenario. Signals that the "
      "kernel or the vehicle writes, with their types and rates, are in "
      "[concepts/signals.md](../concepts/signals.md); fields of types in "
      "[messages.md](messages.md).");
  page += "\n| signal | written by | read by |\n|---|---|---|\n";
  for (const auto& [name, use] : signals) {
    page += fmt::format("| {} | {} | {} |\n", markdown_code(name), listed(use.writers),
                        listed(use.readers));
  }
  return page;
}

std::string messages_page() {
  std::string page = opening(
      "Messages",
      "Types of signals and their fields, as in [`vinerow/api/messages`](../concepts/signals.md) "
      "and, in the spelling of ROS 2, in logs. A plug-in may add types.");
  for_each_message_type([&](auto* type) {
    using T = std::remove_pointer_t<decltype(type)>;
    std::string rows;
    const T fresh{};
    T::fields(fresh, FieldRows{rows});
    page += fmt::format("\n## {}\n\n| field | type | unit | meaning |\n|---|---|---|---|\n{}",
                        markdown_code(T::kType), rows);
  });
  return page;
}

std::string command_line_page(const CLI::App& app) {
  std::string page = opening(
      "Command line",
      "Every command of `vinerow` with its options; `vinerow COMMAND --help` prints the same. "
      "Exit statuses: [exit_status.md](exit_status.md).");
  page += "\n| command | does |\n|---|---|\n";
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    page += fmt::format("| [`{0}`](#vinerow-{0}) | {1} |\n", command->get_name(),
                        markdown_text(command->get_description()));
  }
  page += "\n## Options of every command\n";
  add_options(app, page);
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    add_command(*command, command->get_name(), page);
  }
  return page;
}

}  // namespace vinerow::tools
