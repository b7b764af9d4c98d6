#pragma once
/// Generated pages of docs/reference: metrics, signals, messages, command line.

#include <CLI/CLI.hpp>
#include <string>

#include "engine/api/registry.h"

namespace vinerow::tools {

/// Each returns a whole page as Markdown.

/// Results of metrics, payloads and jobs, with unit, range, definition and source.
std::string metrics_page(const Registry& registry);
/// Signals that built-in parts write and read.
std::string signals_page(const Registry& registry);
/// Message types with their fields.
std::string messages_page();
/// Every command with its arguments and options. @param app  all commands added
std::string command_line_page(const CLI::App& app);

}  // namespace vinerow::tools
