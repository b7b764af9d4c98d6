#pragma once
/// A data set from a study: its cells are run, their cameras' pictures labelled and written.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/dataset/picture_record.h"
#include "tools/study/open_study.h"

namespace vinerow::dataset {

/// A run, for the data card.
struct CellReport {
  std::size_t cell = 0;
  Split split = Split::kTrain;
  std::optional<std::uint64_t> plant_seed;  ///< of DatasetTask
  int pictures = 0;
  std::string failure;  ///< one sentence; "": ran to its end
};

struct DatasetReport {
  std::vector<CellReport> cells;
  std::set<std::pair<std::uint32_t, std::uint32_t>> sizes;  ///< width and height of its pictures
  std::vector<std::string> notes;        ///< parts that are much larger or smaller than their share
  std::map<std::string, int> things[3];  ///< number by class, by Split
  int rows[3] = {0, 0, 0};               ///< rows with an end in the picture
  int pictures(Split split) const;
};

/// Contents of the folder: the guide docs/guides/datasets.md. Cells run side by side; the files
/// have the same bytes on any number of cores. A cell that breaks off gives the pictures until
/// then.
/// @param drawn  is called after each picture with their number so far and the largest possible,
///   from any thread but never by two at once; if it returns false the work ends
/// @returns nullopt if `drawn` ended it; the folder is then absent
/// @throws ConfigError: no `dataset`, an unknown camera, class or format, a camera of depth, a
///   distorting lens for KITTI, no picture at all, a folder that is not empty; WriteError
std::optional<DatasetReport> make_dataset(const study::OpenStudy& open,
                                          const std::filesystem::path& out,
                                          const std::function<bool(int done, int most)>& drawn);

}  // namespace vinerow::dataset
