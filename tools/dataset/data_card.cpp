#include "tools/dataset/data_card.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vinerow/version.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "engine/api/surface.h"
#include "engine/io/files/yaml.h"
#include "tools/dataset/splits.h"
#include "tools/export/markdown.h"

namespace vinerow::dataset {
namespace {

using tools::markdown_code;
using tools::markdown_text;

constexpr Split kParts[] = {Split::kTrain, Split::kValidation, Split::kTest};

/// The head in YAML. All texts of the study's are quoted.
std::string head(const scenario::Study& study, int pictures) {
  std::string name = study.name;  // a name has no quotes
  const char* const size = pictures < 1000      ? "n<1K"
                           : pictures < 10'000  ? "1K<n<10K"
                           : pictures < 100'000 ? "10K<n<100K"
                                                : "100K<n<1M";
  return fmt::format(
      "---\npretty_name: \"{}\"\nlicense: other\ntask_categories:\n- object-detection\n"
      "- image-segmentation\n- keypoint-detection\n- depth-estimation\ntags:\n- synthetic\n"
      "- agriculture\n- robotics\nsize_categories:\n- {}\n---\n\n",
      name, size);
}

std::string row(const std::string& name, const std::function<int(Split)>& count) {
  std::string text = "| " + name + " |";
  for (const Split part : kParts) text += fmt::format(" {} |", count(part));
  return text + "\n";
}

std::string counts(const scenario::DatasetConfig& config, const DatasetReport& report) {
  std::string text = "| | train | val | test |\n|---|---|---|---|\n";
  text += row("pictures", [&](Split part) { return report.pictures(part); });
  for (const std::string& name : config.classes) {
    text += row(markdown_code(name), [&](Split part) {
      const auto& of_part = report.things[static_cast<std::size_t>(part)];
      const auto found = of_part.find(name);
      return found == of_part.end() ? 0 : found->second;
    });
  }
  text += row("rows with an end in view",
              [&](Split part) { return report.rows[static_cast<std::size_t>(part)]; });
  return text + "\n";
}

std::string files(const scenario::DatasetConfig& config) {
  std::string text =
      "| file | contents |\n|---|---|\n"
      "| `images/<part>/` | pictures, PNG |\n"
      "| `semantic/<part>/` | label of each pixel: ";
  for (int i = 0; i < kLabelCount; ++i) {
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", i, to_string(static_cast<Label>(i)));
  }
  text +=
      " |\n"
      "| `instances/<part>/` | number of each pixel's thing: red + 256 green + 65536 blue; 0 sky "
      "and land beyond the world, 1 ground; the same in all pictures of a run |\n"
      "| `depth/<part>/` | depth along the optical axis in mm, 16 bits; 0: nothing up to 65 m |\n"
      "| `pictures.csv` | pose of the optical frame (x right, y down, z forward) in east, north, "
      "up; latitude and longitude; lens (names and order of ROS CameraInfo); factors |\n";
  for (const std::string& format : config.formats) {
    if (format == "coco") {
      text +=
          "| `annotations/` | COCO: `instances_<part>.json` with masks and boxes, "
          "`keypoints_<part>.json` with foot and head of trunks and posts, ends of rows |\n";
    }
    if (format == "coco_panoptic") {
      text +=
          "| `annotations/panoptic_<part>.json`, `annotations/panoptic_<part>/` | COCO panoptic: a "
          "segment of each pixel, 0: of a thing too small to be listed |\n";
    }
    if (format == "yolo") text += "| `data.yaml`, `labels/` | boxes for Ultralytics YOLO |\n";
    if (format == "yolo_segment") {
      text += "| `yolo_segment/` | the pictures with polygons for Ultralytics YOLO |\n";
    }
    if (format == "yolo_pose") {
      text +=
          "| `yolo_pose/` | the pictures with foot and head of trunks and posts, ends of rows, for "
          "Ultralytics YOLO |\n";
    }
    if (format == "kitti") {
      text +=
          "| `kitti/` | KITTI: pictures, labels with 3D boxes, calibration, depth, poses of each "
          "run |\n";
    }
  }
  return text + fmt::format("\nThings of which fewer than {} pixels are seen are not listed.\n\n",
                            config.min_pixels);
}

/// "320 x 240, 160 x 240"
std::string sizes(const DatasetReport& report) {
  std::string text;
  for (const auto& [width, height] : report.sizes) {
    text += fmt::format("{}{} x {}", text.empty() ? "" : ", ", width, height);
  }
  return text;
}

template <class Numbers>
std::string listed(const Numbers& numbers) {
  return fmt::format("{}", fmt::join(numbers, ", "));
}

/// The plants of the runs that gave pictures, by part; nullopt: of a world without plant_seed.
using PlantSeeds = std::set<std::optional<std::uint64_t>>;
std::array<PlantSeeds, 3> plants_of_parts(const DatasetReport& report) {
  std::array<PlantSeeds, 3> plants;
  for (const CellReport& cell : report.cells) {
    if (cell.pictures == 0) continue;
    plants[static_cast<std::size_t>(cell.split)].insert(cell.plant_seed);
  }
  return plants;
}

/// What the parts have in common.
std::string shared(const DatasetReport& report) {
  const std::array<PlantSeeds, 3> plants = plants_of_parts(report);
  std::string text;
  int parts = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    parts += plants[a].empty() ? 0 : 1;
    for (std::size_t b = a + 1; b < 3; ++b) {
      PlantSeeds both;
      std::set_intersection(plants[a].begin(), plants[a].end(), plants[b].begin(), plants[b].end(),
                            std::inserter(both, both.end()));
      if (both.empty()) continue;
      const bool has_seed = both.begin()->has_value();
      std::vector<std::uint64_t> seeds;
      for (const auto& seed : both) {
        if (seed) seeds.push_back(*seed);
      }
      text += fmt::format(" {} and {} show the same {}: scores of {} say nothing about others.",
                          kSplitNames[a], kSplitNames[b],
                          has_seed ? fmt::format("plants (`world.plant_seed` {})", listed(seeds))
                                   : std::string("world"),
                          kSplitNames[b]);
    }
  }
  return text.empty() && parts > 1 ? " No two parts show the same plants." : text;
}

/// A value as the study has it, in one line.
void to_flow(io::YamlNode& node) {
  node.flow = true;
  for (io::YamlNode& item : node.items) to_flow(item);
  for (io::YamlEntry& entry : node.entries) to_flow(entry.value);
}

std::string set_by(const scenario::FactorLevel& level) {
  if (level.values.empty()) return "nothing";
  io::YamlNode all = io::yaml_mapping();
  for (const scenario::OverrideValue& value : level.values) all.put(value.path, value.value);
  to_flow(all);
  std::string text = io::to_yaml(all);
  while (text.ends_with('\n')) text.pop_back();
  return markdown_code(text);
}

/// The key of a factor that sets one to plain values; "" for alternatives.
std::string only_key(const scenario::Factor& factor) {
  std::string key;
  for (const scenario::FactorLevel& level : factor.levels) {
    if (level.values.size() != 1 || level.values[0].value.text != level.texts[0]) return "";
    if (!key.empty() && key != level.values[0].path) return "";
    key = level.values[0].path;
  }
  return key;
}

/// Rows of a factor: one for each of its keys, or for each alternative.
std::string factor_rows(const scenario::Factor& factor) {
  constexpr std::size_t kShown = 12;
  const std::size_t shown = std::min(factor.levels.size(), kShown);
  const std::string more =
      shown < factor.levels.size() ? fmt::format("... ({} levels)", factor.levels.size()) : "";
  const std::string name = markdown_text(factor.name);
  std::string text;
  std::vector<std::string> keys = factor.columns;
  if (keys == std::vector<std::string>{factor.name}) {
    keys = {only_key(factor)};
    if (keys[0].empty()) {
      for (std::size_t k = 0; k < shown; ++k) {
        text += fmt::format("| {} | {} | {} |\n", name, markdown_text(factor.levels[k].texts[0]),
                            set_by(factor.levels[k]));
      }
      return more.empty() ? text : text + fmt::format("| {} | {} | |\n", name, more);
    }
  }
  for (std::size_t column = 0; column < keys.size(); ++column) {
    std::string levels;
    for (std::size_t k = 0; k < shown; ++k) {
      levels += (k == 0 ? "" : ", ") + factor.levels[k].texts[column];
    }
    if (!more.empty()) levels += ", " + more;
    text +=
        fmt::format("| {} | {} | {} |\n", name, markdown_code(keys[column]), markdown_text(levels));
  }
  return text;
}

std::string origin(const study::OpenStudy& open, const DatasetReport& report) {
  const scenario::Study& study = open.study;
  std::string text = fmt::format(
      "Drawn by Vinerow {} from the scenario {}, camera {}, {} pixels, in {} runs: {} "
      "settings x {} seeds. The same study, scenario and program give the same bytes.\n\n",
      VINEROW_VERSION_STRING, markdown_code(study.scenario.filename().string()),
      markdown_code(study.dataset->camera), sizes(report), report.cells.size(),
      open.design.settings(), open.design.seeds());
  text += fmt::format(
      "- command: {}\n- digest of the scenario with its files: `{}`\n- digest of the program: "
      "`{}`\n"
      "- seeds: ",
      markdown_code("vinerow dataset " + study.file.filename().string()), open.identity.scenario(),
      open.identity.program());
  text += listed(study.seeds) + "\n";
  std::set<std::uint64_t> plants;
  for (const CellReport& cell : report.cells) {
    if (cell.plant_seed) plants.insert(*cell.plant_seed);
  }
  if (!plants.empty()) text += fmt::format("- seeds of the plants: {}\n", listed(plants));
  text += "\n";
  if (!study.factors.empty()) {
    text += "| factor | key, or alternative | values |\n|---|---|---|\n";
    for (const scenario::Factor& factor : study.factors) text += factor_rows(factor);
    text += "\n";
  }
  std::string failures;
  for (const CellReport& cell : report.cells) {
    if (cell.failure.empty()) continue;
    failures += fmt::format("- run {}: {} pictures, then: {}\n", cell.cell, cell.pictures,
                            markdown_text(cell.failure));
  }
  if (!failures.empty()) text += "Runs that broke off:\n\n" + failures + "\n";
  return text;
}

}  // namespace

std::string data_card(const study::OpenStudy& open, const DatasetReport& report) {
  const scenario::Study& study = open.study;
  const scenario::DatasetConfig& config = *study.dataset;
  int pictures = 0;
  for (const Split part : kParts) pictures += report.pictures(part);
  std::string text = head(study, pictures);
  text += fmt::format("# {}\n\n", markdown_text(study.name));
  if (!study.description.empty()) text += markdown_text(study.description) + "\n\n";
  text += "## Contents\n\n" + counts(config, report) + files(config);
  text += "## Origin\n\n" + origin(open, report);
  text += fmt::format("Pictures of one {} are all in the same part.{}\n\n",
                      group_name(config.split_by), shared(report));
  for (const std::string& note : report.notes) text += markdown_text(note) + ".\n\n";
  text += "## Licence\n\n";
  text += config.licence.empty() ? std::string("Not stated by the study.")
                                 : markdown_text(config.licence);
  text +=
      "\n\nNo photograph is part of it. Meshes that the scenario loads from files keep their own "
      "licences.\n\n"
      "## Limits\n\n"
      "The pictures are drawn, not taken. Light that goes from leaf to leaf is not followed, and "
      "clouds have no shapes. Labels are exact, which those of people are not: test on real "
      "pictures.\n";
  return text;
}

}  // namespace vinerow::dataset
