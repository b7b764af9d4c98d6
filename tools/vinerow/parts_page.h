#pragma once
/// The page docs/reference/parts.md: every part with its parameters, as Markdown.

#include <string>

#include "engine/api/registry.h"

namespace vinerow::tools {

/// Title, and how the tables are read.
std::string parts_page_opening();

std::string kind_heading(PartKind kind);

/// Heading "world vineyard", description, signals, and a table of the parameters. Keys of groups
/// follow their group: `gusts[].at_s` of a list, `motor.torque_Nm` of one mapping.
/// @pre the registry has the part
std::string part_markdown(const Registry& registry, PartKind kind, const std::string& name);

}  // namespace vinerow::tools
