#pragma once
/// How the plots of a study look: rules beside those of page_style() of the report.

#include <string>

namespace vinerow::study {

/// Content of <style>, behind page_style(). plot_files_of() takes it, too.
std::string study_plot_style();

}  // namespace vinerow::study
