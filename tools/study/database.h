#pragma once
/// Minimal SQLite wrapper for the store.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace vinerow::study {

class Database;

/// Prepared statement. Parameters and columns are counted from 0.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  Statement& bind(int place, std::int64_t value);
  Statement& bind(int place, double value);  ///< NaN is stored as NULL
  Statement& bind(int place, std::string_view text);
  /// Advances to the next row. @returns whether there is one; if not, the statement is reset
  bool step();
  /// Runs a statement that returns no rows.
  void run();

  int columns() const;
  std::string column_name(int place) const;
  std::int64_t integer(int place) const;
  double number(int place) const;  ///< NaN for NULL
  std::string text(int place) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

class Database {
 public:
  enum class Mode { kRead, kWrite, kCreate };
  /// @throws ConfigError "'x/study.sqlite' cannot be read: file is not a database"
  Database(const std::filesystem::path& file, Mode mode);

  /// @throws WriteError if the disk is full or fails, otherwise ConfigError
  void run(const std::string& sql);
  [[noreturn]] void fail(int status) const;

 private:
  friend class Statement;
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> database_;
};

/// Name quoted for SQL: "\"rover.time_s\"".
std::string sql_name(std::string_view name);

}  // namespace vinerow::study
