#include "tools/study/store.h"

#include <fmt/format.h>
#include <unistd.h>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/study/cost_meter.h"

namespace vinerow::study {

namespace fs = std::filesystem;

fs::path CellFiles::file_of(const std::string& identity) const {
  return folder_ / identity.substr(0, 2) / (identity + ".json");
}

std::optional<CellResult> CellFiles::find(const std::string& identity) const {
  const fs::path file = file_of(identity);
  const std::optional<std::string> text = read_bytes(file);
  if (!text) return std::nullopt;
  return cell_result_of(*text, file.string());
}

void CellFiles::put(const std::string& identity, const CellResult& result) const {
  const fs::path file = file_of(identity);
  io::make_folder_of(file);
  // Other processes may write the same cell now: each uses its own temporary name, and the last one
  // replaces an equal file.
  const fs::path mine = fmt::format("{}.{}.{}", file.string(), host_name(), getpid());
  write_whole_file(mine, cell_json(result));
  std::error_code error;
  fs::rename(mine, file, error);
  if (error) throw_cannot_write(fmt::format("'{}'", file.string()), error.value());
}

void CellFiles::remove(const std::string& identity) const {
  std::error_code ignored;
  fs::remove(file_of(identity), ignored);
}

Index::Index(const fs::path& file, const Design& design, const Identity& identity, Access access)
    : file_(file) {
  std::error_code error;
  if (access == Access::kRestart) {
    for (const char* tail : {"", "-journal"}) fs::remove(file.string() + tail, error);
  }
  const bool is_there = fs::exists(file, error);
  database_ = std::make_unique<Database>(file, access == Access::kRead ? Database::Mode::kRead
                                               : is_there              ? Database::Mode::kWrite
                                                                       : Database::Mode::kCreate);
  if (access != Access::kRead) {
    // A power cut may destroy the index, which can be rebuilt from the cells; a killed process does
    // not.
    database_->run("PRAGMA synchronous = OFF");
  }
  if (is_there) {
    check(design, identity);
  } else {
    create(design, identity);
  }
  Statement numbers(*database_, "SELECT * FROM numbers LIMIT 0");
  for (int k = 1; k < numbers.columns(); ++k) columns_[numbers.column_name(k)] = k - 1;
}

void Index::create(const Design& design, const Identity& identity) {
  std::string factors;
  for (const std::string& column : design.columns()) {
    factors += fmt::format(", {} NUMERIC", sql_name("factor." + column));
  }
  begin();
  database_->run("CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID");
  database_->run(
      fmt::format("CREATE TABLE cells (cell INTEGER PRIMARY KEY, setting INTEGER, seed "
                  "INTEGER{}, state TEXT, reason TEXT, digest TEXT, identity TEXT)",
                  factors));
  database_->run("CREATE TABLE numbers (cell INTEGER PRIMARY KEY)");
  database_->run(
      "CREATE TABLE costs (cell INTEGER PRIMARY KEY, wall_s REAL, cpu_s REAL, peak_MB "
      "REAL, host TEXT)");
  Statement meta(*database_, "INSERT INTO study VALUES (?, ?)");
  const std::pair<const char*, std::string> facts[] = {
      {"format", "1"},
      {"name", design.study().name},
      {"scenario_file", design.study().scenario.string()},
      {"scenario", identity.scenario()},
      {"design", identity.design()},
      {"program", identity.program()}};
  for (const auto& [key, value] : facts) meta.bind(0, key).bind(1, value).run();

  std::string marks = "?, ?, ?";
  for (std::size_t k = 0; k < design.columns().size(); ++k) marks += ", ?";
  Statement insert(*database_,
                   fmt::format("INSERT INTO cells VALUES ({}, 'waiting', '', '', ?)", marks));
  std::vector<std::string> texts;
  for (std::size_t cell = 0; cell < design.cells(); ++cell) {
    const std::size_t setting = design.setting_of(cell);
    if (cell % design.seeds() == 0) texts = design.texts(setting);
    int place = 0;
    insert.bind(place++, static_cast<std::int64_t>(cell));
    insert.bind(place++, static_cast<std::int64_t>(setting));
    insert.bind(place++, static_cast<std::int64_t>(design.seed_of(cell)));
    for (const std::string& text : texts) insert.bind(place++, text);
    insert.bind(place, identity.of(cell)).run();
  }
  commit();
}

std::string Index::meta(const std::string& key) {
  Statement select(*database_, "SELECT value FROM study WHERE key = ?");
  select.bind(0, key);
  return select.step() ? select.text(0) : "";
}

void Index::check(const Design& design, const Identity& identity) {
  const std::string file = file_.string();
  const std::string name = meta("name");
  if (name.empty()) throw ConfigError(fmt::format("'{}' is not the index of a study", file));
  if (name != design.study().name) {
    throw ConfigError(
        fmt::format("'{}' belongs to another study, '{}'; give another --out", file, name));
  }
  const char* changed = meta("scenario") != identity.scenario() ? "the scenario or a file it names"
                        : meta("design") != identity.design()   ? "the study's list of cells"
                        : meta("program") != identity.program() ? "the program"
                                                                : nullptr;
  if (!changed) return;
  throw ConfigError(
      fmt::format("'{}': {} has changed since; 'vinerow study run --fresh' starts a new index and "
                  "reuses the cells that the change does not affect",
                  file, changed));
}

void Index::load(Results& results) {
  Statement cells(
      *database_,
      "SELECT cells.cell, state, reason, digest, wall_s, cpu_s, peak_MB, host FROM cells "
      "LEFT JOIN costs USING (cell) WHERE state <> 'waiting' ORDER BY cells.cell");
  Statement numbers(*database_, "SELECT * FROM numbers ORDER BY cell");
  bool has_numbers = numbers.step();
  std::vector<std::string> names;
  for (int k = 1; k < numbers.columns(); ++k) names.push_back(numbers.column_name(k));
  const auto count = static_cast<std::int64_t>(results.design().cells());
  while (cells.step()) {
    const std::int64_t cell = cells.integer(0);
    if (cell < 0 || cell >= count) {
      throw ConfigError(
          fmt::format("'{}' has a cell {}, the study has {}", file_.string(), cell, count));
    }
    CellResult result;
    result.state = cell_state_of(cells.text(1));
    result.reason = cells.text(2);
    result.digest = cells.text(3);
    result.cost = {cells.number(4), cells.number(5), cells.number(6), cells.text(7)};
    while (has_numbers && numbers.integer(0) < cell) has_numbers = numbers.step();
    if (has_numbers && numbers.integer(0) == cell) {
      for (int k = 1; k < numbers.columns(); ++k) {
        result.values[names[static_cast<std::size_t>(k - 1)]] = numbers.number(k);
      }
    }
    results.put(static_cast<std::size_t>(cell), result);
  }
}

void Index::begin() {
  if (!in_transaction_) database_->run("BEGIN");
  in_transaction_ = true;
}

void Index::demand_columns(const CellResult& result) {
  for (const auto& [name, value] : result.values) {
    const auto [place, is_new] = columns_.emplace(name, static_cast<int>(columns_.size()));
    if (is_new) database_->run("ALTER TABLE numbers ADD COLUMN " + sql_name(name) + " REAL");
  }
}

/// Prepared statement, cached: preparing takes longer than running.
Statement& Index::statement(const std::string& sql) {
  std::unique_ptr<Statement>& known = statements_[sql];
  if (!known) known = std::make_unique<Statement>(*database_, sql);
  return *known;
}

void Index::put(std::size_t cell, const CellResult& result) {
  begin();
  demand_columns(result);
  const auto number = static_cast<std::int64_t>(cell);
  statement("UPDATE cells SET state = ?, reason = ?, digest = ? WHERE cell = ?")
      .bind(0, std::string_view(to_string(result.state)))
      .bind(1, result.reason)
      .bind(2, result.digest)
      .bind(3, number)
      .run();
  std::string names = "cell", marks = "?";
  for (const auto& [name, value] : result.values) {
    names += ", " + sql_name(name);
    marks += ", ?";
  }
  Statement& insert =
      statement(fmt::format("INSERT OR REPLACE INTO numbers ({}) VALUES ({})", names, marks));
  insert.bind(0, number);
  int place = 1;
  for (const auto& [name, value] : result.values) insert.bind(place++, value);
  insert.run();
  statement("INSERT OR REPLACE INTO costs VALUES (?, ?, ?, ?, ?)")
      .bind(0, number)
      .bind(1, result.cost.wall_s)
      .bind(2, result.cost.cpu_s)
      .bind(3, result.cost.peak_MB)
      .bind(4, result.cost.host)
      .run();
}

void Index::commit() {
  if (in_transaction_) database_->run("COMMIT");
  in_transaction_ = false;
}

}  // namespace vinerow::study
