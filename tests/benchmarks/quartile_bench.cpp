/// Searches of the planner rrt_quartile on hand-made grids of paper A's size: 2.5 m rows, virtual
/// walls, margin 0.05 m. A new seed each time; the counters are means per search.

#include <benchmark/benchmark.h>

#include "controllers/planning/search/rrt_quartile.h"
#include "engine/math/angles.h"
#include "tests/controllers/planning/search/hand_grids.h"

namespace vinerow::quartile_bench {
namespace {

using hand_grids::Vineyard;

struct Problem {
  Vineyard vineyard;
  double curvature_per_m = 1.0 / 1.767;
  controllers::DistanceKind heuristic = controllers::DistanceKind::kGeodesic;
  bool quartiles = true;
  double inside_m = 0.0;  ///< start and goal this far inside their alleys; 0: the turn alone
};

void search(benchmark::State& state, const Problem& problem) {
  const OccupancyGrid grid = problem.vineyard.make();
  const controllers::DistanceField field(grid);
  const controllers::Footprint footprint(field, hand_grids::rover_outline_B(), 0.05);
  controllers::RrtQuartileParams params;
  params.tree.curvature_per_m = problem.curvature_per_m;
  params.tree.quartiles = problem.quartiles;
  params.heuristic = problem.heuristic;
  const controllers::Pose2 from =
      problem.inside_m > 0.0
          ? controllers::advance(problem.vineyard.entry(0), problem.inside_m, 0.0)
          : problem.vineyard.exit(0);
  const controllers::Pose2 to =
      problem.inside_m > 0.0
          ? controllers::advance(problem.vineyard.exit(1), -problem.inside_m, 0.0)
          : problem.vineyard.entry(1);
  PartContext context;
  double nodes = 0.0, solved = 0.0, length_m = 0.0, first_m = 0.0;
  for (auto _ : state) {
    ++context.seed;
    controllers::SearchReport report;
    const auto pieces =
        controllers::RrtQuartile(params, context).find(from, to, footprint, 1, report);
    nodes += static_cast<double>(report.nodes);
    if (!pieces) continue;
    ++solved;
    length_m += hand_grids::length_m(*pieces);
    first_m += report.first_length_m;
  }
  const auto runs = static_cast<double>(state.iterations());
  state.counters["nodes"] = nodes / runs;
  state.counters["solved"] = solved / runs;
  if (solved > 0.0) {
    state.counters["length_m"] = length_m / solved;
    state.counters["first_length_m"] = first_m / solved;
  }
}

Problem turn(bool walls = true) {
  Problem problem;
  problem.vineyard.walls = walls;
  return problem;
}

Problem two_wheel(Problem problem) {
  problem.curvature_per_m = std::tan(kPi / 6.0) / 1.5;
  return problem;
}

Problem one_search(double rows_m,
                   controllers::DistanceKind heuristic = controllers::DistanceKind::kGeodesic,
                   bool quartiles = true) {
  Problem problem;
  problem.vineyard.length_m = rows_m;
  problem.inside_m = 1.0;
  problem.heuristic = heuristic;
  problem.quartiles = quartiles;
  return problem;
}

#define VINEROW_SEARCH(name, problem) \
  BENCHMARK_CAPTURE(search, name, problem)->Unit(benchmark::kMillisecond)->Iterations(20)

VINEROW_SEARCH(turn, turn());
VINEROW_SEARCH(turn_without_walls, turn(false));
VINEROW_SEARCH(two_wheel_turn_exhausted, two_wheel(turn()));
VINEROW_SEARCH(two_wheel_turn_without_walls, two_wheel(turn(false)));
VINEROW_SEARCH(rows_30m, one_search(30.0));
VINEROW_SEARCH(rows_30m_euclid, one_search(30.0, controllers::DistanceKind::kEuclid));
VINEROW_SEARCH(rows_30m_without_quartiles,
               one_search(30.0, controllers::DistanceKind::kGeodesic, false));
VINEROW_SEARCH(rows_118m, one_search(118.0));
VINEROW_SEARCH(rows_118m_euclid, one_search(118.0, controllers::DistanceKind::kEuclid));

/// The 14 turns of 15 alleys of 118 m, without grid and field.
void turns_of_a_parcel(benchmark::State& state) {
  Vineyard vineyard;
  vineyard.length_m = 118.0;
  vineyard.alleys = 15;
  const OccupancyGrid grid = vineyard.make();
  const controllers::DistanceField field(grid);
  const controllers::Footprint footprint(field, hand_grids::rover_outline_B(), 0.05);
  controllers::RrtQuartileParams params;
  params.tree.curvature_per_m = 1.0 / 1.767;
  PartContext context;
  double nodes = 0.0, solved = 0.0;
  for (auto _ : state) {
    ++context.seed;
    controllers::RrtQuartile planner(params, context);
    for (int i = 1; i < vineyard.alleys; ++i) {
      controllers::SearchReport report;
      solved += planner.find(vineyard.exit(i - 1), vineyard.entry(i), footprint, i, report).ok();
      nodes += static_cast<double>(report.nodes);
    }
  }
  state.counters["nodes"] = nodes / static_cast<double>(state.iterations());
  state.counters["solved"] = solved / static_cast<double>(state.iterations());
}
BENCHMARK(turns_of_a_parcel)->Unit(benchmark::kMillisecond)->Iterations(5);

}  // namespace
}  // namespace vinerow::quartile_bench
