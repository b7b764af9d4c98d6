#include "worlds/mapping/reading/read_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/core/error.h"
#include "engine/io/clouds/parcel_frame.h"
#include "engine/io/clouds/point_cloud.h"
#include "engine/io/clouds/point_cloud_crs.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "worlds/mapping/reading/cloud_outline.h"
#include "worlds/mapping/reading/cloud_sample.h"
#include "worlds/mapping/reading/repeated_places.h"

namespace vinerow::mapping {
namespace {

using Path = std::filesystem::path;

/// Frame of a CRS; errors name the file.
template <class F>
auto named(const Path& file, F&& f) {
  try {
    return f();
  } catch (const ConfigError& error) {
    refuse_cloud(
        file,
        fmt::format("cannot be brought to the local frame: {}; give the system of its coordinates "
                    "by --crs EPSG:<code>, or --crs none if they are metres of a local frame",
                    error.what()));
  }
}

/// Metres of one unit along each axis, by a small step from a point.
Eigen::Vector3d unit_at(const io::CloudFrame& frame, const Eigen::Vector3d& place) {
  constexpr double kStep = 1e-4;  // 11 m of degrees; of metres still 1e-5 of it is exact
  Eigen::Vector3d unit_m;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
    unit_m[k] = (frame.to_local(place + step) - frame.to_local(place - step)).norm() / (2 * kStep);
  }
  return unit_m;
}

/// @param anywhere  a frame at any origin
GeoOrigin origin_at(const io::CloudFrame& anywhere, const GeoOrigin& origin_of_it,
                    const Eigen::Vector3d& middle) {
  const Geodetic place = LocalFrame(origin_of_it).to_geodetic(anywhere.to_local(middle));
  const auto rounded = [](double angle_rad) {
    return rad_from_deg(std::round(deg_from_rad(angle_rad) * 1e5) / 1e5);
  };
  return {rounded(place.latitude_rad), rounded(place.longitude_rad), std::round(place.altitude_m)};
}

std::string megabytes(std::uint64_t bytes) {
  return bytes < 10'000'000 ? fmt::format("{} bytes", bytes)
                            : fmt::format("{} MB", bytes / 1'000'000);
}

void check_memory(const Path& file, const CloudReadOptions& options, const CloudOutline& outline,
                  bool with_colours) {
  const std::uint64_t bytes = with_colours ? 15 : 12;
  const std::uint64_t max_points = options.memory_limit / bytes;
  const std::uint64_t kept = outline.tally.given / options.thin;
  if (kept <= max_points) return;
  const std::uint64_t thin = outline.tally.given / std::max<std::uint64_t>(max_points, 1) + 1;
  refuse_cloud(
      file,
      fmt::format("has {} points, which take {}, more than the limit of {}; keep one of {} "
                  "by --thin {}",
                  kept, megabytes(kept * bytes), megabytes(options.memory_limit), thin, thin));
}

/// Processing of each block in the second reading.
class Collector {
 public:
  Collector(const CloudReadOptions& options, const CloudOutline& outline,
            const io::ParcelFrame* frame, bool with_colours, ParcelCloud& cloud)
      : options_(options), kept_(outline.kept), frame_(frame), cloud_(cloud) {
    const std::uint64_t max_points = outline.tally.given / options.thin + 1;
    cloud_.points.reserve(max_points);
    if (with_colours) cloud_.colours.reserve(max_points);
    with_colours_ = with_colours;
  }

  /// @param block  changed
  void add(std::span<io::CloudPoint> block) {
    std::size_t kept = 0;
    for (const io::CloudPoint& point : block) {
      if (!kept_.contains(point.position)) {
        ++far_away_;
        continue;
      }
      places_.add(point.position);
      if (until_next_-- > 0) continue;
      until_next_ = options_.thin - 1;
      block[kept++] = point;
    }
    block = block.first(kept);
    if (frame_ != nullptr) frame_->to_local(block);
    for (const io::CloudPoint& point : block) {
      const Eigen::Vector3f p = (point.position - cloud_.origin_W).cast<float>();
      bounds_.extend(p);
      cloud_.points.push_back(p);
    }
    if (!with_colours_) return;
    for (const io::CloudPoint& point : block) {
      cloud_.colours.push_back(point.rgb.value_or(std::array<std::uint8_t, 3>{}));
    }
  }

  std::uint64_t far_away() const { return far_away_; }
  const RepeatedPlaces& places() const { return places_; }
  Eigen::AlignedBox3d bounds_W() const {
    return {bounds_.min().cast<double>() + cloud_.origin_W,
            bounds_.max().cast<double>() + cloud_.origin_W};
  }

 private:
  const CloudReadOptions& options_;
  const Eigen::AlignedBox3d kept_;
  const io::ParcelFrame* frame_;
  ParcelCloud& cloud_;
  bool with_colours_ = false;
  RepeatedPlaces places_;
  Eigen::AlignedBox3f bounds_;
  std::uint64_t far_away_ = 0, until_next_ = 0;
};

/// Distance, in words, between the cloud's positions by the file's own CRS and by the given one; ""
/// if they agree. @param used  frame of the given CRS, about `origin`
std::string conflict_of_crs(const std::string& requested, const CloudOutline& outline,
                            const io::CloudFrame& used, const GeoOrigin& origin) {
  const std::string& own = outline.info.crs;
  if (requested.empty() || requested == "none" || own.empty() || requested == own) return "";
  constexpr double kSamePlace_m = 1.0;  // of two realisations of one system
  std::string elsewhere = "somewhere else";
  try {
    const double apart_m =
        (io::CloudFrame(own, origin).to_local(outline.middle) - used.to_local(outline.middle))
            .head<2>()
            .norm();
    if (apart_m < kSamePlace_m) return "";
    elsewhere = apart_m < 10e3 ? fmt::format("{:.0f} m away", apart_m)
                               : fmt::format("{:.0f} km away", 1e-3 * apart_m);
  } catch (const ConfigError&) {
    // The file's own system does not cover this place, or cannot be read.
  }
  return fmt::format(
      "The coordinates were taken as {}, as requested; the file names {}, which puts them {}.",
      requested, own.substr(0, 60), elsewhere);
}

void add_sentences(const CloudOutline& outline, const CloudReadOptions& options,
                   CloudReadReport& report) {
  const auto say = [&](std::string sentence) { report.sentences.push_back(std::move(sentence)); };
  if (report.not_finite > 0) {
    say(fmt::format("{} points were left out: their coordinates are not finite.",
                    report.not_finite));
  }
  if (report.withheld > 0) {
    say(fmt::format("{} points were left out: they are marked as withheld.", report.withheld));
  }
  if (report.far_away > 0) {
    say(fmt::format("{} points were left out: they are far from the other {}.", report.far_away,
                    report.given - report.far_away));
  }
  if (options.thin > 1) say(fmt::format("One of {} points was kept.", options.thin));
  if (report.repeated > report.given / 100) {
    say(fmt::format("{}{} of {} points coincide exactly with another one.",
                    report.repeated_is_exact ? "" : "About ", report.repeated, report.given));
  }
  if (!report.crs_warning.empty()) say(report.crs_warning);
  constexpr double kNational_m = 50'000.0;
  if (report.crs.empty() && outline.middle.head<2>().norm() > kNational_m) {
    say(
        fmt::format("The cloud names no coordinate reference system and lies at x = {:.0f} m, "
                    "y = {:.0f} m of its frame; give the system by --crs EPSG:<code> to have a "
                    "map near its origin and on Earth.",
                    outline.middle.x(), outline.middle.y()));
  }
}

}  // namespace

ParcelCloud read_parcel_cloud(const std::filesystem::path& file, const CloudReadOptions& options,
                              CloudReadReport& report) {
  if (options.thin == 0) refuse_cloud(file, "cannot be read with thin = 0, must be 1 or more");
  report = {};
  report.file = file.string();
  CloudOutline outline = outline_cloud(file);
  report.format = outline.info.format;
  std::error_code error;
  report.file_bytes = std::filesystem::file_size(file, error);
  report.crs = options.crs == "none" ? "" : options.crs.empty() ? outline.info.crs : options.crs;

  constexpr double kTrim = 0.005;
  const Eigen::AlignedBox3d bulk = bulk_of(outline.sample, kTrim);
  const GeoOrigin anywhere = options.origin.value_or(GeoOrigin{});
  std::unique_ptr<io::CloudFrame> exact;
  if (!report.crs.empty()) {
    named(file, [&] { exact = std::make_unique<io::CloudFrame>(report.crs, anywhere); });
  }
  io::check_cloud_unit(file, report.crs, bulk);
  if (exact) named(file, [&] { outline.unit_m = unit_at(*exact, bulk.center()); });
  find_parcel(file, options.largest_extent_m, outline);
  const bool with_colours = options.with_colours && outline.info.has_colour;
  check_memory(file, options, outline, with_colours);

  std::optional<io::ParcelFrame> frame;
  Eigen::Vector3d middle_W = outline.middle;
  report.has_origin = options.origin.has_value() || exact != nullptr;
  report.origin = anywhere;
  if (exact) {
    named(file, [&] {
      if (!options.origin) {
        report.origin = origin_at(*exact, anywhere, outline.middle);
        exact = std::make_unique<io::CloudFrame>(report.crs, report.origin);
      }
      report.crs_warning = conflict_of_crs(options.crs, outline, *exact, report.origin);
      middle_W = exact->to_local(outline.middle);
      frame.emplace(*exact, outline.kept);
    });
  }
  constexpr double kFarthest_m = 20'000.0;  // the vertical is 0.2 degrees off there
  if (exact && middle_W.head<2>().norm() > kFarthest_m) {
    refuse_cloud(
        file,
        fmt::format("is {:.0f} km from the given origin (latitude {:.5f} deg, longitude {:.5f} "
                    "deg), must be within {:.0f} km; give an origin near the cloud, or none",
                    middle_W.head<2>().norm() * 1e-3, deg_from_rad(anywhere.latitude_rad),
                    deg_from_rad(anywhere.longitude_rad), kFarthest_m * 1e-3));
  }

  ParcelCloud cloud;
  cloud.origin_W = middle_W.array().round();
  Collector collector(options, outline, frame ? &*frame : nullptr, with_colours, cloud);
  const std::unique_ptr<io::PointCloudReader> reader = io::open_point_cloud(file);
  std::vector<io::CloudPoint> block(1024);
  std::size_t count = 0;
  do {
    count = reader->read(block);
    named(file, [&] { collector.add(std::span(block).first(count)); });
  } while (count == block.size());

  report.points = cloud.points.size();
  report.given = reader->tally().given;
  report.not_finite = reader->tally().not_finite;
  report.withheld = reader->tally().withheld;
  report.far_away = collector.far_away();
  report.repeated = collector.places().count();
  report.repeated_is_exact = collector.places().is_exact();
  report.bounds_W = collector.bounds_W();
  add_sentences(outline, options, report);
  return cloud;
}

}  // namespace vinerow::mapping
