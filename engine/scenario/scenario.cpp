#include "engine/scenario/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/scenario/scenario_criterion.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/scenario_override.h"
#include "engine/scenario/scenario_part.h"
#include "engine/scenario/scenario_phases.h"
#include "engine/scenario/shipped_file.h"
#include "engine/scenario/yaml_include.h"

namespace vinerow::scenario {
namespace {

namespace fs = std::filesystem;

/// Reader of the merged tree into a Scenario and its resolved text, key by key.
class ScenarioReader {
 public:
  ScenarioReader(const io::YamlNode& root, const io::SourceMark& file, const Registry& registry)
      : root_(root), file_(file), context_{registry, root, Duration{0}, &scenario_.warnings} {}

  Scenario read(const std::string& default_name) {
    check_version();
    std::vector<std::string> known;
    for (const StructuralKey& key : scenario_keys()) known.push_back(key.spec.name);
    check_keys(root_, "", known, "", &context_);
    read_values(default_name);
    read_physics();
    for (const StructuralKey& key : scenario_keys()) {
      if (key.spec.required && !root_.has(key.spec.name)) {
        io::fail_at(file_,
                    fmt::format("{} must be given ({})", key.spec.name, key.spec.description));
      }
    }
    resolved_.put("plugins", read_plugins());
    ReadPart world = read_part(*root_.find_entry("world"), "world", PartKind::kWorld, context_);
    scenario_.world = std::move(world.config);
    resolved_.put("world", std::move(world.resolved));
    read_vehicles();
    read_mission();
    read_lockstep();
    read_metrics();
    read_limits();
    read_record();
    io::YamlNode pictures = io::yaml_mapping();
    scenario_.pictures = read_pictures(root_.find_entry("pictures"), vehicle_names_, pictures);
    scenario_.pictures.moments = read_moments(scenario_.pictures.moment_texts,
                                              mark_of("pictures", "moments"), scenario_.phases);
    check_shot_cameras(scenario_.pictures, scenario_.vehicles, context_.registry);
    check_picture_count();
    resolved_.put("pictures", std::move(pictures));
    scenario_.resolved_yaml =
        "# Written by vinerow: includes and overrides applied, defaults written out, paths "
        "absolute.\n" +
        io::to_yaml(resolved_);
    return std::move(scenario_);
  }

 private:
  void check_version() const {
    const io::YamlNode* version = root_.find("vinerow");
    if (!version) {
      io::fail_at(file_,
                  fmt::format("vinerow must be given: the version of the file format, which is "
                              "{} ('vinerow: {}')",
                              kFormatVersion, kFormatVersion));
    }
    const io::YamlScalar value =
        version->is_scalar() ? io::scalar_value(*version) : io::YamlScalar(0.0);
    const auto* number = std::get_if<std::int64_t>(&value);
    if (!number || *number != kFormatVersion) {
      io::fail_at(version->mark,
                  fmt::format("vinerow = {}, this program reads version {} of the file "
                              "format",
                              io::shown(*version), kFormatVersion));
    }
  }

  void read_values(const std::string& default_name) {
    std::vector<ParameterSpec> fields;
    for (const StructuralKey& key : scenario_keys()) {
      if (key.shape == KeyShape::kParameter) fields.push_back(key.spec);
    }
    ReadParameters read = read_parameters(root_, file_, "", fields, "scenario");
    resolved_ = std::move(read.resolved);
    const Scenario values = scenario_table().read(read.values, "").scenario;
    scenario_.name = values.name;
    if (scenario_.name.empty()) {
      scenario_.name = default_name;
      resolved_.put("name", io::yaml_text(default_name));
    } else if (!is_valid_name(scenario_.name)) {
      // Folders and files are named after the scenario.
      io::fail_at(root_.find("name")->mark,
                  fmt::format("name = '{}', must be made of letters, digits, '_' and '-' and start "
                              "with a letter or '_' (results go to runs/<name>)",
                              scenario_.name));
    }
    scenario_.description = values.description;
    scenario_.seed = values.seed;
    scenario_.duration_s = values.duration_s;
    scenario_.stop_when_finished = values.stop_when_finished;
    scenario_.gravity_mps2 = values.gravity_mps2;
  }

  /// Reads a structural group such as `record`; all defaults if it is absent.
  ParameterSet read_group(const char* name) {
    const auto key = std::find_if(scenario_keys().begin(), scenario_keys().end(),
                                  [&](const auto& k) { return k.spec.name == name; });
    const io::YamlEntry* entry = root_.find_entry(name);
    if (entry) {
      require_mapping(entry->value, name, "{" + key->spec.fields.front().name + ": ...}");
      check_keys(entry->value, name, names_of(key->spec.fields), "", &context_);
    }
    ReadParameters read =
        read_parameters(entry ? entry->value : io::yaml_mapping(), entry ? entry->mark : file_,
                        name, key->spec.fields, name);
    resolved_.put(name, std::move(read.resolved));
    return std::move(read.values);
  }

  void check_picture_count() const {
    const double every_s = scenario_.pictures.every_s;
    if (!(every_s > 0.0) || scenario_.duration_s / every_s <= kMaxPictureInstants) return;
    io::fail_at(
        mark_of("pictures", "every_s"),
        fmt::format("pictures.every_s = {} s makes {:.0f} frames of each camera in {} s, must "
                    "make at most {:.0f}",
                    every_s, scenario_.duration_s / every_s, scenario_.duration_s,
                    kMaxPictureInstants));
  }

  io::SourceMark mark_of(const char* group, const char* key) const {
    const io::YamlNode* node = root_.find(group);
    const io::YamlNode* value = node ? node->find(key) : nullptr;
    return value ? value->mark : file_;
  }

  void read_physics() {
    const double step_s = physics_table().read(read_group("physics"), "").step_s;
    const Duration step = duration_from_s(step_s);
    // The step is a whole number of nanoseconds; the rounding error of a double is far below 1 ns.
    if (step.ns <= 0 || std::abs(step.s() - step_s) > 1e-6 * 1e-9) {
      io::fail_at(
          mark_of("physics", "step_s"),
          fmt::format("physics.step_s = {} s, must be a whole number of nanoseconds", step_s));
    }
    scenario_.physics_step = step;
    context_.physics_step = step;
  }

  io::YamlNode read_plugins() {
    io::YamlNode written = io::yaml_list();
    const io::YamlEntry* entry = root_.find_entry("plugins");
    if (!entry) return written;
    if (!entry->value.is_list()) {
      io::fail_at(entry->value.mark, fmt::format("plugins = {}, must be a list of shared libraries",
                                                 io::shown(entry->value)));
    }
    for (std::size_t i = 0; i < entry->value.items.size(); ++i) {
      const io::YamlNode& item = entry->value.items[i];
      const std::string path = fmt::format("plugins[{}]", i);
      if (!item.is_scalar() || !std::holds_alternative<std::string>(io::scalar_value(item))) {
        io::fail_at(item.mark, fmt::format("{} = {}, must be the path of a shared library", path,
                                           io::shown(item)));
      }
      scenario_.plugins.emplace_back(read_path(item, path, true));
      written.items.push_back(io::yaml_text(scenario_.plugins.back().string()));
    }
    return written;
  }

  friend std::vector<fs::path> read_plugin_list(const io::YamlNode& root);

  void read_vehicles() {
    const io::YamlEntry& entry = *root_.find_entry("vehicles");
    io::YamlNode located = entry.value;
    if (located.is_null()) located.mark = entry.mark;
    require_mapping(located, "vehicles", "{rover: {type: ...}}");
    io::YamlNode written = io::yaml_mapping();
    for (const io::YamlEntry& vehicle : entry.value.entries) {
      check_name(vehicle, "vehicles", "vehicle");
      if (vehicle.value.is_null()) continue;
      io::YamlNode one;
      scenario_.vehicles.push_back(read_vehicle(vehicle, "vehicles." + vehicle.key, context_, one));
      vehicle_names_.push_back(vehicle.key);
      written.put(vehicle.key, std::move(one));
    }
    resolved_.put("vehicles", std::move(written));
  }

  void read_metrics() {
    io::YamlNode metrics = io::yaml_mapping();
    if (const io::YamlEntry* entry = root_.find_entry("metrics")) {
      metrics = entry->value;
      if (metrics.is_null()) metrics.mark = entry->mark;
    } else {
      for (const std::string& type : context_.registry.names(PartKind::kMetric)) {
        const PartSpec& spec = context_.registry.spec(PartKind::kMetric, type);
        const bool needs_the_user = std::any_of(spec.parameters.begin(), spec.parameters.end(),
                                                [](const auto& p) { return p.required; });
        if (needs_the_user) continue;
        io::YamlNode part = io::yaml_mapping();
        part.put("type", io::yaml_text(type));
        metrics.put(type, std::move(part));
      }
    }
    io::YamlNode written;
    scenario_.metrics = read_named_parts(metrics, "metrics", PartKind::kMetric, context_, written);
    resolved_.put("metrics", std::move(written));
  }

  void read_mission() {
    io::YamlNode written;
    scenario_.phases =
        read_phases(root_.find_entry("phases"), scenario_.vehicles, context_, written);
    // Without a mission, the resolved text has no `phases`.
    if (!scenario_.phases.empty()) resolved_.put("phases", std::move(written));
    const io::YamlEntry* traffic = root_.find_entry("traffic");
    scenario_.traffic =
        read_traffic(read_group("traffic"), mark_of("traffic", "reserve_alleys"), vehicle_names_);
    if (!traffic) resolved_.erase("traffic");
  }

  void read_lockstep() {
    const io::YamlEntry* entry = root_.find_entry("lockstep");
    if (!entry) return;
    LockstepConfig& lockstep = scenario_.lockstep;
    lockstep = lockstep_table().read(read_group("lockstep"), "");
    lockstep.where = mark_of("lockstep", "topic");
    // A ROS topic begins with a slash, a signal does not.
    if (lockstep.signal.starts_with('/')) lockstep.signal.erase(0, 1);
    const io::SourceMark rate =
        entry->value.find("rate_Hz") ? mark_of("lockstep", "rate_Hz") : entry->mark;
    lockstep.period =
        check_rate(lockstep.rate_Hz, scenario_.physics_step, rate, "lockstep.rate_Hz");
  }

  void read_limits() {
    CriterionScope scope{vehicle_names_, false};
    for (const PhaseConfig& phase : scenario_.phases) {
      if (phase.job) scope.owners.push_back(phase.name);
    }
    io::YamlNode written;
    scenario_.criteria = read_criteria(root_.find_entry("criteria"), "criteria", scope, written);
    resolved_.put("criteria", std::move(written));
  }

  void read_record() {
    scenario_.record = record_table().read(read_group("record"), "");
    // The rate is irrelevant without a log.
    if (!scenario_.record.enabled) return;
    check_rate(scenario_.record.truth_rate_Hz, scenario_.physics_step,
               mark_of("record", "truth_rate_Hz"), "record.truth_rate_Hz");
  }

  const io::YamlNode& root_;
  io::SourceMark file_;
  Scenario scenario_;
  ReadContext context_;  ///< refers to the warnings of scenario_
  io::YamlNode resolved_ = io::yaml_mapping();
  std::vector<std::string> vehicle_names_;
};

std::vector<fs::path> read_plugin_list(const io::YamlNode& root) {
  const Registry empty;
  ScenarioReader reader(root, root.mark, empty);
  static_cast<void>(reader.read_plugins());
  return std::move(reader.scenario_.plugins);
}

/// Overrides of the key `plugins`, needed before the plug-ins are loaded.
Overrides of_plugins(const Overrides& overrides) {
  const auto is_of_plugins = [](const std::string& text) {
    return text == "plugins" || text.starts_with("plugins=") || text.starts_with("plugins.");
  };
  Overrides result;
  for (const OverrideValue& value : overrides.values) {
    if (is_of_plugins(value.path)) result.values.push_back(value);
  }
  for (const std::string& set : overrides.sets) {
    if (is_of_plugins(set)) result.sets.push_back(set);
  }
  return result;
}

fs::path folder_of(const fs::path& file) {
  return fs::absolute(file).lexically_normal().parent_path();
}

/// A file name without folder has an empty parent path: then this is the current folder.
fs::path absolute_folder(const fs::path& folder) {
  return fs::absolute(fs::path(".") / folder).lexically_normal();
}

void set_folder(io::YamlNode& node, const fs::path& folder) {
  node.folder = folder;
  for (io::YamlNode& item : node.items) set_folder(item, folder);
  for (io::YamlEntry& entry : node.entries) set_folder(entry.value, folder);
}

}  // namespace

std::vector<fs::path> load_plugin_list(const fs::path& named, const Overrides& overrides) {
  const fs::path file = find_shipped(named);
  io::YamlNode root = load_yaml_with_includes(file);
  apply_overrides(root, of_plugins(overrides), folder_of(file));
  return read_plugin_list(root);
}

std::vector<fs::path> parse_plugin_list(io::YamlNode tree, const fs::path& folder,
                                        const Overrides& overrides) {
  const fs::path base = absolute_folder(folder);
  set_folder(tree, base);
  resolve_includes(tree, "");
  apply_overrides(tree, of_plugins(overrides), base);
  return read_plugin_list(tree);
}

ScenarioSource::ScenarioSource(const fs::path& file)
    : file_(find_shipped(file)), tree_(load_yaml_with_includes(file_)) {}

Scenario ScenarioSource::load(const Registry& registry, const Overrides& overrides) const {
  io::YamlNode root = tree_;
  apply_overrides(root, overrides, folder_of(file_));
  Scenario scenario =
      ScenarioReader(root, {file_.string(), 0}, registry).read(file_.stem().string());
  scenario.file = fs::absolute(file_).lexically_normal();
  return scenario;
}

Scenario load_scenario(const fs::path& file, const Registry& registry, const Overrides& overrides) {
  return ScenarioSource(file).load(registry, overrides);
}

namespace {

/// @param mark  of the whole text, for errors
Scenario scenario_of_tree(io::YamlNode root, const io::SourceMark& mark, const fs::path& folder,
                          const Registry& registry, const Overrides& overrides) {
  resolve_includes(root, "");
  apply_overrides(root, overrides, folder);
  return ScenarioReader(root, mark, registry).read("scenario");
}

}  // namespace

Scenario parse_scenario(const std::string& yaml, const fs::path& folder, const Registry& registry,
                        const Overrides& overrides, const std::string& name) {
  const fs::path base = absolute_folder(folder);
  io::YamlNode root = io::parse_yaml(yaml, name, base);
  const io::SourceMark whole{name, 0};
  if (root.is_null()) io::fail_at(whole, "the file is empty; a scenario starts with 'vinerow: 1'");
  if (!root.is_mapping()) {
    io::fail_at(root.mark, fmt::format("the file holds {}, must be a mapping ('key: value' lines)",
                                       io::shown(root)));
  }
  return scenario_of_tree(std::move(root), whole, base, registry, overrides);
}

Scenario parse_scenario(io::YamlNode tree, const fs::path& folder, const Registry& registry,
                        const Overrides& overrides) {
  const fs::path base = absolute_folder(folder);
  set_folder(tree, base);
  return scenario_of_tree(std::move(tree), {}, base, registry, overrides);
}

bool VehicleConfig::estimate_is_truth() const {
  if (autopilot) {
    // Firmware reports its estimate by MAVLink.
    const ParameterSet::Value* listens = autopilot->parameters.find("mavlink");
    return listens != nullptr && !std::get<bool>(*listens);
  }
  return !estimator || estimator->type == "truth";
}

}  // namespace vinerow::scenario
