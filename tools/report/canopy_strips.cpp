#include "tools/report/canopy_strips.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <utility>

#include "engine/core/error.h"
#include "engine/imaging/png.h"
#include "tools/pictures/colour_scale.h"
#include "tools/report/axis.h"
#include "tools/report/html.h"
#include "tools/report/row_faces.h"
#include "tools/report/svg.h"
#include "tools/report/units.h"

namespace vinerow::tools::report {
namespace {

namespace fs = std::filesystem;

constexpr double kStripLeft = 120, kStripRight = 10, kStrip = 26, kStripGap = 4, kStripBottom = 44;
/// Limit on the number of strips; strips that nothing reached are left out first. Chosen: more
/// would fill a page.
constexpr std::size_t kMaxStrips = 80;

using StripKey = std::pair<int, int>;  ///< row, and 0 for its left side, 1 for its right
using Strips = std::map<StripKey, std::vector<const CanopyPatchAmount*>>;

/// Printed form of a unit: "ml/m²" for "ml/m2".
std::string spelled(std::string unit) {
  const std::size_t at = unit.rfind("m2");
  return at == std::string::npos ? unit : unit.replace(at, 2, "m²");
}

Strips strips_of(const CanopyFile& canopy) {
  Strips strips;
  for (const CanopyPatchAmount& patch : canopy.patches) {
    strips[{patch.row, patch.side > 0 ? 0 : 1}].push_back(&patch);
  }
  if (strips.size() <= kMaxStrips) return strips;
  std::erase_if(strips, [](const auto& strip) {
    return std::none_of(strip.second.begin(), strip.second.end(),
                        [](const CanopyPatchAmount* patch) { return patch->amount > 0.0; });
  });
  while (strips.size() > kMaxStrips) strips.erase(std::prev(strips.end()));
  return strips;
}

/// Opaque colour of a share of the scale.
void paint(double share, std::uint8_t* rgba) {
  const Rgb colour = viridis(share);
  std::copy(colour.begin(), colour.end(), rgba);
  rgba[3] = 255;
}

/// One pixel per patch, transparent where the row has no canopy.
imaging::Pixels strip_pixels(const std::vector<const CanopyPatchAmount*>& patches, int columns,
                             int bands, double full) {
  imaging::Pixels pixels(columns, bands);
  for (const CanopyPatchAmount* patch : patches) {
    const double share = full > 0.0 ? patch->amount / full : 0.0;
    paint(share, pixels.at(patch->along, bands - 1 - patch->band));
  }
  return pixels;
}

/// "3 ml/m²", "1 picture".
std::string amount_text(double amount, std::string unit) {
  if (amount == 1.0 && unit.ends_with("pictures")) unit.pop_back();
  return number_text(amount) + " " + unit;
}

std::string strips_svg(const CanopyFile& canopy, double full) {
  const Strips strips = strips_of(canopy);
  int columns = 1, bands = 1;
  for (const CanopyPatchAmount& patch : canopy.patches) {
    columns = std::max(columns, patch.along + 1);
    bands = std::max(bands, patch.band + 1);
  }
  const double bottom = static_cast<double>(strips.size()) * (kStrip + kStripGap);
  const Axis x({0.0, columns * canopy.step_m}, kStripLeft, kWideChart - kStripRight, 10);
  Svg svg(kWideChart, bottom + kStripBottom, "canopy",
          fmt::format("{} of {} on both sides of every row", canopy.quantity, canopy.payload));
  for (const double tick : x.ticks()) {
    svg.line(x.px(tick), 0, x.px(tick), bottom + 4, "grid");
    svg.text(x.px(tick), bottom + 19, x.text(tick), "tick mid");
  }
  svg.text(0.5 * (x.from_px() + x.to_px()), bottom + 38, "distance along the row, m", "label mid");
  double y = 0.0;
  for (const auto& [key, patches] : strips) {
    svg.text(kStripLeft - 8, y + 17,
             fmt::format("row {}, {}", key.first, key.second == 0 ? "left" : "right"), "tick end");
    svg.image(x.from_px(), y, x.to_px() - x.from_px(), kStrip,
              imaging::encode_png(strip_pixels(patches, columns, bands, full)));
    y += kStrip + kStripGap;
  }
  return svg.finish();
}

std::string colour_legend(const CanopyFile& canopy, double full) {
  imaging::Pixels bar(64, 1);
  for (int i = 0; i < 64; ++i) paint(i / 63.0, bar.at(i, 0));
  Svg svg(kWideChart, 34, "canopy", "colour scale");
  svg.text(kStripLeft, 22, "0", "tick end");
  svg.image(kStripLeft + 8, 8, 260, 18, imaging::encode_png(bar));
  const bool is_wanted = canopy.wanted > 0.0;
  svg.text(kStripLeft + 276, 22,
           fmt::format("{} {}", amount_text(full, canopy.unit),
                       is_wanted ? "or more: target reached" : "(maximum)"),
           "tick");
  return svg.finish();
}

/// Texts for the effect of a payload on the canopy.
struct CanopyWords {
  const char* reached;  ///< "of the canopy surface received the target dose"
  const char* target;
};

CanopyWords words_for(const CanopyFile& canopy) {
  if (canopy.quantity == "deposit") {
    return {"of the canopy surface received the target dose", "target dose"};
  }
  if (canopy.quantity == "seen") return {"of the canopy surface was seen", "target"};
  return {"of the canopy surface reached the target", "target"};
}

std::vector<RowFace> faces_of(const CanopyFile& canopy, const RunFolder& run,
                              const std::vector<VehicleLog>& vehicles) {
  for (const VehicleLog& vehicle : vehicles) {
    if (vehicle.name == canopy.vehicle) return row_faces(run, vehicle);
  }
  return {};
}

double passed_share(const CanopyFile& canopy, const std::vector<RowFace>& faces) {
  return canopy.covered_share([&](int row, int side) {
    return std::any_of(faces.begin(), faces.end(), [&](const RowFace& face) {
      return face.passed && face.row == row && face.side == side;
    });
  });
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

std::string payload_section(const CanopyFile& canopy, const std::vector<RowFace>& faces) {
  double full = canopy.wanted;
  for (const CanopyPatchAmount& patch : canopy.patches) {
    if (canopy.wanted <= 0.0) full = std::max(full, patch.amount);
  }
  const CanopyWords words = words_for(canopy);
  const std::string left_out = face_sentence(faces);
  std::string out = fmt::format("<h3>{} of {}: {}</h3>\n<div class=\"cards\">\n",
                                escaped(sentence_case(canopy.payload)), escaped(canopy.vehicle),
                                escaped(canopy.quantity));
  out += card(percent(canopy.covered_share()), words.reached);
  if (!left_out.empty()) {
    out += card(percent(passed_share(canopy, faces)), "on the row sides that the vehicle passed");
  }
  out += card(escaped(amount_text(canopy.mean_amount(), canopy.unit)), "mean over the canopy");
  if (canopy.wanted > 0.0) {
    out += card(escaped(amount_text(canopy.wanted, canopy.unit)), words.target);
  }
  out += card(fmt::format("{} m²", number_text(canopy.area_m2())), "total canopy surface");
  out += "</div>\n";
  if (!left_out.empty()) out += fmt::format("<p>{}.</p>\n", escaped(left_out));
  return out +
         figure("plot wide-chart", "Both sides of every row, unrolled",
                colour_legend(canopy, full) + strips_svg(canopy, full),
                "Each strip is one side of a row as seen from its alley, with the bottom of the "
                "canopy below. Left and right are as seen looking along the row from its first "
                "point. Rows have the numbers of the world; a map made from a point cloud may "
                "number them differently. Heights are stretched. Blank: no canopy.");
}

}  // namespace

double CanopyFile::area_m2() const {
  double sum_m2 = 0.0;
  for (const CanopyPatchAmount& patch : patches) sum_m2 += patch.area_m2;
  return sum_m2;
}

double CanopyFile::covered_share(const std::function<bool(int row, int side)>& counts) const {
  double covered_m2 = 0.0, all_m2 = 0.0;
  for (const CanopyPatchAmount& patch : patches) {
    if (counts && !counts(patch.row, patch.side)) continue;
    all_m2 += patch.area_m2;
    if (patch.amount >= wanted && patch.amount > 0.0) covered_m2 += patch.area_m2;
  }
  return all_m2 > 0.0 ? covered_m2 / all_m2 : std::numeric_limits<double>::quiet_NaN();
}

double CanopyFile::mean_amount() const {
  double sum = 0.0;
  for (const CanopyPatchAmount& patch : patches) sum += patch.amount * patch.area_m2;
  return patches.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / area_m2();
}

CanopyFile read_canopy(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  CanopyFile canopy;
  try {
    const Json json = Json::parse(in);
    canopy.vehicle = json.at("vehicle");
    canopy.payload = json.at("payload");
    canopy.quantity = json.at("quantity");
    canopy.unit = spelled(json.at("unit"));
    canopy.wanted = json.at("wanted");
    canopy.step_m = json.at("step_m");
    canopy.band_m = json.at("band_m");
    for (const Json& p : json.at("patches")) {
      canopy.patches.push_back({p.at(0), p.at(1), p.at(2), p.at(3), p.at(7), p.at(8)});
      if (canopy.patches.back().along < 0 || canopy.patches.back().band < 0) {
        throw ConfigError(
            fmt::format("{}: is not a canopy coverage file: patch {} is before its row's "
                        "first point or below the ground",
                        file.string(), canopy.patches.size() - 1));
      }
    }
  } catch (const Json::exception& error) {
    throw ConfigError(
        fmt::format("{}: is not a canopy coverage file: {}", file.string(), error.what()));
  }
  return canopy;
}

std::vector<CanopyFile> read_canopies(const RunFolder& run) {
  std::vector<CanopyFile> canopies;
  for (const fs::path& file : files_in(run.path / "canopy", ".json")) {
    canopies.push_back(read_canopy(file));
  }
  return canopies;
}

std::string canopy_section(const RunFolder& run, const std::vector<CanopyFile>& canopies,
                           const std::vector<VehicleLog>& vehicles) {
  std::string out;
  for (const CanopyFile& canopy : canopies) {
    out += payload_section(canopy, faces_of(canopy, run, vehicles));
  }
  return out;
}

std::string canopy_remark(const RunFolder& run, const std::vector<CanopyFile>& canopies,
                          const std::vector<VehicleLog>& vehicles) {
  std::string out, previous;
  for (const CanopyFile& canopy : canopies) {
    const std::vector<RowFace> faces = faces_of(canopy, run, vehicles);
    const std::string why = face_sentence(faces);
    if (why.empty()) continue;
    if (why != previous) out += (out.empty() ? "" : " ") + why + ".";
    previous = why;
    out += fmt::format(" {}: {} {}, {} on the sides passed.", sentence_case(canopy.payload),
                       percent(canopy.covered_share()), words_for(canopy).reached,
                       percent(passed_share(canopy, faces)));
  }
  return out;
}

}  // namespace vinerow::tools::report
