#include "worlds/mapping/jobs/photogrammetry_job.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "worlds/mapping/cloud/sampling/hidden_rows.h"
#include "worlds/mapping/cloud/sampling/write_cloud.h"

namespace vinerow::worlds {
namespace {

std::vector<ParameterSpec> photogrammetry_parameters() {
  const PhotogrammetryOptions usual;
  return {
      optional(number_parameter("density_per_m2", "1/m2", 0.0, 1e-3, 1e6,
                                "points per square metre of level ground; default: one per pixel")),
      number_parameter("match_noise_px", "px", usual.match_px, 0.0, 100.0,
                       "1 sigma of a match in u and in v, in each picture"),
      integer_parameter("min_views", usual.min_views, 2, 1000, "pictures that must see a point"),
      integer_parameter("max_views", usual.max_views, 2, 1000, "pictures that fix a point"),
      number_parameter("max_incidence_deg", "deg", 80.0, 1.0, 89.9,
                       "of a view off the surface's normal"),
      number_parameter("min_baseline_deg", "deg", 3.0, 0.0, 179.0,
                       "widest angle between a point's rays at least"),
      number_list_parameter("area_m", "m", {},
                            "x and y of each corner, east and north of the origin, instead of the "
                            "world's parcel"),
      number_parameter("margin_m", "m", 0.0, 0.0, 1000.0, "around the area"),
      text_parameter("crs", "",
                     "coordinates of the file, like EPSG:25832; default: m east, north, up of the "
                     "world's origin"),
      boolean_parameter("truth_classes", false,
                        "points carry their true classes, which no survey knows"),
      number_list_parameter("missing_rows", "", {},
                            "rows whose canopy no picture shows, as under a cloud's shadow or "
                            "uprooted before the flight"),
  };
}

std::vector<int> read_rows(const ParameterSet& parameters) {
  std::vector<int> rows;
  for (const double row : parameters.numbers("missing_rows")) {
    if (!(row >= 0.0 && row <= 1e6) || row != std::floor(row)) {
      throw ConfigError(fmt::format("missing_rows: {:g} is no number of a row", row));
    }
    rows.push_back(static_cast<int>(row));
  }
  return rows;
}

PhotogrammetryOptions read_picture_options(const ParameterSet& parameters, std::uint64_t seed) {
  PhotogrammetryOptions options;
  if (parameters.has("density_per_m2")) {
    options.density_per_m2 = parameters.number("density_per_m2");
  }
  options.match_px = parameters.number("match_noise_px");
  options.min_views = static_cast<int>(parameters.integer("min_views"));
  options.max_views = static_cast<int>(parameters.integer("max_views"));
  options.max_incidence_rad = rad_from_deg(parameters.number("max_incidence_deg"));
  options.min_baseline_rad = rad_from_deg(parameters.number("min_baseline_deg"));
  options.missing_rows = read_rows(parameters);
  options.seed = seed;
  check_options(options);
  return options;
}

JobOutcome outcome_of(const WrittenCloud& written, const std::filesystem::path& file) {
  const CloudSampling& sampling = written.truth.sampling;
  JobOutcome outcome;
  outcome.product.kind = ProductKind::kCloud;
  outcome.product.file = file;
  outcome.numbers = {{"points", static_cast<double>(sampling.points)},
                     {"density_per_m2", sampling.density_per_m2},
                     {"pictures", sampling.pictures},
                     {"gsd_m", sampling.gsd_m},
                     {"mean_views", sampling.views_mean},
                     {"horizontal_noise_m", sampling.horizontal_noise_rms_m},
                     {"height_noise_m", sampling.height_noise_rms_m},
                     {"file_MB", 1e-6 * static_cast<double>(written.bytes)}};
  if (written.tally.missing > 0) {
    outcome.notes.push_back(
        fmt::format("{} canopy points of rows that no picture is to show were left out",
                    written.tally.missing));
  }
  return outcome;
}

class PhotogrammetryJob : public Job {
 public:
  PhotogrammetryJob(const ParameterSet& parameters, const JobContext& context)
      : context_(context),
        options_(read_picture_options(parameters, context.seed)),
        area_(make_survey_area(parameters.numbers("area_m"), parameters.number("margin_m"),
                               *context.world, "area_m")) {
    HiddenRows(*context.world, options_.missing_rows);
    target_.file = context.folder / "cloud.las";
    target_.name = "cloud.las";
    target_.options.crs = parameters.text("crs");
    target_.options.truth_classes = parameters.boolean("truth_classes");
  }

  Result<JobOutcome> run(const std::map<std::string, Product>& inputs) override {
    const PictureSet& pictures = *inputs.at("pictures").pictures;
    if (pictures.X_WS.empty()) {
      return Failure{fmt::format("camera '{}' has taken no picture", pictures.source)};
    }
    try {
      const auto written = write_photogrammetry(*context_.scene, *context_.world, pictures, area_,
                                                options_, target_);
      if (!written) return Failure{written.reason()};
      return outcome_of(*written, target_.file);
    } catch (const ConfigError& error) {
      return Failure{error.what()};
    }
  }

 private:
  const JobContext context_;
  const PhotogrammetryOptions options_;
  const SurveyArea area_;
  CloudTarget target_;
};

}  // namespace

void register_photogrammetry_job(Registry& registry) {
  PartSpec spec;
  spec.name = "photogrammetry";
  spec.description =
      "turns the pictures of a survey into a point cloud: dense matching by visibility, errors of "
      "forward intersection (Hartley, Zisserman, section 5.2); the truth is kept beside it";
  spec.parameters = photogrammetry_parameters();
  spec.takes = {{"pictures", ProductKind::kPictures, true, "of a survey's camera_trigger"}};
  spec.gives = ProductKind::kCloud;
  registry.add_job(std::move(spec), [](const ParameterSet& parameters, const JobContext& context) {
    return std::make_unique<PhotogrammetryJob>(parameters, context);
  });
}

}  // namespace vinerow::worlds
