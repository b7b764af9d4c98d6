#include "engine/sim/plan_job.h"

#include <fmt/format.h>

#include <utility>

#include "engine/api/parameter_table.h"

namespace vinerow {
namespace {

struct PlanJobParams {
  std::string vehicle;
};

const ParameterTable<PlanJobParams>& plan_job_table() {
  using P = PlanJobParams;
  static const ParameterTable<P> table =
      ParameterTable<P>().text("vehicle", &P::vehicle, "name of the vehicle").required();
  return table;
}

class PlanJob : public Job {
 public:
  PlanJob(const ParameterSet& parameters, const JobContext& context)
      : context_(context), of_vehicle_(plan_job_table().read(parameters, "").vehicle) {}

  Result<JobOutcome> run(const std::map<std::string, Product>& inputs) override {
    const auto map = inputs.find("map");
    Result<PlannedPath> planned =
        context_.plan(of_vehicle_, map == inputs.end() ? nullptr : map->second.map);
    if (!planned) return Failure{planned.reason()};
    auto plan = std::make_shared<PlannedPath>(std::move(planned).value());
    if (plan->points.empty()) {
      return Failure{fmt::format("the plan of vehicle '{}' has no points", of_vehicle_)};
    }
    JobOutcome outcome;
    outcome.numbers = {{"length_m", plan->length_m},
                       {"points", static_cast<double>(plan->points.size())}};
    outcome.product.kind = ProductKind::kPlan;
    outcome.product.plan = std::move(plan);
    return outcome;
  }

 private:
  const JobContext context_;
  const std::string of_vehicle_;
};

std::vector<ResultSpec> plan_results() {
  using Range = ResultRange;
  return {
      {"length_m", "m", Range::from_zero(), "planned length",
       "Length of the path planned by the job `plan`.", ""},
      {"points", "1", Range::count(), "points of the plan", "Number of points of the plan.", ""}};
}

}  // namespace

void register_plan_job(Registry& registry) {
  PartSpec spec;
  spec.name = "plan";
  spec.results = plan_results();
  spec.description =
      "plans a path for a vehicle from its present pose, with its own planner, before the phase in "
      "which it drives";
  plan_job_table().add_to(spec);
  spec.takes = {{"map", ProductKind::kMap, false, "map to plan on; default: the vehicle's own"}};
  spec.gives = ProductKind::kPlan;
  registry.add_job(std::move(spec), [](const ParameterSet& parameters, const JobContext& context) {
    return std::make_unique<PlanJob>(parameters, context);
  });
}

}  // namespace vinerow
