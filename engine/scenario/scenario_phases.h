#pragma once
/// Reader of the mission graph: phases, their predecessors, and the products passed between them.

#include <string>
#include <vector>

#include "engine/scenario/scenario.h"
#include "engine/scenario/scenario_reader.h"

namespace vinerow::scenario {

/// @param entry  nullptr: the scenario has no phases
/// @param vehicles  of the scenario, in file order
/// @throws ConfigError naming file, line and reason: unknown phases, vehicles and products, a
///   product of the wrong kind, phases that wait for each other in a cycle, a vehicle in two phases
///   of which neither waits for the other
std::vector<PhaseConfig> read_phases(const io::YamlEntry* entry,
                                     const std::vector<VehicleConfig>& vehicles,
                                     const ReadContext& context, io::YamlNode& written);

/// Cameras of the phase's vehicles that take pictures for a product, as "plane/camera".
std::vector<std::string> picture_sources(const PhaseConfig& phase,
                                         const std::vector<VehicleConfig>& vehicles,
                                         const Registry& registry);

/// @throws ConfigError if a vehicle that reserves alleys is unknown, named twice or alone
TrafficConfig read_traffic(const ParameterSet& values, const io::SourceMark& where,
                           const std::vector<std::string>& vehicles);

/// Reads `pictures.moments`, such as "spray + 30". @throws ConfigError naming the known phases
std::vector<PhaseMoment> read_moments(const std::vector<std::string>& texts,
                                      const io::SourceMark& where,
                                      const std::vector<PhaseConfig>& phases);

}  // namespace vinerow::scenario
