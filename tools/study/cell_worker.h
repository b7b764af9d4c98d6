#pragma once
/// Worker of a study: runs cells and stores their results, possibly on another machine than the
/// driver.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tools/study/cell_runner.h"
#include "tools/study/open_study.h"
#include "tools/study/results.h"
#include "tools/study/study_folder.h"

namespace vinerow::study {

/// Command line that starts a worker.
std::vector<std::string> worker_command(const OpenStudy& open, const StudyFolder& folder);

/// Whether the files of a run in this state are kept.
bool leaves_files(scenario::KeepRuns keep, CellState state);

/// Result of a cell whose worker stored none.
CellResult result_of_end(const EndedCell& ended);

/// Serves a driver: reads lines "cell identity", runs each cell and stores its result, until the
/// input ends.
void serve(const OpenStudy& open, const StudyFolder& folder);

using DescribeCell = std::function<void(std::size_t cell, const CellResult& result)>;

/// Runs cells in separate processes, under the budget, and stores their results. Stored cells do
/// not run again.
/// @param jobs  number of parallel processes, >= 1 @param `report`  called after each cell
/// @throws WriteError if results cannot be stored
void run_cells(const OpenStudy& open, const StudyFolder& folder,
               const std::vector<std::size_t>& cells, int jobs, const DescribeCell& report);

/// Removes unfinished runs of killed processes of this machine from the folder of kept runs.
void remove_leftovers(const StudyFolder& folder);

}  // namespace vinerow::study
