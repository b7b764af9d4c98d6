#pragma once
/// Storage of a study: one file per finished cell, and the index study.sqlite.
///
/// The cell files are authoritative: `cells/ab/abcd....json`, named after the cell's identity and
/// written by rename, so that a cell may run twice and any number of machines may write at the same
/// time. The index belongs to one driver at a time and can be rebuilt from the cells.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "tools/study/database.h"
#include "tools/study/identity.h"
#include "tools/study/results.h"

namespace vinerow::study {

/// Finished cells of one or several studies.
class CellFiles {
 public:
  explicit CellFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::filesystem::path file_of(const std::string& identity) const;
  /// @throws ConfigError if the file is damaged
  std::optional<CellResult> find(const std::string& identity) const;
  /// @throws WriteError, ConfigError
  void put(const std::string& identity, const CellResult& result) const;
  void remove(const std::string& identity) const;

 private:
  std::filesystem::path folder_;
};

/// Index of a study: tables `study` (identity), `cells` (factors, seed, state, reason), `numbers`
/// (a column per number) and `costs` (times and memory, which differ from run to run).
class Index {
 public:
  enum class Access {
    kRead,    ///< must exist
    kWrite,   ///< is created, with all cells waiting, if it does not exist
    kRestart  ///< is created in any case
  };
  /// @throws ConfigError if the index belongs to another study, scenario or list of cells, or
  /// cannot
  ///   be read
  Index(const std::filesystem::path& file, const Design& design, const Identity& identity,
        Access access);

  /// Loads all cells except waiting ones into `results`.
  void load(Results& results);
  void put(std::size_t cell, const CellResult& result);
  /// Ends the transaction that put() started. @throws WriteError
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
  std::map<std::string, std::unique_ptr<Statement>> statements_;  ///< prepared statements by text
  bool in_transaction_ = false;
  std::map<std::string, int> columns_;  ///< columns of `numbers`, from 0 after the cell
};

}  // namespace vinerow::study
