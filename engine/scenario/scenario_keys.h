#pragma once
/// Table of the keys of a scenario file that do not belong to a part, used by the loader and the
/// JSON Schema.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/api/registry.h"
#include "engine/io/files/yaml.h"
#include "engine/scenario/scenario.h"

namespace vinerow::scenario {

/// Version of the file format (`vinerow: 1`).
constexpr std::int64_t kFormatVersion = 1;

/// Kind of value under a key.
enum class KeyShape {
  kParameter,   ///< a value by its ParameterSpec
  kGroup,       ///< a mapping of parameters (`spec.fields`), all defaults if absent
  kGroupList,   ///< a list of mappings of parameters
  kPart,        ///< one part: `type`, `rate_Hz`, its parameters
  kNamedParts,  ///< a mapping from free names to parts
  kVehicles,    ///< a mapping from names to vehicles
  kSpawn,       ///< one of spawn_forms()
  kPictures,    ///< pictures_keys()
  kCameras,     ///< a mapping from names to cameras
  kPathList,    ///< a list of files
  kPhases,      ///< a mapping from names to phases of the mission
};

struct StructuralKey {
  ParameterSpec spec;  ///< name, description, required; the whole spec for kParameter and kGroup
  KeyShape shape = KeyShape::kParameter;
  PartKind part_kind = PartKind::kWorld;  ///< of kPart and kNamedParts
  bool removable = false;                 ///< `null` is allowed and means absent
};

const std::vector<StructuralKey>& scenario_keys();
/// Keys of a vehicle besides its type's own parameters.
const std::vector<StructuralKey>& vehicle_keys();
const std::vector<StructuralKey>& pictures_keys();
/// Values at a scenario's top level; only these members of `scenario` are set.
struct ScenarioValues {
  std::int64_t format = kFormatVersion;
  Scenario scenario;
};
const ParameterTable<ScenarioValues>& scenario_table();
struct PhysicsParams {
  double step_s = 0.001;
};
const ParameterTable<PhysicsParams>& physics_table();
const ParameterTable<TrafficConfig>& traffic_table();
const ParameterTable<LockstepConfig>& lockstep_table();
const ParameterTable<RecordConfig>& record_table();
/// Values of a vehicle besides its type's own.
const ParameterTable<VehicleConfig>& vehicle_table();
/// Values of `pictures` besides the cameras.
const ParameterTable<PicturesConfig>& pictures_table();
struct CriterionParams {
  std::string metric;
  std::optional<double> min;
  std::optional<double> max;
  std::optional<std::string> name;
};
const ParameterTable<CriterionParams>& criterion_table();
/// Keys of a phase besides `job`, `criteria` and those of the products it takes.
const ParameterTable<PhaseConfig>& phase_table();
/// Products that phases take, by key: `map` and `plan` of vehicles, and those of every known job.
std::vector<ProductPort> product_ports(const Registry& registry);

/// One of several alternative sets of keys. `name` is a key that only this form has.
struct SpawnForm {
  std::string name;
  std::vector<ParameterSpec> fields;
};
const std::vector<SpawnForm>& spawn_forms();
/// Start pose from the values of the form's fields.
SpawnConfig read_spawn_form(const std::string& form, const ParameterSet& values);
/// Name of the first form that has a key in the mapping, or "".
std::string spawn_form_of(const io::YamlNode& spawn);
/// "{alley, offset_m, reverse}, {x_m, y_m, yaw_deg} or {point}".
std::string spawn_forms_text();

/// Values of a camera's `kind`, and the further keys of each kind.
const std::vector<std::string>& camera_kinds();
std::vector<ParameterSpec> camera_fields(const std::string& kind);
/// Camera from the values of its kind's fields; its vehicle is empty if not given.
CameraConfig read_camera_fields(const std::string& kind, const ParameterSet& values);

/// True if parts of this kind have a `rate_Hz`.
bool has_rate(PartKind kind);
/// True for kinds whose parts run as often as the controller if neither the file nor their spec has
/// a rate. Parts of other kinds then run every physics step.
bool follows_controller(PartKind kind);
/// Spec of a part's `rate_Hz`, with the part's default.
ParameterSpec rate_field(PartKind kind, const PartSpec& part);
struct RateParams {
  std::optional<double> rate_Hz;
};
/// Table for the key of rate_field().
const ParameterTable<RateParams>& rate_table();

/// Regular expression for names of vehicles, sensors, metrics and cameras, shared by JSON Schema
/// and loader.
constexpr const char* kNamePattern = "^[A-Za-z_][A-Za-z0-9_-]*$";
bool is_valid_name(const std::string& name);
/// Names of signals of the kernel and of a vehicle's parts; sensors and observers cannot have them.
const std::vector<std::string>& reserved_signal_names();

}  // namespace vinerow::scenario
