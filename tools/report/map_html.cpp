#include "tools/report/map_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "engine/math/polygon.h"
#include "tools/report/html.h"

namespace vinerow::tools {
namespace {

constexpr const char* kMapStyle = R"(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0; background: #faf9f5; color: #262c2e; font: 16px/1.5 "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 40px 28px 64px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 4px; }
h2 { font-size: 20px; margin: 44px 0 12px; }
p.lead { margin: 0 0 28px; color: #5c6462; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(200px, 1fr)); gap: 12px; }
.card { background: #fff; border: 1px solid #e3dfd3; border-radius: 6px; padding: 14px 16px; }
.card .value { font-size: 26px; font-weight: 600; line-height: 1.2; color: #2e6a28; }
.card .value small { font-size: 15px; font-weight: 400; color: #5c6462; }
.card .what { font-size: 14px; color: #5c6462; }
figure { margin: 0 0 28px; }
figure img { width: 100%; height: auto; display: block; border: 1px solid #e3dfd3; border-radius: 6px; }
figcaption { font-size: 14px; color: #5c6462; margin-top: 6px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; background: #fff; font-variant-numeric: tabular-nums; }
th, td { padding: 6px 10px; border-bottom: 1px solid #e9e5da; text-align: right; white-space: nowrap; }
th { background: #f1eee4; font-weight: 600; vertical-align: bottom; }
th small { font-weight: 400; color: #5c6462; }
td:first-child, th:first-child, table.facts td { text-align: left; }
table.facts td:first-child { color: #5c6462; width: 260px; }
tfoot td { font-weight: 600; border-top: 2px solid #c9c4b4; }
ul { padding-left: 20px; }
footer { margin-top: 48px; font-size: 13px; color: #787c7a; }
@media print { body { background: #fff; } main { max-width: none; padding: 0; } figure, tr, .card { break-inside: avoid; } }
)";

std::string grouped_count(std::int64_t number) {
  return report::grouped(std::to_string(number), 4);
}

std::string megabytes(std::int64_t bytes) {
  const double mb = 1e-6 * static_cast<double>(bytes);
  return fmt::format("{:.{}f} MB", mb, mb < 10.0 ? 2 : mb < 100.0 ? 1 : 0);
}

double total_length_m(const mapping::CloudMapReport& r) {
  double sum_m = 0.0;
  for (const auto& row : r.rows) sum_m += row.length_m;
  return sum_m;
}

double gaps_of_m(const mapping::MappedRowFigures& row) {
  double sum_m = 0.0;
  for (const auto& [from_m, to_m] : row.gaps_m) sum_m += to_m - from_m;
  return sum_m;
}

double all_gaps_m(const mapping::CloudMapReport& r) {
  double sum_m = 0.0;
  for (const auto& row : r.rows) sum_m += gaps_of_m(row);
  return sum_m;
}

std::string figure_card(const std::string& value, const std::string& unit,
                        const std::string& what) {
  return fmt::format(
      "<div class=\"card\"><div class=\"value\">{}{}</div><div class=\"what\">{}</div></div>\n",
      value, unit.empty() ? "" : fmt::format(" <small>{}</small>", unit), what);
}

std::string fact(const std::string& what, const std::string& value) {
  return fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", what, escaped(value));
}

std::string cards(const mapping::CloudMap& map) {
  const mapping::CloudMapReport& r = map.report;
  const double area_ha = 1e-4 * std::abs(signed_area_m2(map.map.boundary_W));
  std::string out = "<div class=\"cards\">\n";
  out += figure_card(std::to_string(r.rows.size()), "", "rows");
  out += figure_card(fmt::format("{:.0f}", total_length_m(r)), "m", "total length of the rows");
  out += figure_card(fmt::format("{:.2f}", r.spacing_m), fmt::format("± {:.2f} m", r.spacing_std_m),
                     "row spacing");
  out += figure_card(fmt::format("{:.1f}°", r.bearing_deg), "from north", "direction of the rows");
  out += figure_card(fmt::format("{:.2f}", r.canopy_top_m), "m", "canopy height above the ground");
  out += figure_card(fmt::format("{:.2f}", r.canopy_width_m), "m", "canopy width");
  out += figure_card(fmt::format("{:.0f}", r.volume_m3),
                     area_ha > 0.0 ? fmt::format("m³, {:.0f} m³/ha", r.volume_m3 / area_ha) : "m³",
                     "volume inside the meshes");
  out += figure_card(fmt::format("{:.0f}", r.seen_volume_m3), "m³",
                     "canopy seen, without the volume that noise adds");
  out += figure_card(
      fmt::format("{:.0f}", all_gaps_m(r)),
      fmt::format("m, {:.1f} %",
                  total_length_m(r) > 0.0 ? 100.0 * all_gaps_m(r) / total_length_m(r) : 0.0),
      "of row length without canopy");
  out += figure_card(fmt::format("{:.1f} %", 100.0 * r.containment), "",
                     "of canopy points within 1 cm of the meshes");
  out += figure_card(fmt::format("{:.1f} %", 100.0 * r.reduction),
                     fmt::format("{} of {}", megabytes(r.mesh_bytes), megabytes(r.cloud_bytes)),
                     "less data than the point cloud");
  return out + "</div>\n";
}

std::string row_table(const mapping::CloudMap& map) {
  const mapping::CloudMapReport& r = map.report;
  std::string out =
      "<div class=\"scroll\"><table>\n<thead><tr><th>row</th><th>length<br/><small>m</small></th>"
      "<th>bearing<br/><small>°</small></th><th>to the next<br/><small>m</small></th>"
      "<th>canopy from<br/><small>m</small></th><th>to<br/><small>m</small></th>"
      "<th>width<br/><small>m</small></th><th>volume<br/><small>m³</small></th>"
      "<th>without canopy<br/><small>m (gaps)</small></th>"
      "<th>contained<br/><small>%</small></th><th>points</th><th>triangles</th>"
      "</tr></thead>\n<tbody>\n";
  for (const mapping::MappedRowFigures& f : r.rows) {
    out += fmt::format(
        "<tr><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td>"
        "<td>{:.2f}</td><td>{:.1f}</td><td>{}</td><td>{:.2f}</td><td>{}</td><td>{}</td></tr>\n",
        f.row, f.length_m, f.bearing_deg,
        f.spacing_m > 0.0 ? fmt::format("{:.3f}", f.spacing_m) : "", f.canopy_base_m,
        f.canopy_top_m, f.canopy_width_m, f.volume_m3,
        f.gaps_m.empty() ? "0" : fmt::format("{:.1f} ({})", gaps_of_m(f), f.gaps_m.size()),
        100.0 * f.containment, grouped_count(f.points), grouped_count(f.triangles));
  }
  out += fmt::format(
      "</tbody>\n<tfoot><tr><td>all</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.3f}</td><td></td>"
      "<td>{:.2f}</td><td>{:.2f}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.2f}</td><td>{}</td>"
      "<td>{}</td></tr></tfoot>\n</table></div>\n",
      total_length_m(r), r.bearing_deg, r.spacing_m, r.canopy_top_m, r.canopy_width_m, r.volume_m3,
      all_gaps_m(r), 100.0 * r.containment, grouped_count(r.canopy_points),
      grouped_count(r.triangles));
  return out;
}

std::string end_table(const mapping::CloudMap& map) {
  std::string out =
      "<div class=\"scroll\"><table>\n<thead><tr><th>row</th><th>end</th><th>east<br/>"
      "<small>m</small></th><th>north<br/><small>m</small></th><th>up<br/><small>m</small></th>";
  if (map.has_origin) {
    out +=
        "<th>latitude<br/><small>° N</small></th><th>longitude<br/><small>° E</small></th>"
        "<th>altitude<br/><small>m</small></th>";
  }
  out += "</tr></thead>\n<tbody>\n";
  for (const mapping::MappedRowFigures& f : map.report.rows) {
    for (const bool last : {false, true}) {
      const Eigen::Vector3d& p = last ? f.last_W : f.first_W;
      out += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td>",
                         f.row, last ? "last" : "first", p.x(), p.y(), p.z());
      if (map.has_origin) {
        const Geodetic place = LocalFrame(map.origin).to_geodetic(p);
        out += fmt::format("<td>{:.7f}</td><td>{:.7f}</td><td>{:.2f}</td>",
                           deg_from_rad(place.latitude_rad), deg_from_rad(place.longitude_rad),
                           place.altitude_m);
      }
      out += "</tr>\n";
    }
  }
  return out + "</tbody>\n</table></div>\n";
}

std::string facts(const mapping::CloudMap& map) {
  const mapping::CloudMapReport& r = map.report;
  const auto share = [&](std::int64_t part) {
    return fmt::format("{} ({:.1f} %)", grouped_count(part),
                       r.points > 0 ? 100.0 * static_cast<double>(part) / r.points : 0.0);
  };
  std::string out = "<table class=\"facts\"><tbody>\n";
  out += fact("file", r.file + (r.format.empty() ? "" : ", " + r.format));
  out += fact("coordinate reference system", r.crs.empty() ? "none, local metres" : r.crs);
  out += fact("points", grouped_count(r.points) +
                            (r.not_finite > 0 ? fmt::format(", {} more ignored, not finite",
                                                            grouped_count(r.not_finite))
                                              : ""));
  out += fact("density", fmt::format("{:.0f} per m²", r.density_per_m2));
  out += fact("noise", fmt::format("{:.1f} cm (1 sigma of ground points)", 100.0 * r.noise_m));
  out += fact("ground points", share(r.ground_points));
  out += fact("low vegetation", share(r.low_points));
  out += fact("canopy of rows", share(r.canopy_points));
  out += fact("other points as high as the canopy", share(r.other_points));
  if (map.has_origin) {
    out += fact("origin of the map",
                fmt::format("{:.7f}° N, {:.7f}° E, {:.2f} m", deg_from_rad(map.origin.latitude_rad),
                            deg_from_rad(map.origin.longitude_rad), map.origin.altitude_m));
  } else {
    out += fact("origin of the map", "unknown: coordinates are local metres");
  }
  if (!map.map.occupancy.empty()) {
    const OccupancyGrid& grid = map.map.occupancy;
    out += fact("occupancy grid",
                fmt::format("{} x {} cells of {:g} m", grid.columns, grid.rows, grid.cell_m));
  }
  out += fact("surface of the meshes", fmt::format("{:.1f} cm (1 sigma, stated to estimators)",
                                                   100.0 * map.map.accuracy.surface_std_m));
  return out + "</tbody></table>\n";
}

}  // namespace

std::string map_report_html(const mapping::CloudMap& map,
                            const std::vector<ReportPicture>& pictures, const std::string& title) {
  const mapping::CloudMapReport& r = map.report;
  std::string out = page_head(title + ": map of the vineyard", kMapStyle);
  out +=
      fmt::format("<main>\n<h1>{}</h1>\n<p class=\"lead\">Map of the vineyard from {} points</p>\n",
                  escaped(title), grouped_count(r.points));
  out += cards(map);
  if (!r.notes.empty()) {
    out += "<h2>Notes</h2>\n<ul>\n";
    for (const std::string& note : r.notes) out += fmt::format("<li>{}</li>\n", escaped(note));
    out += "</ul>\n";
  }
  if (!pictures.empty()) out += "<h2>Pictures</h2>\n";
  for (const ReportPicture& picture : pictures) {
    out += fmt::format("<figure><img src=\"{}\" alt=\"{}\"/><figcaption>{}</figcaption></figure>\n",
                       escaped(picture.file), escaped(picture.caption), escaped(picture.caption));
  }
  out += "<h2>Rows</h2>\n" + row_table(map);
  out += "<h2>Ends of the rows</h2>\n" + end_table(map);
  out += "<h2>Point cloud and map</h2>\n" + facts(map);
  out +=
      "<footer>Made by Vinerow. Files next to this page: map.json (rows, figures), report.json "
      "(figures), meshes (PLY), terrain.tif (GeoTIFF), occupancy.yaml (ROS map), rows.geojson "
      "(QGIS, if the origin is known).</footer>\n</main>\n</body>\n</html>\n";
  return out;
}

std::string map_report_text(const mapping::CloudMap& map) {
  const mapping::CloudMapReport& r = map.report;
  const auto percent = [&](std::int64_t part) {
    return r.points > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(r.points) : 0.0;
  };
  std::string out;
  out += fmt::format("cloud          {} ({}), {} points, {}, {:.0f} per m², noise {:.1f} cm\n",
                     r.file, r.format, r.points, megabytes(r.cloud_bytes), r.density_per_m2,
                     100.0 * r.noise_m);
  if (r.not_finite > 0) {
    out += fmt::format("ignored        {} points that are not finite\n", r.not_finite);
  }
  out += fmt::format(
      "classes        {:.1f} % ground, {:.1f} % low vegetation, {:.1f} % canopy, {:.1f} % other\n",
      percent(r.ground_points), percent(r.low_points), percent(r.canopy_points),
      percent(r.other_points));
  out += fmt::format("rows           {}, total length {:.0f} m, {:.0f} m without canopy\n",
                     r.rows.size(), total_length_m(r), all_gaps_m(r));
  out += fmt::format("direction      {:.2f} deg from north\n", r.bearing_deg);
  out += fmt::format("spacing        {:.3f} m +- {:.3f} m\n", r.spacing_m, r.spacing_std_m);
  out += fmt::format("canopy         {:.2f} m high, {:.2f} m wide\n", r.canopy_top_m,
                     r.canopy_width_m);
  out += fmt::format("volume         {:.1f} m3 inside the meshes, {:.1f} m3 of canopy seen\n",
                     r.volume_m3, r.seen_volume_m3);
  out += fmt::format("meshes         {} triangles, {}, {:.2f} % less than the cloud\n", r.triangles,
                     megabytes(r.mesh_bytes), 100.0 * r.reduction);
  out +=
      fmt::format("containment    {:.2f} % of canopy points within 1 cm\n", 100.0 * r.containment);
  if (!map.map.occupancy.empty()) {
    const OccupancyGrid& grid = map.map.occupancy;
    out += fmt::format("grid           {} x {} cells of {:g} m\n", grid.columns, grid.rows,
                       grid.cell_m);
  }
  for (const std::string& note : r.notes) out += fmt::format("note: {}\n", note);
  return out;
}

}  // namespace vinerow::tools
