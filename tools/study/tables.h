#pragma once
/// Tables of a study as comma-separated files, with the same bytes wherever it ran.

#include <filesystem>
#include <string>
#include <vector>

#include "tools/study/results.h"

namespace vinerow::study {

/// Names of the numbers that the study keeps: those it lists, otherwise all; then derived columns.
std::vector<std::string> kept_numbers(const Results& results);

/// One row per cell, in order: cell, setting, seed, factors, state, reason, digest of the run,
/// numbers.
std::string cells_csv(const Results& results);

/// One row per setting: factors, numbers of finished, met and failed cells, share that met with its
/// Wilson interval, and for each number its count, mean, deviation, median and the t interval of
/// the mean. Intervals are at 95 %.
std::string settings_csv(const Results& results);

/// One row per finished cell: times, memory, machine. Differs from run to run.
std::string costs_csv(const Results& results);

}  // namespace vinerow::study
