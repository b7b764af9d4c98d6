#pragma once
/// The tables of a study as comma-separated files, the same bytes wherever it was run.

#include <filesystem>
#include <string>
#include <vector>

#include "tools/study/results.h"

namespace vinerow::study {

/// Names of the numbers that the study keeps: those it lists, else all; then derived columns.
std::vector<std::string> kept_numbers(const Results& results);

/// A row for each cell, in the order of cells: cell, setting, seed, factors, state, reason, digest
/// of the run, numbers.
std::string cells_csv(const Results& results);

/// A row for each setting: factors, how many of its cells are finished, met and failed, share that
/// met with its Wilson interval, and of each number count, mean, deviation, median and the t
/// interval of the mean, all at 95 %.
std::string settings_csv(const Results& results);

/// A row for each finished cell: times, memory, machine. Differs from run to run.
std::string costs_csv(const Results& results);

}  // namespace vinerow::study
