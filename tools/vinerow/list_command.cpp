#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "tools/vinerow/commands.h"

namespace vinerow::tools {
namespace {

std::string default_text(const ParameterSpec& spec) {
  if (spec.required) return "required";
  const auto list = [](const auto& values) { return fmt::format("[{}]", fmt::join(values, ", ")); };
  if (const auto* v = std::get_if<double>(&spec.default_value)) return fmt::format("{}", *v);
  if (const auto* v = std::get_if<std::int64_t>(&spec.default_value)) return fmt::format("{}", *v);
  if (const auto* v = std::get_if<bool>(&spec.default_value)) return *v ? "true" : "false";
  if (const auto* v = std::get_if<std::string>(&spec.default_value))
    return v->empty() ? "\"\"" : *v;
  if (const auto* v = std::get_if<std::vector<double>>(&spec.default_value)) return list(*v);
  if (const auto* v = std::get_if<std::vector<std::string>>(&spec.default_value)) return list(*v);
  return "-";
}

std::string range_text(const ParameterSpec& spec) {
  if (!spec.choices.empty()) return fmt::format("{}", fmt::join(spec.choices, " | "));
  const bool has_min = std::isfinite(spec.min), has_max = std::isfinite(spec.max);
  if (has_min && has_max)
    return fmt::format("{}{:g}, {:g}]", spec.min_exclusive ? "(" : "[", spec.min, spec.max);
  if (has_min) return fmt::format("{} {:g}", spec.min_exclusive ? ">" : ">=", spec.min);
  if (has_max) return fmt::format("<= {:g}", spec.max);
  return "";
}

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
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("list", "list the parts a scenario can name, with their parameters");
  command->add_option("part", arguments->part,
                      "only this kind (world, sensor, ...) or this part (pure_pursuit)");
  command->add_option("--plugin", arguments->plugins, "include the parts of a plug-in")
      ->allow_extra_args(false);
  command->callback([arguments, &exit_status] {
    const Registry registry = make_registry(arguments->plugins);
    std::vector<std::string> known;
    bool found = false;
    for (const PartKind kind : kAllPartKinds) {
      known.emplace_back(to_string(kind));
      for (const std::string& name : registry.names(kind)) {
        known.push_back(name);
        const bool wanted = arguments->part.empty() || arguments->part == to_string(kind) ||
                            arguments->part == name;
        if (!wanted) continue;
        found = true;
        print_part(registry, kind, name);
      }
      found = found || arguments->part == to_string(kind);
    }
    if (!found) {
      throw ConfigError(fmt::format("list: unknown kind or part '{}'{} (known: {})",
                                    arguments->part, did_you_mean(arguments->part, known),
                                    join(known)));
    }
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
