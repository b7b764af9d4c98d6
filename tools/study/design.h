#pragma once
/// Experimental design of a study: its settings and cells.
///
/// A *setting* is one combination of levels; the last factor of the file changes fastest. A *cell*
/// is one run: a setting with a seed. All settings have the same seeds, so that comparisons between
/// them share their noise. Cells are counted from 0: cell = setting * seeds + index of the seed.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/scenario/study.h"

namespace vinerow::study {

class Design {
 public:
  /// @param study  outlives the design
  explicit Design(const scenario::Study& study);

  const scenario::Study& study() const { return study_; }
  std::size_t settings() const { return settings_; }
  std::size_t seeds() const { return study_.seeds.size(); }
  std::size_t cells() const { return settings_ * seeds(); }
  std::size_t setting_of(std::size_t cell) const { return cell / seeds(); }
  std::uint64_t seed_of(std::size_t cell) const { return study_.seeds[cell % seeds()]; }
  std::size_t cell_of(std::size_t setting, std::size_t seed_place) const {
    return setting * seeds() + seed_place;
  }

  /// Level of each factor.
  std::vector<std::size_t> levels(std::size_t setting) const;
  /// Overrides of the scenario for a cell's run.
  scenario::Overrides overrides(std::size_t cell) const;
  /// Overrides for given levels, one per factor, without a seed.
  scenario::Overrides overrides_of(const std::vector<std::size_t>& levels) const;

  /// Columns of all factors, and their texts for a setting.
  const std::vector<std::string>& columns() const { return columns_; }
  std::vector<std::string> texts(std::size_t setting) const;

  /// Settings in running order: those that share a world are consecutive, so that it is built once.
  std::vector<std::size_t> settings_in_running_order() const;

 private:
  const scenario::Study& study_;
  std::size_t settings_ = 1;
  std::vector<std::string> columns_;
  std::vector<bool> changes_world_;  ///< by factor
};

}  // namespace vinerow::study
