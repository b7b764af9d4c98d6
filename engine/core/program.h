#pragma once
/// Other programs as processes of their own.

#include <string>
#include <vector>

namespace vinerow {

/// Whether a program of that name stands in a folder of PATH.
bool has_program(const char* name);

struct ProgramOutput {
  bool succeeded = false;  ///< it ended with status 0
  std::string output;      ///< what it wrote to its standard output
  std::string complaint;   ///< the last line of its standard error that is not blank
};

/// Runs a program of PATH to its end, without input. @param words  its name and its arguments
/// @throws WriteError where it does not start
ProgramOutput run_program(std::vector<std::string> words);

}  // namespace vinerow
