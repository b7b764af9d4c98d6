#pragma once
/// What a data set is made of: the study's cells, each with the camera's layers switched on.

#include <array>
#include <cstddef>
#include <string>

#include "engine/scenario/study.h"
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
  /// Of a cell, whose camera writes all layers at `every_s`, without delay and dropouts.
  scenario::Scenario scenario(std::size_t cell) const;

 private:
  [[noreturn]] void fail(const std::string& sentence) const;
  void check_cell(std::size_t cell);

  const study::OpenStudy& open_;
  std::string vehicle_, sensor_;
  int most_pictures_ = 0;
};

}  // namespace vinerow::dataset
