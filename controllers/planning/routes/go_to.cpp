#include "controllers/planning/routes/go_to.h"

#include <fmt/format.h>

#include "controllers/planning/routes/place_route.h"
#include "engine/api/parameter_table.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

struct GoToParams {
  std::vector<double> x_m, y_m;
  std::optional<double> bearing_rad;
  PlaceRouteParams route;
};

const ParameterTable<GoToParams>& go_to_table() {
  using P = GoToParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .numbers("x_m", "m", &P::x_m, kAnyNumber, "x of the places in W (east), in their order")
          .numbers("y_m", "m", &P::y_m, kAnyNumber, "y of the places in W (north), as many as x_m")
          .degrees(
              "end_bearing_deg", &P::bearing_rad, between(-360.0, 360.0),
              "heading at the last place, clockwise from north; default: the direction of arrival")
          .include(&P::route, place_route_table())
          .rule([](const P& p) -> std::string {
            if (p.x_m.size() != p.y_m.size()) {
              return fmt::format("x_m has {} numbers and y_m {}, must be as many", p.x_m.size(),
                                 p.y_m.size());
            }
            return p.x_m.empty() ? "needs at least one place, x_m and y_m" : "";
          });
  return table;
}

class GoTo final : public Planner {
 public:
  GoTo(const GoToParams& params, const PlannerContext& context, const std::string& who)
      : route_(params.route, *context.vehicle_description, context.map, context, who),
        scene_(context.scene) {
    for (std::size_t i = 0; i < params.x_m.size(); ++i) {
      places_.emplace_back(params.x_m[i], params.y_m[i]);
    }
    if (params.bearing_rad) end_yaw_rad_ = 0.5 * kPi - *params.bearing_rad;
  }

  const PlanReport* report() const override { return &route_.report(); }

  Result<PlannedPath> plan(const Pose& start) override {
    return route_.find(start, places_, end_yaw_rad_, scene_);
  }

 private:
  PlaceRoute route_;
  const SceneQuery* scene_;
  std::vector<Eigen::Vector2d> places_;
  std::optional<double> end_yaw_rad_;
};

}  // namespace

PartSpec go_to_spec() {
  PartSpec spec;
  spec.name = "go_to";
  spec.description =
      "Path from the vehicle's position to given places, around rows and mapped obstacles: the "
      "shortest Dubins path if it is free, else the shortened result of the quartile tree of "
      "rrt_quartile on the occupancy grid.";
  go_to_table().add_to(spec);
  spec.reads = {"estimate"};
  spec.writes = {"plan", "plan_tree"};
  return spec;
}

std::unique_ptr<Planner> make_go_to(const ParameterSet& parameters, const PlannerContext& context) {
  const std::string who = context.part + " (go_to)";
  return std::make_unique<GoTo>(go_to_table().read(parameters, who), context, who);
}

}  // namespace vinerow::controllers
