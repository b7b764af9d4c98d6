#pragma once
/// Keeps the links of a vehicle, with their meshes for display, for vehicles that are built later.
/// To make the meshes takes longer than all else in the reset of a session.

#include <string>
#include <utility>
#include <vector>

#include "engine/api/file_shelf.h"
#include "engine/api/vehicle.h"

namespace vinerow {
struct VehicleContext;
}

namespace vinerow::vehicles {

class LinkShelf {
 public:
  /// Keeps nothing.
  LinkShelf() = default;
  /// Keeps the links of the run's file shelf, for all vehicles with equal parameters.
  LinkShelf(const ParameterSet& parameters, const VehicleContext& context);

  /// @param make  () -> std::vector<VehicleLink>, from nothing but the parameters
  template <class Make>
  std::vector<VehicleLink> get(Make&& make) const {
    return *keep<std::vector<VehicleLink>>(shelf_, key_, std::forward<Make>(make));
  }

 private:
  FileShelf* shelf_ = nullptr;
  std::string key_;
};

}  // namespace vinerow::vehicles
