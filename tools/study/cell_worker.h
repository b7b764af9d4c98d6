#pragma once
/// Runs cells and stores their results: the side of a study that may stand on another machine than
/// its driver.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tools/study/cell_runner.h"
#include "tools/study/open_study.h"
#include "tools/study/results.h"
#include "tools/study/study_folder.h"

namespace vinerow::study {

/// Words of the command that starts a worker.
std::vector<std::string> worker_command(const OpenStudy& open, const StudyFolder& folder);

/// Whether a run of this state leaves its files.
bool leaves_files(scenario::KeepRuns keep, CellState state);

/// The result of a cell whose worker could not tell it.
CellResult result_of_end(const EndedCell& ended);

/// Answers a driver: reads "cell identity" lines, runs each and stores its result. Ends with the
/// input.
void serve(const OpenStudy& open, const StudyFolder& folder);

using TellCell = std::function<void(std::size_t cell, const CellResult& result)>;

/// Runs cells in processes of their own, under the budget, and stores their results. What is
/// stored already is not run again.
/// @param jobs  processes at a time, >= 1 @param tell  is called after each cell, as they end
/// @throws WriteError where results cannot be stored
void run_cells(const OpenStudy& open, const StudyFolder& folder,
               const std::vector<std::size_t>& cells, int jobs, const TellCell& tell);

/// Removes what runs that were killed on this machine have left in the folder of kept runs.
void remove_leftovers(const StudyFolder& folder);

}  // namespace vinerow::study
