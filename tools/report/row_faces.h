#pragma once
/// Row sides that a vehicle passed, and row sides without an alley.

#include <string>
#include <vector>

#include "tools/report/run_folder.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// One side of a row.
struct RowFace {
  int row = 0;             ///< id
  int side = 1;            ///< 1: left, looking along the row from its first point, -1: right
  bool passed = false;     ///< the vehicle passed at least half of it within the alley's width
  bool has_alley = false;  ///< the true world has an alley on that side
};

/// Both sides of every row; empty if the world or the vehicle's true poses are unknown.
std::vector<RowFace> row_faces(const RunFolder& run, const VehicleLog& vehicle);

/// Faces that were not passed: "row 0 (right) and row 3 (left)"; "" if all were passed.
std::string faces_left_out(const std::vector<RowFace>& faces);

/// "No alley runs along 2 of the 8 row sides: row 0 (right) and row 3 (left)", or "The plan left
/// out
/// ..."; "" if all were passed, or none.
std::string face_sentence(const std::vector<RowFace>& faces);

}  // namespace vinerow::tools::report
