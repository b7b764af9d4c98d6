#include "tools/export/map_cloud_file.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/io/clouds/cloud_output.h"
#include "engine/io/clouds/point_cloud_crs.h"
#include "engine/io/clouds/point_cloud_writer.h"
#include "tools/export/number_bytes.h"
#include "tools/export/scan_files.h"

namespace vinerow::tools {
namespace {

using record::RosKind;

class TableCloud final : public MapCloudFile {
 public:
  explicit TableCloud(const std::filesystem::path& file)
      : format_(file.extension() == ending_of(CloudFormat::kPcd) ? CloudFormat::kPcd
                                                                 : CloudFormat::kPly),
        output_(file) {}

  void begin(const std::vector<CloudField>& fields) override {
    fields_ = written_ = fields;
    for (CloudField& field : written_) {
      // Single precision has steps of 0.1 ms after half an hour.
      if (is_float(field, "time")) field.kind = RosKind::kFloat64;
    }
    output_.put_text(cloud_header(format_, written_, 0));
  }

  void put(const std::uint8_t* point, const Eigen::Vector3d& p_W, Time time) override {
    for (const CloudField& field : fields_) {
      if (is_float(field, "x")) {
        output_.put(static_cast<float>(p_W.x()));
      } else if (is_float(field, "y")) {
        output_.put(static_cast<float>(p_W.y()));
      } else if (is_float(field, "z")) {
        output_.put(static_cast<float>(p_W.z()));
      } else if (is_float(field, "time")) {
        output_.put(time.s());
      } else {
        output_.put_text(
            {reinterpret_cast<const char*>(point + field.offset), record::size_of(field.kind)});
      }
    }
    output_.flush_if_long();
  }

  void finish(std::uint64_t points) override {
    output_.flush();
    output_.overwrite_text(0, cloud_header(format_, written_, points));
    output_.close();
  }

 private:
  static bool is_float(const CloudField& field, const char* name) {
    return field.kind == RosKind::kFloat32 && field.name == name;
  }

  CloudFormat format_;
  io::CloudOutput output_;
  std::vector<CloudField> fields_;  ///< of the messages
  std::vector<CloudField> written_;
};

class LasCloud final : public MapCloudFile {
 public:
  LasCloud(std::filesystem::path file, const std::optional<CrsPlace>& place)
      : file_(std::move(file)) {
    if (!place) return;
    crs_ = place->crs;
    is_geographic_ = io::find_epsg_code(crs_).is_geographic;
    to_crs_ = std::make_unique<io::LocalToCrs>(crs_, place->origin);
  }

  void begin(const std::vector<CloudField>& fields) override { fields_ = fields; }

  void put(const std::uint8_t* point, const Eigen::Vector3d& p_W, Time time) override {
    points_.emplace_back().position = place_of(p_W);
    io::CloudPulse& pulse = pulses_.emplace_back();
    pulse.time_s = time.s();
    for (const CloudField& field : fields_) {
      const auto number = [&](double scale, double least, double most) {
        const double value = scale * number_of(field.kind, point + field.offset);
        return std::isfinite(value) ? std::round(std::clamp(value, least, most)) : least;
      };
      if (field.name == "intensity") {
        pulse.intensity = static_cast<std::uint16_t>(number(kIntensitySteps, 0.0, 65535.0));
      } else if (field.name == "ring") {
        pulse.user_data = static_cast<std::uint8_t>(number(1.0, 0.0, 255.0));
      } else if (field.name == "return_number") {
        pulse.return_number = static_cast<std::uint8_t>(number(1.0, 1.0, 5.0));
      }
    }
    constexpr std::size_t kBlock = 4096;
    if (points_.size() >= kBlock) flush();
  }

  void finish(std::uint64_t /*points*/) override {
    flush();
    writer_->finish();
  }

 private:
  static constexpr double kIntensitySteps = 100.0;  // of a unit of intensity

  /// In the file's frame.
  Eigen::Vector3d place_of(const Eigen::Vector3d& p_W) {
    if (!to_crs_) return p_W;
    // Points this near to each other go there by one straight map (LocalToCrs::Nearby).
    constexpr double kReach_m = 20.0;
    if (!nearby_ || (p_W - nearby_->centre_W).norm() > kReach_m) nearby_ = to_crs_->near(p_W);
    return (*nearby_)(p_W);
  }

  void flush() {
    if (!writer_) {
      io::PointCloudWriterOptions options;
      options.has_pulses = true;
      options.crs = crs_;
      options.las_scale.setConstant(1e-4);
      if (is_geographic_) options.las_scale.head<2>().setConstant(1e-9);
      if (!points_.empty()) options.las_offset = points_.front().position.array().round();
      writer_ = io::create_las_cloud(file_, options);
    }
    writer_->write(points_, pulses_);
    points_.clear();
    pulses_.clear();
  }

  std::filesystem::path file_;
  std::string crs_;
  bool is_geographic_ = false;
  std::unique_ptr<io::LocalToCrs> to_crs_;  ///< null: W
  std::optional<io::LocalToCrs::Nearby> nearby_;
  std::unique_ptr<io::PointCloudWriter>
      writer_;  ///< from the first points on, which give its origin
  std::vector<CloudField> fields_;
  std::vector<io::CloudPoint> points_;
  std::vector<io::CloudPulse> pulses_;
};

}  // namespace

std::unique_ptr<MapCloudFile> make_table_cloud(const std::filesystem::path& file) {
  return std::make_unique<TableCloud>(file);
}

std::unique_ptr<MapCloudFile> make_las_cloud(const std::filesystem::path& file,
                                             const std::optional<CrsPlace>& place) {
  return std::make_unique<LasCloud>(file, place);
}

}  // namespace vinerow::tools
