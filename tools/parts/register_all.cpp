#include "tools/parts/register_all.h"

#include "controllers/register_controllers.h"
#include "engine/metrics/register_metrics.h"
#include "engine/sensors/register_sensors.h"
#include "engine/sim/plan_job.h"
#include "engine/sim/truth_estimator.h"
#include "vehicles/register_vehicles.h"
#include "worlds/register_worlds.h"

namespace vinerow {

void register_all(Registry& registry) {
  register_worlds(registry);
  register_vehicles(registry);
  register_sensors(registry);
  register_controllers(registry);
  register_metrics(registry);
  register_truth_estimator(registry);
  register_plan_job(registry);
}

}  // namespace vinerow
