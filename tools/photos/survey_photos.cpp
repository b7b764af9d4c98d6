#include "tools/photos/survey_photos.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/core/whole_file.h"
#include "engine/imaging/jpeg.h"
#include "engine/io/files/whole_folder.h"
#include "engine/math/angles.h"
#include "engine/physics/check_world.h"
#include "engine/physics/surface_rays.h"
#include "engine/sensors/camera/imager.h"
#include "engine/sensors/camera/lens.h"
#include "engine/sensors/camera/scene_look.h"
#include "engine/sensors/camera/view_caster.h"
#include "tools/photos/photo_facts.h"

namespace vinerow::tools {
namespace {

/// Rays of a pixel: without several, leaves smaller than a pixel flicker from picture to picture,
/// which real optics blur.
constexpr int kSamples = 4;
constexpr int kQuality = 95;

Lens photo_lens(const SurveyCamera& camera) {
  sensors::LensParams lens;
  lens.width_px = camera.columns;
  lens.height_px = camera.rows;
  lens.fx_px = camera.focal_length_mm / camera.sensor_width_mm * camera.columns;
  return sensors::make_lens(lens, "survey: --picture-width");
}

struct BandSpec {
  const char* key;
  const char* name;
  sensors::Channel channel;
  double wavelength_nm, width_nm;
};

/// Centres and widths: MicaSense, RedEdge-M user manual (2017).
constexpr BandSpec kBands[] = {{"blue", "Blue", sensors::Channel::kBlue, 475.0, 20.0},
                               {"green", "Green", sensors::Channel::kGreen, 560.0, 20.0},
                               {"red", "Red", sensors::Channel::kRed, 668.0, 10.0},
                               {"red_edge", "Red edge", sensors::Channel::kRedEdge, 717.0, 10.0},
                               {"nir", "NIR", sensors::Channel::kNir, 840.0, 40.0}};

const BandSpec& find_band(const std::string& key) {
  for (const BandSpec& band : kBands) {
    if (band.key == key) return band;
  }
  throw ConfigError(
      fmt::format("survey: --bands has '{}', must be of {}", key, fmt::join(photo_bands(), ", ")));
}

/// Of the photographs of one moment.
std::string capture_name(std::size_t index) {
  return fmt::format("photo_{:04}", index + 1);
}

std::string photo_name(std::size_t index, const std::string& band = "") {
  return capture_name(index) + (band.empty() ? ".jpg" : "_" + band + ".tif");
}

/// What all photographs share. Thread safe.
class Darkroom {
 public:
  /// @param columns  of the camera itself; pictures of fewer have pixels that join several of its
  Darkroom(const SurveyCamera& camera, int columns, const WorldModel& world,
           const SurveyPhotoOptions& options)
      : camera_(camera),
        joined_(std::max(1.0, static_cast<double>(columns) / camera.columns)),
        world_(world),
        seed_(options.seed),
        frame_(world.origin),
        lens_(photo_lens(camera)) {
    if (options.bands.empty()) looks_.emplace_back(world, sensors::Channel::kColour);
    for (const std::string& band : options.bands) {
      bands_.push_back(&find_band(band));
      looks_.emplace_back(world, bands_.back()->channel);
    }
    if (world.terrain) terrain_.emplace(*world.terrain);
    light_.emplace(world, terrain_ ? &*terrain_ : nullptr, &physics::is_seen_by_light);
  }

  const LocalFrame& frame() const { return frame_; }

  /// Writes the photographs of one moment. @param estimated_W  place of the camera
  void write(std::size_t index, const Pose& X_WS, const Eigen::Vector3d& estimated_W,
             const std::filesystem::path& folder) const {
    PhotoFacts facts = {camera_.name,
                        camera_.focal_length_mm,
                        camera_.sensor_width_mm,
                        camera_.columns,
                        camera_.rows,
                        frame_.to_geodetic(estimated_W),
                        X_WS.q,
                        std::nullopt};
    if (bands_.empty()) {
      const std::string name = photo_name(index);
      write_whole_file(folder / name, jpeg(name, X_WS, facts));
      return;
    }
    for (std::size_t b = 0; b < bands_.size(); ++b) {
      const std::string name = photo_name(index, bands_[b]->key);
      write_whole_file(folder / name, tiff(name, b, X_WS, facts, capture_name(index)));
    }
  }

 private:
  sensors::ImagerParams image_sensor() const {
    sensors::ImagerParams params;
    params.pixel_um = 1e3 * camera_.sensor_width_mm / camera_.columns;
    // Pixels that are joined hold the electrons of all of them: else the shortest exposure fills
    // them.
    params.full_well_e *= joined_ * joined_;
    return params;
  }

  /// @param name  of the file, for errors and for the noise
  Picture take(const std::string& name, const Pose& X_WS, const sensors::SceneLook& look,
               const sensors::ImagerParams& image_sensor, int channels) const {
    sensors::ViewSettings settings;
    settings.samples = kSamples;
    settings.facts = false;
    settings.channels = channels;
    sensors::ViewCaster caster(lens_, settings, world_, *light_, look);
    const std::string blindness = caster.blindness(X_WS);
    if (!blindness.empty()) {
      throw ConfigError(fmt::format("survey: the camera of {} {}", name, blindness));
    }
    sensors::View view;
    caster.cast({X_WS, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}, 0.0, view);
    sensors::Imager imager(image_sensor, camera_.columns, camera_.rows, channels, look.white(),
                           RandomStream(seed_, "survey", "pattern"));
    sensors::QuickNormals noise{RandomStream(seed_, "survey", name)};
    Picture picture, without_noise;
    picture.format = channels == 3 ? Picture::Format::kRgb8 : Picture::Format::kMono16;
    picture.width = static_cast<std::uint32_t>(camera_.columns);
    picture.height = static_cast<std::uint32_t>(camera_.rows);
    picture.data.resize(std::size_t{picture.width} * picture.height *
                        Picture::bytes_per_pixel(picture.format));
    without_noise = picture;
    imager.expose(view.radiance, noise, picture, without_noise);
    return picture;
  }

  std::string jpeg(const std::string& name, const Pose& X_WS, const PhotoFacts& facts) const {
    const Picture picture = take(name, X_WS, looks_.front(), image_sensor(), 3);
    imaging::Pixels pixels(camera_.columns, camera_.rows);
    for (std::size_t i = 0; i < picture.data.size() / 3; ++i) {
      std::copy_n(&picture.data[3 * i], 3, &pixels.rgba[4 * i]);
    }
    const std::string segments[] = {exif_segment(facts), xmp_segment(facts)};
    return imaging::encode_jpeg(pixels, kQuality, segments);
  }

  std::string tiff(const std::string& name, std::size_t index, const Pose& X_WS, PhotoFacts facts,
                   const std::string& capture) const {
    const BandSpec& band = *bands_[index];
    const sensors::SceneLook& look = looks_[index];
    sensors::ImagerParams params = image_sensor();
    params.exposure_s =
        sensors::Imager::calc_exposure_s(params, double{1} * look.white().x(), kPanel / 65535.0);
    facts.band = PhotoBand{band.name,     static_cast<int>(index), band.wavelength_nm,
                           band.width_nm, params.exposure_s,       params.f_number,
                           capture};
    return tiff_file(facts, take(name, X_WS, look, params, 1));
  }

  const SurveyCamera& camera_;
  double joined_;  ///< columns of the camera in one of a picture, >= 1
  const WorldModel& world_;
  std::uint64_t seed_;
  LocalFrame frame_;
  Lens lens_;
  std::vector<const BandSpec*> bands_;     ///< empty: colours
  std::vector<sensors::SceneLook> looks_;  ///< of each band, or of the colours
  std::optional<physics::HeightFieldRay> terrain_;
  std::optional<physics::SurfaceRays> light_;
};

/// Least accuracy that is stated: OpenDroneMap takes 0 as unknown.
constexpr double kLeastAccuracy_m = 0.01;

/// Root of the mean squared error of the positions, horizontally and vertically.
Eigen::Vector2d calc_accuracy_m(const PictureSet& pictures,
                                const std::vector<Eigen::Vector3d>& places_W) {
  Eigen::Vector2d squares_m2 = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < places_W.size(); ++i) {
    const Eigen::Vector3d error_W = places_W[i] - pictures.X_WS[i].p;
    squares_m2 += Eigen::Vector2d(error_W.head<2>().squaredNorm(), error_W.z() * error_W.z());
  }
  return (squares_m2 / static_cast<double>(places_W.size())).cwiseSqrt().cwiseMax(kLeastAccuracy_m);
}

/// Files of one moment.
std::vector<std::string> names_of(std::size_t index, const std::vector<std::string>& bands) {
  if (bands.empty()) return {photo_name(index)};
  std::vector<std::string> names;
  for (const std::string& band : bands) names.push_back(photo_name(index, band));
  return names;
}

/// Names, positions and orientations of all photographs.
void write_lists(const PictureSet& pictures, const std::vector<Eigen::Vector3d>& places_W,
                 const LocalFrame& frame, const std::vector<std::string>& bands,
                 const std::filesystem::path& folder) {
  // OpenDroneMap, "Image geolocation files": name, x, y, z, yaw, pitch, roll, accuracies. Its
  // angles are those of photo_angles(): 0 looks down, with the upper edge to the north.
  const Eigen::Vector2d accuracy_m = calc_accuracy_m(pictures, places_W);
  std::string geo = "EPSG:4326\n";
  std::string truth =
      "photo,x_m,y_m,z_m,qw,qx,qy,qz,latitude_deg,longitude_deg,altitude_m,yaw_deg,pitch_deg,"
      "roll_deg\n";
  for (std::size_t i = 0; i < pictures.X_WS.size(); ++i) {
    const Geodetic said = frame.to_geodetic(places_W[i]);
    const Pose& X_WS = pictures.X_WS[i];
    const Geodetic place = frame.to_geodetic(X_WS.p);
    const Eigen::Vector3d angles = photo_angles(X_WS.q);
    for (const std::string& name : names_of(i, bands)) {
      geo += fmt::format("{} {:.9f} {:.9f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f}\n", name,
                         deg_from_rad(said.longitude_rad), deg_from_rad(said.latitude_rad),
                         said.altitude_m, deg_from_rad(angles.x()), deg_from_rad(angles.y()),
                         deg_from_rad(angles.z()), accuracy_m.x(), accuracy_m.y());
      truth += fmt::format(
          "{},{:.4f},{:.4f},{:.4f},{:.8f},{:.8f},{:.8f},{:.8f},{:.9f},{:.9f},{:.4f},{:.4f},{:.4f},"
          "{:.4f}\n",
          name, X_WS.p.x(), X_WS.p.y(), X_WS.p.z(), X_WS.q.w(), X_WS.q.x(), X_WS.q.y(), X_WS.q.z(),
          deg_from_rad(place.latitude_rad), deg_from_rad(place.longitude_rad), place.altitude_m,
          deg_from_rad(angles.x()), deg_from_rad(angles.y()), deg_from_rad(angles.z()));
    }
  }
  write_whole_file(folder / "geo.txt", geo);
  write_whole_file(folder / "truth.csv", truth);
}

}  // namespace

std::vector<std::string> photo_bands() {
  std::vector<std::string> names;
  for (const BandSpec& band : kBands) names.emplace_back(band.key);
  return names;
}

SurveyCamera photo_camera(const SurveyCamera& camera, const SurveyPhotoOptions& options) {
  SurveyCamera photo = camera;
  if (options.columns) {
    photo.columns = *options.columns;
    photo.rows = static_cast<int>(
        std::lround(static_cast<double>(camera.rows) * *options.columns / camera.columns));
  }
  for (std::size_t i = 0; i < options.bands.size(); ++i) {
    find_band(options.bands[i]);
    const auto first = options.bands.begin();
    if (std::count(first, first + static_cast<std::ptrdiff_t>(i), options.bands[i]) == 0) continue;
    throw ConfigError(fmt::format("survey: --bands has '{}' twice", options.bands[i]));
  }
  constexpr int kFewest = 16, kMost = 8192;
  if (photo.columns < kFewest || photo.rows < kFewest || photo.columns > kMost ||
      photo.rows > kMost) {
    throw ConfigError(
        fmt::format("survey: photographs of {} x {} pixels, must be from {} to {} each way; change "
                    "--picture-width",
                    photo.columns, photo.rows, kFewest, kMost));
  }
  return photo;
}

bool write_survey_photos(const PictureSet& pictures, const WorldModel& world,
                         const SurveyPhotoOptions& options, const std::filesystem::path& folder,
                         const std::function<bool(int done)>& drawn) {
  const SurveyCamera camera = photo_camera(pictures.camera, options);
  const std::size_t count = pictures.X_WS.size();
  if (count == 0) throw ConfigError("survey: there are no pictures");
  io::WholeFolder whole(folder);
  const Darkroom darkroom(camera, pictures.camera.columns, world, options);
  std::vector<Eigen::Vector3d> places_W = pictures.estimated_W;
  if (places_W.empty()) {
    for (const Pose& X_WS : pictures.X_WS) places_W.push_back(X_WS.p);
  }
  std::mutex one_reports;
  std::atomic<bool> goes_on = true;
  int done = 0;
  for_chunks(count, 1, [&](std::size_t i, std::size_t, std::size_t) {
    if (!goes_on) return;
    darkroom.write(i, pictures.X_WS[i], places_W[i], whole.path());
    const std::scoped_lock lock(one_reports);
    if (!drawn(++done)) goes_on = false;
  });
  if (!goes_on) return false;
  write_lists(pictures, places_W, darkroom.frame(), options.bands, whole.path());
  whole.finish();
  return true;
}

}  // namespace vinerow::tools
