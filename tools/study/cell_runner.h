#pragma once
/// Who runs the cells that a driver names: processes of this machine, or a cluster.

#include <cstddef>
#include <string>
#include <vector>

namespace vinerow::study {

/// How a cell left its runner.
struct EndedCell {
  enum class How {
    kStored,     ///< its result is in its file
    kCrashed,    ///< the process ended
    kOutOfTime,  ///< the budget's
    kOutOfMemory,
    kNotStored  ///< the result could not be stored, or the study has changed: no cell can be run
  };
  std::size_t cell = 0;
  How how = How::kStored;
  std::string words;    ///< why, where it is not kStored
  double wall_s = 0.0;  ///< since it was given
};

/// What goes away ends what it runs.
class CellRunner {
 public:
  virtual ~CellRunner() = default;

  /// Whether a further cell may be given.
  virtual bool has_room() const = 0;
  /// Whether a cell that was given has not ended yet.
  virtual bool is_busy() const = 0;
  /// @pre has_room() @throws WriteError, ConfigError
  virtual void give(std::size_t cell, const std::string& identity) = 0;
  /// Cells that ended since the last call; waits for the first, at most so long.
  /// @throws WriteError, ConfigError
  virtual std::vector<EndedCell> wait(double longest_s) = 0;
  /// What it does now, for people; "" where there is nothing to say.
  virtual std::string status() const { return ""; }
  /// Whether the cells go on without this process, which may end.
  virtual bool is_detached() const { return false; }
};

}  // namespace vinerow::study
