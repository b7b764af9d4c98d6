#include "tools/dataset/make_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/csv.h"
#include "engine/io/files/whole_folder.h"
#include "engine/math/angles.h"
#include "tools/dataset/cell_run.h"
#include "tools/dataset/coco.h"
#include "tools/dataset/data_card.h"
#include "tools/dataset/dataset_task.h"
#include "tools/dataset/kitti.h"
#include "tools/dataset/panoptic.h"
#include "tools/dataset/splits.h"
#include "tools/dataset/yolo.h"

namespace vinerow::dataset {
namespace {

/// A row for each picture: where and when it was taken, by what lens, under which factors.
std::string pictures_csv(const study::OpenStudy& open, const std::vector<CellPictures>& cells) {
  std::string text =
      "picture,part,cell,seed,time_s,x_m,y_m,z_m,qw,qx,qy,qz,latitude_deg,longitude_deg,"
      "altitude_m,width,height,lens,fx,fy,cx,cy,d1,d2,d3,d4,d5";
  for (const std::string& column : open.design.columns()) text += "," + io::csv_text(column);
  text += "\n";
  for (const CellPictures& cell : cells) {
    for (const PictureRecord& r : cell.records) {
      const CameraInfo& c = r.camera;
      text += fmt::format(
          "{},{},{},{},{:.6f},{:.5f},{:.5f},{:.5f},{:.8f},{:.8f},{:.8f},{:.8f},{:.9f},{:.9f},"
          "{:.4f},{},{},{},{},{},{},{}",
          r.name(), to_string(r.split), r.cell, r.seed, r.time.s(), r.X_WC.p.x(), r.X_WC.p.y(),
          r.X_WC.p.z(), r.X_WC.q.w(), r.X_WC.q.x(), r.X_WC.q.y(), r.X_WC.q.z(),
          deg_from_rad(r.place.latitude_rad), deg_from_rad(r.place.longitude_rad),
          r.place.altitude_m, c.width, c.height,
          c.lens == CameraInfo::Lens::kFisheye ? "equidistant" : "plumb_bob", c.fx_px, c.fy_px,
          c.cx_px, c.cy_px);
      for (const double k : c.distortion) text += fmt::format(",{}", k);
      for (const std::string& level : open.design.texts(open.design.setting_of(r.cell))) {
        text += "," + io::csv_text(level);
      }
      text += "\n";
    }
  }
  return text;
}

/// Parts whose share of the pictures is far from the wanted one.
std::vector<std::string> share_notes(const scenario::DatasetConfig& config,
                                     const DatasetReport& report) {
  constexpr double kMuch = 0.05;
  double all = 0.0;
  for (const Split part : {Split::kTrain, Split::kValidation, Split::kTest}) {
    all += report.pictures(part);
  }
  std::vector<std::string> notes;
  if (all == 0.0) return notes;
  const auto compare = [&](Split part, const char* key, double share) {
    const double real = report.pictures(part) / all;
    if (std::abs(real - share) <= kMuch) return;
    notes.push_back(fmt::format(
        "{} has {:.0f} % of the pictures, not the {:.0f} % of {}: the pictures of a {} "
        "stay together",
        to_string(part), 100.0 * real, 100.0 * share, key, group_name(config.split_by)));
  };
  compare(Split::kValidation, "validation_share", config.validation_share);
  compare(Split::kTest, "test_share", config.test_share);
  return notes;
}

DatasetReport report_of(const DatasetTask& task, const std::vector<CellPictures>& cells) {
  DatasetReport report;
  for (const CellPictures& cell : cells) {
    report.cells.push_back(cell.report);
    for (const PictureRecord& record : cell.records) {
      const auto part = static_cast<std::size_t>(record.split);
      report.sizes.insert({record.camera.width, record.camera.height});
      report.rows[part] += static_cast<int>(record.rows.size());
      for (const Annotation& thing : record.things) {
        ++report.things[part][task.config().classes[static_cast<std::size_t>(thing.class_index)]];
      }
    }
  }
  report.notes = share_notes(task.config(), report);
  return report;
}

constexpr std::pair<const char*, YoloTask> kYoloFormats[] = {{"yolo", YoloTask::kDetect},
                                                             {"yolo_segment", YoloTask::kSegment},
                                                             {"yolo_pose", YoloTask::kPose}};

void write_formats(const DatasetTask& task, const std::vector<CellPictures>& cells,
                   const std::filesystem::path& out) {
  const scenario::DatasetConfig& config = task.config();
  const scenario::Study& study = task.open().study;
  const nlohmann::ordered_json head =
      coco_head(study.description.empty() ? study.name : study.description, config.licence);
  if (task.writes("coco")) {
    CocoFiles coco(config.classes, head);
    for (const CellPictures& cell : cells) {
      for (const PictureRecord& record : cell.records) coco.add(record);
    }
    coco.write(out / "annotations");
  }
  if (task.writes("coco_panoptic")) {
    PanopticFiles panoptic(config.classes, head);
    for (const CellPictures& cell : cells) {
      for (const PictureRecord& record : cell.records) panoptic.add(record);
    }
    panoptic.write(out / "annotations");
  }
  for (const auto& [format, yolo_task] : kYoloFormats) {
    if (!task.writes(format)) continue;
    YoloFiles yolo(yolo_task, config.classes, out);
    for (const CellPictures& cell : cells) {
      for (const PictureRecord& record : cell.records) yolo.add(record);
    }
    yolo.finish();
  }
  if (task.writes("kitti")) {
    KittiFiles kitti(config.classes, out);
    for (const CellPictures& cell : cells) {
      for (const PictureRecord& record : cell.records) kitti.add(record);
    }
    kitti.finish();
  }
}

/// Cells in running order: those that share a world are consecutive, so that it is built once.
std::vector<std::size_t> running_order(const DatasetTask& task) {
  const study::Design& design = task.open().design;
  const bool seeds_have_own_plants =
      design.seeds() > 1 && task.plant_seed(0) != task.plant_seed(design.cell_of(0, 1));
  std::vector<std::size_t> cells;
  for (const std::size_t setting : design.settings_in_running_order()) {
    for (std::size_t seed = 0; seed < design.seeds(); ++seed) {
      cells.push_back(design.cell_of(setting, seed));
    }
  }
  if (seeds_have_own_plants) {
    std::stable_sort(cells.begin(), cells.end(), [&](std::size_t a, std::size_t b) {
      return a % design.seeds() < b % design.seeds();
    });
  }
  return cells;
}

}  // namespace

std::string PictureRecord::name() const {
  return fmt::format("{:06}.png", index);
}

int DatasetReport::pictures(Split split) const {
  int sum = 0;
  for (const CellReport& cell : cells) sum += cell.split == split ? cell.pictures : 0;
  return sum;
}

std::optional<DatasetReport> make_dataset(const study::OpenStudy& open,
                                          const std::filesystem::path& out,
                                          const std::function<bool(int done, int most)>& drawn) {
  const DatasetTask task(open);
  const std::vector<Split> splits = make_splits(open.design, task.config());
  io::WholeFolder folder(out);
  const std::size_t count = open.design.cells();
  std::vector<CellPictures> cells(count);
  Counter counter(static_cast<int>(count) * task.most_pictures(), drawn);
  const auto shelf = std::make_shared<RunShelf>(2);
  const std::vector<std::size_t> order = running_order(task);
  for_chunks(count, 1, [&](std::size_t place, std::size_t, std::size_t) {
    if (!counter.goes_on()) return;
    const std::size_t cell = order[place];
    cells[cell] = run_cell(task, cell, splits[cell], shelf, folder.path(), counter);
  });
  if (!counter.goes_on()) return std::nullopt;
  DatasetReport report = report_of(task, cells);
  if (report.sizes.empty()) {
    throw ConfigError(
        fmt::format("{}: no cell gave a picture; cell 0: {}", open.study.file.string(),
                    report.cells.front().failure.empty() ? "ended before the first"
                                                         : report.cells.front().failure));
  }
  write_formats(task, cells, folder.path());
  write_whole_file(folder.path() / "pictures.csv", pictures_csv(open, cells));
  write_whole_file(folder.path() / "README.md", data_card(open, report));
  folder.finish();
  return report;
}

}  // namespace vinerow::dataset
