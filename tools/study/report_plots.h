#pragma once
/// The plots of a study's page, chosen by what its factors are.

#include <string>

#include "tools/study/results.h"

namespace vinerow::study {

/// Figures of one number: a map over two factors, lines over a numeric one, boxes over a factor of
/// words. "" where nothing was measured.
std::string number_figures(const Results& results, const std::string& name);

/// How often the criteria were met in each setting, with Wilson's interval; "" for one seed.
std::string success_figure(const Results& results);

/// All settings at once, over all factors and numbers; "" with fewer than three axes.
std::string parallel_figure(const Results& results, const std::vector<std::string>& names);

}  // namespace vinerow::study
