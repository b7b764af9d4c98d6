#pragma once
/// Generated pages of docs/reference: metrics, signals, messages, command line.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "engine/api/registry.h"

namespace vinerow::tools {

/// Option or argument of a command as its help shows it.
struct ShownOption {
  std::string name;           ///< "-o,--out", or the name of an argument
  std::string value;          ///< "TEXT"; empty if it takes none
  std::string default_value;  ///< empty if there is none
  std::string description;
  bool is_argument = false;
  bool is_required = false;
};

/// Options and arguments without hidden ones. The help option of the program stands for that of
/// each command.
std::vector<ShownOption> shown_options(const CLI::App& command);

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
