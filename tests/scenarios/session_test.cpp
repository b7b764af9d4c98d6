/// Sessions: what is reset, stepped in slices or shared between threads gives the bits of a process
/// of its own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <thread>

#include "engine/api/messages/sensors.h"
#include "engine/core/error.h"
#include "engine/run/run.h"
#include "engine/scenario/scenario_seed.h"
#include "engine/sim/vehicle_runtime.h"
#include "tests/scenarios/session_support.h"
#include "tools/parts/register_all.h"

namespace vinerow::session_test {
namespace {

using test::all_of;
using test::scenario_file;
using ::testing::HasSubstr;

void run_to(Session& session, double end_s) {
  if (!session.over()) session.advance(Time{} + duration_from_s(end_s));
}

struct Shipped {
  const char* name;
  double end_s;
  std::vector<std::string> sets = {};
};

void PrintTo(const Shipped& shipped, std::ostream* out) {
  *out << shipped.name;
}

class ResetSession : public ::testing::TestWithParam<Shipped> {};

TEST_P(ResetSession, ComputesWhatAFreshOneDoes) {
  const auto& [name, end_s, sets] = GetParam();
  Session session = open_session(scenario_file(name), {sets, 1});
  run_to(session, end_s);
  const std::vector<std::string> first = all_of(session);

  session.reset(2);
  EXPECT_EQ(session.now().ns, 0);
  run_to(session, end_s);
  Session fresh = open_session(scenario_file(name), {sets, 2});
  EXPECT_EQ(session.scenario().resolved_yaml, fresh.scenario().resolved_yaml);
  run_to(fresh, end_s);
  EXPECT_EQ(all_of(session), all_of(fresh));
  EXPECT_NE(all_of(session), first);

  session.reset(1);
  run_to(session, 0.4 * end_s);  // given up half way
  session.reset();
  run_to(session, end_s);
  EXPECT_EQ(all_of(session), first);
}

// A rover by the paper, a quadrotor in gusts that come by chance, an aircraft with wings, sensors
// with estimators, a mission whose first phase ends.
INSTANTIATE_TEST_SUITE_P(
    Scenarios, ResetSession,
    ::testing::Values(
        Shipped{"riseholme_rover", 4.0},
        Shipped{"quadrotor_gust",
                2.0,
                {"world.wind.random_gusts={interval_s: 1, amplitude_mps: 2, duration_s: 0.5}"}},
        Shipped{"trmpc_stress", 1.0}, Shipped{"localisation_closed_loop", 1.5},
        Shipped{"cooperative_small", 12.0}),
    [](const auto& shipped) { return std::string(shipped.param.name); });

TEST(Session, SlicesChangeNothing) {
  Session whole = open_session(scenario_file("riseholme_rover"));
  whole.advance(Time{2'000'000'000});
  Session sliced = whole.twin();
  sliced.advance(Time{-5});  // before the first instant: nothing happens
  EXPECT_EQ(sliced.steps(), 0u);
  sliced.advance_for(Duration{7'000'000});
  EXPECT_EQ(sliced.now().ns, 7'000'000);
  for (std::int64_t ns = 100'000'000; ns < 2'000'000'000; ns += 333'333'333) {
    sliced.advance(Time{ns});
  }
  sliced.advance(Time{2'000'000'000});
  EXPECT_EQ(sliced.now(), whole.now());
  EXPECT_EQ(all_of(sliced), all_of(whole));
}

TEST(Session, HasTheDigestAndTheEventsOfACommandsRun) {
  Session session = open_session(scenario_file("orchard_rover"), {{"duration_s=2"}, {}});
  while (!session.over()) session.advance_for(Duration{300'000'000});

  Registry registry;
  register_all(registry);
  const run::RunResult result = run::run_scenario(session.scenario(), registry, {});
  EXPECT_EQ(session.digest(), result.digest);

  const std::vector<SessionEvent> events = session.take_events();
  ASSERT_GE(events.size(), 2u);
  EXPECT_EQ(events.front().event.text, "started 'orchard_rover'");
  EXPECT_EQ(events.back().event.text, "duration is over");
  EXPECT_EQ(events.back().time, session.now());
}

TEST(Session, SignalsOutliveResetWithTheMemoryOfTheirRun) {
  std::shared_ptr<const void> memory;
  const Odometry* truth = nullptr;
  Odometry copy;
  {
    Session session = open_session_text(test::kFreeRover);
    session.advance(Time{50'000'000});
    memory = session.run_memory();
    truth = &session.signal<Odometry>("rover/truth").value();
    copy = *truth;
    session.reset(2);
    session.advance(Time{100'000'000});
    EXPECT_NE(truth, &session.signal<Odometry>("rover/truth").value());
  }
  EXPECT_EQ(truth->X_WB.p, copy.X_WB.p);
}

TEST(Session, ManyOnThreadsOfTheirOwnDoNotDisturbEachOther) {
  constexpr int kThreads = 4;
  constexpr double kEnd_s = 1.5;
  // Two that share a world, and two that load and build everything at the same time.
  Session first = open_session(scenario_file("riseholme_rover"), {{}, 1});
  Session twin = first.twin();
  std::vector<std::vector<std::string>> seen(kThreads);
  std::vector<std::thread> threads;
  threads.emplace_back([&] {
    run_to(first, kEnd_s);
    seen[0] = all_of(first);
  });
  threads.emplace_back([&] {
    twin.reset(2);
    run_to(twin, kEnd_s);
    seen[1] = all_of(twin);
  });
  for (int k = 2; k < kThreads; ++k) {
    threads.emplace_back([&seen, k] {
      Session own =
          open_session(scenario_file("riseholme_rover"), {{}, static_cast<std::uint64_t>(k + 1)});
      run_to(own, kEnd_s);
      seen[k] = all_of(own);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int k = 0; k < kThreads; ++k) {
    Session alone =
        open_session(scenario_file("riseholme_rover"), {{}, static_cast<std::uint64_t>(k + 1)});
    run_to(alone, kEnd_s);
    EXPECT_EQ(seen[k], all_of(alone)) << "thread " << k;
  }
}

TEST(Session, KeepsAWorldThatTheSeedDoesNotChange) {
  Session session = open_session_text(test::kFreeRover);
  const WorldModel* world = &session.simulation().world();
  session.reset(7);
  EXPECT_EQ(&session.simulation().world(), world);
  EXPECT_EQ(session.seed(), 7u);
}

TEST(Session, KeepsTheSceneWhereTheSeedChangesGustsAlone) {
  Session session = open_session_text(
      test::kFreeRover, ".",
      {{"world.wind={mean_speed_mps: 3, random_gusts: {interval_s: 5}}"}, std::nullopt});
  const auto scene = session.simulation().built_world().scene;
  session.reset(7);
  EXPECT_EQ(session.simulation().world().wind.random_gusts->seed, 7u);
  EXPECT_EQ(session.simulation().built_world().scene, scene);
}

/// Its ground rises with the seed, and it does not say that it ignores it.
std::unique_ptr<WorldModel> make_seeded_ground(const ParameterSet&, const WorldContext& context) {
  auto world = std::make_unique<WorldModel>();
  HeightField ground;
  ground.columns = ground.rows = 2;
  ground.cell_m = 100.0;
  ground.corner_W = {-50, -50};
  ground.heights_m.assign(4, static_cast<float>(context.seed));
  world->terrain = ground;
  return world;
}

TEST(Session, BuildsAWorldAnewThatTheSeedChanges) {
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  PartSpec spec;
  spec.name = "seeded_ground";
  registry->add_world(spec, make_seeded_ground);
  const scenario::Scenario scenario = scenario::parse_scenario(
      "{vinerow: 1, name: x, seed: 3, duration_s: 1, world: {type: seeded_ground}, "
      "vehicles: {rover: {type: diff_drive_rover, spawn: {x_m: 0, y_m: 0, yaw_deg: 0}}}}",
      ".", *registry);
  Session session(scenario, registry);
  const auto height_m = [&] {
    session.advance(Time{});
    return session.signal<Odometry>("rover/truth").value().X_WB.p.z();
  };
  const double low_m = height_m();
  session.reset(5);
  EXPECT_NEAR(height_m() - low_m, 2.0, 1e-6);
  EXPECT_EQ(session.simulation().world().terrain->heights_m[0], 5.0f);
}

TEST(Session, ViewsSeeEveryRunAndNoneAfterTheSession) {
  SignalView<Odometry> truth;
  SignalView<GnssFix> gps;
  {
    Session session = open_session_text(test::kFreeRover);
    truth = session.signal<Odometry>("rover/truth");
    gps = session.signal<GnssFix>("rover/gps");
    EXPECT_FALSE(truth.has_value());
    session.advance(Time{50'000'000});
    EXPECT_EQ(truth.stamp().ns, 50'000'000);
    EXPECT_EQ(truth.sequence(), 51u);
    EXPECT_EQ(gps.sequence(), 1u);
    std::uint64_t seen = 0;
    EXPECT_TRUE(gps.is_newer_than(seen));
    EXPECT_FALSE(gps.is_newer_than(seen));
    EXPECT_EQ(&truth.value(), &session.signal<Odometry>("rover/truth").value()) << "a copy";

    session.reset();
    EXPECT_FALSE(truth.has_value());
    session.advance(Time{});
    EXPECT_EQ(truth.stamp().ns, 0);

    Session moved = std::move(session);
    moved.advance(Time{1'000'000});
    EXPECT_EQ(truth.stamp().ns, 1'000'000);
  }
  EXPECT_FALSE(truth.has_value());
}

TEST(Session, TellsWhatThereIs) {
  Session session = open_session(scenario_file("cooperative_small"), {{"duration_s=11"}, {}});
  EXPECT_EQ(session.vehicles().size(), session.simulation().vehicles().size());
  const std::vector<SignalInfo> signals = session.signals();
  EXPECT_EQ(signals.front().name, "run/events");
  EXPECT_EQ(signals.front().type, "Event");
  EXPECT_EQ(signals.front().writer, "run");
  EXPECT_EQ(&session.any_signal(signals.back().name),
            session.simulation().bus().signals().back().get());

  // The survey waits for calm air.
  session.advance(Time{8'000'000'000});
  EXPECT_EQ(session.phases().front().state, "waiting");
  session.advance(Time{9'000'000'000});
  EXPECT_EQ(session.phases().front().state, "running");
  EXPECT_EQ(session.phases().front().begin, Time{9'000'000'000});
  const std::vector<SessionEvent> events = session.take_events();
  const auto begins = [](const SessionEvent& event) {
    return event.time == Time{9'000'000'000} && event.event.text == "phase 'survey' begins";
  };
  EXPECT_EQ(std::count_if(events.begin(), events.end(), begins), 1);
  EXPECT_TRUE(session.take_events().empty());
  while (!session.over()) session.advance_for(Duration{500'000'000});
  EXPECT_EQ(session.now().ns, 11'000'000'000);
  EXPECT_EQ(session.phases().front().state, "failed");
  EXPECT_FALSE(session.finished());
  EXPECT_TRUE(session.crashes().empty());
}

TEST(Session, AScenarioWithAnotherSeedIsWhatLoadingItGives) {
  Registry registry;
  register_all(registry);
  scenario::Overrides overrides;
  overrides.seed = 18446744073709551ull;
  const auto load = [&](const scenario::Overrides& with) {
    return scenario::load_scenario(scenario_file("cooperative_small"), registry, with);
  };
  const scenario::Scenario changed = scenario::with_seed(load({}), *overrides.seed);
  EXPECT_EQ(changed.resolved_yaml, load(overrides).resolved_yaml);
  EXPECT_EQ(changed.seed, *overrides.seed);
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(Session, SaysWhatIsWrong) {
  Session session = open_session_text(test::kFreeRover);
  EXPECT_THAT(message_of([&] { session.signal<Odometry>("rover/truht"); }),
              HasSubstr("no signal 'rover/truht'; did you mean 'rover/truth'?"));
  EXPECT_EQ(message_of([&] { session.signal<GnssFix>("rover/truth"); }),
            "signal 'rover/truth' is Odometry, not GnssFix");
  EXPECT_THAT(message_of([&] { session.any_signal("rover/gpss"); }), HasSubstr("rover/gps"));
  while (!session.over()) session.advance_for(Duration{1'000'000'000});
  EXPECT_EQ(message_of([&] { session.advance_for(Duration{1'000'000}); }),
            "advance: session 'free_rover' is over at 3 s; call reset() to restart");
  EXPECT_THAT(message_of([] { open_session("no_such_file.yaml"); }), HasSubstr("no_such_file"));
}

TEST(Session, CanBeResetAfterItBrokeOff) {
  // Driven off the terrain's edge.
  Session session = open_session_text(
      "{vinerow: 1, name: edge, duration_s: 20, world: {type: vineyard, row_count: 2, "
      "row_length_m: 20, leaf_cards_per_m: 10, plant_variants: 1}, vehicles: {rover: {type: "
      "diff_drive_rover, spawn: {alley: 0, offset_m: 9}}}}",
      ".", {}, SessionOptions().take_over<NamedValues>("rover/actuators"));
  NamedValues backwards{{"wheel_fl_speed_radps", "wheel_fr_speed_radps", "wheel_rl_speed_radps",
                         "wheel_rr_speed_radps"},
                        {-9, -9, -9, -9}};
  session.command("rover/actuators", Time{}, backwards);
  EXPECT_THROW(session.advance(Time{20'000'000'000}), SimulationError);
  const Time end = session.now();
  EXPECT_GT(end.s(), 0.5);
  EXPECT_THAT(message_of([&] { session.advance_for(Duration{1'000'000}); }),
              HasSubstr("session 'edge' broke off: "));
  EXPECT_THAT(message_of([&] { session.command("rover/actuators", end, backwards); }),
              HasSubstr("broke off"));
  EXPECT_GT(session.metrics().at("rover").at("distance_m"), 0.5);
  session.reset();
  session.advance(Time{1'000'000'000});
  EXPECT_EQ(session.now().ns, 1'001'000'000);
}

}  // namespace
}  // namespace vinerow::session_test
