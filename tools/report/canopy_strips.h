#pragma once
/// What payloads did to the canopy: both sides of every row unrolled, along x height, coloured by
/// amount.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/report/run_folder.h"
#include "tools/report/vehicle_log.h"

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
  /// Of the area with at least the wanted amount; of the sides of rows that are asked for.
  double covered_share(const std::function<bool(int row, int side)>& counts = nullptr) const;
  /// Mean over the area.
  double mean_amount() const;
};

/// @throws ConfigError "x/canopy/y.json: is no canopy coverage: ..."
CanopyFile read_canopy(const std::filesystem::path& file);

/// Every payload's file of a run, by name; none where canopy/ is absent.
std::vector<CanopyFile> read_canopies(const RunFolder& run);

/// The chapter; nothing where no payload worked on the canopy.
std::string canopy_section(const RunFolder& run, const std::vector<CanopyFile>& canopies,
                           const std::vector<VehicleLog>& vehicles);

/// How much of the canopy each payload reached, and which sides of the rows its vehicle left out,
/// in a sentence each for the verdict; "" where every side was passed.
std::string canopy_remark(const RunFolder& run, const std::vector<CanopyFile>& canopies,
                          const std::vector<VehicleLog>& vehicles);

}  // namespace vinerow::tools::report
