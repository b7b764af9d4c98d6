#pragma once
/// Along which sides of the rows a vehicle went, and where it could not have gone.

#include <string>
#include <vector>

#include "tools/report/run_folder.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// One side of a row.
struct RowFace {
  int row = 0;             ///< id
  int side = 1;            ///< 1: left of who looks along the row from its first point, -1: right
  bool passed = false;     ///< the vehicle went along at least half of it, no farther than an alley
  bool has_alley = false;  ///< an alley of the true world lies on that side
};

/// Both sides of every row; empty where the world or the vehicle's true poses are not known.
std::vector<RowFace> row_faces(const RunFolder& run, const VehicleLog& vehicle);

/// "row 0 (right) and row 3 (left)", of the faces that were not passed; "" where all were.
std::string faces_left_out(const std::vector<RowFace>& faces);

/// "No alley runs beside 2 of the 8 row sides: row 0 (right) and row 3 (left)", or "The plan left
/// out
/// ..."; "" where there is nothing to explain: all were passed, or none.
std::string face_sentence(const std::vector<RowFace>& faces);

}  // namespace vinerow::tools::report
