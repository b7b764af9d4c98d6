#pragma once
/// The Python object of a part.

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/api/parameters.h"
#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"
#include "engine/api/vehicle.h"
#include "python/core/part_life.h"

namespace vinerow::python {

/// A class of a file.
struct PartClass {
  std::string file;
  std::string name;
  Held type;
};

/// What contexts of vehicles' parts have in common.
struct VehicleContext {
  const VehicleDescription* vehicle;
  const RowMap* map;
  std::vector<SensorMounting> sensors;  ///< empty for planners
};

/// An object of a part's class, and the calls into it.
class PartObject {
 public:
  /// @throws ConfigError  with the exception of the class
  PartObject(std::shared_ptr<const PartClass> type, const ParameterSet& parameters,
             const PartContext& context, const VehicleContext& around);

  void connect(Ports& ports);

  /// Calls methods of the object. @param work  gets the object; its result is no Python object
  template <class Work>
  auto call(Time now, Work&& work) {
    const pybind11::gil_scoped_acquire lock;
    const InCall mark(*life_, Life::Stage::kWorking, now);
    try {
      return work(object_->get());
    } catch (const pybind11::error_already_set& error) {
      throw std::runtime_error(sentence_of(error, type_->file));
    }
  }

  void step(const pybind11::handle& object, Time now);
  bool finished(const pybind11::handle& object);
  std::string failure(const pybind11::handle& object);

  /// @throws std::runtime_error with the part's file
  template <class... Words>
  [[noreturn]] void fault(fmt::format_string<Words...> text, Words&&... words) const {
    throw std::runtime_error(fmt::format("{} ({})",
                                         fmt::format(text, std::forward<Words>(words)...),
                                         std::filesystem::path(type_->file).filename().string()));
  }

 private:
  [[noreturn]] void refuse(const pybind11::error_already_set& error) const;

  std::shared_ptr<const PartClass> type_;
  std::shared_ptr<Life> life_;
  std::unique_ptr<Held> object_;
};

}  // namespace vinerow::python
