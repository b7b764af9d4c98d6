#pragma once
/// Digest of everything that a cell's result depends on: equal digests mean equal results.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/scenario/scenario.h"
#include "tools/study/design.h"

namespace vinerow::study {

/// Digests of files, including the files that they name.
class FileDigests {
 public:
  /// Digest of every file and folder that a text in the tree names, and recursively of those that
  /// they name; "" without any. A text counts as a name if such a file exists.
  std::string of(const io::YamlNode& tree);
  /// Digest of a file with all files that it names, or of all files in a folder.
  std::string of(const std::filesystem::path& path);

 private:
  std::map<std::filesystem::path, std::string> known_;
};

/// Digest of the program: its version, and every byte of it and of the simulation library.
std::string program_digest();

class Identity {
 public:
  /// @param source  source of the study's scenario @param program  result of program_digest()
  Identity(const Design& design, const scenario::ScenarioSource& source,
           const std::string& program);

  /// Digest of a cell: scenario with all files that it names, values set over it, seed, program.
  std::string of(std::size_t cell) const;
  /// Digest of the scenario with all files that it names.
  const std::string& scenario() const { return scenario_; }
  /// Digest of the program, as given.
  const std::string& program() const { return program_; }
  /// Digest of the list of cells: factors, levels, seeds and their order.
  const std::string& design() const { return design_digest_; }
  /// Digest of the whole study: equal digests mean equal cells with equal numbers.
  std::string whole() const;

 private:
  const Design& design_;
  std::string scenario_, program_, common_, design_digest_;
  std::vector<std::vector<std::string>> levels_;  ///< by factor and level
};

}  // namespace vinerow::study
