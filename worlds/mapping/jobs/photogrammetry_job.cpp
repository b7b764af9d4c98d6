#include "worlds/mapping/jobs/photogrammetry_job.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/io/geo/local_to_crs.h"
#include "worlds/mapping/jobs/photogrammetry_job_params.h"
#include "worlds/mapping/photogrammetry/hidden_rows.h"
#include "worlds/mapping/photogrammetry/write_cloud.h"

namespace vinerow::mapping {
namespace {

PhotogrammetryJobParams read_photogrammetry_job(const ParameterSet& parameters,
                                                std::uint64_t seed) {
  PhotogrammetryJobParams params = photogrammetry_job_table().read(parameters, "");
  params.options.seed = seed;
  check_options(params.options);
  // An unknown system is refused now, not after the flight.
  if (!params.file.crs.empty()) io::LocalToCrs(params.file.crs, GeoOrigin{});
  return params;
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
                     {"georeference_shift_m",
                      std::hypot(sampling.georeference_east_m, sampling.georeference_north_m)},
                     {"georeference_height_m", sampling.georeference_up_m},
                     {"georeference_tilt_deg", sampling.georeference_tilt_deg},
                     {"georeference_turn_deg", sampling.georeference_turn_deg},
                     {"file_MB", 1e-6 * static_cast<double>(written.bytes)}};
  if (written.tally.missing > 0) {
    outcome.notes.push_back(
        fmt::format("{} canopy points were left out because no picture shows their rows",
                    written.tally.missing));
  }
  return outcome;
}

class PhotogrammetryJob : public Job {
 public:
  PhotogrammetryJob(const PhotogrammetryJobParams& params, const JobContext& context)
      : context_(context),
        options_(params.options),
        area_(make_survey_area(params.area_m, params.margin_m, *context.world, "area_m")) {
    HiddenRows(*context.world, options_.missing_rows);
    target_.file = context.folder / "cloud.las";
    target_.name = "cloud.las";
    target_.options = params.file;
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

std::vector<ResultSpec> photogrammetry_results() {
  using Range = ResultRange;
  return {
      {"points", "1", Range::count(), "points", "Number of points that the job produced or read.",
       ""},
      {"density_per_m2", "1/m²", Range::from_zero(), "point density",
       "Points of the cloud per square metre of covered ground.", "paper A, §3"},
      {"pictures", "1", Range::count(), "pictures used",
       "Number of pictures from which the cloud is made.", ""},
      {"gsd_m", "m", Range::from_zero(), "GSD of the pictures",
       "Ground sampling distance of the pictures from which the cloud is made.", "paper A, §2"},
      {"mean_views", "1", Range::from_zero(), "pictures per point",
       "Mean number of pictures that show a point.", ""},
      {"horizontal_noise_m", "m", Range::from_zero(), "horizontal point noise",
       "Root mean square of the horizontal errors of the points, both coordinates together.", ""},
      {"height_noise_m", "m", Range::from_zero(), "vertical point noise",
       "Root mean square of the height errors of the points.", ""},
      {"georeference_shift_m", "m", Range::from_zero(), "horizontal georeferencing error",
       "Horizontal displacement of the whole cloud.", ""},
      {"georeference_height_m", "m", Range::any(), "vertical georeferencing error",
       "Vertical displacement of the whole cloud, positive upwards.", ""},
      {"georeference_tilt_deg", "deg", Range::any(), "georeferencing tilt error",
       "Tilt of the whole cloud.", ""},
      {"georeference_turn_deg", "deg", Range::any(), "georeferencing heading error",
       "Rotation of the whole cloud about the vertical.", ""},
      {"file_MB", "MB", Range::from_zero(), "cloud file size",
       "Size of the file of the point cloud.", ""}};
}

}  // namespace

void register_photogrammetry_job(Registry& registry) {
  PartSpec spec;
  spec.name = "photogrammetry";
  spec.results = photogrammetry_results();
  spec.description =
      "turns the pictures of a survey into a point cloud: dense matching by visibility, errors of "
      "forward intersection (Hartley, Zisserman, section 5.2); the truth is in a file next to it";
  photogrammetry_job_table().add_to(spec);
  spec.takes = {{"pictures", ProductKind::kPictures, true, "of a survey's camera_trigger"}};
  spec.gives = ProductKind::kCloud;
  registry.add_job(std::move(spec), [](const ParameterSet& parameters, const JobContext& context) {
    return std::make_unique<PhotogrammetryJob>(read_photogrammetry_job(parameters, context.seed),
                                               context);
  });
}

}  // namespace vinerow::mapping
