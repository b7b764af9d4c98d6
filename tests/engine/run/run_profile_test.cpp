/// Profile of a run, with a clock and a heap of the test: every time is known.

#include "engine/run/run_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

namespace vinerow::run::run_profile_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::int64_t now_ns = 0;
std::uint64_t allocations = 0;
std::int64_t clock_ns() {
  return now_ns;
}
std::uint64_t heap() {
  return allocations;
}

/// Work that takes a time and allocates.
void work(std::int64_t us, std::uint64_t count = 0) {
  now_ns += 1000 * us;
  allocations += count;
}

class RunProfileTest : public testing::Test {
 protected:
  RunProfileTest() {
    now_ns = 5'000'000;
    allocations = 100;
    profile.emplace(clock_ns, heap);
  }
  /// The only row of a part in a phase.
  RunProfile::Row row(const std::string& part, const std::string& phase) const {
    std::vector<RunProfile::Row> found;
    for (const RunProfile::Row& row : profile->rows()) {
      if (row.part == part && row.phase == phase) found.push_back(row);
    }
    EXPECT_EQ(found.size(), 1u) << part << " in " << phase;
    return found.empty() ? RunProfile::Row{} : found.front();
  }
  nlohmann::json events() const {
    return nlohmann::json::parse(profile->trace_json()).at("traceEvents");
  }
  std::optional<RunProfile> profile;
};

TEST_F(RunProfileTest, TimeOfASpanExcludesTheSpansWithinIt) {
  const ProfileRecording recording(&*profile);
  for (int k = 0; k < 3; ++k) {
    const ProfileSpan tick("rover.sensors.sonar", "sense");
    work(10, 1);
    if (k == 1) {
      const ProfileSpan trees("trees of rays");
      work(500, 40);
    }
    work(5);
  }
  work(7, 2);  // in no span
  const RunProfile::Row sonar = row("rover.sensors.sonar", "set-up");
  EXPECT_EQ(sonar.stage, "sense");
  EXPECT_EQ(sonar.calls, 3u);
  EXPECT_NEAR(sonar.time_s, 45e-6, 1e-12);
  EXPECT_NEAR(sonar.longest_s, 515e-6, 1e-12);
  EXPECT_EQ(sonar.allocations, 3u);
  const RunProfile::Row trees = row("trees of rays", "set-up");
  EXPECT_EQ(trees.stage, "sense") << "that of the span around it";
  EXPECT_NEAR(trees.time_s, 500e-6, 1e-12);
  EXPECT_EQ(trees.allocations, 40u);
  const RunProfile::Row rest = row("not in a span", "all");
  EXPECT_NEAR(rest.time_s, 7e-6, 1e-12);
  EXPECT_NEAR(rest.longest_s, 7e-6, 1e-12);
  EXPECT_EQ(rest.allocations, 2u);
}

TEST_F(RunProfileTest, RowsSumToTheWholeTimeAlsoWhileSpansAreOpen) {
  const ProfileRecording recording(&*profile);
  const ProfileSpan outer("outer", "results");
  work(3);
  const ProfileSpan inner("inner");
  work(11);
  double sum_s = 0.0;
  std::vector<std::string> parts;
  for (const RunProfile::Row& row : profile->rows()) {
    sum_s += row.time_s;
    parts.push_back(row.part);
  }
  EXPECT_NEAR(sum_s, 14e-6, 1e-12);
  EXPECT_NEAR(profile->total_s(), 14e-6, 1e-12);
  EXPECT_THAT(parts, ElementsAre("inner", "outer", "not in a span")) << "by falling time";
}

TEST_F(RunProfileTest, WorkOfAVehicleBelongsToItsPhase) {
  const ProfileRecording recording(&*profile);
  const auto step = [](const char* part, std::int64_t us) {
    const ProfileSpan span(part, "control");
    work(us);
  };
  set_profile_phase("", "survey");
  set_profile_phase("plane", "survey");
  step("plane.controller", 1);
  step("rover.controller", 10);
  step("digest", 100);
  set_profile_phase("rover", "spray");
  set_profile_phase("", "survey + spray");
  step("plane.controller", 2);
  step("rover.controller", 20);
  step("digest", 200);
  EXPECT_NEAR(row("plane.controller", "survey").time_s, 3e-6, 1e-12);
  EXPECT_NEAR(row("rover.controller", "survey").time_s, 10e-6, 1e-12);
  EXPECT_NEAR(row("rover.controller", "spray").time_s, 20e-6, 1e-12);
  EXPECT_NEAR(row("digest", "survey").time_s, 100e-6, 1e-12);
  EXPECT_NEAR(row("digest", "survey + spray").time_s, 200e-6, 1e-12);

  // The trace has the phases on a track of their own.
  std::map<std::string, double> length_us;
  for (const auto& event : events()) {
    if (event.value("cat", "") == "phase") length_us[event.at("name")] = event.at("dur");
  }
  EXPECT_DOUBLE_EQ(length_us.at("survey"), 111.0);
  EXPECT_DOUBLE_EQ(length_us.at("survey + spray"), 222.0);
}

TEST_F(RunProfileTest, WithoutARecordingSpansAreFree) {
  {
    const ProfileSpan span("nobody looks", "sense");
    work(1);
  }
  set_profile_phase("", "nobody looks");
  EXPECT_EQ(profile->rows().size(), 1u);
  {
    const ProfileRecording recording(&*profile);
    const ProfileRecording none(nullptr);
    const ProfileSpan span("nobody looks", "sense");
  }
  EXPECT_EQ(profile->rows().size(), 1u);
}

TEST_F(RunProfileTest, TraceNestsAndCountsFromTheStart) {
  const ProfileRecording recording(&*profile);
  work(1);
  profile->begin_slice(Time{2'000'000'000});
  {
    const ProfileSpan outer("outer \"quoted\"", "guide");
    const ProfileSpan inner("inner");
    work(4, 5);
  }
  work(1);
  profile->end_slice(Time{2'250'000'000});
  std::vector<std::string> names;
  for (const auto& event : events()) {
    if (event.at("ph") == "X" && event.at("tid") == 1) names.push_back(event.at("name"));
    if (event.at("name") == "outer \"quoted\"") {
      EXPECT_DOUBLE_EQ(event.at("ts"), 1.0);
      EXPECT_DOUBLE_EQ(event.at("dur"), 4.0);
      EXPECT_EQ(event.at("cat"), "guide");
    }
    if (event.at("name") == "2 s") {
      EXPECT_DOUBLE_EQ(event.at("dur"), 5.0);
    }
    // A quarter of a second in 5 us; 5 allocations in it.
    if (event.at("name") == "times real time") {
      EXPECT_DOUBLE_EQ(event.at("args").at("value"), 50'000.0);
    }
    if (event.at("name") == "allocations per simulated second") {
      EXPECT_DOUBLE_EQ(event.at("args").at("value"), 20.0);
    }
  }
  EXPECT_THAT(names, ElementsAre("outer \"quoted\"", "inner")) << "the enclosing span first";
}

/// A long run has millions of spans. The trace keeps the longest, the table counts all.
TEST_F(RunProfileTest, TraceOfALongRunKeepsTheLongestSpans) {
  const ProfileRecording recording(&*profile);
  constexpr int kTicks = 500'000;
  for (int k = 0; k < kTicks; ++k) {
    const ProfileSpan tick(k % 1000 == 0 ? "slow" : "fast", "sense");
    work(k % 1000 == 0 ? 900 : k % 7);
  }
  EXPECT_EQ(row("fast", "set-up").calls + row("slow", "set-up").calls,
            static_cast<std::uint64_t>(kTicks));
  int slow = 0, fast = 0;
  for (const auto& event : events()) {
    slow += event.at("name") == "slow";
    fast += event.at("name") == "fast";
  }
  EXPECT_EQ(slow, kTicks / 1000);
  EXPECT_LT(slow + fast, 200'000);
  EXPECT_GT(slow + fast, 20'000);
}

TEST_F(RunProfileTest, CsvQuotesNamesAndLeavesUnknownAllocationsEmpty) {
  const ProfileRecording recording(&*profile);
  {
    const ProfileSpan span("a, \"b\"", "sense");
    work(2, 3);
  }
  EXPECT_THAT(profile->csv(),
              StartsWith("part,phase,stage,calls,time_s,us_per_call,longest_us,allocations\n"
                         "\"a, \"\"b\"\"\",set-up,sense,1,2e-06,2.000,2.000,3\n"));
  RunProfile uncounted(clock_ns, nullptr);
  const ProfileRecording other(&uncounted);
  {
    const ProfileSpan span("part", "sense");
    work(2, 3);
  }
  EXPECT_THAT(uncounted.csv(), HasSubstr("part,set-up,sense,1,2e-06,2.000,2.000,\n"));
  EXPECT_THAT(uncounted.trace_json(), testing::Not(HasSubstr("allocations")));
}

}  // namespace
}  // namespace vinerow::run::run_profile_test
