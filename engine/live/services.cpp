#include "engine/live/services.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/live/entities.h"
#include "engine/live/message_json.h"
#include "engine/record/ros_definitions.h"

namespace vinerow::live {
namespace {

using nlohmann::json;

// Values of simulation_interfaces.
enum Result {
  kUnsupported = 0,
  kOk = 1,
  kNotFound = 2,
  kIncorrectState = 3,
  kFailed = 4,
  kAlreadyThere = 101,
  kWrongTransition = 103
};
enum State { kStopped = 0, kPlaying = 1, kPaused = 2, kQuitting = 3 };
enum Scope { kScopeTime = 1, kScopeState = 2, kScopeSpawned = 4 };
// Numbers of SimulatorFeatures: state of entities, reset, state of the run, steps.
constexpr int kFeatures[] = {10, 20, 21, 22, 24, 25, 26, 31, 32};

json result_of(int result, const std::string& reason = "") {
  return {{"result", {{"result", result}, {"error_message", reason}}}};
}

/// Result of a request to the control: "" is success.
json outcome(const std::string& reason, int failure) {
  return reason.empty() ? result_of(kOk) : result_of(failure, reason);
}

int state_of(const RunSnapshot& run) {
  switch (run.state) {
    case RunState::kStarting:
    case RunState::kPaused:
      return kPaused;
    case RunState::kOver:
      return kQuitting;
    default:
      return kPlaying;
  }
}

json get_features() {
  json features = json::array();
  for (const int feature : kFeatures) features.push_back(feature);
  return {{"features",
           {{"features", features},
            {"spawn_formats", json::array()},
            {"custom_info", "Vinerow: entities are the vehicles of the scenario"}}}};
}

void set_state(RunControl& control, const json& request, const Respond& respond) {
  const int wanted = request["state"]["state"];
  const int present = state_of(control.snapshot());
  if (present == kQuitting) return respond(result_of(kWrongTransition, "the run is over"));
  if (wanted == present) {
    return respond(result_of(kAlreadyThere, "the run is already in this state"));
  }
  switch (wanted) {
    case kPlaying:
      control.resume();
      return respond(result_of(kOk));
    case kPaused:
      control.pause();
      return respond(result_of(kOk));
    case kStopped:
      // "Equivalent to pausing and resetting", as the package defines it.
      control.pause();
      return control.reset(std::nullopt, [respond](const std::string& reason) {
        respond(outcome(reason, kFailed));
      });
    case kQuitting:
      control.stop("ended by a client");
      return respond(result_of(kOk));
    default:
      respond(result_of(kUnsupported, fmt::format("state {} is not supported: 0 (stopped), 1 "
                                                  "(playing), 2 (paused) or 3 (quitting)",
                                                  wanted)));
  }
}

void reset(RunControl& control, const json& request, const Respond& respond) {
  const int scope = request["scope"];
  const int all = kScopeTime | kScopeState;
  const bool is_partial = scope != 0 && (scope & all) != all;
  if (is_partial) {
    return respond(result_of(
        kUnsupported, fmt::format("scope {} is not supported: time and state are reset together (0 "
                                  "= all)",
                                  scope)));
  }
  control.reset(std::nullopt,
                [respond](const std::string& reason) { respond(outcome(reason, kFailed)); });
}

json get_entities(const Entities& entities, const json& request) {
  const json& filters = request["filters"];
  json response = result_of(kOk);
  response["entities"] = json::array();
  if (!filters["categories"].empty() || !filters["tags"]["tags"].empty() ||
      filters["bounds"]["type"] != 0) {
    const char* words = "entities are filtered by name alone, not by category, tag or bounds";
    response["result"] = result_of(kUnsupported, words)["result"];
    return response;
  }
  const std::string pattern = filters["filter"];
  constexpr std::size_t kLongestPattern = 200;
  try {
    if (pattern.size() > kLongestPattern) throw std::regex_error(std::regex_constants::error_space);
    // The package asks for POSIX extended regular expressions.
    // __polynomial: the library's usual search takes exponential time for "(x*|y*){30}z", and the
    // server's thread with it.
    const std::regex expression(pattern.empty() ? ".*" : pattern,
                                std::regex::extended | std::regex_constants::__polynomial);
    for (const std::string& name : entities.names()) {
      if (std::regex_match(name, expression)) response["entities"].push_back(name);
    }
  } catch (const std::regex_error&) {
    const std::string words =
        fmt::format("filter '{}' is no POSIX extended regular expression of at most {} characters",
                    pattern.substr(0, kLongestPattern), kLongestPattern);
    response["result"] = result_of(kFailed, words)["result"];
  }
  return response;
}

json xyz(const Eigen::Vector3d& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

json get_entity_state(const Entities& entities, const json& request) {
  const std::string name = request["entity"];
  const std::vector<std::string> names = entities.names();
  if (std::ranges::find(names, name) == names.end()) {
    return result_of(kNotFound, fmt::format("no entity '{}'{} (known: {})", name,
                                            did_you_mean(name, names), join(names)));
  }
  const std::optional<Entities::State> state = entities.state(name);
  if (!state) return result_of(kIncorrectState, "the run has not begun");
  const Eigen::Quaterniond& q = state->X_WB.q;
  json response = result_of(kOk);
  response["state"] = {
      {"header",
       {{"stamp",
         {{"sec", state->stamp.ns / 1'000'000'000}, {"nanosec", state->stamp.ns % 1'000'000'000}}},
        {"frame_id", "map"}}},
      {"pose",
       {{"position", xyz(state->X_WB.p)},
        {"orientation", {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}}},
      {"twist", {{"linear", xyz(state->v_WB_W)}, {"angular", xyz(state->w_WB_W)}}}};
  return response;
}

enum Index {
  kGetFeatures,
  kGetState,
  kSetState,
  kStep,
  kReset,
  kGetEntities,
  kGetEntityState,
};

ServiceType service(const char* name, const char* type, const char* request, const char* response) {
  const std::string full = fmt::format("simulation_interfaces/srv/{}", type);
  return {name, full, record::full_ros_definition(request, {}),
          record::full_ros_definition(response, {})};
}

}  // namespace

const std::vector<ServiceType>& service_types() {
  // In the order of Index.
  static const std::vector<ServiceType> types = {
      service("get_simulator_features", "GetSimulatorFeatures", "",
              "simulation_interfaces/SimulatorFeatures features\n"),
      service("get_simulation_state", "GetSimulationState", "",
              "simulation_interfaces/SimulationState state\nsimulation_interfaces/Result result\n"),
      service("set_simulation_state", "SetSimulationState",
              "simulation_interfaces/SimulationState state\n",
              "simulation_interfaces/Result result\n"),
      service("step_simulation", "StepSimulation", "uint64 steps 1\n",
              "simulation_interfaces/Result result\n"),
      service("reset_simulation", "ResetSimulation", "uint8 scope\n",
              "simulation_interfaces/Result result\n"),
      service("get_entities", "GetEntities", "simulation_interfaces/EntityFilters filters\n",
              "simulation_interfaces/Result result\nstring[] entities\n"),
      service("get_entity_state", "GetEntityState", "string entity\n",
              "simulation_interfaces/Result result\nsimulation_interfaces/EntityState state\n")};
  return types;
}

Services::Services(RunControl& control, const Entities& entities)
    : control_(control), entities_(entities) {}

void Services::call(std::size_t index, const json& given, const Respond& respond) {
  const ServiceType& type = service_types()[index];
  // Through CDR, so that absent fields have their values and wrong ones their sentence.
  const auto schema = record::RosSchema::parse(type.type + "_Request", type.request);
  const json request = json_from_cdr(cdr_from_json(given, schema), schema);
  switch (index) {
    case kGetFeatures:
      return respond(get_features());
    case kGetState: {
      json response = result_of(kOk);
      response["state"] = {{"state", state_of(control_.snapshot())}};
      return respond(response);
    }
    case kSetState:
      return set_state(control_, request, respond);
    case kStep: {
      // The definition's default of one step.
      const bool is_given = given.is_object() && given.contains("steps");
      const std::uint64_t steps = is_given ? request["steps"].get<std::uint64_t>() : 1;
      return control_.step(
          steps, [respond](const std::string& reason) { respond(outcome(reason, kFailed)); });
    }
    case kReset:
      return reset(control_, request, respond);
    case kGetEntities:
      return respond(get_entities(entities_, request));
    default:
      return respond(get_entity_state(entities_, request));
  }
}

void Services::call_cdr(std::size_t index, std::span<const std::uint8_t> request,
                        const std::function<void(const std::vector<std::uint8_t>&)>& respond) {
  const ServiceType& type = service_types()[index];
  const auto schema = record::RosSchema::parse(type.type + "_Request", type.request);
  call(index, json_from_cdr(request, schema), [&type, respond](const json& response) {
    respond(
        cdr_from_json(response, record::RosSchema::parse(type.type + "_Response", type.response)));
  });
}

}  // namespace vinerow::live
