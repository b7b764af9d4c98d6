#pragma once
/// Which pictures of a data set are for training, validation and test.

#include <vector>

#include "tools/dataset/picture_record.h"
#include "tools/study/design.h"

namespace vinerow::dataset {

/// What a group of cells is called: "run", "seed" or "setting".
const char* group_name(scenario::SplitBy by);

/// Part of each cell. Groups of cells (DatasetConfig::split_by) stay together, so that no picture
/// is tested whose neighbour was trained on. Which groups go where is drawn from a stream of its
/// own: the same in every run. A part with a share gets at least one group, and so does training.
/// @throws ConfigError if there are too few groups for that
std::vector<Split> make_splits(const study::Design& design, const scenario::DatasetConfig& config);

}  // namespace vinerow::dataset
