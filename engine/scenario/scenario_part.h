#pragma once
/// Readers of the parts of a scenario: world, vehicles with their parts, metrics, cameras.

#include <string>
#include <vector>

#include "engine/scenario/scenario.h"
#include "engine/scenario/scenario_reader.h"

namespace vinerow::scenario {

struct ReadPart {
  PartConfig config;
  io::YamlNode resolved = io::yaml_mapping();
};

/// Reads one part: `type`, `rate_Hz` if its kind has it, and the parameters of its type.
/// @param extra_keys  further allowed keys, read by the caller (a vehicle's sensors, controller,
/// ...)
ReadPart read_part(const io::YamlEntry& entry, const std::string& path, PartKind kind,
                   const ReadContext& context, const std::vector<std::string>& extra_keys = {});

/// Reads a mapping from names to parts; entries of `null` are skipped.
std::vector<NamedPart> read_named_parts(const io::YamlNode& mapping, const std::string& path,
                                        PartKind kind, const ReadContext& context,
                                        io::YamlNode& resolved);

/// Signals of a part of this type that do not depend on its name: "wheels", not "<name>_event".
std::vector<std::string> fixed_signals(const PartSpec& spec);

VehicleConfig read_vehicle(const io::YamlEntry& entry, const std::string& path,
                           const ReadContext& context, io::YamlNode& resolved);

/// Reads `pictures`; if absent, like {}: a chase camera. @param vehicles  names in file order
PicturesConfig read_pictures(const io::YamlEntry* entry, const std::vector<std::string>& vehicles,
                             io::YamlNode& resolved);

/// @throws ConfigError if a camera of kind shots names a sensor that its vehicle does not have
void check_shot_cameras(const PicturesConfig& pictures, const std::vector<VehicleConfig>& vehicles,
                        const Registry& registry);

/// @throws ConfigError "unknown vehicle 'rovr'; did you mean 'rover'? (known: rover)"
void check_vehicle(const std::string& vehicle, const std::vector<std::string>& vehicles,
                   const io::SourceMark& mark, const std::string& path);

}  // namespace vinerow::scenario
