/// The same bits, whatever does not belong to the scenario.

#include <gtest/gtest.h>

#include <thread>

#include "engine/api/messages/sensors.h"
#include "engine/run/run.h"
#include "engine/sim/simulation.h"
#include "tests/scenarios/command.h"
#include "tools/parts/register_all.h"
#include "vinerow/testing.h"

namespace vinerow::determinism_test {
namespace {

using test::scenario_file;
using testing::TestRun;

constexpr double kSpan_s = 6.0;

std::string digest_after(double span_s, const std::vector<std::string>& sets = {}) {
  return TestRun::from_file(scenario_file("riseholme_rover"), sets).run_for_s(span_s).digest();
}

TEST(Determinism, TwoRunsInOneProcessGiveTheSameDigest) {
  EXPECT_EQ(digest_after(kSpan_s), digest_after(kSpan_s));
}

TEST(Determinism, PauseAndResumeChangesNothing) {
  TestRun sliced = TestRun::from_file(scenario_file("riseholme_rover"));
  for (const double slice_s : {0.001, 0.5, 2.499, 3.0}) sliced.run_for_s(slice_s);
  EXPECT_EQ(sliced.digest(), digest_after(kSpan_s));
}

TEST(Determinism, WorkersSideBySideDoNotDisturbEachOther) {
  constexpr double kShort_s = 2.0;
  std::string digests[3];
  std::vector<std::thread> workers;
  for (std::string& digest : digests)
    workers.emplace_back([&digest] { digest = digest_after(kShort_s); });
  for (std::thread& worker : workers) worker.join();
  const std::string alone = digest_after(kShort_s);
  for (const std::string& digest : digests) EXPECT_EQ(digest, alone);
}

TEST(Determinism, AnotherSeedGivesAnotherDigest) {
  EXPECT_NE(digest_after(1.0), digest_after(1.0, {"seed=2"}));
}

TEST(Determinism, LogAndItsRateChangeNothing) {
  const test::ScratchFolder folder("determinism_log");
  Registry registry;
  register_all(registry);
  const auto digest_with = [&](bool log, const std::vector<std::string>& sets) {
    scenario::Overrides overrides;
    overrides.sets = sets;
    overrides.sets.push_back("duration_s=4");
    overrides.sets.push_back("criteria=[]");
    run::RunOptions options;
    options.out = folder.path();
    options.log = log;
    options.pictures = false;
    return run::run_scenario(
               scenario::load_scenario(scenario_file("riseholme_rover"), registry, overrides),
               registry, options)
        .digest;
  };
  const std::string base = digest_with(true, {});
  EXPECT_EQ(base, digest_with(false, {}));
  EXPECT_EQ(base, digest_with(true, {"record.truth_rate_Hz=100"}));
}

TEST(Determinism, ASensorMoreDoesNotChangeTheNoiseOfTheOthers) {
  TestRun with =
      TestRun::from_file(scenario_file("riseholme_rover"),
                         {"rover.sensors.second={type: gps, rate_Hz: 40, error: gaussian}"});
  TestRun without = TestRun::from_file(scenario_file("riseholme_rover"));
  with.run_for_s(1.0), without.run_for_s(1.0);
  EXPECT_EQ(with.signal<GnssFix>("rover/gps").p_W, without.signal<GnssFix>("rover/gps").p_W);
  EXPECT_EQ(with.signal<ImuSample>("rover/imu").f_WS_S,
            without.signal<ImuSample>("rover/imu").f_WS_S);
  EXPECT_NE(with.signal<GnssFix>("rover/second").p_W, with.signal<GnssFix>("rover/gps").p_W);
}

TEST(Determinism, TwoProcessesWithAndWithoutPicturesGiveTheSameDigest) {
  const test::ScratchFolder folder("determinism_process");
  const std::string run =
      "run " + scenario_file("riseholme_rover") + " --quiet --set duration_s=2 --set criteria=[] " +
      "--set pictures.width=320 --set pictures.height=180 --out " + folder.path().string();
  const auto with = test::run_vinerow(run), without = test::run_vinerow(run + " --no-pictures");
  ASSERT_EQ(with.status, 0) << with.output;
  ASSERT_EQ(without.status, 0) << without.output;
  EXPECT_FALSE(test::value_in(with.output, "digest").empty()) << with.output;
  EXPECT_EQ(test::value_in(with.output, "digest"), test::value_in(without.output, "digest"));
}

}  // namespace
}  // namespace vinerow::determinism_test
