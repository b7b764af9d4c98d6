#include "tools/dataset/cell_run.h"

#include <fmt/format.h>

#include <deque>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/imaging/picture_codec.h"
#include "engine/io/files/output_folder.h"
#include "engine/sensors/camera/camera.h"
#include "engine/sensors/camera/view_caster.h"
#include "engine/sim/session.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_rays.h"
#include "engine/sim/vehicle_runtime.h"
#include "tools/dataset/panoptic.h"

namespace vinerow::dataset {
namespace {

/// A run that is watched for pictures.
class CellRun {
 public:
  CellRun(const DatasetTask& task, std::size_t cell, Split split, std::shared_ptr<RunShelf> shelf,
          const std::filesystem::path& out)
      : task_(task),
        cell_(cell),
        split_(split),
        out_(out),
        session_(task.scenario(cell),
                 std::shared_ptr<const Registry>(std::shared_ptr<void>(), &task.open().registry),
                 with_shelf(std::move(shelf))),
        shapes_(session_.simulation().world()),
        vehicles_(session_.simulation().vehicles()),
        frame_(session_.simulation().world().origin),
        readout_s_(task.readout_s(cell)) {
    const std::string base = task.vehicle() + "/" + task.sensor();
    picture_ = session_.signal<Picture>(base);
    info_ = session_.signal<CameraInfo>(base + "_info");
    for (const char* layer : kLayerNames) {
      layers_.push_back(session_.signal<Picture>(fmt::format("{}_{}", base, layer)));
    }
    truth_ = session_.signal<Odometry>(task.vehicle() + "/truth");
    for (const auto& vehicle : session_.simulation().vehicles()) {
      if (vehicle->name() != task.vehicle()) continue;
      for (const SensorMounting& mounting : vehicle->mountings()) {
        if (mounting.name == task.sensor()) {
          X_BS_ = mounting.X_BS;
        }
      }
    }
  }

  /// Runs to the end, or until it has enough pictures. @throws SimulationError and others of a run
  void run(Counter& counter, CellPictures& result) {
    const int most = task_.config().pictures.value_or(task_.most_pictures());
    std::uint64_t seen = 0;
    while (!session_.over() && result.report.pictures < most && counter.goes_on()) {
      session_.advance_for(session_.step());
      remember_body();
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

  void remember_body() {
    bodies_.push_back({truth_.stamp(), truth_.value()});
    constexpr std::size_t kKept = 16;
    if (bodies_.size() > kKept) bodies_.pop_front();
  }

  CameraPath path_at(Time time) const {
    for (const auto& [stamp, body] : bodies_) {
      if (stamp == time) return {sensors::CameraMotion::of_body(body, X_BS_), readout_s_};
    }
    throw SimulationError(task_.config().camera, time, "its picture is older than 16 steps");
  }

  std::vector<VehicleShape> vehicle_shapes() {
    vehicles_.update();
    std::vector<VehicleShape> shapes;
    for (const auto& vehicle : session_.simulation().vehicles()) {
      Odometry truth;
      vehicle->vehicle().read_truth(truth);
      shapes.push_back(
          {{}, truth.X_WB.q * Eigen::Vector3d::UnitX(), vehicle->name() == task_.vehicle()});
    }
    const std::span<const MeshInstance> links = vehicles_.links();
    for (std::size_t i = 0; i < links.size(); ++i) {
      const std::vector<Eigen::Vector3d> vertices_W = vertices_of(links[i]);
      auto& all = shapes[static_cast<std::size_t>(vehicles_.vehicle_of(static_cast<int>(i)))];
      all.vertices_W.insert(all.vertices_W.end(), vertices_W.begin(), vertices_W.end());
    }
    return shapes;
  }

  void write(const std::filesystem::path& folder, const Picture& picture,
             const std::string& name) const {
    const std::filesystem::path file = out_ / folder / name;
    io::make_folder_of(file);
    write_whole_file(file, imaging::encode_picture(picture));
  }

  PictureRecord take(int number) {
    PictureRecord record;
    record.index = static_cast<int>(cell_) * task_.most_pictures() + number;
    record.split = split_;
    record.cell = cell_;
    record.seed = task_.open().design.seed_of(cell_);
    record.time = picture_.stamp();
    record.camera = info_.value();
    const CameraPath path = path_at(record.time);
    record.X_WC = path.X_WC();
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
    record.things = annotate(layers, lens, path, shapes_, vehicles, task_.config().classes,
                             task_.config().min_pixels);
    record.rows = annotate_rows(layers, lens, path, session_.simulation().world().rows->rows);
    const char* const part = to_string(split_);
    if (task_.writes("coco_panoptic")) {
      PanopticPicture panoptic = make_panoptic(layers, layers_[0].value().data, shapes_,
                                               record.things, task_.config().classes);
      write(std::filesystem::path("annotations") / (std::string("panoptic_") + part), panoptic.ids,
            record.name());
      record.segments = std::move(panoptic.segments);
    }
    write(std::filesystem::path("images") / part, picture_.value(), record.name());
    write(std::filesystem::path("semantic") / part, layers_[0].value(), record.name());
    write(std::filesystem::path("instances") / part, instance, record.name());
    write(std::filesystem::path("depth") / part, depth, record.name());
    return record;
  }

  const DatasetTask& task_;
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
  std::deque<std::pair<Time, Odometry>> bodies_;  ///< of the last steps
  Pose X_BS_;
  double readout_s_;
};

}  // namespace

CellPictures run_cell(const DatasetTask& task, std::size_t cell, Split split,
                      const std::shared_ptr<RunShelf>& shelf, const std::filesystem::path& out,
                      Counter& counter) {
  CellPictures result;
  result.report.cell = cell;
  result.report.split = split;
  result.report.plant_seed = task.plant_seed(cell);
  try {
    CellRun run(task, cell, split, shelf, out);
    run.run(counter, result);
  } catch (const WriteError&) {
    throw;
  } catch (const std::exception& error) {
    result.report.failure = error.what();
  }
  return result;
}

}  // namespace vinerow::dataset
