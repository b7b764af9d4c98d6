/// Writes a page with every kind of plot, and the plots as files of their own, for people to look
/// at.
///
/// Usage: study_plots_sample FOLDER

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/tools/study_plots/sample_plots.h"
#include "tools/report/plot_files.h"
#include "tools/study/plots/plot_style.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: study_plots_sample FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  const std::string page = vinerow::study::testing::sample_page();
  bool good = static_cast<bool>(std::ofstream(folder / "sample.html", std::ios::binary) << page);
  for (const auto& file : vinerow::tools::plot_files_of(page, vinerow::study::study_plot_style())) {
    good =
        static_cast<bool>(std::ofstream(folder / file.name, std::ios::binary) << file.svg) && good;
  }
  if (!good) std::fprintf(stderr, "cannot write to %s\n", argv[1]);
  return good ? 0 : 3;
}
