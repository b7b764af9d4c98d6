#pragma once
/// Sessions with every built-in part: load a scenario, step it, change its commands, read its
/// signals (engine/sim/session.h). Includes the messages of commands, events and motion; those of
/// other signals are in engine/api/messages/.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/motion.h"
#include "engine/sim/session.h"

namespace vinerow {

/// Changes applied to a scenario before it is checked, as on the command line.
struct ScenarioChanges {
  std::vector<std::string> sets;  ///< "rover.controller.lookahead_m=0.5"
  std::optional<std::uint64_t> seed;
};

/// Opens a scenario file, with its plug-ins. @throws ConfigError with "file:line: key = value, ..."
Session open_session(const std::filesystem::path& file, const ScenarioChanges& changes = {},
                     SessionOptions options = {});

/// Opens a scenario text. @param folder  base of its relative paths; its `plugins` are not loaded
Session open_session_text(const std::string& yaml, const std::filesystem::path& folder = ".",
                          const ScenarioChanges& changes = {}, SessionOptions options = {});

}  // namespace vinerow
