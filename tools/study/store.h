#pragma once
/// A study's folder: the finished cells, a file each, and the index study.sqlite.
///
/// The cells are the truth: `cells/ab/abcd....json`, named after the cell's identity and written by
/// rename, so that a cell that ran twice is harmless and any number of machines may write side by
/// side. The index belongs to one driver at a time and can be made anew from the cells.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "tools/study/database.h"
#include "tools/study/identity.h"
#include "tools/study/results.h"

namespace vinerow::study {

/// The finished cells of one or several studies.
class CellFiles {
 public:
  explicit CellFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::filesystem::path file_of(const std::string& identity) const;
  /// @throws ConfigError where the file is damaged
  std::optional<CellResult> find(const std::string& identity) const;
  /// @throws WriteError, ConfigError
  void put(const std::string& identity, const CellResult& result) const;
  void remove(const std::string& identity) const;

 private:
  std::filesystem::path folder_;
};

/// The index of a study: tables `study` (what it is of), `cells` (factors, seed, state, reason),
/// `numbers` (a column for each) and `costs` (times and memory, which differ from run to run).
class Index {
 public:
  enum class Access {
    kRead,   ///< must be there
    kWrite,  ///< is made, with all cells waiting, where it is not there
    kAnew    ///< is made whether it is there or not
  };
  /// @throws ConfigError where the index is of another study, scenario or list of cells, or cannot
  ///   be read
  Index(const std::filesystem::path& file, const Design& design, const Identity& identity,
        Access access);

  /// Puts the cells that are not waiting into `results`.
  void load(Results& results);
  void put(std::size_t cell, const CellResult& result);
  /// Ends the transaction that put() began. @throws WriteError
  void commit();

 private:
  void create(const Design& design, const Identity& identity);
  void check(const Design& design, const Identity& identity);
  std::string meta(const std::string& key);
  void begin();
  void demand_columns(const CellResult& result);
  Statement& statement(const std::string& sql);

  std::filesystem::path file_;
  std::unique_ptr<Database> database_;
  std::map<std::string, std::unique_ptr<Statement>> statements_;  ///< prepared, by their text
  bool in_transaction_ = false;
  std::map<std::string, int> columns_;  ///< of `numbers`, from 0 after the cell
};

}  // namespace vinerow::study
