#pragma once
/// Files of an earlier run in the same folder. They could be mistaken for those of a new one, so
/// they go; a new run that is refused puts them back.

#include <filesystem>
#include <vector>

namespace vinerow::run {

/// Files of a run in a folder, relative to it: those that a run and the commands on its log write
/// there. Empty if the folder does not hold a run, which writes scenario.resolved.yaml first.
/// Products of jobs are not among them, because other runs may use them.
std::vector<std::filesystem::path> find_files_of_run(const std::filesystem::path& folder);

/// Removes them, and folders that they leave empty. Files of others stay.
void remove_run(const std::filesystem::path& folder);

class EarlierRun {
 public:
  /// Moves the files of a run, if there is one, to a hidden folder in the same place.
  explicit EarlierRun(const std::filesystem::path& folder);
  ~EarlierRun() { remove(); }
  EarlierRun(const EarlierRun&) = delete;
  EarlierRun& operator=(const EarlierRun&) = delete;

  /// Once the new run cannot be refused any more.
  void remove();
  /// In place of the files of the new run.
  void put_back();

 private:
  std::filesystem::path folder_, aside_;
};

}  // namespace vinerow::run
