#pragma once
/// Interface of the runners of cells: processes on this machine, or a cluster.

#include <cstddef>
#include <string>
#include <vector>

namespace vinerow::study {

/// Cell that a runner has ended.
struct EndedCell {
  enum class How {
    kStored,     ///< its result is in its file
    kCrashed,    ///< the process ended
    kOutOfTime,  ///< it exceeded the time budget
    kOutOfMemory,
    kNotStored  ///< the result could not be stored, or the study has changed: no cell can run
  };
  std::size_t cell = 0;
  How how = How::kStored;
  std::string words;    ///< reason unless kStored
  double wall_s = 0.0;  ///< time since it was given
};

/// Longest line of a program's output in a reason, bytes.
inline constexpr std::size_t kLongestLine = 300;

/// Runs cells. The destructor ends running cells.
class CellRunner {
 public:
  virtual ~CellRunner() = default;

  /// Whether another cell can be given.
  virtual bool has_free_slot() const = 0;
  /// Whether a given cell has not ended yet.
  virtual bool is_busy() const = 0;
  /// @pre has_free_slot() @throws WriteError, ConfigError
  virtual void give(std::size_t cell, const std::string& identity) = 0;
  /// Cells that ended since the last call; waits for the first for at most `longest_s`.
  /// @throws WriteError, ConfigError
  virtual std::vector<EndedCell> wait(double longest_s) = 0;
  /// Current activity for people; may be "".
  virtual std::string status() const { return ""; }
  /// Whether the cells continue without this process, which may end.
  virtual bool is_detached() const { return false; }
};

}  // namespace vinerow::study
