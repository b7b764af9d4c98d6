#pragma once
/// Files of an earlier run in the same folder. They could be mistaken for those of a new one, so
/// they go; a new run that is refused puts them back.

#include <filesystem>
#include <set>

namespace vinerow::run {

/// Names are those that a run and the commands on its log write. Products of jobs are not among
/// them, because other runs may use them. A folder holds a run if it has scenario.resolved.yaml,
/// which a run writes first; in any other folder files of these names are somebody else's, as all
/// others are, and stay.
class EarlierRun {
 public:
  /// Moves the files of a run, if there is one, to a hidden folder in the same place.
  explicit EarlierRun(const std::filesystem::path& folder);
  ~EarlierRun() { remove(); }
  EarlierRun(const EarlierRun&) = delete;
  EarlierRun& operator=(const EarlierRun&) = delete;

  /// Once the new run cannot be refused any more.
  void remove();
  /// What the new run has written, before it starts again.
  void remove_new() const;
  /// In place of the files of the new run.
  void put_back();

 private:
  std::filesystem::path folder_, aside_;
  std::set<std::filesystem::path> of_others_;  ///< relative to the folder
};

}  // namespace vinerow::run
