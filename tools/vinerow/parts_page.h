#pragma once
/// The page docs/reference/parts.md: every part with its parameters, as Markdown.

#include <string>

#include "engine/api/registry.h"

namespace vinerow::tools {

/// Title, and how to read the tables.
std::string parts_page_opening();

std::string kind_heading(PartKind kind);

/// Section of one part: heading "world vineyard", description, signals, and a parameter table. Keys
/// of groups follow their group: `gusts[].at_s` in a list, `motor.torque_Nm` in a mapping.
/// @pre the registry has the part
std::string part_markdown(const Registry& registry, PartKind kind, const std::string& name);

/// The whole page.
std::string parts_page(const Registry& registry);

}  // namespace vinerow::tools
