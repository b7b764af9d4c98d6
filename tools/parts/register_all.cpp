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
  worlds::register_worlds(registry);
  vehicles::register_vehicles(registry);
  sensors::register_sensors(registry);
  controllers::register_controllers(registry);
  metrics::register_metrics(registry);
  register_truth_estimator(registry);
  register_plan_job(registry);
}

}  // namespace vinerow
