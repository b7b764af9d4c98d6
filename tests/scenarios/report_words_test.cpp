/// What a report states in words: numbers, meanings, events, papers, setup, verdicts.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <regex>
#include <sstream>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "tests/scenarios/command.h"
#include "tools/parts/register_all.h"
#include "tools/report/canopy_strips.h"
#include "tools/report/events.h"
#include "tools/report/html.h"
#include "tools/report/metric_table.h"
#include "tools/report/papers.h"
#include "tools/report/row_faces.h"
#include "tools/report/setup.h"
#include "tools/report/time_line.h"
#include "tools/report/units.h"
#include "tools/report/verdict.h"

namespace vinerow::tools::report::report_words_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ReportNumbers, AreWrittenForPeople) {
  EXPECT_EQ(number_text(0.0123456), "0.01235");
  EXPECT_EQ(number_text(-3.0), "−3");
  EXPECT_EQ(number_text(1234567.0), "1\u202f234\u202f567");
  EXPECT_EQ(number_text(4321.4), "4321");
  EXPECT_EQ(number_text(std::nan("")), "not measured");
  EXPECT_EQ(duration_text(8.04), "8.0 s");
  EXPECT_EQ(duration_text(59.7), "1 min 0 s");
  EXPECT_EQ(duration_text(483.5), "8 min 4 s");
  EXPECT_EQ(duration_text(7300), "2 h 1 min");
  EXPECT_EQ(escaped("a<b & \"c\"\x01"), "a&lt;b &amp; &quot;c&quot;");
  EXPECT_EQ(unit_of("row_speed_mean_mps"), "m/s");
  EXPECT_EQ(unit_of("relative_accuracy_per_m"), "1/m");
  EXPECT_EQ(unit_of("alleys_driven"), "");
  EXPECT_EQ(unit_of("sprayer_litres_per_ha"), "l/ha");
  EXPECT_EQ(words_of("axle_front_steer_rad"), "axle front steer");
}

TEST(ReportMeanings, AreThereForEveryMetricOfTheProgram) {
  Registry registry;
  register_all(registry);
  for (const PartKind kind : {PartKind::kMetric, PartKind::kPayload, PartKind::kJob}) {
    for (const std::string& part : registry.names(kind)) {
      const std::vector<ResultSpec>& results = registry.spec(kind, part).results;
      EXPECT_FALSE(results.empty()) << part;
      for (const ResultSpec& result : results) {
        std::string name = (kind == PartKind::kPayload ? "tank_" : "") + result.name;
        for (const auto& [pattern, example] : {std::pair<std::string, std::string>{"<wheel>", "fl"},
                                               {"<source>", "range"},
                                               {"<observer>", "ekf"}}) {
          const std::size_t at = name.find(pattern);
          if (at != std::string::npos) name.replace(at, pattern.size(), example);
        }
        const MetricMeaning meaning = metric_meaning(name);
        EXPECT_TRUE(meaning.known) << part << " gives " << name;
        // Jobs may share a name: "points" of a cloud and of a plan.
        if (kind != PartKind::kJob) {
          EXPECT_EQ(meaning.definition, result.definition) << name;
        }
        EXPECT_NE(meaning.definition, "") << name;
        EXPECT_NE(result.unit, "") << name;
      }
    }
  }
  for (const char* name : {"ekf_lateral_rms_m", "paper_c_nees_mean", "ekf_nis_range_mean",
                           "no_map_consistent", "paper_c_ellipsoid_containment_share"}) {
    EXPECT_TRUE(metric_meaning(name).known) << name;
  }
  EXPECT_THAT(metric_meaning("ekf_lateral_rms_m").title, HasSubstr("(ekf)"));
  EXPECT_EQ(metric_meaning("relative_accuracy_per_m").source, "paper B, eq. 8");
  EXPECT_FALSE(metric_meaning("grapes_eaten").known);
  EXPECT_EQ(metric_meaning("grapes_eaten").title, "grapes eaten");
}

TEST(ReportEvents, StandInOrderWithTheGraveOnesFirst) {
  const test::ScratchFolder folder("report_events");
  folder.file("events.jsonl",
              "{\"t_s\":0.0,\"level\":\"info\",\"source\":\"run\",\"text\":\"started\"}\n"
              "{\"t_s\":61.5,\"level\":\"warning\",\"source\":\"rover\",\"text\":\"touches trunk "
              "<7>\"}\n"
              "{\"t_s\":80.25,\"level\":\"error\",\"source\":\"drone\",\"text\":\"crashed\"}\n"
              "{\"t_s\":90.0,\"level\":\"in");  // a run that was killed
  RunFolder run;
  run.path = folder.path();
  const std::vector<RunEvent> events = read_events(run);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[1].t_s, 61.5);
  EXPECT_EQ(events[1].source, "rover");
  const std::string notice = event_notice(events);
  EXPECT_THAT(notice, HasSubstr("1 error, 1 warning during the run"));
  EXPECT_THAT(notice, HasSubstr("touches trunk &lt;7&gt;"));
  EXPECT_LT(notice.find("crashed"), notice.find("touches trunk"));
  EXPECT_THAT(notice, Not(HasSubstr("started")));
  EXPECT_EQ(event_notice({events[0]}), "");
  const std::string chapter = event_table(events);
  EXPECT_LT(chapter.find("started"), chapter.find("touches trunk"));
  EXPECT_LT(chapter.find("touches trunk"), chapter.find("crashed"));
  EXPECT_EQ(event_table({}), "");
}

TEST(ReportEvents, ALongTextIsCutAfterAWord) {
  std::string text;
  while (text.size() < 200) text += "seventy ";
  const std::string notice = event_notice({{9.0, "warning", "plane.guidance", text}});
  EXPECT_THAT(notice, HasSubstr("seventy seventy …"));
  // Without spaces anywhere, and never within a letter of two bytes.
  std::string one_word = "x";
  while (one_word.size() < 300) one_word += "°";
  EXPECT_THAT(event_notice({{9.0, "warning", "plane", one_word}}), HasSubstr("°° …"));
}

TEST(ReportPapers, AreNamedInFullOnceWhereTheyAreCited) {
  const std::string page = with_citations("As paper A, figure 3. And paper A, section 2.");
  EXPECT_EQ(page,
            "As <a class=\"cite\" href=\"#paper-A\">[A]</a>, figure 3. And <a class=\"cite\" "
            "href=\"#paper-A\">[A]</a>, section 2.");
  const std::string sources = source_list(page);
  EXPECT_THAT(sources, HasSubstr("id=\"paper-A\""));
  EXPECT_THAT(sources, HasSubstr("M. Mammarella et al."));
  EXPECT_THAT(sources, Not(HasSubstr("AgriEngineering")));
  EXPECT_EQ(source_list("nothing cited"), "");
}

/// Two rows from west to east, 2 m apart, one alley between them.
std::shared_ptr<WorldModel> two_rows() {
  auto world = std::make_shared<WorldModel>();
  for (const int i : {0, 1}) {
    PlantRow row;
    row.id = i;
    row.line_W = {{0, 2.0 * i, 0}, {20, 2.0 * i, 0}};
    world->rows->rows.push_back(row);
  }
  Alley alley;
  alley.width_m = 2.0;
  alley.line_W = {{0, 1, 0}, {20, 1, 0}};
  world->rows->alleys = {alley};
  return world;
}

VehicleLog driving(const std::vector<Eigen::Vector2d>& places) {
  VehicleLog vehicle;
  vehicle.name = "rover";
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    for (int k = 0; k <= 100; ++k) {
      const Eigen::Vector2d p = places[i] + 0.01 * k * (places[i + 1] - places[i]);
      Odometry truth;
      truth.X_WB.p = {p.x(), p.y(), 0.5};
      vehicle.truth.times.push_back(Time{} + duration_from_s(static_cast<double>(100 * i) + k));
      vehicle.truth.values.push_back(truth);
    }
  }
  return vehicle;
}

TEST(ReportFaces, TellWhichSidesOfRowsLieBesideNoAlley) {
  RunFolder run;
  run.world = two_rows();
  // Rows point east: north of row 0 is its left side, south of row 1 its right side.
  const auto faces = row_faces(run, driving({{-3, 1}, {23, 1}}));
  ASSERT_EQ(faces.size(), 4u);
  EXPECT_EQ(face_sentence(faces),
            "No alley runs along 2 of the 4 row sides: row 0 (right) and row 1 (left)");
  // Around the whole block: nothing to explain.
  const auto all =
      row_faces(run, driving({{-3, 1}, {23, 1}, {23, 3}, {-3, 3}, {-3, -1}, {23, -1}}));
  EXPECT_EQ(face_sentence(all), "");
  // It turned back at a quarter of the alley, so it passed no side.
  EXPECT_EQ(face_sentence(row_faces(run, driving({{-3, 1}, {5, 1}}))), "");
  // The outer side alone: the alley was there to be driven.
  EXPECT_THAT(face_sentence(row_faces(run, driving({{-3, -1}, {23, -1}}))),
              HasSubstr("The plan left out 3 of the 4 row sides"));
}

TEST(ReportSetup, TellsSlopeAndSensorsOfTheScenario) {
  const std::shared_ptr<WorldModel> world = two_rows();
  RunFolder run;
  run.world = world;
  // z = 0.15 x + 0.08 y: 17 % in all, 15 % along the rows, which point east, 8 % across.
  HeightField field;
  field.columns = field.rows = 61;
  field.corner_W = {-20, -30};
  for (int j = 0; j < 61; ++j) {
    for (int i = 0; i < 61; ++i) {
      field.heights_m.push_back(static_cast<float>(0.15 * (i - 20) + 0.08 * (j - 30)));
    }
  }
  world->terrain = field;
  world->soil.name = "wet_soil";
  run.scenario.emplace();
  scenario::VehicleConfig rover;
  rover.name = "<rover>";
  rover.vehicle.type = "diff_drive_rover";
  for (const auto& [name, type] :
       {std::pair{"imu", "imu"}, {"left", "ultrasound"}, {"right", "ultrasound"}}) {
    scenario::NamedPart sensor;
    sensor.name = name;
    sensor.part.type = type;
    rover.sensors.push_back(sensor);
  }
  run.scenario->vehicles = {rover};
  const std::string table = setup_table(run);
  EXPECT_THAT(table, HasSubstr("2 rows of 20 m, 2.0 m apart"));
  EXPECT_THAT(table, HasSubstr("slope 17 % (15 % along the rows, 8 % across)"));
  EXPECT_THAT(table, HasSubstr("soil wet soil"));
  EXPECT_THAT(table, HasSubstr("wind calm"));
  EXPECT_THAT(table, HasSubstr("&lt;rover&gt;"));
  EXPECT_THAT(table, HasSubstr("sensors: imu, 2 × ultrasound"));
  EXPECT_EQ(setup_table(RunFolder{}), "");
}

RunFolder folder_of(const std::string& summary) {
  RunFolder run;
  run.summary = Json::parse(summary);
  return run;
}

TEST(ReportVerdict, SaysInASentenceWhatFailed) {
  const Verdict met = make_verdict(folder_of(
      R"({"exit_status": 0, "finished": true, "criteria": [{"metric": "rover.slip_max", "kind": "max", "value": 0.01, "limit": 0.1, "met": true}]})"));
  EXPECT_EQ(met.kind, Verdict::Kind::kMet);
  EXPECT_EQ(met.headline, "The one requirement is met");

  // A requirement with two limits is one requirement.
  const std::string both =
      R"({"exit_status": 0, "finished": true, "criteria": [
      {"name": "o", "metric": "rover.alley_offset_mean_m", "kind": "max", "value": 0.01, "limit": 0.03, "met": true},
      {"name": "o", "metric": "rover.alley_offset_mean_m", "kind": "min", "value": 0.01, "limit": -0.03, "met": true},
      {"name": "p", "metric": "rover.slip_max", "kind": "max", "value": 0.01, "limit": 0.1, "met": true}]})";
  EXPECT_EQ(make_verdict(folder_of(both)).headline, "All 2 requirements met");
  EXPECT_THAT(criteria_table(folder_of(both)), HasSubstr("−0.03 to 0.03"));

  // A name of the user's own is shown, one that repeats metric and limit is not.
  EXPECT_THAT(criteria_table(folder_of(both)), HasSubstr("<summary>o ("));
  const std::string plain =
      R"({"exit_status": 0, "criteria": [{"name": "rover.slip_max <= 0.1", "metric": "rover.slip_max",
          "kind": "max", "value": 0.01, "limit": 0.1, "met": true}]})";
  EXPECT_THAT(criteria_table(folder_of(plain)), Not(HasSubstr("0.1 (")));

  const Verdict failed = make_verdict(folder_of(R"({"exit_status": 1, "criteria": [
      {"metric": "rover.cross_track_max_m", "kind": "max", "value": 0.13, "limit": 0.1, "met": false},
      {"metric": "plane.covered_share", "kind": "min", "value": 0.934, "limit": 0.99, "met": false},
      {"metric": "rover.finished", "kind": "min", "value": 0, "limit": 1, "met": false},
      {"metric": "rover.slip_max", "kind": "max", "value": null, "limit": 1, "met": false},
      {"metric": "rover.contact_count", "kind": "max", "value": 0, "limit": 0, "met": true}]})"));
  EXPECT_EQ(failed.kind, Verdict::Kind::kFailed);
  EXPECT_THAT(criteria_table(folder_of(both)), Not(HasSubstr("..")));  // definitions are sentences
  EXPECT_EQ(failed.headline, "Failed: 4 of 5 requirements missed");
  EXPECT_EQ(failed.sentence,
            "Rover: max lateral error on legs is 0.13 m, at most 0.1 m is "
            "allowed; plane: parcel photographed is 93.4 %, at least 99 % is required; rover: "
            "mission completed: no; and 1 more below.");

  const Verdict crashed = make_verdict(folder_of(
      R"({"exit_status": 1, "criteria": [], "crashes": [{"vehicle": "drone", "time_s": 12.34, "text": "hit the ground at 2.3 m/s"}]})"));
  EXPECT_EQ(crashed.sentence, "Drone crashed after 12 s: hit the ground at 2.3 m/s.");

  const Verdict broken = make_verdict(
      folder_of(R"({"exit_status": 3, "error": "rover.controller wrote NaN", "criteria": []})"));
  EXPECT_EQ(broken.kind, Verdict::Kind::kBrokenOff);
  EXPECT_EQ(broken.sentence, "Rover.controller wrote NaN.");
  const Verdict timed = make_verdict(folder_of(
      R"({"exit_status": 3, "error": "t = 20.050000 s: rover.controller: wrote NaN", "criteria": []})"));
  EXPECT_EQ(timed.sentence, "At t = 20.050000 s: rover.controller: wrote NaN.");
  const Verdict open = make_verdict(folder_of(R"({"exit_status": 0, "criteria": []})"));
  EXPECT_EQ(open.kind, Verdict::Kind::kOpen);
}

TEST(ReportTimeLine, NamesBesideTheBarsFitThere) {
  // At the left of a wide chart are 140 px, and letters of 13 px are 8 px wide.
  const std::vector<TimeBar> bars = {{0.0, 10.0, "work", "drives"}};
  EXPECT_THAT(time_line({{"rover", "", "", bars}}, 10.0, "who works"), HasSubstr("label end"));
  const std::string name = "rover_of_a_careful_farmer";
  EXPECT_THAT(time_line({{name, "", "", bars}}, 10.0, "who works"),
              AllOf(HasSubstr(name), Not(HasSubstr("label end"))));
}

TEST(ReportTimeLine, AParkedVehicleDoesNotDrive) {
  Track parked, driven;
  parked.t_s = driven.t_s = {0.0, 1.0, 2.0};
  parked.in_turn = driven.in_turn = {0, 0, 0};
  parked.speed_mps = {0.0, 1e-6, 0.0};
  driven.speed_mps = {0.0, 0.5, 0.0};
  const std::vector<TimeRow> rows = activity_rows(std::vector<VehicleLog>(2), {parked, driven});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows.front().bars.front().tip, "drives");
}

TEST(ReportCanopy, WeighsPatchesByTheirArea) {
  const test::ScratchFolder folder("report_canopy");
  const CanopyFile canopy = read_canopy(folder.file(
      "a.json",
      R"({"vehicle": "rover", "payload": "sprayer", "quantity": "deposit", "unit": "ml/m2",
          "wanted": 10, "step_m": 0.5, "band_m": 0.25, "patches": [
          [0, 1, 0, 2, 0, 0, 1, 1.0, 12], [0, -1, 0, 2, 0, 0, 1, 2.0, 6], [1, 1, 3, 1, 0, 0, 1, 1.0, 0]]})"));
  EXPECT_DOUBLE_EQ(canopy.area_m2(), 4.0);
  EXPECT_DOUBLE_EQ(canopy.covered_share(), 0.25);
  EXPECT_DOUBLE_EQ(canopy.mean_amount(), (12.0 + 2.0 * 6.0) / 4.0);
  const std::string broken = folder.file("b.json", R"({"vehicle": "rover"})");
  try {
    read_canopy(broken);
    ADD_FAILURE() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("b.json: is not a canopy coverage file: "));
    EXPECT_THAT(error.what(), HasSubstr("payload"));
  }
}

}  // namespace
}  // namespace vinerow::tools::report::report_words_test
