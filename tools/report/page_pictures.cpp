#include "tools/report/page_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/imaging/jpeg.h"
#include "engine/imaging/png.h"
#include "engine/math/polyline.h"
#include "engine/playback/frame_words.h"
#include "tools/replay/page_text.h"
#include "tools/report/html.h"
#include "tools/report/map_captions.h"
#include "tools/report/units.h"

namespace vinerow::tools::report {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFrames = 36;
/// A file of at most this size is embedded unchanged. Chosen.
constexpr std::uintmax_t kSmall_bytes = 250'000;
constexpr double kMoves_mps = 0.05;
constexpr int kPhotoQuality = 84;
/// Approximate ratio of a frame's JPEG size at that quality to its PNG size.
constexpr double kPhotoShare = 0.1;

/// Parsed frame name "<camera>_<milliseconds>", with a decimal point or without; the camera is
/// empty if the name has another form.
struct FrameName {
  std::string camera;
  double time_s = 0.0;
};

FrameName frame_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t at = stem.rfind('_');
  if (at == std::string::npos) return {};
  const std::size_t point = std::min(stem.find('.', at), stem.size());
  const auto is_number = [&](std::size_t from, std::size_t to) {
    return from < to && stem.find_first_not_of("0123456789", from) >= to;
  };
  const bool fits = point - at <= 16 && is_number(at + 1, point) &&
                    (point == stem.size() || is_number(point + 1, stem.size()));
  if (!fits) return {};
  double ms = 0.0;
  std::from_chars(&stem[at + 1], stem.data() + stem.size(), ms);
  return {stem.substr(0, at), 1e-3 * ms};
}

const scenario::CameraConfig* camera_of(const RunFolder& run, const std::string& name) {
  if (!run.scenario) return nullptr;
  for (const scenario::CameraConfig& camera : run.scenario->pictures.cameras) {
    if (camera.name == name) return &camera;
  }
  return nullptr;
}

std::string frame_caption(const RunFolder& run, const fs::path& file) {
  const FrameName name = frame_name(file);
  if (name.camera.empty()) return file.stem().string();
  const scenario::CameraConfig* camera = camera_of(run, name.camera);
  std::string what = name.camera;
  if (camera && camera->kind == scenario::CameraKind::kTop) what += ", seen from above";
  if (camera && camera->kind == scenario::CameraKind::kChase) what += ", behind " + camera->vehicle;
  if (camera && camera->kind == scenario::CameraKind::kOnBoard)
    what += ", on board " + camera->vehicle;
  if (camera && camera->kind == scenario::CameraKind::kShots) {
    what += ", picture taken by " + camera->vehicle;
  }
  return fmt::format("{}, after {}", what, duration_text(name.time_s));
}

/// Share of a frame that shows each vehicle, read from its file; empty if the file has no such
/// data.
std::map<std::string, double> seen_in(const fs::path& file) {
  const std::map<std::string, std::string> words = imaging::read_png_words(file.string());
  const auto text = words.find(playback::kSeenKey);
  return text == words.end() ? std::map<std::string, double>() : playback::parse_seen(text->second);
}

/// Whether a position is between rows or next to one, where vehicles work.
bool is_at_a_row(const RunFolder& run, const Eigen::Vector3d& p_W) {
  constexpr double kLateralOffset_m = 2.0;
  if (!run.world) return false;
  for (const PlantRow& row : run.world->rows->rows) {
    if (row.line_W.size() < 2) continue;
    const Polyline line(from_above(row.line_W));
    if (line.nearest(p_W.head<2>()).distance_m < kLateralOffset_m) return true;
  }
  return false;
}

/// Share of a picture above which a larger vehicle gains no score. Chosen.
constexpr double kFillsPicture = 0.2;

/// Score of a frame as the title picture; larger is better. Each term outweighs all later ones.
double score_of(const RunFolder& run, const fs::path& file,
                const std::vector<VehicleLog>& vehicles) {
  const FrameName name = frame_name(file);
  const scenario::CameraConfig* camera = camera_of(run, name.camera);
  if (camera == nullptr) return 0.0;
  double score = 0.0;
  const bool aslant =
      camera->kind != scenario::CameraKind::kTop && camera->kind != scenario::CameraKind::kShots;
  const bool plain = !camera->show_map && !camera->show_estimate && !camera->show_grid;
  score += aslant ? 10'000 : 0;
  score += plain ? 5'000 : 0;
  const std::map<std::string, double> seen = seen_in(file);
  double moving_share = 0.0;
  for (const VehicleLog& vehicle : vehicles) {
    if (vehicle.truth.empty()) continue;
    const Odometry truth =
        playback::odometry_at(vehicle.truth, Time{} + duration_from_s(name.time_s));
    const bool moves = truth.v_WB_B.norm() > kMoves_mps;
    const auto share = seen.find(vehicle.name);
    if (moves && share != seen.end()) moving_share += share->second;
    // Without data on the shares, count moving vehicles.
    score += moves && seen.empty() ? 1e-3 : 0.0;
    if (vehicle.name != camera->vehicle) continue;
    score += moves ? 1'000 : 0;
    score += is_at_a_row(run, truth.X_WB.p) ? 500 : 0;
  }
  // Prefer the frame that shows more of the moving vehicles.
  return score + 400.0 * std::min(1.0, moving_share / kFillsPicture);
}

}  // namespace

std::vector<Picture> frame_pictures(const RunFolder& run) {
  std::vector<Picture> pictures;
  const std::size_t count = run.frames.size(), shown = std::min(count, kMaxFrames);
  for (std::size_t i = 0; i < shown; ++i) {
    const fs::path& file = run.frames[i * count / shown];
    pictures.push_back({file, frame_caption(run, file), true});
  }
  return pictures;
}

std::vector<Picture> coverage_pictures(const RunFolder& run) {
  std::vector<Picture> pictures;
  for (const fs::path& file : files_in(run.path, ".png")) {
    if (!file.filename().string().starts_with("coverage")) continue;
    pictures.push_back({file,
                        "Number of survey pictures that see each point of the parcel, and "
                        "their forward overlap",
                        false});
  }
  return pictures;
}

std::vector<Picture> product_pictures(const RunFolder& run) {
  // Order of production: points, meshes, rows, grid.
  const auto rank = [](const fs::path& file) {
    const std::string order[] = {"classes", "mesh", "top", "grid"};
    return std::find(std::begin(order), std::end(order), file.stem().string()) - std::begin(order);
  };
  std::vector<Picture> pictures;
  for (const Json& phase : list_in(run.summary, "phases")) {
    // The folder of a phase without a product may be left from an earlier run.
    if (!phase.contains("product") || !phase["product"].contains("file")) continue;
    const std::string name = phase.at("name");
    std::vector<fs::path> files =
        files_in(run.path / phase["product"]["file"].get<std::string>(), ".png");
    std::stable_sort(files.begin(), files.end(),
                     [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    for (const fs::path& file : files) {
      std::string caption = map_picture_caption(file.stem().string());
      if (caption.ends_with('.')) caption.pop_back();
      pictures.push_back({file, fmt::format("{} ({})", caption, name), false});
    }
  }
  return pictures;
}

const Picture* hero_picture(const RunFolder& run, const std::vector<VehicleLog>& vehicles,
                            const std::vector<Picture>& frames) {
  std::vector<const Picture*> best;
  double best_score = -1.0;
  for (const Picture& picture : frames) {
    const double score = score_of(run, picture.file, vehicles);
    if (score > best_score) best.clear();
    best_score = std::max(best_score, score);
    if (score == best_score) best.push_back(&picture);
  }
  return best.empty() ? nullptr : best[(best.size() - 1) / 2];
}

int fitting_width(const std::vector<Picture>& pictures, std::size_t budget_bytes) {
  double bytes = 0.0;
  for (const Picture& picture : pictures) {
    std::error_code failed;
    const std::uintmax_t size = fs::file_size(picture.file, failed);
    if (!failed) bytes += (picture.is_photo ? kPhotoShare : 1.0) * static_cast<double>(size);
  }
  for (const int width : {1280, 1024, 800, 640}) {
    // The size of a picture is proportional to its area; the estimate is for 1280 px width.
    const double share = std::pow(width / 1280.0, 2);
    if (share * bytes <= static_cast<double>(budget_bytes)) return width;
  }
  return 480;
}

std::string embedded(const Picture& picture, int max_width) {
  auto pixels = imaging::read_png(picture.file.string());
  if (!pixels) throw ConfigError(pixels.reason());
  const bool is_wide = pixels->width > max_width;
  const imaging::Pixels shown = is_wide ? shrunk(*pixels, max_width) : std::move(*pixels);
  const bool as_it_is = !is_wide && fs::file_size(picture.file) <= kSmall_bytes;
  std::string bytes, type = "png";
  if (picture.is_photo) {
    type = "jpeg";
    bytes = imaging::encode_jpeg(shown, kPhotoQuality);
  } else {
    bytes = as_it_is ? read_bytes(picture.file).value() : imaging::encode_png(shown);
  }
  return fmt::format("<img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/{};base64,{}\"/>",
                     shown.width, shown.height, escaped(picture.caption), type, base64(bytes));
}

std::string picture_figure(const Picture& picture, int max_width) {
  return fmt::format("<figure class=\"picture\">{}<figcaption>{}</figcaption></figure>\n",
                     embedded(picture, max_width), escaped(sentence_case(picture.caption)));
}

imaging::Pixels shrunk(const imaging::Pixels& pixels, int width) {
  const double scale = static_cast<double>(pixels.width) / width;
  const int height = std::max(1, static_cast<int>(std::lround(pixels.height / scale)));
  const double scale_y = static_cast<double>(pixels.height) / height;
  imaging::Pixels out(width, height);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      double sum[4] = {0, 0, 0, 0}, area = 0.0;
      const double left = i * scale, right = (i + 1) * scale;
      const double top = j * scale_y, bottom = (j + 1) * scale_y;
      for (int y = static_cast<int>(top); y < std::min<double>(bottom, pixels.height); ++y) {
        const double tall = std::min<double>(bottom, y + 1) - std::max<double>(top, y);
        for (int x = static_cast<int>(left); x < std::min<double>(right, pixels.width); ++x) {
          const double share = tall * (std::min<double>(right, x + 1) - std::max<double>(left, x));
          for (int c = 0; c < 4; ++c) sum[c] += share * pixels.at(x, y)[c];
          area += share;
        }
      }
      for (int c = 0; c < 4; ++c) {
        out.at(i, j)[c] = static_cast<std::uint8_t>(std::lround(sum[c] / area));
      }
    }
  }
  return out;
}

}  // namespace vinerow::tools::report
