#include "worlds/mapping/jobs/photogrammetry_job.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
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
        fmt::format("{} canopy points of rows that no picture is to show were left out",
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

}  // namespace

void register_photogrammetry_job(Registry& registry) {
  PartSpec spec;
  spec.name = "photogrammetry";
  spec.description =
      "turns the pictures of a survey into a point cloud: dense matching by visibility, errors of "
      "forward intersection (Hartley, Zisserman, section 5.2); the truth is kept beside it";
  spec.parameters = photogrammetry_job_table().specs();
  spec.takes = {{"pictures", ProductKind::kPictures, true, "of a survey's camera_trigger"}};
  spec.gives = ProductKind::kCloud;
  registry.add_job(std::move(spec), [](const ParameterSet& parameters, const JobContext& context) {
    return std::make_unique<PhotogrammetryJob>(read_photogrammetry_job(parameters, context.seed),
                                               context);
  });
}

}  // namespace vinerow::mapping
