#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "tools/terminal/colour.h"
#include "tools/vinerow/parameter_words.h"
#include "tools/vinerow/parts_json.h"
#include "tools/vinerow/parts_page.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

void print_parameters(const std::vector<ParameterSpec>& specs, int indent) {
  for (const ParameterSpec& spec : specs) {
    fmt::print("{:{}}{:<26} {:<14} default {:<14} {:<22} {}\n", "", indent, spec.name, spec.unit,
               default_text(spec), range_text(spec), spec.description);
    print_parameters(spec.fields, indent + 4);
  }
}

void print_part(const Registry& registry, PartKind kind, const std::string& name) {
  const PartSpec& spec = registry.spec(kind, name);
  fmt::print("{} {}  (version {}, {})\n    {}\n", to_string(kind), name, spec.version,
             registry.origin(kind, name), spec.description);
  if (spec.default_rate_Hz > 0.0) fmt::print("    rate_Hz: default {:g}\n", spec.default_rate_Hz);
  if (!spec.reads.empty()) fmt::print("    reads:  {}\n", join(spec.reads));
  if (!spec.writes.empty()) fmt::print("    writes: {}\n", join(spec.writes));
  for (const ResultSpec& result : spec.results) {
    fmt::print("      {:<30} {:<8} {:<20} {}\n", result.name, result.unit, result.range.text(),
               result.title);
  }
  print_parameters(spec.parameters, 6);
}

/// First sentence of a description, cut to one line of a terminal.
std::string in_one_line(const std::string& description) {
  constexpr std::size_t kMax = 100;
  // A full stop before a lower-case letter or a digit belongs to an abbreviation: "eq. 8".
  std::size_t end = description.find(". ");
  while (end != std::string::npos && end + 2 < description.size() &&
         !(description[end + 2] >= 'A' && description[end + 2] <= 'Z')) {
    end = description.find(". ", end + 1);
  }
  std::string line = description.substr(0, end);
  if (line.ends_with('.')) line.pop_back();
  if (line.size() <= kMax) return line;
  // Cut at a blank: never inside a multi-byte character.
  const std::size_t blank = line.rfind(' ', kMax - 4);
  return line.substr(0, blank == std::string::npos ? kMax - 4 : blank) + " ...";
}

void print_names(const Registry& registry, PartKind kind, const std::vector<std::string>& names) {
  fmt::print("{}\n", coloured(to_string(kind), Colour::kHeading));
  for (const std::string& name : names) {
    fmt::print("  {:<26} {}\n", name, in_one_line(registry.spec(kind, name).description));
  }
}

struct ListArguments {
  std::string part;
  std::vector<std::filesystem::path> plugins;
  bool markdown = false, json = false, full = false;
};

/// Requested parts by kind. @throws ConfigError if there is no part or kind of that name
std::vector<std::pair<PartKind, std::vector<std::string>>> chosen_parts(const Registry& registry,
                                                                        const std::string& wanted) {
  std::vector<std::pair<PartKind, std::vector<std::string>>> chosen;
  std::vector<std::string> known;
  for (const PartKind kind : kAllPartKinds) {
    known.emplace_back(to_string(kind));
    const bool whole_kind = wanted.empty() || wanted == to_string(kind);
    std::vector<std::string> names;
    for (const std::string& name : registry.names(kind)) {
      known.push_back(name);
      if (whole_kind || wanted == name) names.push_back(name);
    }
    if (whole_kind || !names.empty()) chosen.emplace_back(kind, std::move(names));
  }
  if (chosen.empty()) {
    throw ConfigError(fmt::format("list: unknown kind or part '{}'{} (known: {})", wanted,
                                  did_you_mean(wanted, known), join(known)));
  }
  return chosen;
}

void list_parts(const ListArguments& arguments) {
  const Registry registry = make_registry(arguments.plugins);
  const auto chosen = chosen_parts(registry, arguments.part);
  const bool short_form = arguments.part.empty() && !arguments.full;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  std::string page = parts_page_opening();
  for (const auto& [kind, names] : chosen) {
    if (names.empty()) continue;
    if (arguments.markdown) page += kind_heading(kind);
    if (!arguments.markdown && !arguments.json && short_form) print_names(registry, kind, names);
    for (const std::string& name : names) {
      if (arguments.markdown) {
        page += part_markdown(registry, kind, name);
      } else if (arguments.json) {
        json.push_back(part_json(registry, kind, name));
      } else if (!short_form) {
        print_part(registry, kind, name);
      }
    }
  }
  if (arguments.markdown) {
    fmt::print("{}", page);
  } else if (arguments.json) {
    fmt::print("{}\n", json.dump(1));
  } else if (short_form) {
    fmt::print(
        "\n'vinerow list NAME' prints all about one part, 'vinerow list KIND' about all parts of a "
        "kind.\n");
  }
}

}  // namespace

void add_list_command(CLI::App& app, int& exit_status) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App* command = app.add_subcommand("list", "list the parts that a scenario can use");
  command->add_option("part", arguments->part,
                      "print all parameters of this part (pure_pursuit), or of all parts of a kind "
                      "(world, sensor, ...)");
  command->add_option("--plugin", arguments->plugins, "include the parts of a plug-in")
      ->allow_extra_args(false);
  command->add_flag("--full", arguments->full, "all parts with all parameters");
  CLI::Option* markdown = command->add_flag("--markdown", arguments->markdown,
                                            "print the page docs/reference/parts.md");
  command->add_flag("--json", arguments->json, "print JSON, with all parameters")
      ->excludes(markdown);
  command->callback([arguments, &exit_status] {
    list_parts(*arguments);
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
