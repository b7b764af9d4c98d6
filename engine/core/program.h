#pragma once
/// External programs as child processes.

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace vinerow {

/// True if a folder of PATH contains a program of that name.
bool has_program(const char* name);

struct ProgramOutput {
  bool succeeded = false;  ///< it ended with status 0
  std::string output;      ///< its standard output
  std::string complaint;   ///< the last line of its standard error that is not blank
};

/// Runs a program of PATH to its end, without input.
/// @param words  program name and arguments
/// @throws WriteError if it does not start
ProgramOutput run_program(std::vector<std::string> words);

/// Content of an open file from its start.
std::string read_from_start(std::FILE* file);

/// Last line of a text that is not blank; "" if all are.
std::string last_line_of(std::string_view text);

}  // namespace vinerow
