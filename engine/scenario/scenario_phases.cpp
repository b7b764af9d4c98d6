#include "engine/scenario/scenario_phases.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>

#include "engine/api/parameter_table.h"
#include "engine/core/suggest.h"
#include "engine/scenario/scenario_criterion.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/scenario_part.h"
#include "engine/scenario/yaml_include.h"

namespace vinerow::scenario {
namespace {

template <class List>
bool holds(const List& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// Vehicle of a job, from its parameter `vehicle`; empty if the job has no such parameter.
std::string vehicle_of(const PhaseConfig& phase, const Registry& registry) {
  if (!phase.job) return {};
  const bool works_for_one =
      holds(names_of(registry.spec(PartKind::kJob, phase.job->type).parameters), "vehicle");
  const ParameterSet::Value* vehicle =
      works_for_one ? phase.job->parameters.find("vehicle") : nullptr;
  return vehicle ? std::get<std::string>(*vehicle) : "";
}

const PhaseConfig* find_phase(const std::vector<PhaseConfig>& phases, const std::string& name) {
  const auto found =
      std::find_if(phases.begin(), phases.end(), [&](const auto& p) { return p.name == name; });
  return found == phases.end() ? nullptr : &*found;
}

std::vector<std::string> phase_names(const std::vector<PhaseConfig>& phases) {
  std::vector<std::string> names;
  for (const PhaseConfig& phase : phases) names.push_back(phase.name);
  return names;
}

std::string unknown_phase(const std::string& name, const std::vector<PhaseConfig>& phases) {
  const std::vector<std::string> known = phase_names(phases);
  return fmt::format("unknown phase '{}'{} (known: {})", name, did_you_mean(name, known),
                     known.empty() ? "none" : join(known));
}

const char* article(ProductKind kind) {
  return kind == ProductKind::kPictures ? "" : "a ";
}

/// "from build_map" or "from survey/plane/camera".
ProductSource read_source(const io::YamlEntry& entry, const std::string& path, ProductKind kind) {
  const io::YamlNode& node = entry.value;
  constexpr std::string_view kFrom = "from ";
  const bool is_text =
      node.is_scalar() && std::holds_alternative<std::string>(io::scalar_value(node));
  if (!is_text || !node.text.starts_with(kFrom) || node.text.size() == kFrom.size()) {
    io::fail_at(entry.mark,
                fmt::format("{} = {}, must be 'from <phase>': the phase that gives the {}", path,
                            io::shown(node), to_string(kind)));
  }
  ProductSource source;
  source.key = entry.key;
  source.kind = kind;
  source.where = entry.mark;
  source.phase = node.text.substr(kFrom.size());
  const std::size_t slash = source.phase.find('/');
  if (slash != std::string::npos) {
    source.item = source.phase.substr(slash + 1);
    source.phase.resize(slash);
  }
  return source;
}

/// The products that a phase of this kind takes.
std::vector<ProductPort> ports_of(const PhaseConfig& phase, const Registry& registry) {
  if (phase.job) return registry.spec(PartKind::kJob, phase.job->type).takes;
  std::vector<ProductPort> ports = product_ports(registry);
  ports.resize(2);  // map and plan
  return ports;
}

class PhaseReader {
 public:
  PhaseReader(const std::vector<VehicleConfig>& vehicles, const ReadContext& context)
      : vehicles_(vehicles), context_(context) {
    for (const VehicleConfig& vehicle : vehicles) vehicle_names_.push_back(vehicle.name);
  }

  PhaseConfig read(const io::YamlEntry& entry, io::YamlNode& written) {
    const std::string path = join_path("phases", entry.key);
    require_mapping(entry.value, path, "{vehicles: [rover]}");
    PhaseConfig phase;
    phase.name = entry.key;
    phase.where = entry.mark;
    if (holds(vehicle_names_, phase.name)) {
      io::fail_at(entry.mark, fmt::format("{}: a phase cannot have the name of a vehicle", path));
    }
    read_job(entry, path, phase, written);
    check_phase_keys(entry.value, path, phase);
    read_values(entry, path, phase, written);
    read_products(entry, path, phase, written);
    CriterionScope scope{phase.vehicles, phase.job.has_value()};
    io::YamlNode criteria;
    phase.criteria = read_criteria(entry.value.find_entry("criteria"), join_path(path, "criteria"),
                                   scope, criteria);
    written.put("criteria", std::move(criteria));
    return phase;
  }

 private:
  void read_job(const io::YamlEntry& entry, const std::string& path, PhaseConfig& phase,
                io::YamlNode& written) {
    written = io::yaml_mapping();
    const io::YamlEntry* job = entry.value.find_entry("job");
    if (!job) return;
    ReadPart part = read_part(*job, join_path(path, "job"), PartKind::kJob, context_);
    phase.job = std::move(part.config);
    const std::string vehicle = vehicle_of(phase, context_.registry);
    if (!vehicle.empty()) {
      check_vehicle(vehicle, vehicle_names_, job->mark, join_path(path, "job.vehicle"));
    }
    written.put("job", std::move(part.resolved));
  }

  void check_phase_keys(const io::YamlNode& node, const std::string& path,
                        const PhaseConfig& phase) {
    std::vector<std::string> known = names_of(phase_table().specs());
    known.insert(known.end(), {"job", "criteria"});
    for (const ProductPort& port : ports_of(phase, context_.registry)) known.push_back(port.key);
    check_keys(node, path, known, phase.job ? fmt::format("job '{}'", phase.job->type) : "",
               &context_);
  }

  void read_values(const io::YamlEntry& entry, const std::string& path, PhaseConfig& phase,
                   io::YamlNode& written) {
    ReadParameters read = read_parameters(entry.value, entry.mark, path, phase_table().specs(),
                                          "phase " + phase.name);
    PhaseConfig values = phase_table().read(read.values, "");
    phase.vehicles = std::move(values.vehicles);
    phase.after = std::move(values.after);
    phase.timeout_s = values.timeout_s;
    phase.duration_s = values.duration_s;
    phase.on_failure = values.on_failure;
    phase.weather = values.weather;
    for (io::YamlEntry& resolved : read.resolved.entries) {
      written.put(resolved.key, std::move(resolved.value));
    }
    check_who_works(entry, path, phase);
  }

  void check_who_works(const io::YamlEntry& entry, const std::string& path,
                       const PhaseConfig& phase) {
    if (phase.job.has_value() == !phase.vehicles.empty()) {
      io::fail_at(entry.mark, fmt::format("{}: {}, must have one of them", path,
                                          phase.job ? "has both vehicles and a job"
                                                    : "has neither vehicles nor a job"));
    }
    const auto refuse = [&](const char* key, const char* reason) {
      io::fail_at(entry.value.find_entry(key)->mark, fmt::format("{}.{}: {}", path, key, reason));
    };
    if (phase.job && phase.timeout_s > 0.0) {
      refuse("timeout_s", "not allowed for a job, which takes duration_s of simulated time");
    }
    if (!phase.job && phase.duration_s > 0.0) {
      refuse("duration_s", "allowed for jobs only; vehicles work until they have finished");
    }
    const io::SourceMark mark = phase.job ? entry.mark : entry.value.find_entry("vehicles")->mark;
    std::vector<std::string> seen;
    for (const std::string& name : phase.vehicles) {
      check_vehicle(name, vehicle_names_, mark, join_path(path, "vehicles"));
      if (holds(seen, name)) {
        io::fail_at(mark, fmt::format("{}.vehicles: '{}' is named twice", path, name));
      }
      seen.push_back(name);
      const auto vehicle = std::find_if(vehicles_.begin(), vehicles_.end(),
                                        [&](const auto& v) { return v.name == name; });
      if (!vehicle->controller && !vehicle->autopilot) {
        io::fail_at(
            mark, fmt::format("{}.vehicles: '{}' has no controller, so it would never finish", path,
                              name));
      }
    }
  }

  void read_products(const io::YamlEntry& entry, const std::string& path, PhaseConfig& phase,
                     io::YamlNode& written) {
    for (const ProductPort& port : ports_of(phase, context_.registry)) {
      const io::YamlEntry* given = entry.value.find_entry(port.key);
      if (!given || given->value.is_null()) {
        if (!port.required) continue;
        io::fail_at(
            entry.mark,
            fmt::format("{}.{} must be given: 'from <phase>', the phase whose {} the job '{}' "
                        "takes",
                        path, port.key, to_string(port.kind), phase.job->type));
      }
      phase.takes.push_back(read_source(*given, join_path(path, port.key), port.kind));
      written.put(port.key, io::yaml_text(given->value.text));
      if (port.kind == ProductKind::kPlan && !phase.job && phase.vehicles.size() != 1) {
        io::fail_at(given->mark,
                    fmt::format("{}.{}: a plan is for one vehicle, but the phase has {}", path,
                                port.key, phase.vehicles.size()));
      }
    }
  }

  const std::vector<VehicleConfig>& vehicles_;
  const ReadContext& context_;
  std::vector<std::string> vehicle_names_;
};

/// Checks that the source of a product gives the requested kind of product.
void check_product(const PhaseConfig& phase, const ProductSource& source,
                   const std::vector<PhaseConfig>& phases,
                   const std::vector<VehicleConfig>& vehicles, const Registry& registry) {
  const std::string path = fmt::format("phases.{}.{}", phase.name, source.key);
  const PhaseConfig* source_phase = find_phase(phases, source.phase);
  if (!source_phase) {
    io::fail_at(source.where, fmt::format("{}: {}", path, unknown_phase(source.phase, phases)));
  }
  std::optional<ProductKind> gives;
  std::vector<std::string> items;
  if (source_phase->job) {
    gives = registry.spec(PartKind::kJob, source_phase->job->type).gives;
  } else {
    items = picture_sources(*source_phase, vehicles, registry);
    if (!items.empty()) gives = ProductKind::kPictures;
  }
  if (gives != source.kind) {
    io::fail_at(source.where,
                fmt::format("{}: phase '{}' gives {}{}, must give {}{}", path, source_phase->name,
                            gives ? article(*gives) : "", gives ? to_string(*gives) : "nothing",
                            article(source.kind), to_string(source.kind)));
  }
  const std::string planned_for = vehicle_of(*source_phase, registry);
  if (source.kind == ProductKind::kPlan && !planned_for.empty() && phase.vehicles.size() == 1 &&
      phase.vehicles.front() != planned_for) {
    io::fail_at(source.where,
                fmt::format("{}: phase '{}' plans for '{}', but this phase uses '{}'", path,
                            source_phase->name, planned_for, phase.vehicles.front()));
  }
  if (source.item.empty() ? items.size() > 1 : !holds(items, source.item)) {
    io::fail_at(
        source.where,
        fmt::format("{}: phase '{}' gives pictures of {}; write 'from {}/{}'", path,
                    source_phase->name, items.empty() ? "no camera" : join(items),
                    source_phase->name, items.empty() ? "<vehicle>/<camera>" : items.front()));
  }
}

/// Cycle of phases from `phase` back to itself, or empty, by depth-first search. `done` holds
/// phases without a cycle.
std::vector<std::string> find_circle(const std::vector<PhaseConfig>& phases,
                                     const std::string& phase, std::vector<std::string>& stack,
                                     std::vector<std::string>& done) {
  const auto on_path = std::find(stack.begin(), stack.end(), phase);
  if (on_path != stack.end()) {
    std::vector<std::string> circle(on_path, stack.end());
    circle.push_back(phase);
    return circle;
  }
  if (holds(done, phase)) return {};
  stack.push_back(phase);
  for (const std::string& before : find_phase(phases, phase)->after) {
    std::vector<std::string> circle = find_circle(phases, before, stack, done);
    if (!circle.empty()) return circle;
  }
  stack.pop_back();
  done.push_back(phase);
  return {};
}

void check_no_circle(const std::vector<PhaseConfig>& phases) {
  std::vector<std::string> stack, done;
  for (const PhaseConfig& phase : phases) {
    const std::vector<std::string> circle = find_circle(phases, phase.name, stack, done);
    if (circle.empty()) continue;
    io::fail_at(find_phase(phases, circle.front())->where,
                fmt::format("phases.{}: waits for itself: {}", circle.front(),
                            join(circle, " waits for ")));
  }
}

bool waits_for(const std::vector<PhaseConfig>& phases, const PhaseConfig& phase,
               const std::string& other) {
  return std::any_of(phase.after.begin(), phase.after.end(), [&](const std::string& before) {
    return before == other || waits_for(phases, *find_phase(phases, before), other);
  });
}

/// Checks that no vehicle is in two phases at the same time.
void check_vehicles_in_turn(const std::vector<PhaseConfig>& phases,
                            const std::vector<VehicleConfig>& vehicles) {
  for (const VehicleConfig& vehicle : vehicles) {
    std::vector<const PhaseConfig*> of_vehicle;
    for (const PhaseConfig& phase : phases) {
      if (holds(phase.vehicles, vehicle.name)) of_vehicle.push_back(&phase);
    }
    if (of_vehicle.empty() && (vehicle.controller || vehicle.autopilot)) {
      io::fail_at(
          vehicle.where,
          fmt::format("vehicles.{}: is in no phase; add it to one, or remove its {} to keep "
                      "it parked",
                      vehicle.name, vehicle.autopilot ? "autopilot" : "controller"));
    }
    for (std::size_t i = 0; i < of_vehicle.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const PhaseConfig &a = *of_vehicle[i], &b = *of_vehicle[j];
        if (waits_for(phases, a, b.name) || waits_for(phases, b, a.name)) continue;
        io::fail_at(a.where,
                    fmt::format("phases.{}: uses '{}' like phase '{}', but neither phase waits for "
                                "the other",
                                a.name, vehicle.name, b.name));
      }
    }
  }
}

}  // namespace

std::vector<std::string> picture_sources(const PhaseConfig& phase,
                                         const std::vector<VehicleConfig>& vehicles,
                                         const Registry& registry) {
  std::vector<std::string> sources;
  for (const VehicleConfig& vehicle : vehicles) {
    if (!holds(phase.vehicles, vehicle.name)) continue;
    for (const NamedPart& sensor : vehicle.sensors) {
      if (registry.spec(PartKind::kSensor, sensor.part.type).gives == ProductKind::kPictures) {
        sources.push_back(vehicle.name + "/" + sensor.name);
      }
    }
  }
  return sources;
}

std::vector<PhaseConfig> read_phases(const io::YamlEntry* entry,
                                     const std::vector<VehicleConfig>& vehicles,
                                     const ReadContext& context, io::YamlNode& written) {
  written = io::yaml_mapping();
  std::vector<PhaseConfig> phases;
  if (!entry) return phases;
  require_mapping(entry->value, "phases", "{survey: {vehicles: [plane]}}");
  PhaseReader reader(vehicles, context);
  for (const io::YamlEntry& phase : entry->value.entries) {
    check_name(phase, "phases", "phase");
    if (phase.value.is_null()) continue;
    io::YamlNode one;
    phases.push_back(reader.read(phase, one));
    written.put(phase.key, std::move(one));
  }
  for (PhaseConfig& phase : phases) {
    for (const std::string& before : phase.after) {
      if (find_phase(phases, before)) continue;
      io::fail_at(phase.where,
                  fmt::format("phases.{}.after: {}", phase.name, unknown_phase(before, phases)));
    }
    for (const ProductSource& source : phase.takes) {
      check_product(phase, source, phases, vehicles, context.registry);
      if (!holds(phase.after, source.phase)) phase.after.push_back(source.phase);
    }
  }
  check_no_circle(phases);
  if (!phases.empty()) check_vehicles_in_turn(phases, vehicles);
  return phases;
}

TrafficConfig read_traffic(const ParameterSet& values, const io::SourceMark& where,
                           const std::vector<std::string>& vehicles) {
  TrafficConfig traffic = traffic_table().read(values, "");
  traffic.where = where;
  std::vector<std::string> seen;
  for (const std::string& vehicle : traffic.vehicles) {
    check_vehicle(vehicle, vehicles, where, "traffic.reserve_alleys");
    if (holds(seen, vehicle)) {
      io::fail_at(where, fmt::format("traffic.reserve_alleys: '{}' is named twice", vehicle));
    }
    seen.push_back(vehicle);
  }
  if (seen.size() == 1) {
    io::fail_at(where, fmt::format("traffic.reserve_alleys: '{}' is named alone, must be at least "
                                   "2 vehicles",
                                   seen.front()));
  }
  return traffic;
}

std::vector<PhaseMoment> read_moments(const std::vector<std::string>& texts,
                                      const io::SourceMark& where,
                                      const std::vector<PhaseConfig>& phases) {
  std::vector<PhaseMoment> moments;
  for (const std::string& text : texts) {
    PhaseMoment moment;
    moment.where = where;
    const std::size_t plus = text.find('+');
    moment.phase = text.substr(0, plus);
    while (moment.phase.ends_with(' ')) moment.phase.pop_back();
    bool is_good = !moment.phase.empty();
    if (plus != std::string::npos) {
      std::string number = text.substr(plus + 1);
      while (number.starts_with(' ')) number.erase(0, 1);
      const char* end = number.data() + number.size();
      const auto read = std::from_chars(number.data(), end, moment.after_s);
      is_good = is_good && read.ec == std::errc() && read.ptr == end && moment.after_s >= 0.0 &&
                moment.after_s <= 1e7;
    }
    if (!is_good) {
      io::fail_at(where, fmt::format("pictures.moments: '{}', must be '<phase>' or '<phase> + "
                                     "<seconds>', e.g. 'survey + 30'",
                                     text));
    }
    if (!find_phase(phases, moment.phase)) {
      io::fail_at(where, fmt::format("pictures.moments: '{}': {}", text,
                                     unknown_phase(moment.phase, phases)));
    }
    moments.push_back(std::move(moment));
  }
  return moments;
}

}  // namespace vinerow::scenario
