#include "tools/parts/register_all.h"

#include "controllers/register.h"
#include "engine/sensors/register.h"
#include "engine/sim/metrics/register.h"
#include "engine/sim/plan_job.h"
#include "vehicles/register.h"
#include "worlds/register.h"

namespace vinerow {

void register_all(Registry& registry) {
  register_worlds(registry);
  register_vehicles(registry);
  register_sensors(registry);
  register_controllers(registry);
  register_metrics(registry);
  register_plan_job(registry);
}

}  // namespace vinerow
