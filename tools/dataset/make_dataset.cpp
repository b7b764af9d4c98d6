#include "tools/dataset/make_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <mutex>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/core/suggest.h"
#include "engine/core/whole_file.h"
#include "engine/imaging/picture_codec.h"
#include "engine/io/files/csv.h"
#include "engine/io/files/output_folder.h"
#include "engine/io/files/whole_folder.h"
#include "engine/math/angles.h"
#include "engine/sensors/camera/camera.h"
#include "engine/sensors/camera/view_caster.h"
#include "engine/sim/run_shelf.h"
#include "engine/sim/session.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_rays.h"
#include "engine/sim/vehicle_runtime.h"
#include "tools/dataset/coco.h"
#include "tools/dataset/data_card.h"
#include "tools/dataset/kitti.h"
#include "tools/dataset/splits.h"
#include "tools/dataset/yolo.h"

namespace vinerow::dataset {
namespace {

constexpr const char* kLayerNames[] = {"semantic", "instance", "depth"};

io::YamlNode scalar(std::string text) {
  io::YamlNode node;
  node.kind = io::YamlKind::kScalar;
  node.text = std::move(text);
  return node;
}

/// What the study says, checked against its scenario.
class Order {
 public:
  explicit Order(const study::OpenStudy& open) : open_(open) {
    if (!open.study.dataset) {
      throw ConfigError(
          fmt::format("{}: has no 'dataset'; add dataset: {{camera: <vehicle>/<camera>}}",
                      open.study.file.string()));
    }
    const scenario::DatasetConfig& config = *open.study.dataset;
    const std::size_t slash = config.camera.find('/');
    vehicle_ = config.camera.substr(0, slash);
    sensor_ = slash == std::string::npos ? "" : config.camera.substr(slash + 1);
    check_names("classes", config.classes, class_names());
    check_names("formats", config.formats, {"coco", "yolo", "kitti"});
    for (std::size_t cell = 0; cell < open.design.cells(); ++cell) check_cell(cell);
  }

  const study::OpenStudy& open() const { return open_; }
  const scenario::DatasetConfig& config() const { return *open_.study.dataset; }
  bool writes(const char* format) const {
    const auto& formats = config().formats;
    return std::find(formats.begin(), formats.end(), format) != formats.end();
  }
  const std::string& vehicle() const { return vehicle_; }
  const std::string& sensor() const { return sensor_; }
  /// Pictures of the longest run: the numbers of each cell's pictures start at its multiple.
  int most_pictures() const { return most_pictures_; }

  scenario::Scenario scenario(std::size_t cell) const {
    scenario::Overrides overrides = open_.design.overrides(cell);
    const std::string key = fmt::format("{}.sensors.{}.", vehicle_, sensor_);
    for (const char* layer : kLayerNames) overrides.values.push_back({key + layer, scalar("true")});
    // Every picture, when it is taken.
    overrides.values.push_back({key + "delay_s", scalar("0")});
    overrides.values.push_back({key + "dropout_share", scalar("0")});
    if (config().every_s) {
      overrides.values.push_back(
          {key + "rate_Hz", scalar(fmt::format("{}", 1.0 / *config().every_s))});
    }
    return open_.source.load(open_.registry, overrides);
  }

 private:
  [[noreturn]] void fail(const std::string& sentence) const {
    io::fail_at(open_.study.dataset_mark, "dataset." + sentence);
  }

  void check_names(const char* key, const std::vector<std::string>& names,
                   const std::vector<std::string>& known) const {
    if (names.empty()) fail(fmt::format("{} = [], must name one of: {}", key, join(known)));
    for (const std::string& name : names) {
      if (std::count(names.begin(), names.end(), name) > 1) {
        fail(fmt::format("{} has '{}' twice", key, name));
      }
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      fail(fmt::format("{} = '{}', must be one of: {}{}", key, name, join(known),
                       did_you_mean(name, known)));
    }
  }

  void check_cell(std::size_t cell) {
    const scenario::Scenario plain =
        open_.source.load(open_.registry, open_.design.overrides(cell));
    std::vector<std::string> cameras;
    const scenario::NamedPart* found = nullptr;
    for (const scenario::VehicleConfig& vehicle : plain.vehicles) {
      for (const scenario::NamedPart& sensor : vehicle.sensors) {
        if (sensor.part.type != "camera") continue;
        cameras.push_back(vehicle.name + "/" + sensor.name);
        if (cameras.back() == config().camera) found = &sensor;
      }
    }
    if (found == nullptr) {
      fail(fmt::format("camera = '{}', must be a sensor of type camera: {}{}", config().camera,
                       cameras.empty() ? "the scenario has none" : join(cameras),
                       did_you_mean(config().camera, cameras)));
    }
    const sensors::CameraNature nature = sensors::camera_nature(found->part.parameters);
    if (nature.takes_depth_alone) {
      fail(
          fmt::format("camera = '{}' takes pictures of depth alone; choose one of colour, grey or "
                      "a band",
                      config().camera));
    }
    if (writes("kitti") && nature.has_distortion) {
      fail(
          fmt::format("formats has kitti, which knows no distortion: '{}' must have the lens "
                      "brown_conrady with distortion: []",
                      config().camera));
    }
    const double period_s = config().every_s.value_or(1.0 / found->part.rate_Hz);
    const int all = static_cast<int>(std::floor(plain.duration_s / period_s + 1e-9)) + 1;
    most_pictures_ = std::max(most_pictures_, std::min(all, config().pictures.value_or(all)));
  }

  const study::OpenStudy& open_;
  std::string vehicle_, sensor_;
  int most_pictures_ = 0;
};

/// Counts pictures and asks whether to go on; for several threads.
class Counter {
 public:
  Counter(int most, const std::function<bool(int, int)>& drawn) : most_(most), drawn_(drawn) {}
  bool goes_on() const { return goes_on_; }
  void add() {
    const std::scoped_lock lock(mutex_);
    if (!drawn_(++done_, most_)) goes_on_ = false;
  }

 private:
  int most_;
  const std::function<bool(int, int)>& drawn_;
  std::mutex mutex_;
  int done_ = 0;
  std::atomic<bool> goes_on_ = true;
};

struct CellPictures {
  CellReport report;
  std::vector<PictureRecord> records;
};

/// A run that is watched for pictures.
class CellRun {
 public:
  CellRun(const Order& order, std::size_t cell, Split split, std::shared_ptr<RunShelf> shelf,
          const std::filesystem::path& out)
      : order_(order),
        cell_(cell),
        split_(split),
        out_(out),
        session_(order.scenario(cell),
                 std::shared_ptr<const Registry>(std::shared_ptr<void>(), &order.open().registry),
                 with_shelf(std::move(shelf))),
        shapes_(session_.simulation().world()),
        vehicles_(session_.simulation().vehicles()),
        frame_(session_.simulation().world().origin) {
    const std::string base = order.vehicle() + "/" + order.sensor();
    picture_ = session_.signal<Picture>(base);
    info_ = session_.signal<CameraInfo>(base + "_info");
    for (const char* layer : kLayerNames) {
      layers_.push_back(session_.signal<Picture>(fmt::format("{}_{}", base, layer)));
    }
    truth_ = session_.signal<Odometry>(order.vehicle() + "/truth");
    for (const auto& vehicle : session_.simulation().vehicles()) {
      if (vehicle->name() != order.vehicle()) continue;
      for (const SensorMounting& mounting : vehicle->mountings()) {
        if (mounting.name == order.sensor()) {
          X_BC_ =
              mounting.X_BS * Pose{Eigen::Quaterniond(sensors::R_SC()), Eigen::Vector3d::Zero()};
        }
      }
    }
  }

  /// Runs to the end, or until it has enough pictures. @throws SimulationError and others of a run
  void run(Counter& counter, CellPictures& result) {
    const int most = order_.config().pictures.value_or(order_.most_pictures());
    std::uint64_t seen = 0;
    while (!session_.over() && result.report.pictures < most && counter.goes_on()) {
      session_.advance_for(session_.step());
      remember_pose();
      if (!picture_.is_newer_than(seen)) continue;
      result.records.push_back(take(result.report.pictures++));
      counter.add();
    }
  }

 private:
  static SessionOptions with_shelf(std::shared_ptr<RunShelf> shelf) {
    SessionOptions options;
    options.shelf = std::move(shelf);
    return options;
  }

  void remember_pose() {
    poses_.push_back({truth_.stamp(), truth_.value().X_WB});
    constexpr std::size_t kKept = 16;
    if (poses_.size() > kKept) poses_.pop_front();
  }

  const Pose& pose_at(Time time) const {
    for (const auto& [stamp, X_WB] : poses_) {
      if (stamp == time) return X_WB;
    }
    throw SimulationError(order_.config().camera, time, "its picture is older than 16 steps");
  }

  std::vector<VehicleShape> vehicle_shapes() {
    vehicles_.update();
    std::vector<VehicleShape> shapes;
    for (const auto& vehicle : session_.simulation().vehicles()) {
      Odometry truth;
      vehicle->vehicle().read_truth(truth);
      shapes.push_back({{}, truth.X_WB.q * Eigen::Vector3d::UnitX()});
    }
    const std::span<const MeshInstance> links = vehicles_.links();
    for (std::size_t i = 0; i < links.size(); ++i) {
      const std::vector<Eigen::Vector3d> vertices_W = vertices_of(links[i]);
      auto& all = shapes[static_cast<std::size_t>(vehicles_.vehicle_of(static_cast<int>(i)))];
      all.vertices_W.insert(all.vertices_W.end(), vertices_W.begin(), vertices_W.end());
    }
    return shapes;
  }

  void write(const char* kind, const Picture& picture, const std::string& name) const {
    const std::filesystem::path file = out_ / kind / to_string(split_) / name;
    io::make_folder_of(file);
    write_whole_file(file, imaging::encode_picture(picture));
  }

  PictureRecord take(int number) {
    PictureRecord record;
    record.index = static_cast<int>(cell_) * order_.most_pictures() + number;
    record.split = split_;
    record.cell = cell_;
    record.seed = order_.open().design.seed_of(cell_);
    record.time = picture_.stamp();
    record.camera = info_.value();
    record.X_WC = pose_at(record.time) * X_BC_;
    record.place = frame_.to_geodetic(record.X_WC.p);
    const Picture &instance = layers_[1].value(), &depth = layers_[2].value();
    Layers layers;
    layers.width = static_cast<int>(instance.width);
    layers.height = static_cast<int>(instance.height);
    for (std::size_t i = 0; i < std::size_t{instance.width} * instance.height; ++i) {
      const std::uint8_t *rgb = &instance.data[3 * i], *mm = &depth.data[2 * i];
      layers.thing.push_back(rgb[0] | (std::uint32_t{rgb[1]} << 8) | (std::uint32_t{rgb[2]} << 16));
      layers.depth_mm.push_back(static_cast<std::uint16_t>(mm[0] | (mm[1] << 8)));
    }
    const Lens lens(record.camera);
    const std::vector<VehicleShape> vehicles = vehicle_shapes();
    record.things = annotate(layers, lens, record.X_WC, shapes_, vehicles, order_.config().classes,
                             order_.config().min_pixels);
    record.rows =
        annotate_rows(layers, lens, record.X_WC, session_.simulation().world().rows->rows);
    write("images", picture_.value(), record.name());
    write("semantic", layers_[0].value(), record.name());
    write("instances", instance, record.name());
    write("depth", depth, record.name());
    return record;
  }

  const Order& order_;
  std::size_t cell_;
  Split split_;
  const std::filesystem::path& out_;
  Session session_;
  ThingShapes shapes_;
  VehicleRays vehicles_;
  LocalFrame frame_;
  SignalView<Picture> picture_;
  SignalView<CameraInfo> info_;
  std::vector<SignalView<Picture>> layers_;
  SignalView<Odometry> truth_;
  std::deque<std::pair<Time, Pose>> poses_;  ///< of the last steps
  Pose X_BC_;
};

CellPictures run_cell(const Order& order, std::size_t cell, Split split,
                      const std::shared_ptr<RunShelf>& shelf, const std::filesystem::path& out,
                      Counter& counter) {
  CellPictures result;
  result.report.cell = cell;
  result.report.split = split;
  try {
    CellRun run(order, cell, split, shelf, out);
    run.run(counter, result);
  } catch (const WriteError&) {
    throw;
  } catch (const std::exception& error) {
    result.report.failure = error.what();
  }
  return result;
}

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

DatasetReport report_of(const Order& order, const std::vector<CellPictures>& cells) {
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
        ++report.things[part][order.config().classes[static_cast<std::size_t>(thing.class_index)]];
      }
    }
  }
  return report;
}

void write_formats(const Order& order, const std::vector<CellPictures>& cells,
                   const std::filesystem::path& out) {
  const scenario::DatasetConfig& config = order.config();
  const scenario::Study& study = order.open().study;
  if (order.writes("coco")) {
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
      if (order.writes("yolo")) write_yolo_labels(record, out);
    }
  }
  if (order.writes("yolo")) write_yolo_data(config.classes, parts, out);
  if (order.writes("kitti")) {
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
  const Order order(open);
  io::WholeFolder folder(out);
  const std::vector<Split> splits = make_splits(open.design, order.config());
  const std::size_t count = open.design.cells();
  std::vector<CellPictures> cells(count);
  Counter counter(static_cast<int>(count) * order.most_pictures(), drawn);
  const auto shelf = std::make_shared<RunShelf>(2);
  for_chunks(count, 1, [&](std::size_t cell, std::size_t, std::size_t) {
    if (!counter.goes_on()) return;
    cells[cell] = run_cell(order, cell, splits[cell], shelf, folder.path(), counter);
  });
  if (!counter.goes_on()) return std::nullopt;
  DatasetReport report = report_of(order, cells);
  if (report.width == 0) {
    throw ConfigError(
        fmt::format("{}: no cell gave a picture; cell 0: {}", open.study.file.string(),
                    report.cells.front().failure.empty() ? "ended before the first"
                                                         : report.cells.front().failure));
  }
  write_formats(order, cells, folder.path());
  write_whole_file(folder.path() / "pictures.csv", pictures_csv(open, cells));
  write_whole_file(folder.path() / "README.md", data_card(open, report));
  folder.finish();
  return report;
}

}  // namespace vinerow::dataset
