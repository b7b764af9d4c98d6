#include "worlds/mapping/folder/map_gis.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/core/error.h"
#include "engine/io/geo/gis_files.h"
#include "engine/io/geo/local_to_crs.h"
#include "engine/math/angles.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// From W to the CRS of the files and back, quickly: straight maps on tiles of the parcel.
class GisFrame {
 public:
  GisFrame(const CloudMap& map, const Eigen::AlignedBox3d& box_W) : corner_W_(box_W.min()) {
    const std::string crs = gis_crs(map);
    if (!crs.empty()) exact_ = std::make_unique<io::LocalToCrs>(crs, map.origin);
    columns_ = std::max(1, static_cast<int>(std::ceil(box_W.sizes().x() / kTile_m)));
    rows_ = std::max(1, static_cast<int>(std::ceil(box_W.sizes().y() / kTile_m)));
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < columns_; ++i) {
        const Vector3d centre_W(corner_W_.x() + kTile_m * (i + 0.5),
                                corner_W_.y() + kTile_m * (j + 0.5), box_W.center().z());
        tiles_.push_back(exact_ ? exact_->near(centre_W) : io::LocalToCrs::Nearby{});
        inverses_.push_back(tiles_.back().linear.inverse());
      }
    }
    if (exact_) {
      const Vector3d step = exact_->from_local(Vector3d(1, 0, 0)) - exact_->from_local({0, 0, 0});
      unit_ = step.norm();
      height_unit_ = exact_->from_local(Vector3d(0, 0, 1)).z() - exact_->from_local({0, 0, 0}).z();
    }
  }

  /// Height in metres.
  Vector3d from_W(const Vector3d& p_W) const {
    Vector3d p = tiles_[tile_of(p_W.head<2>())](p_W);
    p.z() /= height_unit_;
    return p;
  }
  /// x, y in W of a place at the parcel's height.
  Vector2d to_W(const Vector2d& place) const {
    // A first guess by the middle tile, then by the guess's own.
    Vector2d p_W = by_tile(tiles_.size() / 2, place);
    for (int step = 0; step < 2; ++step) p_W = by_tile(tile_of(p_W), place);
    return p_W;
  }
  double unit() const { return unit_; }  ///< of the CRS in a metre

 private:
  static constexpr double kTile_m = 20.0;

  std::size_t tile_of(const Vector2d& p_W) const {
    const auto at = [](double from_corner_m, int count) {
      return std::clamp(static_cast<int>(from_corner_m / kTile_m), 0, count - 1);
    };
    return static_cast<std::size_t>(at(p_W.y() - corner_W_.y(), rows_)) *
               static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(at(p_W.x() - corner_W_.x(), columns_));
  }
  Vector2d by_tile(std::size_t k, const Vector2d& place) const {
    const io::LocalToCrs::Nearby& tile = tiles_[k];
    const Vector3d off(place.x() - tile.constant.x(), place.y() - tile.constant.y(), 0.0);
    return (tile.centre_W + inverses_[k] * off).head<2>();
  }

  Vector3d corner_W_;
  std::unique_ptr<io::LocalToCrs> exact_;
  int columns_ = 0, rows_ = 0;
  std::vector<io::LocalToCrs::Nearby> tiles_;
  std::vector<Eigen::Matrix3d> inverses_;
  double unit_ = 1.0, height_unit_ = 1.0;
};

/// So that most pixels hold four points.
double pixel_m(double density_per_m2) {
  for (const double cell_m : {0.1, 0.2, 0.25, 0.5}) {
    if (density_per_m2 * cell_m * cell_m >= 4.0) return cell_m;
  }
  return 1.0;
}

/// The three rasters of one grid.
struct Rasters {
  io::CrsRaster dtm, dsm, chm;
};

Rasters make_rasters(const CloudMap& map, const ParcelCloud& cloud, const GisFrame& frame) {
  // Points are converted twice: keeping the places of all would take twice the memory of the cloud.
  const auto place = [&](std::size_t k) { return frame.from_W(cloud.point_W(k)); };
  Eigen::AlignedBox2d box;
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    box.extend(Vector2d(place(k).head<2>()));
  }
  constexpr double kMaxPixels = 100e6;
  double cell_m = pixel_m(map.report.density_per_m2);
  while (box.sizes().prod() / std::pow(cell_m * frame.unit(), 2) > kMaxPixels) cell_m *= 2.0;
  Rasters made;
  io::CrsRaster& dsm = made.dsm;
  dsm.crs = gis_crs(map);
  dsm.cell = std::abs(frame.unit() - 1.0) < 0.01 ? cell_m : cell_m * frame.unit();
  const auto line = [&](double at) { return std::floor(at / dsm.cell); };
  dsm.north_west = {dsm.cell * line(box.min().x()), dsm.cell * (line(box.max().y()) + 1.0)};
  dsm.columns = static_cast<int>(line(box.max().x()) - line(box.min().x())) + 1;
  dsm.rows = static_cast<int>(line(box.max().y()) - line(box.min().y())) + 1;
  dsm.values.assign(static_cast<std::size_t>(dsm.columns) * dsm.rows, io::CrsRaster::kNoHeight);
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    const Vector3d p = place(k);
    const int i =
        std::clamp(static_cast<int>((p.x() - dsm.north_west.x()) / dsm.cell), 0, dsm.columns - 1);
    const int j =
        std::clamp(static_cast<int>((dsm.north_west.y() - p.y()) / dsm.cell), 0, dsm.rows - 1);
    float& highest = dsm.values[static_cast<std::size_t>(j) * dsm.columns + i];
    highest = std::max(highest, static_cast<float>(p.z()));
  }
  made.dtm = made.chm = dsm;
  made.dsm.description = "highest point";
  made.dtm.description = "height of the ground";
  made.chm.description = "height above the ground";
  const HeightField& ground = *map.map.terrain;
  for (int j = 0; j < dsm.rows; ++j) {
    for (int i = 0; i < dsm.columns; ++i) {
      const Vector2d p_W = frame.to_W(dsm.north_west + dsm.cell * Vector2d(i + 0.5, -(j + 0.5)));
      const double z_W = ground.height_m(p_W.x(), p_W.y());
      const double height_m = frame.from_W({p_W.x(), p_W.y(), z_W}).z();
      const std::size_t at = static_cast<std::size_t>(j) * dsm.columns + i;
      made.dtm.values[at] = static_cast<float>(height_m);
      if (dsm.values[at] == io::CrsRaster::kNoHeight) continue;
      made.chm.values[at] = static_cast<float>(std::max(0.0, dsm.values[at] - height_m));
    }
  }
  return made;
}

std::vector<Vector3d> line_in(const GisFrame& frame, const std::vector<Vector3d>& line_W) {
  std::vector<Vector3d> line;
  for (const Vector3d& p : line_W) line.push_back(frame.from_W(p));
  return line;
}

std::vector<io::GisLayer> make_layers(const CloudMap& map, const GisFrame& frame) {
  using Kind = io::GeometryKind;
  const auto whole = [](int number) { return io::GisValue(static_cast<std::int64_t>(number)); };
  io::GisLayer rows{"rows", Kind::kLineString, {"block", "row"}, {}};
  io::GisLayer ends{"row_ends", Kind::kPoint, {"block", "row", "end"}, {}};
  for (std::size_t k = 0; k < map.map.rows.size(); ++k) {
    const PlantRow& row = map.map.rows[k];
    const MappedRowFigures& figures = map.report.rows[k];
    io::GisFeature feature{line_in(frame, row.line_W), {whole(figures.block), whole(row.id)}};
    for (const auto& [name, value] : row_values(figures)) {
      if (k == 0) rows.fields.push_back(name);
      feature.values.emplace_back(value);
    }
    for (const bool last : {false, true}) {
      ends.features.push_back(
          {{last ? feature.points.back() : feature.points.front()},
           {whole(figures.block), whole(row.id), std::string(last ? "last" : "first")}});
    }
    rows.features.push_back(std::move(feature));
  }
  std::vector<io::GisLayer> layers{std::move(rows), std::move(ends)};
  io::GisLayer alleys{"alleys", Kind::kLineString, {"alley", "width_m"}, {}};
  for (const Alley& alley : map.map.alleys) {
    alleys.features.push_back({line_in(frame, alley.line_W), {whole(alley.id), alley.width_m}});
  }
  if (!alleys.features.empty()) layers.push_back(std::move(alleys));
  if (!map.map.boundary_W.empty()) {
    std::vector<Vector3d> ring_W;
    for (const Vector2d& p : map.map.boundary_W) {
      ring_W.emplace_back(p.x(), p.y(), map.map.terrain->height_m(p.x(), p.y()));
    }
    double volume_m3 = 0.0;
    for (const MappedRowFigures& row : map.report.rows) volume_m3 += row.volume_m3;
    layers.push_back(
        {"boundary",
         Kind::kPolygon,
         {"rows", "volume_m3"},
         {{line_in(frame, ring_W), {whole(static_cast<int>(map.map.rows.size())), volume_m3}}}});
  }
  return layers;
}

}  // namespace

std::vector<std::pair<std::string, double>> row_values(const MappedRowFigures& row) {
  double gaps_m = 0.0;
  for (const auto& [from_m, to_m] : row.gaps_m) gaps_m += to_m - from_m;
  return {{"length_m", row.length_m},
          {"bearing_deg", row.bearing_deg},
          {"canopy_width_m", row.canopy_width_m},
          {"canopy_base_m", row.canopy_base_m},
          {"canopy_top_m", row.canopy_top_m},
          {"volume_m3", row.volume_m3},
          {"volume_m3_per_m", row.length_m > 0.0 ? row.volume_m3 / row.length_m : 0.0},
          {"seen_volume_m3", row.seen_volume_m3},
          {"gaps", static_cast<double>(row.gaps_m.size())},
          {"gaps_m", gaps_m}};
}

std::string rows_to_csv(const CloudMap& map) {
  std::string text;
  for (const MappedRowFigures& row : map.report.rows) {
    const auto values = row_values(row);
    if (text.empty()) {
      text = "block,row";
      for (const auto& [name, value] : values) text += "," + name;
      text += "\n";
    }
    text += fmt::format("{},{}", row.block, row.row);
    for (const auto& [name, value] : values) text += fmt::format(",{:.6g}", value);
    text += "\n";
  }
  return text;
}

std::string gis_crs(const CloudMap& map) {
  if (!map.has_origin) return "";
  if (!map.report.crs.empty()) {
    const io::LocalToCrs given(map.report.crs, map.origin);
    // A degree is some 1e5 m.
    const Vector3d step = given.from_local({1, 0, 0}) - given.from_local({0, 0, 0});
    if (step.head<2>().norm() > 1e-3) return map.report.crs;
  }
  const double longitude_deg = deg_from_rad(map.origin.longitude_rad);
  const int zone =
      std::clamp(static_cast<int>(std::floor((longitude_deg + 180.0) / 6.0)) + 1, 1, 60);
  return fmt::format("EPSG:{}", (map.origin.latitude_rad < 0.0 ? 32700 : 32600) + zone);
}

void save_gis(const CloudMap& map, const ParcelCloud& cloud, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder / "gis", error);
  if (error) {
    throw ConfigError(fmt::format("folder '{}' cannot be created for the map: {}",
                                  (folder / "gis").string(), error.message()));
  }
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : cloud.points) box.extend(p);
  const GisFrame frame(
      map, {box.min().cast<double>() + cloud.origin_W, box.max().cast<double>() + cloud.origin_W});
  io::write_geopackage(make_layers(map, frame), gis_crs(map), folder / "gis" / "map.gpkg");
  if (!map.map.terrain) return;
  const Rasters rasters = make_rasters(map, cloud, frame);
  io::write_crs_raster(rasters.dtm, folder / "gis" / "dtm.tif");
  io::write_crs_raster(rasters.dsm, folder / "gis" / "dsm.tif");
  io::write_crs_raster(rasters.chm, folder / "gis" / "chm.tif");
}

}  // namespace vinerow::mapping
