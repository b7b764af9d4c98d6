#pragma once
/// Style of the plots of a study, in addition to page_style() of the report.

#include <string>

namespace vinerow::study {

/// Content of <style>, after page_style(); also for plot_files_of().
std::string study_plot_style();

}  // namespace vinerow::study
