#include "tools/study/database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cmath>
#include <limits>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"

namespace vinerow::study {

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Statement::Statement(Database& database, const std::string& sql) : database_(database) {
  sqlite3_stmt* made = nullptr;
  const int status = sqlite3_prepare_v2(database.database_.get(), sql.c_str(), -1, &made, nullptr);
  statement_.reset(made);
  if (status != SQLITE_OK) database_.fail(status);
}

Statement& Statement::bind(int place, std::int64_t value) {
  const int status = sqlite3_bind_int64(statement_.get(), place + 1, value);
  if (status != SQLITE_OK) database_.fail(status);
  return *this;
}

Statement& Statement::bind(int place, double value) {
  const int status = sqlite3_bind_double(statement_.get(), place + 1, value);
  if (status != SQLITE_OK) database_.fail(status);
  return *this;
}

Statement& Statement::bind(int place, std::string_view text) {
  const int status = sqlite3_bind_text(statement_.get(), place + 1, text.data(),
                                       static_cast<int>(text.size()), SQLITE_TRANSIENT);
  if (status != SQLITE_OK) database_.fail(status);
  return *this;
}

bool Statement::step() {
  const int status = sqlite3_step(statement_.get());
  if (status == SQLITE_ROW) return true;
  if (status != SQLITE_DONE) database_.fail(status);
  sqlite3_reset(statement_.get());
  return false;
}

void Statement::run() {
  while (step()) {
  }
}

int Statement::columns() const {
  return sqlite3_column_count(statement_.get());
}

std::string Statement::column_name(int place) const {
  return sqlite3_column_name(statement_.get(), place);
}

std::int64_t Statement::integer(int place) const {
  return sqlite3_column_int64(statement_.get(), place);
}

double Statement::number(int place) const {
  if (sqlite3_column_type(statement_.get(), place) == SQLITE_NULL) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return sqlite3_column_double(statement_.get(), place);
}

std::string Statement::text(int place) const {
  const auto* text = sqlite3_column_text(statement_.get(), place);
  if (!text) return "";
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), place));
  return {reinterpret_cast<const char*>(text), size};
}

void Database::Close::operator()(sqlite3* database) const {
  sqlite3_close(database);
}

Database::Database(const std::filesystem::path& file, Mode mode) : file_(file) {
  const int flags = mode == Mode::kRead    ? SQLITE_OPEN_READONLY
                    : mode == Mode::kWrite ? SQLITE_OPEN_READWRITE
                                           : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  sqlite3* opened = nullptr;
  const int status = sqlite3_open_v2(file.c_str(), &opened, flags, nullptr);
  database_.reset(opened);
  if (status != SQLITE_OK) fail(status);
  sqlite3_busy_timeout(opened, 10'000);
  // A run that was killed while it wrote leaves a journal. Who only reads cannot undo what it had
  // begun, who may write does it by reading.
  const char* const look = "SELECT count(*) FROM sqlite_master";
  if (mode == Mode::kRead &&
      sqlite3_exec(opened, look, nullptr, nullptr, nullptr) == SQLITE_READONLY) {
    Database(file, Mode::kWrite).run(look);
  }
}

void Database::run(const std::string& sql) {
  const int status = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (status != SQLITE_OK) fail(status);
}

void Database::fail(int status) const {
  const int kind = status & 0xff;
  if (kind == SQLITE_FULL) {
    throw WriteError(fmt::format("'{}' cannot be written: the disk is full", file_.string()));
  }
  const std::string words = database_ ? sqlite3_errmsg(database_.get()) : sqlite3_errstr(status);
  if (kind == SQLITE_IOERR) {
    throw WriteError(fmt::format("'{}' cannot be written: {}", file_.string(), words));
  }
  const bool is_damaged = kind == SQLITE_NOTADB || kind == SQLITE_CORRUPT;
  throw ConfigError(fmt::format("'{}' cannot be read: {}{}", file_.string(), words,
                                is_damaged ? "; 'vinerow study run --fresh' rebuilds it from "
                                             "the finished cells"
                                           : ""));
}

std::string sql_name(std::string_view name) {
  std::string quoted = "\"";
  for (const char c : name) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + "\"";
}

}  // namespace vinerow::study
