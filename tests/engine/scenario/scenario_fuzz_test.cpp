#include <gtest/gtest.h>

#include "engine/core/random.h"
#include "tests/engine/scenario/scenario_fakes.h"

namespace vinerow::scenario::test::scenario_fuzz_test {
namespace {

constexpr const char* kTokens[] = {
    ":",         ": ",   "- ",   "\n",   "\n  ", "{",         "}",     "[",
    "]",         ",",    "\"",   "'",    "#",    "&a",        "*a",    "!x",
    "|",         ">",    "~",    "%",    "@",    "`",         "\t",    "\r",
    "\0",        "?",    "<<",   "--- ", "...",  ".nan",      "1e999", "-1",
    "include: ", "null", "\xff", "\xc3", "type", "vehicles:", "0x",    "99999999999999999999"};

std::size_t index_below(RandomStream& random, std::size_t n) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
}

std::string mutate(std::string text, RandomStream& random) {
  const std::size_t changes = 1 + index_below(random, 4);
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t at = index_below(random, text.size());
    const std::size_t length = index_below(random, 30);
    switch (index_below(random, 7)) {
      case 0:
        text[at] = static_cast<char>(index_below(random, 256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(index_below(random, text.size()), length));
        break;
      case 3:
        text.insert(at, kTokens[index_below(random, std::size(kTokens))]);
        break;
      case 4:
        text.replace(at, length, kTokens[index_below(random, std::size(kTokens))]);
        break;
      case 5:
        text.resize(at);
        break;
      default: {
        // Moves a whole line, which often keeps the YAML valid and the scenario not.
        const std::size_t begin = text.rfind('\n', at) + 1;
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        const std::string line = text.substr(begin, end - begin);
        text.erase(begin, end - begin);
        text.insert(text.empty() ? 0 : text.rfind('\n', index_below(random, text.size())) + 1,
                    line);
        break;
      }
    }
  }
  return text;
}

/// Either it loads, and then its resolved text loads too, or it says in one line why not.
void expect_loads_or_explains(const std::string& yaml, const Registry& registry, int& loaded) {
  try {
    const Scenario s = parse_scenario(yaml, "/nowhere", registry);
    const Scenario again = parse_scenario(s.resolved_yaml, "/", registry);
    EXPECT_EQ(again.resolved_yaml, s.resolved_yaml) << yaml;
    ++loaded;
  } catch (const ConfigError& fault) {
    const std::string text = fault.what();
    EXPECT_FALSE(text.empty()) << yaml;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

TEST(ScenarioFuzz, MutatedTextsLoadOrExplainThemselves) {
  const Registry registry = fake_registry();
  const std::string full = std::string(kCartScenario) +
                           "physics: {step_s: 0.001}\n"
                           "record: {truth_rate_Hz: 20, compression: zstd}\n"
                           "pictures:\n"
                           "  times_s: [1, 2]\n"
                           "  cameras: {a: {kind: top}, b: {kind: fixed, position_m: [1, 2, 3], "
                           "look_at_m: [0, 0, 0]}}\n"
                           "metrics: {deviation: {type: deviation}}\n";
  RandomStream random(1, "fuzz", "scenario");
  int loaded = 0;
  constexpr int kTexts = 4000;
  for (int i = 0; i < kTexts; ++i) expect_loads_or_explains(mutate(full, random), registry, loaded);
  // The mutations must reach behind the parser, and must not be harmless.
  EXPECT_GT(loaded, kTexts / 50);
  EXPECT_LT(loaded, kTexts / 2);
}

TEST(ScenarioFuzz, MutatedOverridesLoadOrExplainThemselves) {
  const Registry registry = fake_registry();
  RandomStream random(2, "fuzz", "overrides");
  for (int i = 0; i < 1500; ++i) {
    const std::string set =
        mutate(i % 2 == 0 ? "rover.controller.lookahead_m=0.5" : "rover.sensors={gps: {type: gps}}",
               random);
    try {
      parse_scenario(kCartScenario, "/", registry, {{set}, {}});
    } catch (const ConfigError& fault) {
      const std::string text = fault.what();
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      EXPECT_FALSE(text.empty());
    }
  }
}

}  // namespace
}  // namespace vinerow::scenario::test::scenario_fuzz_test
