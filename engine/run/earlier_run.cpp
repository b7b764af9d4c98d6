#include "engine/run/earlier_run.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "engine/core/whole_file.h"

namespace vinerow::run {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFirstFile = "scenario.resolved.yaml";
constexpr const char* kAside = ".earlier_run";

bool is_file_of_run(const fs::path& path) {
  static const fs::path kNames[] = {kFirstFile,    "events.jsonl", "log.mcap",
                                    "report.html", "replay.html",  "summary.json",
                                    "junit.xml",   "profile.csv",  "profile.json"};
  const fs::path folder = path.parent_path(), name = path.filename(), ending = path.extension();
  if (folder == "frames") return ending == ".png";
  if (folder == "canopy") return ending == ".json";
  if (folder == "robot_description") return ending == ".urdf";
  if (folder.parent_path() == "robot_description") return ending == ".dae";
  if (!folder.empty()) return false;
  const std::string stem = name.stem().string();
  const bool of_coverage = stem == "coverage" || stem.starts_with("coverage_");
  if (of_coverage && (ending == ".png" || ending == ".json")) return true;
  return std::any_of(std::begin(kNames), std::end(kNames), [&](const fs::path& known) {
    return name == known || name == temporary_name(known);
  });
}

/// Moves files between folders, makes the folders that this needs, and removes those that it leaves
/// empty. A file that cannot be moved stays.
void move_files(const std::vector<fs::path>& files, const fs::path& from, const fs::path& to) {
  std::error_code ignored;
  for (const fs::path& file : files) {
    fs::create_directories((to / file).parent_path(), ignored);
    fs::rename(from / file, to / file, ignored);
  }
}

void remove_empty_folders(const std::vector<fs::path>& files, const fs::path& folder) {
  std::error_code ignored;
  for (const fs::path& file : files) {
    for (fs::path parent = file.parent_path(); !parent.empty(); parent = parent.parent_path()) {
      if (fs::is_empty(folder / parent, ignored)) fs::remove(folder / parent, ignored);
    }
  }
}

/// Relative to the folder.
std::vector<fs::path> find_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (auto it = fs::recursive_directory_iterator(folder, ignored);
       it != fs::recursive_directory_iterator(); it.increment(ignored)) {
    const fs::path path = it->path().lexically_relative(folder);
    if (it->is_directory(ignored)) {
      // A run writes nothing deeper, and what is there may be large.
      const bool is_known = path == "frames" || path == "canopy" || path == "robot_description" ||
                            path.parent_path() == "robot_description";
      if (!is_known) it.disable_recursion_pending();
      continue;
    }
    if (is_file_of_run(path)) files.push_back(path);
  }
  return files;
}

}  // namespace

EarlierRun::EarlierRun(const fs::path& folder) : folder_(folder), aside_(folder / kAside) {
  remove();  // of a run that was killed
  const std::vector<fs::path> files = find_files(folder);
  std::error_code ignored;
  if (!fs::is_regular_file(folder / kFirstFile, ignored)) {
    of_others_.insert(files.begin(), files.end());
    return;
  }
  move_files(files, folder, aside_);
  remove_empty_folders(files, folder);
}

void EarlierRun::remove() {
  std::error_code ignored;
  fs::remove_all(aside_, ignored);
}

void EarlierRun::remove_new() const {
  std::error_code ignored;
  std::vector<fs::path> files = find_files(folder_);
  std::erase_if(files, [this](const fs::path& file) { return of_others_.contains(file); });
  for (const fs::path& file : files) fs::remove(folder_ / file, ignored);
  remove_empty_folders(files, folder_);
}

void EarlierRun::put_back() {
  remove_new();
  move_files(find_files(aside_), aside_, folder_);
  remove();
}

}  // namespace vinerow::run
