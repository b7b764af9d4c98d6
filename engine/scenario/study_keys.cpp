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
          .number("half_width", "", &P::half_width, kPositive,
                  "enough seeds of a setting are run once the confidence interval of the mean is "
                  "no wider than this to either side")
          .required()
          .boolean("relative", &P::relative, "half_width is a share of the mean")
          .number("confidence", "", &P::confidence, between(0.5, 0.9999), "of the interval")
          .integer("at_least", &P::at_least, between(2, 1e6), "seeds of each setting");
  return table;
}

const ParameterTable<CellBudget>& budget_table() {
  using P = CellBudget;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("time_s", "s", &P::time_s, kNotNegative,
                  "of wall clock, after which a cell is ended; 0: unlimited")
          .number("memory_MB", "MB", &P::memory_MB, kNotNegative,
                  "above which a cell is ended; 0: unlimited");
  return table;
}

}  // namespace

const ParameterTable<StudyValues>& study_table() {
  using P = StudyValues;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("vinerow_study", &P::format, kAnyNumber, "version of the file format")
          .required()
          .text("name", inside(&P::study, &Study::name),
                "results go to runs/<name>; default: the file's")
          .text("description", inside(&P::study, &Study::description), "for people")
          .path("scenario", inside(&P::study, &Study::scenario), "the scenario file that is run")
          .required()
          .texts("metrics", inside(&P::study, &Study::metrics),
                 "<vehicle>.<metric> to keep; absent: all")
          .choice("keep", inside(&P::study, &Study::keep),
                  {{"nothing", KeepRuns::kNothing},
                   {"summary", KeepRuns::kSummary},
                   {"log", KeepRuns::kLog},
                   {"failed", KeepRuns::kFailed}},
                  "files of runs that stay: none, summaries, logs too, or all of failed runs")
          .group("stop", inside(&P::study, &Study::stop), stop_table(),
                 "run further seeds only where the first ones leave it uncertain")
          .group("budget", inside(&P::study, &Study::budget), budget_table(),
                 "what a cell may take");
  return table;
}

const std::vector<FreeStudyKey>& free_study_keys() {
  static const std::vector<FreeStudyKey> keys = {
      {"set", "values of every cell: key path to value"},
      {"factors", "what varies: name to values, range, alternatives, zipped lists or sample"},
      {"seeds",
       "number of seeds, which are 1, 2, ..., or a list of them; every setting has the "
       "same"},
      {"derived", "further columns: name to expression of metrics"}};
  return keys;
}

}  // namespace vinerow::scenario
