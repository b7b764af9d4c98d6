#pragma once
/// What a data set is made of: the study's cells, each with the camera's layers switched on.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/scenario/study.h"
#include "engine/sensors/camera/camera.h"
#include "tools/study/open_study.h"

namespace vinerow::dataset {

/// Layers of the camera that labels are made from.
constexpr std::array<const char*, 3> kLayerNames = {"semantic", "instance", "depth"};

class DatasetTask {
 public:
  /// Checks the study's `dataset` against its scenario with every setting. @param open  outlives
  /// this object
  /// @throws ConfigError "study.yaml:7: dataset.camera = ..." in one sentence
  explicit DatasetTask(const study::OpenStudy& open);

  const study::OpenStudy& open() const { return open_; }
  const scenario::DatasetConfig& config() const { return *open_.study.dataset; }
  bool writes(const char* format) const;
  const std::string& vehicle() const { return vehicle_; }
  const std::string& sensor() const { return sensor_; }
  /// Pictures of the longest run: the numbers of each cell's pictures start at its multiple.
  int most_pictures() const { return most_pictures_; }
  /// Of a cell, whose camera writes all layers at `every_s`, without delay and dropouts, and depth
  /// without its errors. The plants are those of plant_seed().
  scenario::Scenario scenario(std::size_t cell) const;
  /// World's `plant_seed` of a cell: the study's or the scenario's, else the cell's seed, so that
  /// each seed shows other plants. @returns nullopt for a world without it
  std::optional<std::uint64_t> plant_seed(std::size_t cell) const { return plant_seeds_[cell]; }
  /// Of the camera in a cell: from the first row of a picture to the last.
  double readout_s(std::size_t cell) const { return readouts_s_[cell]; }

 private:
  [[noreturn]] void fail(const std::string& sentence) const;
  sensors::CameraNature nature_of(const scenario::NamedPart& camera) const;
  void check_cell(std::size_t cell);
  void add_plant_seed(std::size_t cell, const scenario::PartConfig& world);
  double pictures_of(const scenario::Scenario& plain, double rate_Hz) const;

  const study::OpenStudy& open_;
  std::string vehicle_, sensor_;
  int most_pictures_ = 0;
  std::vector<std::optional<std::uint64_t>> plant_seeds_;  ///< by cell
  std::vector<double> readouts_s_;                         ///< by cell
};

}  // namespace vinerow::dataset
