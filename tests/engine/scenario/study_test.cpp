#include "engine/scenario/study.h"

#include <gtest/gtest.h>

#include <set>

#include "engine/scenario/space_filling.h"
#include "tests/engine/scenario/scenario_fakes.h"

namespace vinerow::scenario::test::study_test {
namespace {

/// Loads "vinerow_study: 1", a scenario and this.
Study load(const std::string& text) {
  TemporaryFolder folder;
  folder.write("cart.yaml", kCartScenario);
  return load_study(
      folder.write("my_study.yaml", "vinerow_study: 1\nscenario: cart.yaml\n" + text));
}

/// The sentence without its folder.
std::string fault(const std::string& text) {
  try {
    static_cast<void>(load(text));
  } catch (const ConfigError& error) {
    const std::string sentence = error.what();
    const std::size_t at = sentence.find("my_study.yaml");
    return at == std::string::npos ? sentence : sentence.substr(at);
  }
  return "no error";
}

std::vector<std::string> texts(const Study& study, std::size_t factor = 0) {
  std::vector<std::string> texts;
  for (const FactorLevel& level : study.factors.at(factor).levels) {
    std::string text;
    for (const std::string& one : level.texts) text += (text.empty() ? "" : "|") + one;
    texts.push_back(text);
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(Study, TheSmallestOneIsOneRun) {
  const Study study = load("");
  EXPECT_EQ(study.name, "my_study");
  EXPECT_TRUE(study.factors.empty());
  EXPECT_EQ(study.seeds, (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(study.keep, KeepRuns::kNothing);
  EXPECT_FALSE(study.stop);
}

TEST(Study, FactorsOfEveryForm) {
  const Study study = load(
      "factors:\n"
      "  a: {key: rover.mass_kg, values: [1, 2.50, 3]}\n"
      "  b: {key: rover.controller.gain, from: 0.1, to: 0.5, step: 0.1}\n"
      "  c: {key: x.c, from: 1, to: 1000, count: 4, scale: log}\n"
      "  d: {key: x.d, from: 1, to: 4, count: 7, whole: true}\n"
      "  e: {key: x.e, from: 0, to: 1, step: 0.4}\n"
      "  f: {alternatives: {as_it_is: {}, other: {x.f: {type: pid, gain: 2}, x.g: 1}}}\n"
      "  g: {zip: {x.h: [1, 2], x.i: [a, b]}}\n");
  EXPECT_EQ(texts(study, 0), (Texts{"1", "2.50", "3"})) << "as they are written";
  EXPECT_EQ(texts(study, 1), (Texts{"0.1", "0.2", "0.3", "0.4", "0.5"}));
  EXPECT_EQ(texts(study, 2), (Texts{"1", "10", "100", "1000"}));
  EXPECT_EQ(texts(study, 3), (Texts{"1", "2", "3", "4"})) << "each whole number once";
  EXPECT_EQ(texts(study, 4), (Texts{"0", "0.4", "0.8"})) << "a step need not reach the end";
  EXPECT_EQ(texts(study, 5), (Texts{"as_it_is", "other"}));
  EXPECT_TRUE(study.factors[5].levels[0].values.empty());
  ASSERT_EQ(study.factors[5].levels[1].values.size(), 2u);
  EXPECT_EQ(study.factors[5].levels[1].values[0].path, "x.f");
  EXPECT_EQ(study.factors[5].levels[1].values[0].value.find("gain")->text, "2");
  EXPECT_EQ(study.factors[6].columns, (Texts{"x.h", "x.i"}));
  EXPECT_EQ(texts(study, 6), (Texts{"1|a", "2|b"}));
}

TEST(Study, SeedsAreANumberOrAList) {
  EXPECT_EQ(load("seeds: 3").seeds, (std::vector<std::uint64_t>{1, 2, 3}));
  EXPECT_EQ(load("seeds: [7, 0]").seeds, (std::vector<std::uint64_t>{7, 0}));
}

TEST(Study, ASampleStaysInItsRanges) {
  const Study study = load(
      "factors:\n  s: {sample: latin_hypercube, count: 50, ranges: {x.a: {from: -2, to: 2}, "
      "x.b: {from: 1, to: 100, scale: log}, x.n: {from: 1, to: 9, whole: true}}}\n");
  EXPECT_EQ(study.factors[0].columns, (Texts{"x.a", "x.b", "x.n"}));
  ASSERT_EQ(study.factors[0].levels.size(), 50u);
  int below_ten = 0;
  for (const FactorLevel& level : study.factors[0].levels) {
    EXPECT_GE(std::stod(level.texts[0]), -2.0);
    EXPECT_LE(std::stod(level.texts[0]), 2.0);
    below_ten += std::stod(level.texts[1]) < 10.0 ? 1 : 0;
    EXPECT_EQ(level.texts[2].find('.'), std::string::npos);
  }
  EXPECT_EQ(below_ten, 25) << "10 lies in the middle of 1 to 100 by ratio";
}

TEST(SpaceFilling, AHypercubeHasOnePointInEachSlice) {
  constexpr std::size_t kPoints = 40;
  const auto points = latin_hypercube(kPoints, 3, 5);
  for (std::size_t k = 0; k < 3; ++k) {
    std::set<int> slices;
    for (const auto& point : points) {
      ASSERT_TRUE(point[k] >= 0.0 && point[k] < 1.0);
      slices.insert(static_cast<int>(point[k] * kPoints));
    }
    EXPECT_EQ(slices.size(), kPoints);
  }
  EXPECT_EQ(points, latin_hypercube(kPoints, 3, 5));
  EXPECT_NE(points, latin_hypercube(kPoints, 3, 6));
}

/// scipy.stats.qmc.Sobol(d, scramble=False).random(n)[1:]
TEST(SpaceFilling, SobolPointsAreThoseOfScipy) {
  const std::vector<std::vector<double>> first = {
      {0.5, 0.5, 0.5},       {0.75, 0.25, 0.25},    {0.25, 0.75, 0.75},   {0.375, 0.375, 0.625},
      {0.875, 0.875, 0.125}, {0.625, 0.125, 0.875}, {0.125, 0.625, 0.375}};
  EXPECT_EQ(sobol_points(7, 3), first);
  const auto points = sobol_points(100, 5);
  EXPECT_EQ(points[36], (std::vector<double>{0.921875, 0.640625, 0.578125, 0.921875, 0.765625}));
  EXPECT_EQ(points[99],
            (std::vector<double>{0.4140625, 0.2578125, 0.7734375, 0.7265625, 0.8828125}));
}

TEST(StudyFault, OneSentenceWithPlaceAndCause) {
  EXPECT_EQ(
      fault("facters: {}"),
      "my_study.yaml:3: facters: unknown key; did you mean 'factors'? (known: budget, dataset, "
      "derived, "
      "description, factors, keep, metrics, name, scenario, seeds, set, stop, vinerow_study)");
  EXPECT_EQ(fault("factors: {a: {key: x.a, values: []}}"),
            "my_study.yaml:3: factors.a.values is empty, must have at least one value");
  EXPECT_EQ(fault("factors: {a: {values: [1]}}"),
            "my_study.yaml:3: factors.a.key must be given: the path of a parameter; e.g. {key: "
            "rover.controller.lookahead_m, values: [0.5, 1]}");
  EXPECT_EQ(fault("factors: {a: {key: x.a}}"),
            "my_study.yaml:3: factors.a must have one of the keys values, from, alternatives, zip, "
            "sample; e.g. {key: rover.controller.lookahead_m, values: [0.5, 1]}");
  EXPECT_EQ(fault("factors: {a: {key: x.a, from: 1, to: 0, count: 3}}"),
            "my_study.yaml:3: factors.a: from = 1 is above to = 0");
  EXPECT_EQ(fault("factors: {a: {key: x.a, from: 0, to: 1}}"),
            "my_study.yaml:3: factors.a: one of step and count must be given");
  EXPECT_EQ(fault("factors: {a: {key: x.a, from: 0, to: 1, count: 3, scale: log}}"),
            "my_study.yaml:3: factors.a.from = 0, must be > 0 on a logarithmic scale");
  EXPECT_EQ(fault("factors: {a: {key: x.a, from: 0, to: 1, step: 1e-9}}"),
            "my_study.yaml:3: factors.a has 1e+09 values, must have at most 1000000");
  EXPECT_EQ(fault("factors: {a: {zip: {x.a: [1, 2], x.b: [1]}}}"),
            "my_study.yaml:3: factors.a.zip.x.b has 1 values, x.a has 2; zipped lists must be "
            "equally long");
  EXPECT_EQ(fault("seeds: 0"),
            "my_study.yaml:3: seeds = 0, must be the number of seeds (at least "
            "1) or a list of them");
  EXPECT_EQ(fault("seeds: [1, 1]"), "my_study.yaml:3: seeds names a seed twice");
  EXPECT_EQ(fault("stop: {metric: x.y, half_width: 1}\nseeds: 3"),
            "my_study.yaml:3: stop.at_least = 5, but there are 3 seeds");
}

TEST(StudyFault, OneKeyHasOneFactor) {
  EXPECT_EQ(fault("factors:\n  a: {key: x.a, values: [1]}\n  b: {key: x.a, values: [2]}"),
            "my_study.yaml:5: x.a is set by factors.a and by factors.b; remove one of them");
  EXPECT_EQ(fault("set: {x.a: 1}\nfactors:\n  b: {key: x.a, values: [2]}"),
            "my_study.yaml:5: x.a is set by set and by factors.b; remove one of them");
  EXPECT_EQ(fault("factors:\n  a: {key: x.c.gain, values: [1]}\n  b: {key: x.c, values: [{}]}"),
            "my_study.yaml:5: x.c of factors.b would overwrite x.c.gain of factors.a; put "
            "factors.b first");
  EXPECT_EQ(fault("factors:\n  a: {key: x.c, values: [{}]}\n  b: {key: x.c.gain, values: [1]}"),
            "no error");
  EXPECT_EQ(fault("factors: {a: {key: seed, values: [1]}}"),
            "my_study.yaml:3: factors.a cannot vary seed; list the seeds under 'seeds'");
}

TEST(StudyFault, AColumnOfTheTablesHasOneMeaning) {
  const std::string factor = "factors: {gain: {key: x.a, values: [1, 2]}}\n";
  EXPECT_EQ(fault("factors: {seed: {key: x.a, values: [1]}}"),
            "my_study.yaml:3: every table and factors.seed both give a column 'seed'; rename "
            "factors.seed");
  EXPECT_EQ(fault(factor + "derived: {met: 2 * gain}"),
            "my_study.yaml:4: every table and derived.met both give a column 'met'; rename "
            "derived.met");
  EXPECT_EQ(fault(factor + "derived: {gain: x.y}"),
            "my_study.yaml:4: factors.gain and derived.gain both give a column 'gain'; rename "
            "derived.gain");
  EXPECT_EQ(fault("metrics: [x.y, x.z, x.y]"), "my_study.yaml:3: metrics has 'x.y' twice");
  EXPECT_EQ(fault(factor + "derived: {twice: 2 * gain}\nmetrics: [x.y, x.z]"), "no error");
}

TEST(StudyFault, ATrillionCellsAreRefused) {
  EXPECT_EQ(fault("seeds: 1000\nfactors:\n"
                  "  a: {key: x.a, from: 1, to: 1000, count: 1000}\n"
                  "  b: {key: x.b, from: 1, to: 1000, count: 1000}\n"
                  "  c: {key: x.c, from: 1, to: 1000, count: 1000}\n"),
            "my_study.yaml: 1000 seeds x 1000 of a x 1000 of b x 1000 of c make 1e+12 cells, must "
            "be at most 1000000; sample the factors, or reduce the study");
}

/// What a cell sets stands over the scenario's own values, and its errors name the study.
TEST(StudyValues, AreCheckedAgainstTheScenario) {
  TemporaryFolder folder;
  const auto cart = folder.write("cart.yaml", kCartScenario);
  const auto file = folder.write("s.yaml",
                                 "vinerow_study: 1\nscenario: cart.yaml\nfactors:\n"
                                 "  w: {key: rover.wheel_radius_m, values: [0.3, -1]}\n  n: {key: "
                                 "rovr.mass_kg, values: [1]}\n");
  const Study study = load_study(file);
  const ScenarioSource source(cart);
  const auto load_with = [&](std::size_t factor, std::size_t level) {
    Overrides overrides;
    overrides.values = study.factors[factor].levels[level].values;
    return source.load(fake_registry(), overrides);
  };
  EXPECT_EQ(load_with(0, 0).vehicles[0].vehicle.parameters.number("wheel_radius_m"), 0.3);
  const auto fault = [&](std::size_t factor, std::size_t level) -> std::string {
    try {
      load_with(factor, level);
    } catch (const ConfigError& error) {
      return std::string(error.what()).substr(folder.path().string().size() + 1);
    }
    return "no error";
  };
  EXPECT_EQ(fault(0, 1), "s.yaml:4: vehicles.rover.wheel_radius_m = -1 m, must be > 0 m");
  EXPECT_EQ(fault(1, 0).substr(0, 57), "s.yaml:5: unknown path 'rovr'; did you mean 'rover'? (kno");
}

}  // namespace
}  // namespace vinerow::scenario::test::study_test
