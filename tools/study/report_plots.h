#pragma once
/// Plots of a study's page, chosen by the kinds of its factors.

#include <string>

#include "tools/study/results.h"

namespace vinerow::study {

/// Figures of one number: a heat map over two factors, lines over a numeric factor, boxes over a
/// categorical factor. "" if nothing was measured.
std::string number_figures(const Results& results, const std::string& name);

/// Share of runs that met the criteria in each setting, with Wilson intervals; "" for one seed.
std::string success_figure(const Results& results);

/// Parallel plot of all settings over all factors and numbers; "" with fewer than three axes.
std::string parallel_figure(const Results& results, const std::vector<std::string>& names);

}  // namespace vinerow::study
