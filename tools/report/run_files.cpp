#include "tools/report/run_files.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/profile.h"
#include "engine/core/whole_file.h"
#include "tools/pictures/coverage_picture_files.h"
#include "tools/pictures/map_picture_files.h"
#include "tools/report/report.h"

namespace vinerow::tools {

void write_further_files(const scenario::Scenario& scenario, const Registry& registry,
                         const run::RunResult& result, const FurtherFiles& wanted) {
  const auto try_to_write = [&](const char* what, const char* kind, const auto& write) {
    const ProfileSpan span(what, "results");
    try {
      const std::vector<std::filesystem::path> files = write();
      if (wanted.written) wanted.written(kind, files);
    } catch (const WriteError& error) {
      if (wanted.missing) wanted.missing(fmt::format("no {}: {}", what, error.what()), true);
    } catch (const ConfigError& error) {
      if (wanted.missing) wanted.missing(fmt::format("no {}: {}", what, error.what()), false);
    }
  };
  if (wanted.coverage_and_maps) {
    // Ground covered by the vehicles' pictures, and maps made by jobs.
    try_to_write("coverage", "coverage", [&] {
      playback::CoverageChoice choice;
      choice.shelf = wanted.shelf;
      return write_coverage(wanted.out / "log.mcap", registry, choice, wanted.out / "coverage.png");
    });
    try_to_write("pictures of maps", "map", [&] { return write_job_pictures(scenario, result); });
  }
  if (wanted.report) {
    try_to_write("report", "report", [&] {
      const std::filesystem::path report = wanted.out / "report.html";
      write_report(wanted.out, registry, report, wanted.report_progress, wanted.shelf.get());
      return std::vector{report};
    });
  }
}

}  // namespace vinerow::tools
