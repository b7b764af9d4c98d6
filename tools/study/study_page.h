#pragma once
/// Report page of a study: outcome, plots, effects, a table of settings. It is self-contained, and
/// a click on a mark in a plot shows the command that repeats its run.

#include <string>
#include <vector>

#include "tools/study/open_study.h"
#include "tools/study/results.h"

namespace vinerow::study {

/// Numbers to draw: those that the study lists, otherwise those with a criterion in the scenario,
/// then derived columns; at most eight.
std::vector<std::string> drawn_numbers(const OpenStudy& open, const Results& results);

/// The page as HTML that is well-formed XML too.
std::string study_page(const OpenStudy& open, const Results& results);

}  // namespace vinerow::study
