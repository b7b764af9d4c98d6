/// The whole chain at the density of paper A's survey: the cloud of a survey, its map, and the
/// errors of the map. Bounds are the requirements for the map; the figures reached are printed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"
#include "tests/scenarios/command.h"
#include "worlds/mapping/folder/map_folder.h"
#include "worlds/mapping/photogrammetry/cloud_truth.h"

namespace vinerow::cloud_to_map_test {
namespace {

using test::run_vinerow;
using test::scenario_file;
using test::ScratchFolder;

struct Mapped {
  mapping::CloudTruth truth;
  mapping::CloudMap map;
  std::vector<int> row_of;   ///< mapped row of every true one, -1: not found
  double worst_end_m = 0.0;  ///< of the rows found, horizontally
  double worst_bearing_deg = 0.0;
};

Mapped map_of(const std::string& name, const std::string& cloud_arguments) {
  const ScratchFolder folder(name);
  const std::string cloud = (folder.path() / (name + ".las")).string();
  const std::string out = (folder.path() / "map").string();
  const auto command = run_vinerow("cloud " + cloud_arguments + " --out " + cloud);
  if (command.status != 0) throw std::runtime_error(command.output);
  const mapping::CloudTruth truth = mapping::read_cloud_truth(mapping::truth_file_of(cloud));
  const auto mapped = run_vinerow("map " + cloud + " --no-pictures --out " + out);
  if (mapped.status != 0) throw std::runtime_error(mapped.output);
  Mapped result{truth, mapping::load_map(out), {}, 0.0, 0.0};
  for (const mapping::RowTruth& row : truth.rows) {
    // The nearest by both ends; a map may count rows from the other side and other end.
    int best = -1;
    double best_m = 1.0;
    for (const mapping::MappedRowFigures& found : result.map.report.rows) {
      const auto apart = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return (a - b).head<2>().norm();
      };
      const double end_m =
          std::min(std::max(apart(found.first_W, row.first_W), apart(found.last_W, row.last_W)),
                   std::max(apart(found.first_W, row.last_W), apart(found.last_W, row.first_W)));
      if (end_m < best_m) {
        best_m = end_m;
        best = found.row;
      }
    }
    result.row_of.push_back(best);
    if (best < 0) continue;
    result.worst_end_m = std::max(result.worst_end_m, best_m);
    const double off_deg = std::remainder(
        result.map.report.rows[static_cast<std::size_t>(best)].bearing_deg - row.bearing_deg,
        180.0);
    result.worst_bearing_deg = std::max(result.worst_bearing_deg, std::abs(off_deg));
  }
  const mapping::CloudMapReport& report = result.map.report;
  std::printf(
      "%s: %zu rows of %zu, direction %.4f deg (worst row %.4f), spacing %.4f m off, ends %.3f m "
      "at "
      "worst, volume %+.2f %% (seen %+.2f %%), containment %.2f %%, reduction %.2f %%, %.2f MB\n",
      name.c_str(), report.rows.size(), truth.rows.size(), report.bearing_deg - truth.bearing_deg,
      result.worst_bearing_deg, report.spacing_m - truth.spacing_m, result.worst_end_m,
      100.0 * (report.volume_m3 / truth.volume_m3 - 1.0),
      100.0 * (report.seen_volume_m3 / truth.volume_m3 - 1.0), 100.0 * report.containment,
      100.0 * report.reduction, 1e-6 * static_cast<double>(report.mesh_bytes));
  return result;
}

void expect_every_row_once(const Mapped& mapped) {
  std::vector<int> rows = mapped.row_of;
  EXPECT_EQ(std::count(rows.begin(), rows.end(), -1), 0);
  std::sort(rows.begin(), rows.end());
  EXPECT_EQ(std::unique(rows.begin(), rows.end()), rows.end());
  EXPECT_EQ(mapped.map.report.rows.size(), mapped.truth.rows.size());
}

TEST(CloudToMap, ParcelFAtFullDensity) {
  const Mapped mapped = map_of("parcel_f", scenario_file("map_parcel"));
  const mapping::CloudMapReport& report = mapped.map.report;
  EXPECT_GT(report.points, 6'500'000);
  ASSERT_EQ(report.rows.size(), 16u);
  expect_every_row_once(mapped);
  EXPECT_LE(std::abs(report.bearing_deg - mapped.truth.bearing_deg), 0.1);
  EXPECT_LE(mapped.worst_bearing_deg, 0.1);
  EXPECT_LE(std::abs(report.spacing_m - mapped.truth.spacing_m), 0.01);
  EXPECT_LE(mapped.worst_end_m, 0.3);
  EXPECT_LE(std::abs(report.volume_m3 / mapped.truth.volume_m3 - 1.0), 0.05);
  EXPECT_GE(report.containment, 0.98);
  EXPECT_GE(report.reduction, 0.986);
  EXPECT_LE(report.mesh_bytes, 4'000'000);
}

TEST(CloudToMap, CurvedThinNoisyAmongWeedsWithAQuarterOfTheVinesMissing) {
  const Mapped mapped =
      map_of("curved", scenario_file("map_curved") + " --uniform 200 --noise 0.05 --weeds 0.5");
  expect_every_row_once(mapped);
  EXPECT_LE(mapped.worst_end_m, 0.3);
  EXPECT_LE(std::abs(mapped.map.report.spacing_m - mapped.truth.spacing_m), 0.02);
  EXPECT_GE(mapped.map.report.containment, 0.98);
}

TEST(CloudToMap, RiseholmeGivesBackItsRowsAndPitch) {
  const Mapped mapped = map_of("riseholme", scenario_file("map_riseholme"));
  ASSERT_EQ(mapped.truth.rows.size(), 10u);
  expect_every_row_once(mapped);
  EXPECT_NEAR(mapped.map.report.spacing_m, 2.50, 0.01);
  EXPECT_LE(mapped.worst_bearing_deg, 0.3);
  EXPECT_LE(mapped.worst_end_m, 0.3);
}

}  // namespace
}  // namespace vinerow::cloud_to_map_test
