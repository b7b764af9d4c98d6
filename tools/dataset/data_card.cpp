#include "tools/dataset/data_card.h"

#include <fmt/format.h>
#include <vinerow/version.h>

#include "engine/api/surface.h"
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
      "| `instances/<part>/` | number of each pixel's thing: red + 256 green + 65536 blue; 0 sky, "
      "1 "
      "ground; the same in all pictures of a run |\n"
      "| `depth/<part>/` | depth along the optical axis in mm, 16 bits; 0: nothing up to 65 m |\n"
      "| `pictures.csv` | pose of the optical frame (x right, y down, z forward) in east, north, "
      "up; latitude and longitude; lens (names and order of ROS CameraInfo); factors |\n";
  for (const std::string& format : config.formats) {
    if (format == "coco") {
      text +=
          "| `annotations/` | COCO: `instances_<part>.json` with masks and boxes, "
          "`keypoints_<part>.json` with foot and head of trunks and posts, ends of rows |\n";
    }
    if (format == "yolo") text += "| `data.yaml`, `labels/` | boxes for Ultralytics YOLO |\n";
    if (format == "kitti") {
      text +=
          "| `kitti/` | KITTI: pictures, labels with 3D boxes, calibration, depth, poses of each "
          "run |\n";
    }
  }
  return text + fmt::format("\nThings of which fewer than {} pixels are seen are not listed.\n\n",
                            config.min_pixels);
}

std::string origin(const study::OpenStudy& open, const DatasetReport& report) {
  const scenario::Study& study = open.study;
  std::string text = fmt::format(
      "Drawn by Vinerow {} from the scenario {}, camera {}, {} x {} pixels, in {} runs: {} "
      "settings "
      "x {} seeds. The same study, scenario and program give the same bytes.\n\n",
      VINEROW_VERSION_STRING, markdown_code(study.scenario.filename().string()),
      markdown_code(study.dataset->camera), report.width, report.height, report.cells.size(),
      open.design.settings(), open.design.seeds());
  text += fmt::format(
      "- command: {}\n- digest of the scenario with its files: `{}`\n- digest of the program: "
      "`{}`\n"
      "- seeds: ",
      markdown_code("vinerow dataset " + study.file.filename().string()), open.identity.scenario(),
      open.identity.program());
  for (std::size_t i = 0; i < study.seeds.size(); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", study.seeds[i]);
  }
  text += "\n\n";
  if (!study.factors.empty()) {
    text += "| factor | key | levels |\n|---|---|---|\n";
    for (const scenario::Factor& factor : study.factors) {
      for (std::size_t column = 0; column < factor.columns.size(); ++column) {
        std::string levels;
        constexpr std::size_t kShown = 12;
        for (std::size_t k = 0; k < factor.levels.size() && k < kShown; ++k) {
          levels += (k == 0 ? "" : ", ") + factor.levels[k].texts[column];
        }
        if (factor.levels.size() > kShown) {
          levels += fmt::format(", ... ({} levels)", factor.levels.size());
        }
        text += fmt::format("| {} | {} | {} |\n", markdown_text(factor.name),
                            markdown_code(factor.columns[column]), markdown_text(levels));
      }
    }
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
  const char* const by = config.split_by == scenario::SplitBy::kCell   ? "run"
                         : config.split_by == scenario::SplitBy::kSeed ? "seed"
                                                                       : "setting";
  text += fmt::format("Pictures of one {} are all in the same part.\n\n", by);
  text += "## Licence\n\n";
  text += config.licence.empty() ? std::string("Not stated by the study.")
                                 : markdown_text(config.licence);
  text +=
      "\n\nNo photograph is part of it. Meshes that the scenario loads from files keep their own "
      "licences.\n\n"
      "## Limits\n\n"
      "The pictures are drawn, not taken. Light that goes from leaf to leaf is not followed, and "
      "the sky is clear. Labels are exact, which those of people are not: test on real "
      "pictures.\n";
  return text;
}

}  // namespace vinerow::dataset
