#include "tools/dataset/make_dataset.h"

#include <fmt/format.h>

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

DatasetReport report_of(const DatasetTask& task, const std::vector<CellPictures>& cells) {
  DatasetReport report;
  for (const CellPictures& cell : cells) {
    report.cells.push_back(cell.report);
    for (const PictureRecord& record : cell.records) {
      const auto part = static_cast<std::size_t>(record.split);
      if (report.width == 0) {
        report.width = static_cast<int>(record.camera.width);
        report.height = static_cast<int>(record.camera.height);
      }
      report.rows[part] += static_cast<int>(record.rows.size());
      for (const Annotation& thing : record.things) {
        ++report.things[part][task.config().classes[static_cast<std::size_t>(thing.class_index)]];
      }
    }
  }
  return report;
}

void write_formats(const DatasetTask& task, const std::vector<CellPictures>& cells,
                   const std::filesystem::path& out) {
  const scenario::DatasetConfig& config = task.config();
  const scenario::Study& study = task.open().study;
  if (task.writes("coco")) {
    CocoFiles coco(config.classes, study.description.empty() ? study.name : study.description,
                   config.licence);
    for (const CellPictures& cell : cells) {
      for (const PictureRecord& record : cell.records) coco.add(record);
    }
    coco.write(out / "annotations");
  }
  std::vector<bool> parts(3, false);
  for (const CellPictures& cell : cells) {
    for (const PictureRecord& record : cell.records) {
      parts[static_cast<std::size_t>(record.split)] = true;
      if (task.writes("yolo")) write_yolo_labels(record, out);
    }
  }
  if (task.writes("yolo")) write_yolo_data(config.classes, parts, out);
  if (task.writes("kitti")) {
    KittiFiles kitti(config.classes, out);
    for (const CellPictures& cell : cells) {
      for (const PictureRecord& record : cell.records) kitti.add(record);
    }
    kitti.finish();
  }
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
  io::WholeFolder folder(out);
  const std::vector<Split> splits = make_splits(open.design, task.config());
  const std::size_t count = open.design.cells();
  std::vector<CellPictures> cells(count);
  Counter counter(static_cast<int>(count) * task.most_pictures(), drawn);
  const auto shelf = std::make_shared<RunShelf>(2);
  for_chunks(count, 1, [&](std::size_t cell, std::size_t, std::size_t) {
    if (!counter.goes_on()) return;
    cells[cell] = run_cell(task, cell, splits[cell], shelf, folder.path(), counter);
  });
  if (!counter.goes_on()) return std::nullopt;
  DatasetReport report = report_of(task, cells);
  if (report.width == 0) {
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
