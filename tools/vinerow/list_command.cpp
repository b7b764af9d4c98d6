#include <fmt/format.h>

#include <utility>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "tools/vinerow/commands.h"
#include "tools/vinerow/parameter_words.h"
#include "tools/vinerow/parts_page.h"

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
  print_parameters(spec.parameters, 6);
}

}  // namespace

void add_list_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    std::string part;
    std::vector<std::filesystem::path> plugins;
    bool markdown = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("list", "list the parts a scenario can name, with their parameters");
  command->add_option("part", arguments->part,
                      "only this kind (world, sensor, ...) or this part (pure_pursuit)");
  command->add_option("--plugin", arguments->plugins, "include the parts of a plug-in")
      ->allow_extra_args(false);
  command->add_flag("--markdown", arguments->markdown, "as a page of tables (docs/parts.md)");
  command->callback([arguments, &exit_status] {
    const Registry registry = make_registry(arguments->plugins);
    std::vector<std::string> known;
    bool found = false;
    // A part that does not exist must not leave the head of a page.
    std::string page = parts_page_opening();
    for (const PartKind kind : kAllPartKinds) {
      known.emplace_back(to_string(kind));
      bool opened = false;
      for (const std::string& name : registry.names(kind)) {
        known.push_back(name);
        const bool wanted = arguments->part.empty() || arguments->part == to_string(kind) ||
                            arguments->part == name;
        if (!wanted) continue;
        found = true;
        if (!arguments->markdown) {
          print_part(registry, kind, name);
          continue;
        }
        if (!std::exchange(opened, true)) page += kind_heading(kind);
        page += part_markdown(registry, kind, name);
      }
      found = found || arguments->part == to_string(kind);
    }
    if (!found) {
      throw ConfigError(fmt::format("list: unknown kind or part '{}'{} (known: {})",
                                    arguments->part, did_you_mean(arguments->part, known),
                                    join(known)));
    }
    if (arguments->markdown) fmt::print("{}", page);
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
