#include "tools/dataset/panoptic.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "engine/api/surface.h"
#include "engine/io/files/output_folder.h"
#include "engine/sensors/camera/thing_numbers.h"
#include "tools/dataset/coco.h"

namespace vinerow::dataset {
namespace {

using Json = nlohmann::ordered_json;

bool has_name(std::span<const std::string> classes, const std::string& name) {
  return std::find(classes.begin(), classes.end(), name) != classes.end();
}

/// Categories of things have the numbers of COCO's instances; those of labels come after them.
int stuff_category(std::span<const std::string> classes, int label) {
  return static_cast<int>(classes.size()) + 1 + label;
}

/// Colours for viewers: far apart in hue, from the golden ratio.
Json colour_of(int category) {
  constexpr double kGolden = 0.61803398875;
  const double hue = category * kGolden - std::floor(category * kGolden);
  const auto channel = [&](double shift) {
    const double k = std::fmod(hue * 6.0 + shift, 6.0);
    const double share = std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
    return static_cast<int>(std::lround(255.0 * (0.9 - 0.7 * share)));
  };
  return {channel(5.0), channel(3.0), channel(1.0)};
}

/// Grows a segment by a pixel.
void extend(Segment& segment, int x, int y) {
  if (segment.area == 0) {
    segment.left = x;
    segment.top = y;
    segment.width = segment.height = 1;
  }
  const int right = std::max(segment.left + segment.width, x + 1);
  const int bottom = std::max(segment.top + segment.height, y + 1);
  segment.left = std::min(segment.left, x);
  segment.top = std::min(segment.top, y);
  segment.width = right - segment.left;
  segment.height = bottom - segment.top;
  ++segment.area;
}

}  // namespace

PanopticPicture make_panoptic(const Layers& layers, std::span<const std::uint8_t> labels,
                              const ThingShapes& shapes, std::span<const Annotation> things,
                              std::span<const std::string> classes) {
  // Segments by what they are: a label, or a thing after all labels.
  using Key = std::uint32_t;
  const auto key_of_thing = [](std::uint32_t thing) { return Key{kLabelCount} + thing; };
  std::map<Key, Segment> segments;
  for (const Annotation& thing : things) {
    Segment& segment = segments[key_of_thing(thing.thing)];
    segment.category = thing.class_index + 1;
    segment.thing = thing.thing;
  }
  std::array<bool, kLabelCount> is_stuff{};
  for (int label = 0; label < kLabelCount; ++label) {
    is_stuff[static_cast<std::size_t>(label)] =
        !has_name(classes, to_string(static_cast<Label>(label)));
  }
  std::map<std::uint32_t, bool> is_left_out;  // things of a class that are not listed
  const auto key_of = [&](std::size_t pixel) -> std::optional<Key> {
    const std::uint32_t thing = layers.thing[pixel];
    if (thing > sensors::ThingNumbers::kTerrain) {
      if (segments.contains(key_of_thing(thing))) return key_of_thing(thing);
      const auto [place, is_new] = is_left_out.try_emplace(thing);
      if (is_new) place->second = has_name(classes, shapes.class_name(thing));
      if (place->second) return std::nullopt;
    }
    if (!is_stuff[labels[pixel]]) return std::nullopt;
    return Key{labels[pixel]};
  };

  const std::size_t pixels = layers.thing.size();
  std::vector<std::optional<Key>> keys;
  keys.reserve(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    keys.push_back(key_of(i));
    if (!keys.back()) continue;
    Segment& segment = segments[*keys.back()];
    if (*keys.back() < Key{kLabelCount}) segment.category = stuff_category(classes, labels[i]);
    const auto width = static_cast<std::size_t>(layers.width);
    extend(segment, static_cast<int>(i % width), static_cast<int>(i / width));
  }
  PanopticPicture result;
  for (auto& [key, segment] : segments) {
    segment.id = static_cast<std::uint32_t>(result.segments.size()) + 1;
    result.segments.push_back(segment);
  }
  result.ids.width = static_cast<std::uint32_t>(layers.width);
  result.ids.height = static_cast<std::uint32_t>(layers.height);
  result.ids.format = Picture::Format::kRgb8;
  result.ids.data.resize(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint32_t id = keys[i] ? segments[*keys[i]].id : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      result.ids.data[3 * i + k] = static_cast<std::uint8_t>(id >> (8 * k));
    }
  }
  return result;
}

PanopticFiles::PanopticFiles(const std::vector<std::string>& classes, Json head)
    : head_(std::move(head)) {
  const auto add = [&](int id, const std::string& name, bool is_thing) {
    categories_.push_back({{"id", id},
                           {"name", name},
                           {"supercategory", "vineyard"},
                           {"isthing", is_thing ? 1 : 0},
                           {"color", colour_of(id)}});
  };
  for (std::size_t i = 0; i < classes.size(); ++i) add(static_cast<int>(i) + 1, classes[i], true);
  for (int label = 0; label < kLabelCount; ++label) {
    const std::string name = to_string(static_cast<Label>(label));
    if (!has_name(classes, name)) add(stuff_category(classes, label), name, false);
  }
}

void PanopticFiles::add(const PictureRecord& picture) {
  Part& part = parts_[static_cast<std::size_t>(picture.split)];
  part.images.push_back(coco_image(picture));
  Json infos = Json::array();
  for (const Segment& segment : picture.segments) {
    Json info = {{"id", segment.id},
                 {"category_id", segment.category},
                 {"area", segment.area},
                 {"bbox", {segment.left, segment.top, segment.width, segment.height}},
                 {"iscrowd", 0}};
    if (segment.thing != 0) info["thing"] = segment.thing;
    infos.push_back(std::move(info));
  }
  part.annotations.push_back({{"image_id", picture.index},
                              {"file_name", picture.name()},
                              {"segments_info", std::move(infos)}});
}

void PanopticFiles::write(const std::filesystem::path& folder) const {
  io::make_folder(folder);
  for (std::size_t s = 0; s < parts_.size(); ++s) {
    const Part& part = parts_[s];
    if (part.images.empty()) continue;
    Json file = head_;
    file["images"] = part.images;
    file["annotations"] = part.annotations;
    file["categories"] = categories_;
    write_coco_file(folder / (std::string("panoptic_") + kSplitNames[s] + ".json"), file);
  }
}

}  // namespace vinerow::dataset
