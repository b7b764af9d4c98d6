#include "engine/sim/alley_traffic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "tests/support/no_alloc.h"

namespace vinerow::alley_traffic_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLength_m = 30.0;    // of an alley
constexpr double kSpacing_m = 2.5;    // between alleys
constexpr double kApproach_m = 10.0;  // before the first leg and after the last one

/// Parallel alleys along x, alley i at y = 2.5 m i. Ids begin at 100.
std::vector<Alley> make_alleys(int count) {
  std::vector<Alley> alleys;
  for (int i = 0; i < count; ++i) {
    const double y = kSpacing_m * i;
    alleys.push_back({100 + i, {{0, y, 0}, {kLength_m, y, 0}}, kSpacing_m});
  }
  return alleys;
}

/// What a plan occupies, worked out beside the code under test.
struct Occupied {
  double start_m, end_m;
  std::set<int> alleys;
};

/// Up one alley, down the next, with turns of three straights, 2 m out into the headland.
struct Tour {
  PlannedPath plan;
  std::vector<Occupied> occupied;
  double length_m = 0.0;
};

void add_point(PlannedPath& plan, double x, double y, PathKind kind, int alley = -1) {
  PathPoint point;
  point.p_W = {x, y, 0.0};
  point.kind = kind;
  point.alley = alley;
  plan.points.push_back(point);
}

/// @param transit_m  of the transit before the first leg and after the last, 0: none
Tour make_tour(const std::vector<int>& order, double transit_m = kApproach_m) {
  Tour tour;
  double at_m = 0.0, x = 0.0;
  if (transit_m > 0.0) add_point(tour.plan, -transit_m, kSpacing_m * order[0], PathKind::kTransit);
  at_m += transit_m;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double y = kSpacing_m * order[i], far = kLength_m - x;
    tour.occupied.push_back({at_m, at_m + kLength_m, {order[i]}});
    add_point(tour.plan, x, y, PathKind::kLeg, order[i]);
    at_m += kLength_m;
    x = far;
    if (i + 1 == order.size()) break;
    const double out = x > 0.0 ? x + 2.0 : -2.0, next_y = kSpacing_m * order[i + 1];
    add_point(tour.plan, x, y, PathKind::kTurn);
    add_point(tour.plan, out, y, PathKind::kTurn);
    add_point(tour.plan, out, next_y, PathKind::kTurn);
    const double turn_m = 4.0 + std::abs(next_y - y);
    std::set<int> passed;
    for (int k = std::min(order[i], order[i + 1]); k <= std::max(order[i], order[i + 1]); ++k) {
      passed.insert(k);
    }
    tour.occupied.push_back({at_m, at_m + turn_m, passed});
    at_m += turn_m;
  }
  const double y = kSpacing_m * order.back();
  add_point(tour.plan, x, y, PathKind::kTransit);
  if (transit_m > 0.0) {
    add_point(tour.plan, x > 0.0 ? x + transit_m : -transit_m, y, PathKind::kTransit);
    at_m += transit_m;
  }
  tour.length_m = at_m;
  return tour;
}

/// A point that brakes for its authority.
struct Mover {
  Tour tour;
  double speed_mps = 1.0;
  double at_m = 0.0;
  double now_mps = 0.0;
  bool is_done = false;

  void move(double stop_at_m, double dt_s) {
    constexpr double kBraking_mps2 = 0.5;
    const double left_m = std::max(stop_at_m - at_m, 0.0);
    now_mps = std::min({speed_mps, now_mps + kBraking_mps2 * dt_s,
                        std::sqrt(2.0 * kBraking_mps2 * left_m), left_m / dt_s});
    at_m += now_mps * dt_s;
    is_done = at_m >= tour.length_m;
  }
  std::set<int> alleys(double vehicle_m) const {
    std::set<int> all;
    for (const Occupied& stretch : tour.occupied) {
      if (at_m > stretch.start_m && at_m - vehicle_m < stretch.end_m) {
        all.insert(stretch.alleys.begin(), stretch.alleys.end());
      }
    }
    return all;
  }
};

bool is_locked(const AlleyTraffic& traffic) {
  for (int i = 0; i < traffic.vehicles(); ++i) {
    if (traffic.deadlock(i)) return true;
  }
  return false;
}

TrafficVehicle make_vehicle(const std::string& name) {
  TrafficVehicle vehicle;
  vehicle.name = name;
  return vehicle;
}

constexpr Time tick(std::int64_t i) {
  return {i * 100'000'000};
}

/// Vehicles on their tours, ten ticks a second.
struct Yard {
  Yard(const std::vector<Alley>& alleys, std::vector<Mover> all,
       std::vector<std::string> names = {"rover", "drone", "cart", "plane"})
      : movers(std::move(all)), traffic(alleys, describe(names)) {
    for (std::size_t i = 0; i < movers.size(); ++i) {
      traffic.begin(static_cast<int>(i), Time{}, movers[i].tour.plan, movers[i].at_m);
    }
    traffic.serve();
  }
  std::vector<TrafficVehicle> describe(const std::vector<std::string>& names) const {
    std::vector<TrafficVehicle> vehicles;
    for (std::size_t i = 0; i < movers.size(); ++i) vehicles.push_back(make_vehicle(names[i]));
    return vehicles;
  }
  void step() {
    ++ticks;
    for (std::size_t i = 0; i < movers.size(); ++i) {
      if (movers[i].is_done) continue;
      const int vehicle = static_cast<int>(i);
      movers[i].move(traffic.authority(vehicle).stop_at_m, 0.1);
      if (movers[i].is_done) {
        traffic.leave(vehicle, AlleyTraffic::Leaving::kGone);
      } else {
        traffic.advance(vehicle, tick(ticks), movers[i].at_m);
      }
    }
    traffic.serve();
  }
  bool is_done() const {
    return std::all_of(movers.begin(), movers.end(), [](const Mover& m) { return m.is_done; });
  }
  /// Nobody in an alley or turn of another one.
  void expect_apart() const {
    for (std::size_t a = 0; a < movers.size(); ++a) {
      for (std::size_t b = a + 1; b < movers.size(); ++b) {
        if (movers[a].is_done || movers[b].is_done) continue;
        for (const int alley : movers[a].alleys(2.0)) {
          ASSERT_EQ(movers[b].alleys(2.0).count(alley), 0u)
              << traffic.name(static_cast<int>(a)) << " and " << traffic.name(static_cast<int>(b))
              << " in alley " << alley << " at " << 0.1 * static_cast<double>(ticks) << " s";
        }
      }
    }
  }
  /// Until all are done, or longest_s.
  void run(double longest_s) {
    for (const std::int64_t last = ticks + std::lround(10.0 * longest_s);
         ticks < last && !is_done();) {
      step();
      expect_apart();
    }
  }
  std::vector<Mover> movers;
  AlleyTraffic traffic;
  std::int64_t ticks = 0;
};

Mover make_mover(const std::vector<int>& order, double speed_mps = 1.0,
                 double transit_m = kApproach_m) {
  Mover mover;
  mover.tour = make_tour(order, transit_m);
  mover.speed_mps = speed_mps;
  return mover;
}

TEST(AlleyStretches, OfAPlanAreItsLegsTurnsAndTheNearPartOfItsWays) {
  const Tour tour = make_tour({0, 1});
  const auto stretches = find_alley_stretches(tour.plan, make_alleys(3), AlleyUse{});
  ASSERT_EQ(stretches.size(), 3u);
  EXPECT_DOUBLE_EQ(stretches[0].start_m, 6.0);  // 4 m before the leg at 10 m
  EXPECT_DOUBLE_EQ(stretches[0].end_m, 40.0);
  EXPECT_EQ(stretches[0].needs, (std::vector<int>{0}));
  EXPECT_DOUBLE_EQ(stretches[1].end_m, 46.5);
  EXPECT_EQ(stretches[1].needs, (std::vector<int>{0, 1}));
  EXPECT_DOUBLE_EQ(stretches[2].end_m, 80.5);
  EXPECT_EQ(stretches[2].needs, (std::vector<int>{1}));
}

TEST(AlleyStretches, ATurnPastOtherAlleysNeedsThemToo) {
  const Tour tour = make_tour({0, 3});
  const auto stretches = find_alley_stretches(tour.plan, make_alleys(5), AlleyUse{});
  ASSERT_EQ(stretches.size(), 3u);
  EXPECT_EQ(stretches[1].needs, (std::vector<int>{0, 1, 2, 3}));
}

TEST(AlleyStretches, MatchByPlaceNotByNumber) {
  std::vector<Alley> alleys = make_alleys(4);
  std::reverse(alleys.begin(), alleys.end());
  for (Alley& alley : alleys) std::swap(alley.line_W[0], alley.line_W[1]);
  const Tour tour = make_tour({0, 1});
  const auto stretches = find_alley_stretches(tour.plan, alleys, AlleyUse{});
  ASSERT_EQ(stretches.size(), 3u);
  EXPECT_EQ(stretches[0].needs, (std::vector<int>{3}));
  EXPECT_EQ(stretches[2].needs, (std::vector<int>{2}));
  // A made map is 0.3 m next to the true one and has no alley numbers.
  PlannedPath plan = tour.plan;
  for (PathPoint& point : plan.points) {
    point.p_W.y() += 0.3;
    point.alley = -1;
  }
  const auto other = find_alley_stretches(plan, alleys, AlleyUse{});
  ASSERT_EQ(other.size(), 3u);
  EXPECT_EQ(other[0].needs, stretches[0].needs);
  EXPECT_EQ(other[2].needs, stretches[2].needs);
}

TEST(AlleyStretches, FlightsNeedNothingOnTheirWayUpHomeAndDown) {
  PlannedPath plan;
  const auto add = [&plan](double x, double z, PathKind kind, int alley = -1) {
    add_point(plan, x, 0.0, kind, alley);
    plan.points.back().p_W.z() = z;
  };
  add(-10, 0, PathKind::kVertical);
  add(-10, 2, PathKind::kTransit);
  add(0, 2, PathKind::kLeg, 0);
  add(30, 2, PathKind::kReturn);
  add(30, 5, PathKind::kReturn);
  add(-10, 5, PathKind::kVertical);
  add(-10, 0, PathKind::kVertical);
  AlleyUse use;
  use.flies = true;
  const auto stretches = find_alley_stretches(plan, make_alleys(2), use);
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_DOUBLE_EQ(stretches[0].start_m, 8.0);  // 2 m up, 10 m there, less 4 m
  EXPECT_DOUBLE_EQ(stretches[0].end_m, 42.0);
  EXPECT_DOUBLE_EQ(measure_plan(plan, true).back(), 2.0 + 10.0 + 30.0 + 3.0 + 40.0 + 5.0);
  use.approach_m = 0.0;
  EXPECT_DOUBLE_EQ(find_alley_stretches(plan, make_alleys(2), use)[0].start_m, 12.0);
}

TEST(AlleyStretches, AFlightsWayFromRowToRowNeedsBoth) {
  PlannedPath plan;
  add_point(plan, 0, 0, PathKind::kLeg, 0);
  add_point(plan, 30, 0, PathKind::kTransit);
  add_point(plan, 31, 0, PathKind::kTurn);
  add_point(plan, 31, 2.5, PathKind::kTransit);
  add_point(plan, 30, 2.5, PathKind::kLeg, 1);
  add_point(plan, 0, 2.5, PathKind::kTransit);
  add_point(plan, -9, 2.5, PathKind::kTransit);
  AlleyUse use;
  use.flies = true;
  const auto stretches = find_alley_stretches(plan, make_alleys(2), use);
  ASSERT_EQ(stretches.size(), 3u);
  EXPECT_DOUBLE_EQ(stretches[1].start_m, 30.0);
  EXPECT_DOUBLE_EQ(stretches[1].end_m, 34.5);
  EXPECT_EQ(stretches[1].needs, (std::vector<int>{0, 1}));
  EXPECT_DOUBLE_EQ(stretches[2].end_m, 64.5);
}

TEST(AlleyStretches, AreMeasuredAlongArcs) {
  PlannedPath plan;  // half a circle of 2 m in two quarters
  add_point(plan, 0, 0, PathKind::kTurn);
  add_point(plan, 2, 2, PathKind::kTurn);
  add_point(plan, 0, 4, PathKind::kTurn);
  for (PathPoint& point : plan.points) point.curvature_per_m = 0.5;
  EXPECT_NEAR(measure_plan(plan, false).back(), 2.0 * std::acos(-1.0), 1e-12);
}

TEST(AlleyTraffic, OneAfterTheOtherInTheSameDirection) {
  // The slow one goes first; the fast one waits before every turn.
  Yard yard(make_alleys(4), {make_mover({0, 1, 2, 3}, 0.5), make_mover({0, 1, 2, 3}, 2.0)});
  EXPECT_EQ(yard.traffic.authority(0).stop_at_m, 40.0 - 2.0);
  EXPECT_EQ(yard.traffic.authority(0).alley, -1);
  EXPECT_EQ(yard.traffic.authority(1).stop_at_m, 6.0 - 2.0);
  EXPECT_EQ(yard.traffic.authority(1).alley, 100);
  EXPECT_EQ(yard.traffic.authority(1).holder, "rover");
  double ahead_m = 0.0;  // beyond the free way to the rows, where both may be anywhere
  while (!yard.is_done() && yard.ticks < 10000) {
    yard.step();
    yard.expect_apart();
    ASSERT_FALSE(is_locked(yard.traffic));
    if (!yard.movers[0].is_done) ahead_m = yard.movers[0].at_m - yard.movers[1].at_m;
    if (yard.movers[1].at_m > 4.0) {
      ASSERT_GT(ahead_m, 2.0);
    }
  }
  EXPECT_TRUE(yard.is_done());
}

TEST(AlleyTraffic, OppositeOrdersMeetAndAreTold) {
  Yard yard(make_alleys(4), {make_mover({0, 1, 2, 3}), make_mover({3, 2, 1, 0})});
  yard.run(300.0);
  EXPECT_FALSE(yard.is_done());
  ASSERT_TRUE(yard.traffic.deadlock(0).has_value());
  EXPECT_EQ(*yard.traffic.deadlock(0),
            "rover holds alley 101 and waits for alley 102, which drone holds, waiting for alley "
            "101");
  for (const int vehicle : {0, 1}) {
    const Mover& mover = yard.movers[vehicle];
    EXPECT_NEAR(mover.at_m, yard.traffic.authority(vehicle).stop_at_m, 1e-3);
    EXPECT_LT(mover.now_mps, 1e-2);
  }
}

TEST(AlleyTraffic, ACircleOfThreeIsToldWithAllOfThem) {
  const std::vector<Alley> alleys = make_alleys(3);
  AlleyTraffic traffic(alleys, {make_vehicle("a"), make_vehicle("b"), make_vehicle("c")});
  const std::vector<Tour> tours = {make_tour({0, 1}, 0.0), make_tour({1, 2}, 0.0),
                                   make_tour({2, 0}, 0.0)};
  for (int i = 0; i < 3; ++i) traffic.begin(i, Time{}, tours[i].plan);
  for (int i = 0; i < 3; ++i) traffic.advance(i, tick(1), 28.0);
  traffic.serve();
  ASSERT_TRUE(traffic.deadlock(0).has_value());
  EXPECT_EQ(*traffic.deadlock(0),
            "a holds alley 100 and waits for alley 101, which b holds, waiting for alley 102, "
            "which c holds, waiting for alley 100");
}

TEST(AlleyTraffic, OnlyWhoWaitsForeverIsInADeadlock) {
  // a and b block each other. e waits for alley 1 of b, so forever; d waits until c leaves alley 3.
  AlleyTraffic traffic(make_alleys(5), {make_vehicle("a"), make_vehicle("b"), make_vehicle("c"),
                                        make_vehicle("d"), make_vehicle("e")});
  const std::vector<Tour> tours = {make_tour({0, 1}, 0.0), make_tour({1, 0}, 0.0),
                                   make_tour({3}, 0.0), make_tour({4, 3}, 0.0), make_tour({1})};
  for (int i = 0; i < 5; ++i) traffic.begin(i, Time{}, tours[i].plan);
  for (const int i : {0, 1, 3}) traffic.advance(i, tick(1), 28.0);
  traffic.advance(4, tick(1), 5.0);
  traffic.serve();
  EXPECT_EQ(traffic.deadlock(0).value_or(""),
            "a holds alley 100 and waits for alley 101, which b holds, waiting for alley 100");
  EXPECT_EQ(traffic.deadlock(1).value_or(""),
            "b holds alley 101 and waits for alley 100, which a holds, waiting for alley 101");
  EXPECT_EQ(traffic.deadlock(4).value_or(""),
            "e waits for alley 101, which b holds; b holds alley 101 and waits for alley 100, "
            "which a holds, waiting for alley 101");
  EXPECT_EQ(traffic.authority(3).holder, "c");
  EXPECT_FALSE(traffic.deadlock(2));
  EXPECT_FALSE(traffic.deadlock(3));
  traffic.leave(2, AlleyTraffic::Leaving::kGone);
  traffic.serve();
  EXPECT_EQ(traffic.holder(3), 3);
  EXPECT_EQ(traffic.authority(3).stop_at_m, kInfinity);
}

TEST(AlleyTraffic, TheHoldersOfOneTurnAreNeverTwo) {
  // Both end their legs at the same side at the same time; the first in priority turns.
  Yard yard(make_alleys(4), {make_mover({0, 1}, 1.0, 0.0), make_mover({2, 1}, 1.0, 0.0)});
  yard.run(300.0);
  EXPECT_TRUE(yard.is_done());
  EXPECT_FALSE(is_locked(yard.traffic));
}

TEST(AlleyTraffic, WhoAskedFirstGoesFirst) {
  // The second in priority comes to the end of its alley earlier.
  const std::vector<Tour> tours = {make_tour({0, 1}, 0.0), make_tour({2, 1}, 0.0)};
  AlleyTraffic traffic(make_alleys(3), {make_vehicle("rover"), make_vehicle("drone")});
  for (int i = 0; i < 2; ++i) traffic.begin(i, Time{}, tours[i].plan);
  traffic.advance(0, tick(1), 10.0);
  traffic.advance(1, tick(1), 21.0);
  traffic.serve();
  EXPECT_EQ(traffic.authority(1).stop_at_m, kInfinity);
  traffic.advance(0, tick(2), 21.0);
  traffic.serve();
  EXPECT_EQ(traffic.authority(0).stop_at_m, 28.0);
  EXPECT_EQ(traffic.authority(0).holder, "drone");
  // Both at once: priority.
  AlleyTraffic other(make_alleys(3), {make_vehicle("rover"), make_vehicle("drone")});
  for (int i = 0; i < 2; ++i) other.begin(i, Time{}, tours[i].plan);
  for (const int i : {1, 0}) other.advance(i, tick(1), 21.0);
  other.serve();
  EXPECT_EQ(other.authority(0).stop_at_m, kInfinity);
  EXPECT_EQ(other.authority(1).holder, "rover");
}

TEST(AlleyTraffic, TheEarlierOfTwoRequestsForATakenAlleyIsServedFirst) {
  // The cart works in alley 2, into which rover and drone want to turn from either side.
  AlleyTraffic traffic(make_alleys(4),
                       {make_vehicle("rover"), make_vehicle("drone"), make_vehicle("cart")});
  traffic.begin(0, Time{}, make_tour({1, 2}, 0.0).plan);
  traffic.begin(1, Time{}, make_tour({3, 2}, 0.0).plan);
  traffic.begin(2, Time{}, make_tour({2}, 0.0).plan);
  traffic.advance(1, tick(1), 28.0);
  traffic.advance(0, tick(2), 28.0);
  traffic.serve();
  EXPECT_EQ(traffic.authority(0).holder, "cart");
  EXPECT_EQ(traffic.authority(1).holder, "cart");
  traffic.leave(2, AlleyTraffic::Leaving::kGone);
  traffic.serve();
  EXPECT_EQ(traffic.authority(1).stop_at_m, kInfinity);
  EXPECT_EQ(traffic.authority(0).holder, "drone");
}

TEST(AlleyTraffic, WhatAnEarlierRequestNeedsIsKeptForIt) {
  // The rover wants to turn from alley 1 into alley 3, past alley 2; the cart still works in 3.
  AlleyTraffic traffic(make_alleys(4),
                       {make_vehicle("rover"), make_vehicle("drone"), make_vehicle("cart")});
  traffic.begin(0, Time{}, make_tour({1, 3}, 0.0).plan);
  traffic.begin(2, Time{}, make_tour({3}, 0.0).plan);
  traffic.advance(0, tick(1), 28.0);
  // The drone comes later and wants alley 2 alone: free, but the rover asked for it before.
  traffic.begin(1, tick(2), make_tour({2}).plan);
  traffic.serve();
  EXPECT_EQ(traffic.authority(1).stop_at_m, 6.0 - 2.0);
  EXPECT_EQ(traffic.authority(1).alley, 102);
  EXPECT_EQ(traffic.authority(1).holder, "");
  EXPECT_FALSE(is_locked(traffic));
  traffic.leave(2, AlleyTraffic::Leaving::kGone);
  traffic.serve();
  EXPECT_EQ(traffic.authority(0).stop_at_m, kInfinity);
  EXPECT_EQ(traffic.authority(1).holder, "rover");
}

TEST(AlleyTraffic, AnEarlierRequestThatCannotBeServedFirstIsOvertaken) {
  // The rover asked for {1, 2, 3} first, the drone holds 3 and wants 2: waiting for the rover's
  // turn would be a deadlock.
  AlleyTraffic traffic(make_alleys(4), {make_vehicle("rover"), make_vehicle("drone")});
  traffic.begin(0, Time{}, make_tour({0, 3}, 0.0).plan);
  traffic.begin(1, Time{}, make_tour({3, 2}, 0.0).plan);
  traffic.advance(0, tick(1), 28.0);
  traffic.advance(1, tick(1), 0.0);
  traffic.serve();
  EXPECT_EQ(traffic.authority(0).holder, "drone");
  traffic.advance(1, tick(2), 28.0);
  traffic.serve();
  EXPECT_EQ(traffic.authority(1).stop_at_m, kInfinity);
  EXPECT_FALSE(is_locked(traffic));
  traffic.advance(1, tick(3), 64.0);
  traffic.leave(1, AlleyTraffic::Leaving::kGone);
  traffic.serve();
  EXPECT_EQ(traffic.authority(0).stop_at_m, kInfinity);
}

TEST(AlleyTraffic, TheAlleyIsKeptUntilTheTailIsOut) {
  AlleyTraffic traffic(make_alleys(2), {make_vehicle("rover"), make_vehicle("drone")});
  traffic.begin(0, Time{}, make_tour({0, 1}, 0.0).plan);
  EXPECT_EQ(traffic.holder(0), 0);
  EXPECT_EQ(traffic.holder(1), -1);
  traffic.advance(0, tick(1), 25.0);
  traffic.serve();
  EXPECT_EQ(traffic.holder(1), 0);
  traffic.advance(0, tick(2), 36.5 + 1.9);  // the turn ends at 36.5 m, the tail is 2 m behind
  EXPECT_EQ(traffic.holder(0), 0);
  traffic.advance(0, tick(3), 36.5 + 2.0);
  EXPECT_EQ(traffic.holder(0), -1);
  EXPECT_EQ(traffic.holder(1), 0);
}

TEST(AlleyTraffic, StartsInsideAnAlley) {
  Yard yard(make_alleys(3), {make_mover({1, 2}), make_mover({0, 1}, 1.0, 0.0)});
  // The second in priority stands in alley 0 and has it; so has the first nothing to fear there.
  EXPECT_EQ(yard.traffic.holder(0), 1);
  yard.run(300.0);
  EXPECT_TRUE(yard.is_done());
  // In the middle of its plan: what lies behind is not asked for.
  AlleyTraffic traffic(make_alleys(3), {make_vehicle("rover"), make_vehicle("drone")});
  traffic.begin(0, Time{}, make_tour({0, 1, 2}, 0.0).plan, 50.0);
  EXPECT_EQ(traffic.holder(0), -1);
  EXPECT_EQ(traffic.holder(1), 0);
}

TEST(AlleyTraffic, WhoStandsInAnAlleyOfAnotherWaitsForItToLeave) {
  Yard yard(make_alleys(2), {make_mover({0}, 1.0, 0.0), make_mover({0, 1}, 1.0, 0.0)});
  EXPECT_LT(yard.traffic.authority(1).stop_at_m, 0.0);
  EXPECT_EQ(yard.traffic.authority(1).holder, "rover");
  for (int i = 0; i < 1000 && !yard.is_done(); ++i) yard.step();
  EXPECT_TRUE(yard.is_done());
}

TEST(AlleyTraffic, AlleysMayBeVisitedTwice) {
  Yard yard(make_alleys(3), {make_mover({0, 1, 0, 1, 2}), make_mover({2, 2, 1}, 1.0)});
  yard.run(1000.0);
  EXPECT_TRUE(yard.is_done() || is_locked(yard.traffic));
  AlleyTraffic traffic(make_alleys(2), {make_vehicle("rover"), make_vehicle("drone")});
  const Tour tour = make_tour({0, 1, 0}, 0.0);
  traffic.begin(0, Time{}, tour.plan);
  for (std::int64_t i = 0; i <= 700; ++i) {
    traffic.advance(0, tick(i), 0.1 * static_cast<double>(i));
    traffic.serve();
  }
  EXPECT_EQ(traffic.authority(0).stop_at_m, kInfinity);
  EXPECT_EQ(traffic.holder(0), 0);
}

TEST(AlleyTraffic, ASingleAlleyIsSharedInTurn) {
  Yard yard(make_alleys(1), {make_mover({0}), make_mover({0}), make_mover({0})});
  yard.run(400.0);
  EXPECT_TRUE(yard.is_done());
}

TEST(AlleyTraffic, AVehicleThatStaysClosesItsAlleyForGood) {
  for (const bool stays : {false, true}) {
    Yard yard(make_alleys(2), {make_mover({0, 1}), make_mover({0, 1})});
    for (int i = 0; i < 330; ++i) yard.step();  // 32 m: inside alley 0, and may go on into 1
    EXPECT_EQ(yard.traffic.holder(1), 0);
    yard.traffic.leave(0,
                       stays ? AlleyTraffic::Leaving::kStaysThere : AlleyTraffic::Leaving::kGone);
    yard.movers[0].is_done = true;
    for (int i = 0; i < 2000; ++i) yard.step();
    EXPECT_EQ(yard.is_done(), !stays);
    EXPECT_EQ(is_locked(yard.traffic), stays);
    if (stays) {
      EXPECT_EQ(*yard.traffic.deadlock(1), "drone waits for alley 100, in which rover has stopped");
      EXPECT_EQ(yard.traffic.holder(1), -1);
    }
  }
}

TEST(AlleyTraffic, WhoHasNotBegunHoldsNothing) {
  AlleyTraffic traffic(make_alleys(2), {make_vehicle("rover"), make_vehicle("drone")});
  traffic.advance(0, Time{}, 3.0);
  traffic.serve();
  EXPECT_EQ(traffic.authority(0).stop_at_m, kInfinity);
  EXPECT_EQ(traffic.holder(0), -1);
  traffic.begin(1, Time{}, make_tour({0, 1}, 0.0).plan);
  traffic.serve();
  EXPECT_EQ(traffic.holder(0), 1);
  // Another plan, elsewhere: nothing is kept of the first.
  traffic.begin(1, tick(1), make_tour({1, 0}, 0.0).plan);
  EXPECT_EQ(traffic.holder(0), -1);
  EXPECT_EQ(traffic.holder(1), 1);
  traffic.begin(0, tick(1), PlannedPath{});
  traffic.serve();
  EXPECT_EQ(traffic.authority(0).stop_at_m, kInfinity);
}

TEST(AlleyTraffic, TicksTakeNoHeap) {
  Yard yard(make_alleys(4), {make_mover({0, 1, 2}), make_mover({0, 1, 2})});
  std::size_t allocations = 0;
  for (int i = 0; i < 600; ++i) {
    test::AllocationCounter counter;
    yard.step();
    allocations += counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

TEST(AlleyTraffic, RefusesWhatItCannotShare) {
  const auto expect = [](std::vector<Alley> alleys, std::vector<TrafficVehicle> vehicles,
                         const std::string& text) {
    try {
      AlleyTraffic traffic(std::move(alleys), std::move(vehicles));
      ADD_FAILURE() << "must be refused: " << text;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.what(), text);
    }
  };
  expect(make_alleys(1), {make_vehicle("rover")},
         "alley traffic: 1 vehicle cannot share alleys, give at least 2");
  expect(make_alleys(1), {make_vehicle("rover"), make_vehicle("rover")},
         "alley traffic: vehicle 'rover' is named twice");
  TrafficVehicle bad = make_vehicle("drone");
  bad.look_ahead_m = -1.0;
  expect(make_alleys(1), {make_vehicle("rover"), bad},
         "alley traffic: look_ahead_m of vehicle 'drone' is -1, must be >= 0");
  std::vector<Alley> alleys = make_alleys(1);
  alleys[0].line_W.pop_back();
  expect(alleys, {make_vehicle("rover"), make_vehicle("drone")},
         "alley traffic: the centre line of alley 100 has 1 points, must have at least 2");
}

TEST(AlleyTraffic, NobodyMeetsAndNobodyWaitsForEverUnsaid) {
  int done = 0, locked = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    RandomStream random(seed, "", "traffic");
    const auto pick = [&](int count) {
      return std::min(static_cast<int>(random.uniform(0.0, count)), count - 1);
    };
    const int alleys = 1 + pick(8), vehicles = 2 + pick(3);
    std::vector<Alley> shuffled = make_alleys(alleys);
    for (int i = alleys - 1; i > 0; --i) std::swap(shuffled[i], shuffled[pick(i + 1)]);
    std::vector<Mover> movers;
    const bool may_meet = pick(3) == 0;
    for (int i = 0; i < vehicles; ++i) {
      std::vector<int> order;
      const int legs = 1 + pick(6);
      for (int k = 0; k < legs; ++k) order.push_back(pick(alleys));
      // Rising orders of plans, as neighbours drive them, rarely stand in each other's way.
      if (!may_meet) std::sort(order.begin(), order.end());
      movers.push_back(make_mover(order, random.uniform(0.3, 3.0), kApproach_m));
    }
    Yard yard(shuffled, movers);
    double moved_s = 0.0, at_m = 0.0;
    while (!yard.is_done()) {
      yard.step();
      yard.expect_apart();
      if (::testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
      double sum_m = 0.0;
      for (const Mover& mover : yard.movers) sum_m += mover.at_m;
      const double now_s = 0.1 * static_cast<double>(yard.ticks);
      if (sum_m > at_m + 1e-3) {
        at_m = sum_m;
        moved_s = now_s;
      }
      if (now_s > moved_s + 30.0) {
        ASSERT_TRUE(is_locked(yard.traffic)) << "seed " << seed;
        ++locked;
        break;
      }
      ASSERT_LT(now_s, 5000.0) << "seed " << seed;
    }
    done += yard.is_done() ? 1 : 0;
  }
  RecordProperty("done", done);
  RecordProperty("locked", locked);
  EXPECT_GT(done, 200);
  EXPECT_GT(locked, 20);
}

}  // namespace
}  // namespace vinerow::alley_traffic_test
