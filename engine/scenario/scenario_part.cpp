#include "engine/scenario/scenario_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/api/observer.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/yaml_include.h"

namespace vinerow::scenario {
namespace {

bool is_known(const std::string& name, const std::vector<std::string>& known) {
  return std::find(known.begin(), known.end(), name) != known.end();
}

std::string with_article(PartKind kind) {
  return fmt::format("{} {}", kind == PartKind::kEstimator ? "an" : "a", to_string(kind));
}

/// Spec of the type that a part names.
const PartSpec& read_type(const io::YamlEntry& entry, const std::string& path, PartKind kind,
                          const ReadContext& context) {
  const std::vector<std::string> known = context.registry.names(kind);
  const io::YamlNode* type = entry.value.find("type");
  if (!type) {
    io::fail_at(entry.mark, fmt::format("{}.type must be given, one of: {}", path,
                                        known.empty() ? "none is known" : join(known)));
  }
  if (!type->is_scalar() || !std::holds_alternative<std::string>(io::scalar_value(*type))) {
    io::fail_at(type->mark, fmt::format("{}.type = {}, must be one of: {}", path, io::shown(*type),
                                        known.empty() ? "none is known" : join(known)));
  }
  if (is_known(type->text, known)) return context.registry.spec(kind, type->text);
  for (const PartKind other : kAllPartKinds) {
    if (!is_known(type->text, context.registry.names(other))) continue;
    io::fail_at(type->mark, fmt::format("{}.type = '{}' is {}, must be {} (known: {})", path,
                                        type->text, with_article(other), with_article(kind),
                                        known.empty() ? "none" : join(known)));
  }
  io::fail_at(
      type->mark,
      fmt::format("{}.type = {}: unknown {}{} (known: {})", path, io::shown(*type), to_string(kind),
                  did_you_mean(type->text, known), known.empty() ? "none" : join(known)));
}

SpawnConfig read_spawn(const io::YamlEntry& entry, const std::string& path,
                       io::YamlNode& resolved) {
  const io::YamlNode& node = entry.value;
  require_mapping(node, path, "{alley: 0}");
  std::vector<std::string> known;
  std::vector<std::string> given_forms;
  for (const SpawnForm& form : spawn_forms()) {
    bool used = false;
    for (const ParameterSpec& field : form.fields) {
      known.push_back(field.name);
      if (node.has(field.name) && !used) {
        given_forms.push_back(field.name);
        used = true;
      }
    }
  }
  check_keys(node, path, known, "", nullptr);
  if (given_forms.size() != 1) {
    const std::string what = given_forms.empty()
                                 ? "is empty"
                                 : fmt::format("gives {} at once", join(given_forms, " and "));
    io::fail_at(entry.mark,
                fmt::format("{} {}, must be one of {}", path, what, spawn_forms_text()));
  }
  const std::string form_name = spawn_form_of(node);
  const auto form = std::find_if(spawn_forms().begin(), spawn_forms().end(),
                                 [&](const auto& f) { return f.name == form_name; });
  ReadParameters read = read_parameters(node, entry.mark, path, form->fields, "spawn");
  resolved = std::move(read.resolved);
  resolved.flow = true;

  SpawnConfig spawn = read_spawn_form(form_name, read.values);
  spawn.where = entry.mark;
  if (form_name == "point" && spawn.point.empty()) {
    io::fail_at(node.find("point")->mark, path + ".point = '', must be the name of a spawn point");
  }
  return spawn;
}

std::optional<PartConfig>& slot_of(VehicleConfig& vehicle, PartKind kind) {
  switch (kind) {
    case PartKind::kMap:
      return vehicle.map;
    case PartKind::kEstimator:
      return vehicle.estimator;
    case PartKind::kPlanner:
      return vehicle.planner;
    case PartKind::kGuidance:
      return vehicle.guidance;
    case PartKind::kAutopilot:
      return vehicle.autopilot;
    default:
      return vehicle.controller;
  }
}

/// The signal of a sensor or observer has its name.
void check_signal_name(const io::YamlEntry& entry, const std::string& path, const char* what) {
  if (is_known(entry.key, reserved_signal_names())) {
    io::fail_at(entry.mark,
                fmt::format("{}: {} cannot have the name of another signal ({})",
                            join_path(path, entry.key), what, join(reserved_signal_names())));
  }
}

/// True for truth signals, by full name or by the name within the vehicle.
bool is_truth_signal(const std::string& name) {
  const std::string local = name.substr(name.rfind('/') + 1);
  return local == "truth" || local.ends_with("_truth");
}

/// Only sensors, payloads and metrics may use the truth; all other parts of a vehicle work on
/// readings.
bool works_on_readings(PartKind kind) {
  return kind == PartKind::kEstimator || kind == PartKind::kPlanner ||
         kind == PartKind::kGuidance || kind == PartKind::kController;
}

/// Checks parameters that name signals to read: they are free texts.
void check_wires(const io::YamlEntry& entry, const std::string& path, PartKind kind,
                 const std::vector<ParameterSpec>& fields, const ParameterSet& values) {
  if (!works_on_readings(kind)) return;
  for (const ParameterSpec& field : fields) {
    std::vector<std::string> names;
    if (field.kind == ParameterKind::kText && field.choices.empty() && values.has(field.name)) {
      names = {values.text(field.name)};
    } else if (field.kind == ParameterKind::kTextList && values.has(field.name)) {
      names = values.texts(field.name);
    }
    for (const std::string& name : names) {
      if (!is_truth_signal(name)) continue;
      const io::YamlEntry* given = entry.value.find_entry(field.name);
      io::fail_at(
          given ? given->mark : entry.mark,
          fmt::format("{} = '{}' is a truth signal, which parts of a vehicle cannot read; must "
                      "be the name of a sensor's signal",
                      join_path(path, field.name), name));
    }
  }
}

/// Signals of observers and payloads must have unique names.
void check_observer_names(const VehicleConfig& vehicle, const std::string& path) {
  std::map<std::string, std::string> taken;
  for (const NamedPart& sensor : vehicle.sensors) {
    taken.emplace(sensor.name, "the sensor '" + sensor.name + "'");
    taken.emplace(sensor.name + "_truth", "the truth signal of the sensor '" + sensor.name + "'");
  }
  for (const NamedPart& payload : vehicle.payloads) {
    const auto [other, is_free] = taken.emplace(payload.name, "a payload");
    if (is_free) continue;
    io::fail_at(payload.part.where, fmt::format("{}.payloads.{}: its signal has the name of {}",
                                                path, payload.name, other->second));
  }
  for (const NamedPart& observer : vehicle.observers) {
    for (const auto& [local, signal] : observer_signals(observer.name)) {
      const auto [other, is_free] = taken.emplace(signal, "the observer '" + observer.name + "'");
      if (is_free) continue;
      io::fail_at(observer.part.where,
                  fmt::format("{}.observers.{}: its signal '{}' has the name of {}", path,
                              observer.name, signal, other->second));
    }
  }
}

/// Checks names against the signals in the specs of a vehicle's other parts: "wheels", "battery".
void check_part_signals(const VehicleConfig& vehicle, const std::string& path,
                        const Registry& registry) {
  struct Writer {
    std::string who;  ///< "the vehicle 'diff_drive_rover'"
    std::vector<std::string> signals;
  };
  std::map<std::string, Writer> writers;
  const auto add = [&](PartKind kind, const PartConfig& part) {
    Writer writer{fmt::format("the {} '{}'", to_string(kind), part.type),
                  fixed_signals(registry.spec(kind, part.type))};
    for (const std::string& signal : writer.signals) writers.emplace(signal, writer);
  };
  add(PartKind::kVehicle, vehicle.vehicle);
  if (vehicle.estimator) add(PartKind::kEstimator, *vehicle.estimator);
  if (vehicle.planner) add(PartKind::kPlanner, *vehicle.planner);
  if (vehicle.guidance) add(PartKind::kGuidance, *vehicle.guidance);
  if (vehicle.controller) add(PartKind::kController, *vehicle.controller);
  if (vehicle.autopilot) add(PartKind::kAutopilot, *vehicle.autopilot);
  const auto check = [&](const std::string& signal, const NamedPart& part, const char* group,
                         const char* what) {
    const auto found = writers.find(signal);
    if (found == writers.end()) return;
    io::fail_at(
        part.part.where,
        fmt::format("{}.{}.{}: {} cannot have the name of a signal that {} writes ({}); give "
                    "it another name",
                    path, group, part.name, what, found->second.who, join(found->second.signals)));
  };
  for (const NamedPart& sensor : vehicle.sensors) {
    check(sensor.name, sensor, "sensors", "a sensor");
    check(sensor.name + "_truth", sensor, "sensors", "a sensor");
  }
  for (const NamedPart& payload : vehicle.payloads) {
    check(payload.name, payload, "payloads", "a payload");
  }
  for (const NamedPart& observer : vehicle.observers) {
    for (const auto& [local, signal] : observer_signals(observer.name)) {
      check(signal, observer, "observers", "an observer");
    }
  }
}

/// An autopilot does what these parts do.
void check_autopilot_is_alone(const VehicleConfig& vehicle, const std::string& path) {
  if (!vehicle.autopilot) return;
  const std::pair<const char*, const std::optional<PartConfig>&> others[] = {
      {"estimator", vehicle.estimator},
      {"guidance", vehicle.guidance},
      {"controller", vehicle.controller}};
  for (const auto& [name, part] : others) {
    if (!part) continue;
    io::fail_at(
        part->where,
        fmt::format("{}.{}: the vehicle has an autopilot ('{}'), which takes the place of "
                    "estimator, guidance and controller; remove one of both ('{}: null' removes an "
                    "included one)",
                    path, name, vehicle.autopilot->type, name));
  }
}

/// Replaces a former key by the present one, with a warning. If both are given in one file, the
/// user must choose; if an included file or the file below an override has one of them, the later
/// one wins, as for equal keys.
void use_present_name(io::YamlNode& mapping, const std::string& path, const ParameterSpec& spec,
                      const ReadContext& context) {
  const io::YamlEntry* former = mapping.find_entry(spec.former_name);
  if (!former) return;
  const std::string key_path = join_path(path, spec.former_name);
  if (const io::YamlEntry* present = mapping.find_entry(spec.name)) {
    if (present->mark.file == former->mark.file) {
      io::fail_at(former->mark, fmt::format("{} is the former name of {}, which is given too",
                                            key_path, spec.name));
    }
    // A merge appends keys that it does not find.
    if (former < present) return mapping.erase(spec.former_name);
    mapping.erase(spec.name);
  }
  for (io::YamlEntry& entry : mapping.entries) {
    if (entry.key != spec.former_name) continue;
    if (context.warnings) {
      context.warnings->push_back(
          fmt::format("{}: {}: this key is now named {}", entry.mark.text(), key_path, spec.name));
    }
    entry.key = spec.name;
  }
}

/// The same for all parameters of a mapping, in groups too.
void use_present_names(io::YamlNode& mapping, const std::string& path,
                       const std::vector<ParameterSpec>& specs, const ReadContext& context) {
  for (const ParameterSpec& spec : specs) {
    if (!spec.former_name.empty()) use_present_name(mapping, path, spec, context);
    io::YamlNode* given = spec.fields.empty() ? nullptr : mapping.find(spec.name);
    if (!given) continue;
    const std::string group_path = join_path(path, spec.name);
    if (given->is_mapping()) use_present_names(*given, group_path, spec.fields, context);
    for (std::size_t i = 0; i < given->items.size(); ++i) {
      use_present_names(given->items[i], fmt::format("{}[{}]", group_path, i), spec.fields,
                        context);
    }
  }
}

/// The given ones of these parameters, and of their fields.
void add_given_keys(const io::YamlNode& mapping, const std::vector<ParameterSpec>& specs,
                    std::vector<GivenKey>& given) {
  for (const ParameterSpec& spec : specs) {
    const io::YamlEntry* entry = mapping.find_entry(spec.name);
    if (!entry) continue;
    given.push_back({spec.name, entry->value.mark, !spec.fields.empty()});
    if (spec.fields.empty()) continue;
    add_given_keys(entry->value, spec.fields, given);
    for (const io::YamlNode& item : entry->value.items) add_given_keys(item, spec.fields, given);
  }
}

/// Rules across parameters.
void check_rules(const PartSpec& spec, const PartConfig& part, const std::string& path) {
  for (const auto& check : spec.checks) {
    try {
      check(part.parameters, "");
    } catch (const ConfigError& error) {
      const std::string text = error.what();
      const bool begins_with_key = std::any_of(
          spec.parameters.begin(), spec.parameters.end(), [&](const ParameterSpec& parameter) {
            return text.starts_with(parameter.name) &&
                   text.find_first_of(" :[") == parameter.name.size();
          });
      io::fail_at(part.place_of(text), (begins_with_key ? path + "." : path + ": ") + text);
    }
  }
}

/// Readings are delivered in a physics step.
void check_delay(const io::YamlEntry& entry, const ParameterSet& values, const std::string& path,
                 const ReadContext& context) {
  const ParameterSet::Value* value = values.find("delay_s");
  const double* delay_s = value ? std::get_if<double>(value) : nullptr;
  if (!delay_s || duration_from_s(*delay_s).ns % context.physics_step.ns == 0) return;
  const io::YamlEntry* given = entry.value.find_entry("delay_s");
  io::fail_at(given ? given->value.mark : entry.mark,
              fmt::format("{}.delay_s = {} s, must be a multiple of the physics step of {} s", path,
                          *delay_s, context.physics_step.s()));
}

}  // namespace

std::vector<std::string> fixed_signals(const PartSpec& spec) {
  std::vector<std::string> signals;
  for (const std::string& written : spec.writes) {
    if (written.find('<') != std::string::npos) continue;
    signals.push_back(written.substr(0, written.find(':')));
  }
  return signals;
}

ReadPart read_part(const io::YamlEntry& original, const std::string& path, PartKind kind,
                   const ReadContext& context, const std::vector<std::string>& extra_keys) {
  io::YamlEntry entry = original;
  const std::vector<std::string> types = context.registry.names(kind);
  io::YamlNode located = entry.value;
  if (located.is_null()) located.mark = entry.mark;
  require_mapping(located, path,
                  fmt::format("{{type: {}}}", types.empty() ? "..." : types.front()));
  const PartSpec& spec = read_type(entry, path, kind, context);
  use_present_names(entry.value, path, spec.parameters, context);

  std::vector<ParameterSpec> fields = spec.parameters;
  std::vector<std::string> known = names_of(fields);
  known.insert(known.end(), extra_keys.begin(), extra_keys.end());
  known.push_back("type");
  const bool rated = has_rate(kind) && !is_known("rate_Hz", known);
  if (rated) known.push_back("rate_Hz");
  check_keys(entry.value, path, known, fmt::format("{} '{}'", to_string(kind), spec.name),
             &context);

  ReadPart part;
  part.config.type = spec.name;
  part.config.where = entry.mark;
  part.resolved.put("type", io::yaml_text(spec.name));
  if (rated) {
    ReadParameters rate =
        read_parameters(entry.value, entry.mark, path, {rate_field(kind, spec)}, spec.name);
    for (io::YamlEntry& written : rate.resolved.entries) {
      part.resolved.put(written.key, std::move(written.value));
    }
    if (const std::optional<double> rate_Hz = rate_table().read(rate.values, "").rate_Hz) {
      const io::YamlEntry* given = entry.value.find_entry("rate_Hz");
      part.config.rate_Hz = *rate_Hz;
      check_rate(part.config.rate_Hz, context.physics_step, given ? given->mark : entry.mark,
                 join_path(path, "rate_Hz"));
    } else if (!follows_controller(kind)) {
      // The part runs every physics step; llround in period_of_rate restores the exact step.
      part.config.rate_Hz = 1e9 / static_cast<double>(context.physics_step.ns);
    }
  }
  ReadParameters read =
      read_parameters(entry.value, entry.mark, path, fields, path + " (" + spec.name + ")");
  for (io::YamlEntry& written : read.resolved.entries) {
    part.resolved.put(written.key, std::move(written.value));
  }
  check_wires(entry, path, kind, fields, read.values);
  if (kind == PartKind::kSensor && is_known("delay_s", names_of(fields))) {
    check_delay(entry, read.values, path, context);
  }
  part.config.parameters = std::move(read.values);
  add_given_keys(entry.value, fields, part.config.given);
  check_rules(spec, part.config, path);
  return part;
}

std::vector<NamedPart> read_named_parts(const io::YamlNode& mapping, const std::string& path,
                                        PartKind kind, const ReadContext& context,
                                        io::YamlNode& resolved) {
  require_mapping(mapping, path, "{name: {type: ...}}");
  std::vector<NamedPart> parts;
  resolved = io::yaml_mapping();
  for (const io::YamlEntry& entry : mapping.entries) {
    check_name(entry, path, to_string(kind));
    if (kind == PartKind::kSensor) check_signal_name(entry, path, "a sensor");
    if (kind == PartKind::kEstimator) check_signal_name(entry, path, "an observer");
    if (kind == PartKind::kPayload) check_signal_name(entry, path, "a payload");
    if (kind != PartKind::kMetric && entry.key.ends_with("_truth")) {
      io::fail_at(entry.mark, fmt::format("{}: a name cannot end in '_truth', which marks the "
                                          "error-free reading of a sensor",
                                          join_path(path, entry.key)));
    }
    if (entry.value.is_null()) continue;
    ReadPart part = read_part(entry, join_path(path, entry.key), kind, context);
    parts.push_back({entry.key, std::move(part.config)});
    resolved.put(entry.key, std::move(part.resolved));
  }
  return parts;
}

VehicleConfig read_vehicle(const io::YamlEntry& entry, const std::string& path,
                           const ReadContext& context, io::YamlNode& resolved) {
  std::vector<std::string> own_keys;
  for (const StructuralKey& key : vehicle_keys()) own_keys.push_back(key.spec.name);
  ReadPart part = read_part(entry, path, PartKind::kVehicle, context, own_keys);
  resolved = std::move(part.resolved);

  VehicleConfig vehicle;
  vehicle.name = entry.key;
  vehicle.vehicle = std::move(part.config);
  vehicle.where = entry.mark;
  for (const StructuralKey& key : vehicle_keys()) {
    const std::string key_path = join_path(path, key.spec.name);
    if (key.shape == KeyShape::kParameter) {
      ReadParameters read = read_parameters(entry.value, entry.mark, path, {key.spec}, path);
      vehicle.on_crash = vehicle_table().read(read.values, "").on_crash;
      for (io::YamlEntry& written : read.resolved.entries) {
        resolved.put(written.key, std::move(written.value));
      }
      continue;
    }
    const io::YamlEntry* given = entry.value.find_entry(key.spec.name);
    if (!given || (key.removable && given->value.is_null())) {
      if (key.spec.required) {
        io::fail_at(entry.mark,
                    fmt::format("{} must be given, one of {}", key_path, spawn_forms_text()));
      }
      continue;
    }
    io::YamlNode written;
    if (key.shape == KeyShape::kSpawn) {
      vehicle.spawn = read_spawn(*given, key_path, written);
    } else if (key.shape == KeyShape::kNamedParts) {
      auto& named = key.part_kind == PartKind::kSensor    ? vehicle.sensors
                    : key.part_kind == PartKind::kPayload ? vehicle.payloads
                                                          : vehicle.observers;
      named = read_named_parts(given->value, key_path, key.part_kind, context, written);
    } else {
      ReadPart own = read_part(*given, key_path, key.part_kind, context);
      slot_of(vehicle, key.part_kind) = std::move(own.config);
      written = std::move(own.resolved);
    }
    resolved.put(key.spec.name, std::move(written));
  }
  check_autopilot_is_alone(vehicle, path);
  check_observer_names(vehicle, path);
  check_part_signals(vehicle, path, context.registry);
  return vehicle;
}

void check_vehicle(const std::string& vehicle, const std::vector<std::string>& vehicles,
                   const io::SourceMark& mark, const std::string& path) {
  if (is_known(vehicle, vehicles)) return;
  io::fail_at(mark, fmt::format("{}: unknown vehicle '{}'{} (known: {})", path, vehicle,
                                did_you_mean(vehicle, vehicles),
                                vehicles.empty() ? "none" : join(vehicles)));
}

}  // namespace vinerow::scenario
