/// The jobs that make a cloud and a map: same products as the commands, and their reports.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/api/messages/sensors.h"
#include "engine/io/clouds/point_cloud.h"
#include "engine/physics/world_scene.h"
#include "engine/record/log_reader.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/simulation.h"
#include "tests/worlds/mapping/jobs/job_fixture.h"
#include "worlds/mapping/folder/map_folder.h"
#include "worlds/mapping/folder/map_points.h"
#include "worlds/mapping/jobs/cloud_map_type.h"
#include "worlds/mapping/model/parcel_cloud.h"
#include "worlds/mapping/photogrammetry/cloud_truth.h"

namespace vinerow::mapping_jobs_test {
namespace {

using test::job_parameters;
using test::read_text;
using test::run_vinerow;
using test::ScratchFolder;

std::vector<io::CloudPoint> read_points(const std::filesystem::path& file) {
  const auto reader = io::open_point_cloud(file);
  std::vector<io::CloudPoint> points(*reader->info().record_count);
  points.resize(reader->read(points));
  return points;
}

/// A survey of a few rows of Parcel F, flown by the command, and its world.
class FlownSurvey : public ::testing::Test {
 protected:
  FlownSurvey() {
    const std::string scenario =
        folder_.file("survey.yaml", "include: " + test::scenario_file("map_parcel") +
                                        "\nname: survey\nworld: {row_count: 4, row_length_m: "
                                        "40}\n");
    const auto flown =
        run_vinerow("run " + scenario + " --quiet --out " + (folder_.path() / "run").string());
    if (flown.status != 0) throw std::runtime_error(flown.output);
    scenario_ = scenario;
    world_ = build_world(scenario::load_scenario(scenario, test::all_parts()), test::all_parts());
    scene_ = std::make_unique<physics::WorldScene>(*world_);
  }
  JobContext context(const std::string& name) const {
    JobContext context = test::job_context(folder_.path() / name);
    context.world = world_.get();
    context.scene = scene_.get();
    return context;
  }
  std::shared_ptr<const PictureSet> flown_pictures() const {
    auto pictures = std::make_shared<PictureSet>();
    const scenario::Scenario scenario = scenario::load_scenario(scenario_, test::all_parts());
    for (const scenario::NamedPart& sensor : scenario.vehicles.at(0).sensors) {
      if (sensor.name == "camera") pictures->camera = read_survey_camera(sensor.part.parameters);
    }
    const record::LogReader log(folder_.path() / "run" / "log.mcap");
    std::map<std::int64_t, Eigen::Vector3d> estimates;
    log.read<Odometry>("/plane/estimate", [&](Time t, const Odometry& estimate) {
      estimates[t.ns] = estimate.X_WB.p;
    });
    log.read<CameraShot>("/plane/camera", [&](Time t, const CameraShot& shot) {
      if (shot.index < 0) return;
      pictures->X_WS.push_back(shot.X_WS);
      // The camera sits at the origin of the body and shoots when an estimate is logged.
      pictures->estimated_W.push_back(estimates.at(t.ns));
    });
    return pictures;
  }
  std::string parcel_csv() const {
    std::string text;
    for (const Eigen::Vector2d& p : world_->rows->boundary_W) {
      text += fmt::format("{},{}\n", p.x(), p.y());
    }
    return folder_.file("parcel.csv", text);
  }

  const ScratchFolder folder_{"flown_survey"};
  std::string scenario_;
  std::unique_ptr<WorldModel> world_;
  std::unique_ptr<physics::WorldScene> scene_;
};

TEST_F(FlownSurvey, TheCloudLiesWhereTheAutopilotThoughtItFlew) {
  const auto cloud_by = [&](const std::string& means) {
    ParameterSet parameters = test::thin_photogrammetry();
    parameters.set("georeference", means).set("match_noise_px", 0.0);
    const auto made = test::all_parts()
                          .make_job("photogrammetry", parameters, context(means))
                          ->run(test::pictures_input(flown_pictures()));
    EXPECT_TRUE(made) << made.reason();
    return *made;
  };
  const JobOutcome exact = cloud_by("truth"), direct = cloud_by("direct"),
                   marked = cloud_by("control_points");
  std::printf("direct: %.1f mm off, %.1f mm up; control points: %.1f mm, %.1f mm\n",
              1e3 * direct.numbers.at("georeference_shift_m"),
              1e3 * direct.numbers.at("georeference_height_m"),
              1e3 * marked.numbers.at("georeference_shift_m"),
              1e3 * marked.numbers.at("georeference_height_m"));
  EXPECT_EQ(exact.numbers.at("georeference_shift_m"), 0.0);
  // Centimetres, as RTK is: neither nothing nor decimetres.
  EXPECT_GT(direct.numbers.at("georeference_shift_m"), 5e-4);
  EXPECT_LT(direct.numbers.at("georeference_shift_m"), 0.06);
  EXPECT_LT(std::abs(direct.numbers.at("georeference_height_m")), 0.10);
  EXPECT_LT(marked.numbers.at("georeference_shift_m"), 0.02);
  // All points moved by what the numbers say: the means of the clouds differ by it.
  const auto truth = read_points(exact.product.file), moved = read_points(direct.product.file);
  ASSERT_EQ(truth.size(), moved.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    mean += (moved[i].position - truth[i].position) / static_cast<double>(truth.size());
  }
  EXPECT_NEAR(mean.head<2>().norm(), direct.numbers.at("georeference_shift_m"), 0.005);
  EXPECT_NEAR(mean.z(), direct.numbers.at("georeference_height_m"), 0.005);
}

TEST_F(FlownSurvey, JobsMakeTheBytesThatTheCommandsMake) {
  const std::string cloud = (folder_.path() / "cloud.las").string();
  const auto sampled = run_vinerow("cloud " + scenario_ + " --density 150 --log " +
                                   (folder_.path() / "run").string() + " --out " + cloud);
  ASSERT_EQ(sampled.status, 0) << sampled.output;
  const auto made = test::all_parts()
                        .make_job("photogrammetry", test::thin_photogrammetry(), context("cloud"))
                        ->run(test::pictures_input(flown_pictures()));
  ASSERT_TRUE(made) << made.reason();
  EXPECT_TRUE(read_text(made->product.file) == read_text(cloud));
  const mapping::CloudTruth own =
      mapping::read_cloud_truth(mapping::truth_file_of(made->product.file));
  const mapping::CloudTruth theirs = mapping::read_cloud_truth(mapping::truth_file_of(cloud));
  EXPECT_EQ(own.volume_m3, theirs.volume_m3);
  EXPECT_EQ(own.sampling.density_per_m2, theirs.sampling.density_per_m2);
  EXPECT_EQ(made->numbers.at("points"), static_cast<double>(theirs.sampling.points));
  EXPECT_EQ(made->numbers.at("pictures"), theirs.sampling.pictures);
  EXPECT_EQ(made->numbers.at("height_noise_m"), theirs.sampling.height_noise_rms_m);

  // With the parcel that the operator knows, and without.
  for (const char* boundary : {"parcel", "none"}) {
    SCOPED_TRACE(boundary);
    const std::string out = (folder_.path() / boundary).string();
    const auto mapped =
        run_vinerow("map " + cloud + " --no-pictures --scenario " + scenario_ + " --out " + out +
                    (std::string(boundary) == "parcel" ? " --boundary " + parcel_csv() : ""));
    ASSERT_EQ(mapped.status, 0) << mapped.output;
    ParameterSet parameters = job_parameters("cloud_map");
    parameters.set("boundary", std::string(boundary));
    const std::string name = std::string("job_") + boundary;
    const auto map = test::all_parts()
                         .make_job("cloud_map", parameters, context(name))
                         ->run({{"cloud", made->product}});
    ASSERT_TRUE(map) << map.reason();
    auto expected = test::files_in(out);
    expected.erase("report.html");
    expected.erase("timing.json");
    auto files = test::files_in(folder_.path() / name);
    // What each point is the job alone keeps: pictures are drawn from it after the run.
    EXPECT_EQ(files.erase("points.json") + files.erase("points.classes"), 2u);
    EXPECT_EQ(files.size(), expected.size());
    for (const auto& [file, bytes] : expected) {
      EXPECT_TRUE(files.count(file) == 1 && files.at(file) == bytes) << file << " differs";
    }
    EXPECT_EQ(map->numbers.at("rows"), 4.0);
    EXPECT_EQ(map->numbers.at("rows_found"), 4.0);
    EXPECT_EQ(map->numbers.at("rows_true"), 4.0);
    EXPECT_LT(std::abs(map->numbers.at("direction_error_deg")), 0.2);
    // Sections are cut every decimetre or so: no row's end is found to the millimetre.
    EXPECT_LT(map->numbers.at("end_error_max_m"), 0.3);
    EXPECT_GT(map->numbers.at("end_error_max_m"), 0.002);
  }
}

bool same_lines(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  return a == b;
}

TEST(CloudMapJob, GivesTheMapThatItsFolderHoldsForVehicles) {
  const ScratchFolder folder("cloud_map_job");
  const auto made = test::run_job("cloud_map", job_parameters("cloud_map"), folder.path() / "map",
                                  {{"cloud", test::make_cloud(folder.path() / "cloud")}});
  ASSERT_TRUE(made) << made.reason();
  EXPECT_EQ(made->product.file, folder.path() / "map");
  const auto points = mapping::load_map_points(made->product.file);
  ASSERT_TRUE(points);
  const mapping::ParcelCloud cloud =
      mapping::read_classified_cloud(*points, folder.path() / "cloud" / "cloud.las");
  const mapping::CloudMapReport report = mapping::load_map(made->product.file).report;
  EXPECT_EQ(std::count(cloud.classes.begin(), cloud.classes.end(), mapping::PointClass::kCanopy),
            report.canopy_points);
  EXPECT_EQ(std::ssize(cloud.classes), report.points);
  ParameterSet of_folder = test::map_parameters("cloud_map");
  of_folder.set("folder", made->product.file.string());
  const auto loaded =
      mapping::make_map_of_folder(of_folder, test::surveyed_world("vineyard").context());
  const RowMap& map = *made->product.map;
  ASSERT_EQ(map.rows.size(), loaded->rows.size());
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    EXPECT_EQ(map.rows[r].id, loaded->rows[r].id);
    EXPECT_TRUE(same_lines(map.rows[r].line_W, loaded->rows[r].line_W));
    EXPECT_EQ(map.rows[r].canopy_width_m, loaded->rows[r].canopy_width_m);
  }
  ASSERT_EQ(map.alleys.size(), loaded->alleys.size());
  for (std::size_t a = 0; a < map.alleys.size(); ++a) {
    EXPECT_TRUE(same_lines(map.alleys[a].line_W, loaded->alleys[a].line_W));
  }
  EXPECT_EQ(map.boundary_W, loaded->boundary_W);
  EXPECT_EQ(map.occupancy.cells, loaded->occupancy.cells);
  EXPECT_EQ(map.occupancy.corner_W, loaded->occupancy.corner_W);
  EXPECT_EQ(map.terrain->heights_m, loaded->terrain->heights_m);
  EXPECT_EQ(map.accuracy.surface_std_m, loaded->accuracy.surface_std_m);
  ASSERT_EQ(map.meshes.size(), loaded->meshes.size());
  for (std::size_t m = 0; m < map.meshes.size(); ++m) {
    EXPECT_EQ(map.meshes[m].mesh_W.vertices, loaded->meshes[m].mesh_W.vertices);
  }
  // Alleys as the world counts them, so that a mission may name them before the map is there.
  const std::vector<Alley>& alleys = test::surveyed_world("vineyard").model->rows->alleys;
  ASSERT_EQ(map.alleys.size(), alleys.size());
  for (std::size_t a = 0; a < alleys.size(); ++a) {
    EXPECT_LT((map.alleys[a].line_W.front() - alleys[a].line_W.front()).head<2>().norm(), 1.0);
  }
}

TEST(PhotogrammetryJob, MissingRowsLackTheirCanopyAndNothingElseChanges) {
  const ScratchFolder folder("missing_rows");
  ParameterSet parameters = test::thin_photogrammetry();
  parameters.set("truth_classes", true);
  const auto all = read_points(test::make_cloud(folder.path() / "all", parameters).file);
  parameters.set("missing_rows", std::vector<double>{2, 0});
  const auto left = read_points(test::make_cloud(folder.path() / "left", parameters).file);

  const std::vector<PlantRow>& rows = test::surveyed_world("vineyard").model->rows->rows;
  const auto row_of = [&](const Eigen::Vector3d& p) {
    std::size_t nearest = 0;
    double nearest_m = 1e9;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Eigen::Vector2d a = rows[r].line_W.front().head<2>();
      const Eigen::Vector2d d = (rows[r].line_W.back().head<2>() - a).normalized();
      const Eigen::Vector2d off = p.head<2>() - a;
      const double here_m = std::abs(d.x() * off.y() - d.y() * off.x());
      if (here_m < nearest_m) nearest_m = here_m, nearest = r;
    }
    return nearest;
  };
  std::vector<const io::CloudPoint*> expected;
  std::size_t canopy_of[4] = {0, 0, 0, 0};
  for (const io::CloudPoint& point : all) {
    const bool canopy = point.classification == static_cast<int>(mapping::PointClass::kCanopy);
    const std::size_t row = row_of(point.position);
    if (canopy) ++canopy_of[row];
    if (!canopy || (row != 0 && row != 2)) expected.push_back(&point);
  }
  for (const std::size_t count : canopy_of) EXPECT_GT(count, 500u);
  ASSERT_EQ(left.size(), expected.size());
  for (std::size_t k = 0; k < left.size(); ++k) {
    ASSERT_EQ(left[k].position, expected[k]->position) << k;
    ASSERT_EQ(left[k].rgb, expected[k]->rgb) << k;
  }
}

TEST(CloudMapJob, TellsThatARowIsMissing) {
  const ScratchFolder folder("row_missing");
  ParameterSet parameters = test::thin_photogrammetry();
  parameters.set("missing_rows", std::vector<double>{3});
  const auto made = test::run_job("cloud_map", job_parameters("cloud_map"), folder.path() / "map",
                                  {{"cloud", test::make_cloud(folder.path() / "c", parameters)}});
  ASSERT_TRUE(made) << made.reason();
  EXPECT_EQ(made->numbers.at("rows_found"), 3.0);
  EXPECT_EQ(made->numbers.at("rows_true"), 4.0);
  EXPECT_EQ(made->numbers.at("rows"), 3.0);
  EXPECT_EQ(made->numbers.at("rows_extra"), 0.0);
}

TEST(PlanJob, PlansForItsVehicleOnTheMapThatItIsGiven) {
  const ScratchFolder folder("plan_job");
  JobContext context = test::job_context(folder.path());
  std::string requested;
  std::shared_ptr<const RowMap> on;
  context.plan = [&](const std::string& vehicle, std::shared_ptr<const RowMap> map) {
    requested = vehicle;
    on = std::move(map);
    return test::plan_for(vehicle, nullptr);
  };
  ParameterSet parameters = job_parameters("plan");
  parameters.set("vehicle", std::string("rover"));
  const auto job = test::all_parts().make_job("plan", parameters, context);
  const auto own = job->run({});
  ASSERT_TRUE(own) << own.reason();
  EXPECT_EQ(requested, "rover");
  EXPECT_EQ(on, nullptr) << "the map that it has without the job";
  EXPECT_EQ(own->numbers, (std::map<std::string, double>{{"length_m", 2.0}, {"points", 3.0}}));
  EXPECT_EQ(own->product.plan->points.size(), 3u);

  Product map;
  map.map = std::make_shared<RowMap>();
  ASSERT_TRUE(job->run({{"map", map}}));
  EXPECT_EQ(on, map.map);
}

}  // namespace
}  // namespace vinerow::mapping_jobs_test
