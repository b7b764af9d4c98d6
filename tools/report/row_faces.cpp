#include "tools/report/row_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/math/polyline.h"

namespace vinerow::tools::report {
namespace {

constexpr double kBin_m = 0.5;
/// Working distance from a row side without an alley. Chosen.
constexpr double kReach_m = 4.0;
/// A vehicle higher above the row's foot works on neither side. Chosen.
constexpr double kLow_m = 6.0;
constexpr double kPassed = 0.5;
constexpr std::size_t kMaxNamed = 6;

/// Bins along one row side, marked if passed.
class Passed {
 public:
  explicit Passed(double length_m)
      : bins_(static_cast<std::size_t>(std::max(1.0, std::ceil(length_m / kBin_m))), 0) {}
  void add(double s_m) {
    bins_[std::min(static_cast<std::size_t>(s_m / kBin_m), bins_.size() - 1)] = 1;
  }
  double share() const {
    return static_cast<double>(std::count(bins_.begin(), bins_.end(), 1)) /
           static_cast<double>(bins_.size());
  }

 private:
  std::vector<char> bins_;
};

}  // namespace

std::vector<RowFace> row_faces(const RunFolder& run, const VehicleLog& vehicle) {
  std::vector<RowFace> faces;
  if (!run.world || vehicle.truth.empty()) return faces;
  double reach_m = 0.0;
  for (const Alley& alley : run.world->rows->alleys) reach_m = std::max(reach_m, alley.width_m);
  if (reach_m <= 0.0) reach_m = kReach_m;
  for (const PlantRow& row : run.world->rows->rows) {
    if (row.line_W.size() < 2) continue;
    const Polyline line(from_above(row.line_W));
    Passed left(line.length_m()), right(line.length_m());
    for (const Odometry& truth : vehicle.truth.values) {
      const auto at = line.nearest(truth.X_WB.p.head<2>());
      const double foot_m = row.line_W[static_cast<std::size_t>(at.segment)].z();
      const bool is_near = at.distance_m <= reach_m && truth.X_WB.p.z() - foot_m <= kLow_m;
      if (is_near && !line.is_end(at))
        (at.signed_distance_m > 0.0 ? left : right).add(line.s_m(at));
    }
    for (const int side : {1, -1}) {
      RowFace face{row.id, side, (side > 0 ? left : right).share() >= kPassed, false};
      for (const Alley& alley : run.world->rows->alleys) {
        const Eigen::Vector3d middle = alley.line_W[alley.line_W.size() / 2];
        const Eigen::Vector3d before = alley.line_W[(alley.line_W.size() - 1) / 2];
        const auto at = line.nearest((0.5 * (middle + before)).head<2>());
        const bool is_adjacent = at.distance_m < reach_m && side * at.signed_distance_m > 0.0;
        face.has_alley = face.has_alley || is_adjacent;
      }
      faces.push_back(face);
    }
  }
  return faces;
}

std::string faces_left_out(const std::vector<RowFace>& faces) {
  std::vector<std::string> names;
  for (const RowFace& face : faces) {
    if (!face.passed)
      names.push_back(fmt::format("row {} ({})", face.row, face.side > 0 ? "left" : "right"));
  }
  if (names.empty()) return "";
  if (names.size() > kMaxNamed) return fmt::format("{} sides", names.size());
  const std::string last = names.back();
  names.pop_back();
  return names.empty() ? last : fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::string face_sentence(const std::vector<RowFace>& faces) {
  const auto passed =
      std::count_if(faces.begin(), faces.end(), [](const RowFace& face) { return face.passed; });
  if (passed == 0 || static_cast<std::size_t>(passed) == faces.size()) return "";
  const bool no_path = std::none_of(faces.begin(), faces.end(), [](const RowFace& face) {
    return !face.passed && face.has_alley;
  });
  return fmt::format(
      "{} {} of the {} row sides: {}", no_path ? "No alley runs along" : "The plan left out",
      faces.size() - static_cast<std::size_t>(passed), faces.size(), faces_left_out(faces));
}

}  // namespace vinerow::tools::report
