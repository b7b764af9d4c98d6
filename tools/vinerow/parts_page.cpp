#include "tools/vinerow/parts_page.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "tools/export/markdown.h"
#include "tools/vinerow/parameter_words.h"

namespace vinerow::tools {
namespace {

std::string code_list(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + markdown_code(text);
  return list;
}

std::string limits_of(const ParameterSpec& spec) {
  const bool has_min = std::isfinite(spec.min), has_max = std::isfinite(spec.max);
  if (has_min && has_max && !spec.min_exclusive) return fmt::format("{} to {}", spec.min, spec.max);
  std::string limits;
  if (has_min) limits = fmt::format("{} {}", spec.min_exclusive ? ">" : "≥", spec.min);
  if (has_max) limits += fmt::format("{}≤ {}", has_min ? ", " : "", spec.max);
  return limits;
}

std::string with_limits(const std::string& what, const ParameterSpec& spec) {
  const std::string limits = limits_of(spec);
  return limits.empty() ? what : what + ", " + limits;
}

std::string values_of(const ParameterSpec& spec) {
  const std::string choices = code_list(spec.choices);
  switch (spec.kind) {
    case ParameterKind::kNumber: {
      const std::string limits = limits_of(spec);
      return limits.empty() ? "number" : limits;
    }
    case ParameterKind::kInteger:
      return with_limits("whole", spec);
    case ParameterKind::kBoolean:
      return "`true`, `false`";
    case ParameterKind::kText:
      return choices.empty() ? "text" : choices;
    case ParameterKind::kPath:
      return "path";
    case ParameterKind::kNumberList:
      return with_limits(spec.size > 0 ? fmt::format("{} numbers", spec.size) : "list of numbers",
                         spec);
    case ParameterKind::kTextList:
      return choices.empty() ? "list of texts" : "list of " + choices;
    case ParameterKind::kGroup:
      return "mapping";
    case ParameterKind::kGroupList:
      return "list of mappings";
  }
  return "";
}

std::string default_of(const ParameterSpec& spec) {
  if (spec.required) return "required";
  if (std::holds_alternative<std::monostate>(spec.default_value)) return "";
  return markdown_code(default_text(spec));
}

void add_rows(const std::vector<ParameterSpec>& specs, const std::string& place,
              std::string& page) {
  for (const ParameterSpec& spec : specs) {
    page += fmt::format("| {} | {} | {} | {} | {} |\n", markdown_code(place + spec.name),
                        markdown_text(spec.unit), default_of(spec), values_of(spec),
                        markdown_text(spec.description));
    const char* inside = spec.kind == ParameterKind::kGroupList ? "[]." : ".";
    add_rows(spec.fields, place + spec.name + inside, page);
  }
}

void add_line(const char* label, const std::string& text, std::string& page) {
  if (!text.empty()) page += fmt::format("- {}: {}\n", label, text);
}

std::string ports_of(const PartSpec& spec) {
  std::string ports;
  for (const ProductPort& port : spec.takes) {
    ports += fmt::format("{}{} ({}{})", ports.empty() ? "" : ", ", markdown_code(port.key),
                         to_string(port.kind), port.required ? "" : ", if given");
  }
  return ports;
}

}  // namespace

std::string parts_page_opening() {
  return "# Parts\n\n"
         "All parts that a scenario can use, with their parameters. `vinerow list --markdown` "
         "prints this page; do not edit it by hand.\n\n"
         "A key without default is absent unless given; \"required\" must be given. `a.b` is the "
         "key `b` of the mapping `a`, `a[].b` is the key `b` of each mapping in the list `a`.\n";
}

std::string kind_heading(PartKind kind) {
  return fmt::format("\n## Kind: {}\n", to_string(kind));
}

std::string part_markdown(const Registry& registry, PartKind kind, const std::string& name) {
  const PartSpec& spec = registry.spec(kind, name);
  std::string page = fmt::format("\n### {} {}\n\n{}\n", to_string(kind), markdown_code(name),
                                 markdown_text(spec.description));
  std::string lines;
  if (spec.default_rate_Hz > 0.0) {
    add_line("default of `rate_Hz`", fmt::format("{}", spec.default_rate_Hz), lines);
  }
  add_line("reads", code_list(spec.reads), lines);
  add_line("writes", code_list(spec.writes), lines);
  add_line("takes", ports_of(spec), lines);
  if (spec.gives) add_line("gives", to_string(*spec.gives), lines);
  if (!spec.results.empty()) {
    lines += fmt::format("- results: {} in [metrics.md](metrics.md)\n", spec.results.size());
  }
  if (!lines.empty()) page += "\n" + lines;
  if (spec.parameters.empty()) return page + "\nNo parameters.\n";
  page += "\n| key | unit | default | values | meaning |\n|---|---|---|---|---|\n";
  add_rows(spec.parameters, "", page);
  return page;
}

std::string parts_page(const Registry& registry) {
  std::string page = parts_page_opening();
  for (const PartKind kind : kAllPartKinds) {
    const std::vector<std::string> names = registry.names(kind);
    if (names.empty()) continue;
    page += kind_heading(kind);
    for (const std::string& name : names) page += part_markdown(registry, kind, name);
  }
  return page;
}

}  // namespace vinerow::tools
