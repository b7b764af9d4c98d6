#include "controllers/planning/routes/row_route.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

Pose2 heading_along(const Eigen::Vector2d& at, const Eigen::Vector2d& from,
                    const Eigen::Vector2d& to) {
  return {at, std::atan2(to.y() - from.y(), to.x() - from.x())};
}

std::vector<int> driving_order(const RowMap& map, const RowRouteParams& params) {
  std::vector<int> chosen = params.alleys;
  if (chosen.empty()) {
    for (std::size_t i = 0; i < map.alleys.size(); ++i) chosen.push_back(static_cast<int>(i));
  }
  std::vector<int> ordered;
  for (const int place : make_alley_order(static_cast<int>(chosen.size()), params.order)) {
    ordered.push_back(chosen[place]);
  }
  return ordered;
}

}  // namespace

Pose2 RouteLeg::entry() const {
  return heading_along(line_W.front(), line_W[0], line_W[1]);
}

Pose2 RouteLeg::exit() const {
  return heading_along(line_W.back(), line_W[line_W.size() - 2], line_W.back());
}

const ParameterTable<RowRouteParams>& row_route_table() {
  using P = RowRouteParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .numbers("alleys", "", &P::alleys, between(0.0, 1e6),
                   "indices of the alleys to drive, in order; empty = all of the map")
          .choice("order", &P::order,
                  {{"serpentine", AlleyOrder::kSerpentine}, {"skip", AlleyOrder::kSkip}},
                  "serpentine: neighbouring alleys one after another; skip: every second alley, "
                  "the others on the way back, for wide turns")
          .number("straighten_m", "m", &P::straighten_m, between(0.0, 10.0),
                  "tolerance within which vertices of an alley's line are left out of a straight");
  return table;
}

void RowRouteParams::demand_alleys(int alley_count, const std::string& who) const {
  for (auto alley = alleys.begin(); alley != alleys.end(); ++alley) {
    if (*alley < 0 || *alley >= alley_count) {
      throw ConfigError(fmt::format("{}: alleys holds {}, must be whole numbers from 0 to {}", who,
                                    *alley, alley_count - 1));
    }
    if (std::find(alleys.begin(), alley, *alley) != alley) {
      throw ConfigError(fmt::format("{}: alleys holds {} twice", who, *alley));
    }
  }
}

Result<std::vector<RouteLeg>> make_row_route(const RowMap& map, const RowRouteParams& params,
                                             const Eigen::Vector2d& start_W) {
  if (map.alleys.empty()) return Failure{"the map has no alleys to drive"};
  std::vector<RouteLeg> legs;
  Eigen::Vector2d at = start_W;  // position of the vehicle after the legs so far
  for (const int alley : driving_order(map, params)) {
    if (alley < 0 || alley >= static_cast<int>(map.alleys.size())) {
      return Failure{
          fmt::format("the map has no alley {}, only 0 to {}", alley, map.alleys.size() - 1)};
    }
    RouteLeg leg{alley, simplify_line(map.alleys[alley].line_W, params.straighten_m)};
    if (leg.line_W.size() < 2) {
      return Failure{fmt::format("alley {} of the map has no length", alley)};
    }
    if ((leg.line_W.back() - at).norm() < (leg.line_W.front() - at).norm()) {
      std::reverse(leg.line_W.begin(), leg.line_W.end());
    }
    at = leg.line_W.back();
    legs.push_back(std::move(leg));
  }
  for (std::size_t i = 0; i < legs.size() && params.beyond_m > 0.0; ++i) {
    std::vector<Eigen::Vector2d>& line = legs[i].line_W;
    const Pose2 entry = legs[i].entry(), exit = legs[i].exit();
    if (i > 0) line.front() = advance(entry, -params.beyond_m, 0.0).p;
    if (i + 1 < legs.size()) line.back() = advance(exit, params.beyond_m, 0.0).p;
  }
  return legs;
}

void append_leg(const RouteLeg& leg, double speed_mps, std::vector<PathSegment>& pieces) {
  for (std::size_t i = 0; i + 1 < leg.line_W.size(); ++i) {
    pieces.push_back(
        make_straight(leg.line_W[i], leg.line_W[i + 1], PathKind::kLeg, leg.alley, speed_mps));
  }
}

}  // namespace vinerow::controllers
