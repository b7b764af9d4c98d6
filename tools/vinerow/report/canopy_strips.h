#pragma once
/// What payloads did to the canopy: both sides of every row unrolled, along x height, coloured by
/// amount.

#include <filesystem>
#include <string>
#include <vector>

#include "tools/vinerow/report/run_folder.h"

namespace vinerow::tools::report {

struct CanopyPatchAmount {
  int row = 0, side = 1, along = 0, band = 0;
  double area_m2 = 0.0, amount = 0.0;
};

/// One file of canopy/ in a run's folder.
struct CanopyFile {
  std::string vehicle, payload, quantity, unit;
  double wanted = 0.0, step_m = 0.0, band_m = 0.0;
  std::vector<CanopyPatchAmount> patches;

  double area_m2() const;
  /// Of the area with at least the wanted amount.
  double covered_share() const;
  /// Mean over the area.
  double mean_amount() const;
};

/// @throws ConfigError "x/canopy/y.json: is no canopy coverage: ..."
CanopyFile read_canopy(const std::filesystem::path& file);

/// All payloads of a run; nothing where canopy/ is absent.
std::string canopy_section(const RunFolder& run);

}  // namespace vinerow::tools::report
