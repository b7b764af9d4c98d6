#pragma once
/// What a cell's result depends on, as a digest: equal digests, equal results.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/scenario/scenario.h"
#include "tools/study/design.h"

namespace vinerow::study {

/// Digests of files and of what they name.
class FileDigests {
 public:
  /// Of every file and folder that a text in the tree names, and of those that these name in turn;
  /// "" where there is none. A text counts as a name where such a file exists.
  std::string of(const io::YamlNode& tree);
  /// Of one file with all that it names; of a folder, of all files in it.
  std::string of(const std::filesystem::path& path);

 private:
  std::map<std::filesystem::path, std::string> known_;
};

/// Of the program: its version, and every byte of it and of the library that simulates.
std::string program_digest();

class Identity {
 public:
  /// @param source  of the study's scenario @param program  of program_digest()
  Identity(const Design& design, const scenario::ScenarioSource& source,
           const std::string& program);

  /// Digest of a cell: scenario with all files that it names, values set over it, seed, program.
  std::string of(std::size_t cell) const;
  /// Digest of the scenario with all files that it names.
  const std::string& scenario() const { return scenario_; }
  /// As given.
  const std::string& program() const { return program_; }
  /// Digest of the list of cells: factors, levels, seeds and their order.
  const std::string& design() const { return design_digest_; }
  /// Of all of it: equal digests, equal cells under equal numbers.
  std::string whole() const;

 private:
  const Design& design_;
  std::string scenario_, program_, common_, design_digest_;
  std::vector<std::vector<std::string>> levels_;  ///< by factor and level
};

}  // namespace vinerow::study
