#include "engine/playback/canopy_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace vinerow::playback {

std::string canopy_json(const std::string& vehicle, const std::string& payload,
                        const CanopyCoverage& coverage) {
  nlohmann::ordered_json head = {
      {"vehicle", vehicle},       {"payload", payload},        {"quantity", coverage.quantity},
      {"unit", coverage.unit},    {"wanted", coverage.wanted}, {"step_m", coverage.step_m},
      {"band_m", coverage.band_m}};
  std::string text = head.dump();
  text.back() = ',';
  text += "\"patches\":[";
  // Millimetres, square centimetres and six digits: enough for plots, and a third of the size.
  bool first = true;
  for (const CanopyPatch& p : coverage.patches) {
    text +=
        fmt::format("{}\n[{},{},{},{},{:.3f},{:.3f},{:.3f},{:.4f},{:.6g}]", first ? "" : ",", p.row,
                    p.side, p.along, p.band, p.p_W.x(), p.p_W.y(), p.p_W.z(), p.area_m2, p.amount);
    first = false;
  }
  return text + "]}\n";
}

}  // namespace vinerow::playback
