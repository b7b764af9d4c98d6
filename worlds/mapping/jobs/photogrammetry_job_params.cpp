#include "worlds/mapping/jobs/photogrammetry_job_params.h"

#include "engine/api/parameter_table.h"

namespace vinerow::mapping {

const ParameterTable<PhotogrammetryJobParams>& photogrammetry_job_table() {
  using P = PhotogrammetryJobParams;
  using Options = PhotogrammetryOptions;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("density_per_m2", "1/m2", inside(&P::options, &Options::density_per_m2),
                  between(1e-3, 1e6),
                  "points per square metre of level ground; default: one per pixel")
          .number("match_noise_px", "px", inside(&P::options, &Options::match_px),
                  between(0.0, 100.0), "1 sigma of a match in u and in v, in each picture")
          .integer("min_views", inside(&P::options, &Options::min_views), between(2, 1000),
                   "pictures that must see a point")
          .integer("max_views", inside(&P::options, &Options::max_views), between(2, 1000),
                   "pictures that fix a point")
          .degrees("max_incidence_deg", inside(&P::options, &Options::max_incidence_rad),
                   between(1.0, 89.9), "maximum angle between a view and the surface normal")
          .degrees("min_baseline_deg", inside(&P::options, &Options::min_baseline_rad),
                   between(0.0, 179.0),
                   "smallest accepted angle between the outermost rays of a point")
          .include(inside(&P::options, &Options::georeference), georeference_table())
          .numbers("area_m", "m", &P::area_m, kAnyNumber,
                   "x and y of each corner, east and north of the origin, instead of the "
                   "world's parcel")
          .number("margin_m", "m", &P::margin_m, between(0.0, 1000.0),
                  "width of the margin around the area")
          .text("crs", inside(&P::file, &CloudFileOptions::crs),
                "coordinates of the file, like EPSG:25832; default: m east, north, up of the "
                "world's origin")
          .boolean("truth_classes", inside(&P::file, &CloudFileOptions::truth_classes),
                   "points carry their true classes, which no survey knows")
          .numbers("missing_rows", "", inside(&P::options, &Options::missing_rows),
                   between(0.0, 1e6),
                   "rows whose canopy no picture shows, as under a cloud's shadow or "
                   "uprooted before the flight");
  return table;
}

}  // namespace vinerow::mapping
