#include "engine/scenario/study_keys.h"

#include "engine/api/parameter_table.h"

namespace vinerow::scenario {
namespace {

const ParameterTable<StopRule>& stop_table() {
  using P = StopRule;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("metric", &P::metric, "<vehicle>.<metric> or a derived column")
          .required()
          .number(
              "half_width", "", &P::half_width, kPositive,
              "no more seeds of a setting are run once the confidence interval of the mean has at "
              "most this half width")
          .required()
          .boolean("relative", &P::relative, "half_width is a share of the mean")
          .number("confidence", "", &P::confidence, between(0.5, 0.9999),
                  "level of the confidence interval")
          .integer("at_least", &P::at_least, between(2, 1e6),
                   "minimum number of seeds of each setting");
  return table;
}

const ParameterTable<CellBudget>& budget_table() {
  using P = CellBudget;
  static const ParameterTable<P> table = ParameterTable<P>()
                                             .number("time_s", "s", &P::time_s, kNotNegative,
                                                     "wall time limit of a cell; 0: unlimited")
                                             .number("memory_MB", "MB", &P::memory_MB, kNotNegative,
                                                     "memory limit of a cell; 0: unlimited");
  return table;
}

const ParameterTable<DatasetConfig>& dataset_table() {
  using P = DatasetConfig;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("camera", &P::camera, "<vehicle>/<sensor> of type camera")
          .required()
          .number("every_s", "s", &P::every_s, above(0.0, 1e6),
                  "time between pictures; absent: by the camera's rate_Hz")
          .integer("pictures", &P::pictures, between(1, 1e6),
                   "most pictures of a run, which then ends; absent: all")
          .texts("formats", &P::formats, "files of labels to write")
          .one_of(dataset_formats())
          .texts("classes", &P::classes, "things to list")
          .one_of(dataset_classes())
          .integer("min_pixels", &P::min_pixels, between(1, 1e6),
                   "things of which fewer pixels are seen are not listed")
          .number("validation_share", "", &P::validation_share, between(0.0, 1.0),
                  "share of the pictures that go to val")
          .number("test_share", "", &P::test_share, between(0.0, 1.0),
                  "share of the pictures that go to test")
          .choice(
              "split_by", &P::split_by,
              {{"cell", SplitBy::kCell}, {"seed", SplitBy::kSeed}, {"setting", SplitBy::kSetting}},
              "pictures of one cell, seed or setting are never divided")
          .text("licence", &P::licence, "of the data set, for its card");
  return table;
}

}  // namespace

const std::vector<std::string>& dataset_formats() {
  static const std::vector<std::string> names = {"coco",         "coco_panoptic", "yolo",
                                                 "yolo_segment", "yolo_pose",     "kitti"};
  return names;
}

const std::vector<std::string>& dataset_classes() {
  static const std::vector<std::string> names = {"leaf",    "wood",   "trunk", "bunch",
                                                 "fruit",   "post",   "wire",  "obstacle",
                                                 "vehicle", "person", "weed"};
  return names;
}

const ParameterTable<StudyValues>& study_table() {
  using P = StudyValues;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("vinerow_study", &P::format, kAnyNumber, "version of the file format")
          .required()
          .text("name", inside(&P::study, &Study::name),
                "name of the study; results go to runs/<name>; default: the file's name")
          .text("description", inside(&P::study, &Study::description), "purpose of the study")
          .path("scenario", inside(&P::study, &Study::scenario), "path of the scenario file")
          .required()
          .texts("metrics", inside(&P::study, &Study::metrics),
                 "metrics to keep, as <vehicle>.<metric>; absent: all")
          .choice("keep", inside(&P::study, &Study::keep),
                  {{"nothing", KeepRuns::kNothing},
                   {"summary", KeepRuns::kSummary},
                   {"log", KeepRuns::kLog},
                   {"failed", KeepRuns::kFailed}},
                  "files kept of runs: none, summaries, also logs, or all files of failed runs")
          .group("stop", inside(&P::study, &Study::stop), stop_table(),
                 "run further seeds only for settings with an uncertain mean")
          .group("budget", inside(&P::study, &Study::budget), budget_table(), "limits of a cell")
          .group("dataset", inside(&P::study, &Study::dataset), dataset_table(),
                 "what `vinerow dataset` makes of the runs' pictures");
  return table;
}

const std::vector<FreeStudyKey>& free_study_keys() {
  static const std::vector<FreeStudyKey> keys = {
      {"set", "values set in every cell: key path to value"},
      {"factors", "varied quantities: name to values, range, alternatives, zipped lists or sample"},
      {"seeds",
       "number of seeds, which are 1, 2, ..., or a list of them; every setting has the "
       "same"},
      {"derived", "further columns: name to expression of metrics"}};
  return keys;
}

}  // namespace vinerow::scenario
