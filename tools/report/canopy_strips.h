#pragma once
/// Report chapter on the effect of payloads on the canopy: both sides of every row, unrolled
/// (distance along the row x height) and coloured by amount.

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

/// Content of one file of canopy/ in a run's folder.
struct CanopyFile {
  std::string vehicle, payload, quantity, unit;
  double wanted = 0.0, step_m = 0.0, band_m = 0.0;
  std::vector<CanopyPatchAmount> patches;

  double area_m2() const;
  /// Share of the area with at least the wanted amount. @param counts  selects row sides; null: all
  double covered_share(const std::function<bool(int row, int side)>& counts = nullptr) const;
  /// Mean amount over the area.
  double mean_amount() const;
};

/// @throws ConfigError "x/canopy/y.json: is not a canopy coverage file: ..."
CanopyFile read_canopy(const std::filesystem::path& file);

/// Files of all payloads of a run, by name; empty if canopy/ is absent.
std::vector<CanopyFile> read_canopies(const RunFolder& run);

/// The chapter; empty if no payload worked on the canopy.
std::string canopy_section(const RunFolder& run, const std::vector<CanopyFile>& canopies,
                           const std::vector<VehicleLog>& vehicles);

/// Remark for the verdict, one sentence per payload: share of the canopy that it reached and row
/// sides that its vehicle left out; "" if every side was passed.
std::string canopy_remark(const RunFolder& run, const std::vector<CanopyFile>& canopies,
                          const std::vector<VehicleLog>& vehicles);

}  // namespace vinerow::tools::report
