#include "tools/replay/replay_plans.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/api/world_model.h"
#include "tools/replay/simplify_line.h"

namespace vinerow::tools {
namespace {

using nlohmann::json;

constexpr double kTolerance_m = 0.03;

std::vector<Eigen::Vector3d> line_of(const PlannedPath& plan, const WorldModel& world) {
  std::vector<Eigen::Vector3d> line;
  for (const PathPoint& point : plan.points) {
    Eigen::Vector3d p = point.p_W;
    if (world.terrain) p.z() = std::max(p.z(), world.terrain->height_m(p.x(), p.y()));
    line.push_back(p);
  }
  return simplify_line(line, kTolerance_m);
}

}  // namespace

void add_plans(const ReplayInput& input, const ReplayLimits& limits, ReplayTracks& tracks) {
  std::size_t left = limits.plan_points;
  std::size_t left_out = 0;
  for (json& vehicle : tracks.index["vehicles"]) {
    const playback::Trace<PlannedPath>& plans =
        input.trace->vehicles.at(vehicle["name"].get<std::string>()).plan;
    vehicle["plans"] = json::array();
    std::vector<Eigen::Vector3d> last;
    for (std::size_t i = 0; i < plans.values.size(); ++i) {
      std::vector<Eigen::Vector3d> line = line_of(plans.values[i], *input.world);
      if (line.size() < 2 || line == last) continue;
      if (line.size() > left) {
        ++left_out;
        continue;
      }
      left -= line.size();
      while (tracks.bytes.size() % 4 != 0) tracks.bytes += '\0';
      vehicle["plans"].push_back({{"t", (plans.times[i] - input.trace->first).s()},
                                  {"points", tracks.bytes.size()},
                                  {"count", line.size()}});
      for (const Eigen::Vector3d& p : line) {
        const Eigen::Vector3f rounded = p.cast<float>();
        tracks.bytes.append(reinterpret_cast<const char*>(rounded.data()), 3 * sizeof(float));
      }
      last = std::move(line);
    }
  }
  if (left_out > 0) {
    tracks.notes.push_back(
        fmt::format("{} plans are not shown: the page has a limit on plan points", left_out));
  }
}

}  // namespace vinerow::tools
