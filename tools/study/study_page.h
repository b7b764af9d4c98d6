#pragma once
/// The page of a study: what failed, plots, effects, a table of settings. It stands alone, and a
/// click on a part of a plot shows the command that repeats its run.

#include <string>
#include <vector>

#include "tools/study/open_study.h"
#include "tools/study/results.h"

namespace vinerow::study {

/// Numbers that are drawn: those that the study lists, else those that the scenario's criteria are
/// on, then derived columns; at most eight.
std::vector<std::string> drawn_numbers(const OpenStudy& open, const Results& results);

/// HTML that is XML, too.
std::string study_page(const OpenStudy& open, const Results& results);

}  // namespace vinerow::study
