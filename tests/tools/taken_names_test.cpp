/// The list of taken names in docs/reference/scenario.md against the parts that there are.

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/scenario_part.h"
#include "tests/support/paths.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools::taken_names_test {
namespace {

/// The words in backticks of a paragraph, but commands and keys of other places.
std::set<std::string> words_in(const std::string& text) {
  std::set<std::string> words;
  for (std::size_t at = 0; (at = text.find('`', at)) != std::string::npos;) {
    const std::size_t end = text.find('`', at + 1);
    const std::string word = text.substr(at + 1, end - at - 1);
    if (word.find(' ') == std::string::npos) words.insert(word);
    at = end + 1;
  }
  return words;
}

TEST(TakenNames, AreThoseOfTheDocs) {
  std::ifstream in(VINEROW_SOURCE_DIR "/docs/reference/scenario.md");
  std::stringstream page;
  page << in.rdbuf();
  const std::string text = page.str();
  const std::size_t begin = text.find("Names that no sensor, observer or payload may have");
  ASSERT_NE(begin, std::string::npos);
  const std::set<std::string> documented =
      words_in(text.substr(begin, text.find("\n\n", begin) - begin));

  const Registry registry = make_registry({});
  std::set<std::string> taken(scenario::reserved_signal_names().begin(),
                              scenario::reserved_signal_names().end());
  for (const PartKind kind : {PartKind::kVehicle, PartKind::kEstimator, PartKind::kPlanner,
                              PartKind::kGuidance, PartKind::kController, PartKind::kAutopilot}) {
    for (const std::string& type : registry.names(kind)) {
      const auto signals = scenario::fixed_signals(registry.spec(kind, type));
      taken.insert(signals.begin(), signals.end());
    }
  }
  EXPECT_EQ(documented, taken);
}

}  // namespace
}  // namespace vinerow::tools::taken_names_test
