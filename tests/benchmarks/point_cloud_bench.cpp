/// Reading point clouds: each format's reader, and the whole way into a ParcelCloud. Of 0.7 and 7
/// million points at 1500 a square metre, and 60 million as LAS. Files lie in the folder for
/// temporary files and in the system's cache; bytes per second are the file's.

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/random.h"
#include "engine/io/clouds/cloud_output.h"
#include "engine/io/clouds/point_cloud.h"
#include "engine/io/clouds/point_cloud_writer.h"
#include "worlds/mapping/reading/read_cloud.h"

namespace vinerow::point_cloud_bench {
namespace {

namespace fs = std::filesystem;

/// PCL's own layout: x y z rgb as 32-bit numbers.
class PcdWriter {
 public:
  PcdWriter(const fs::path& file, std::int64_t count) : output_(file) {
    output_.put_text(
        fmt::format("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\n"
                    "COUNT 1 1 1 1\nWIDTH {}\nHEIGHT 1\nPOINTS {}\nDATA binary\n",
                    count, count));
  }
  void write(const std::vector<io::CloudPoint>& points) {
    for (const io::CloudPoint& point : points) {
      for (int k = 0; k < 3; ++k) output_.put(static_cast<float>(point.position[k]));
      output_.put(std::uint32_t{0xff204060});
      output_.flush_if_long();
    }
    output_.flush();
  }
  void finish() { output_.close(); }

 private:
  io::CloudOutput output_;
};

/// A parcel of `count` points in millimetres, in blocks.
template <class Writer>
void write_parcel(Writer& writer, std::int64_t count) {
  RandomStream random(1, "", "points");
  const double side_m = std::sqrt(static_cast<double>(count) / 1500.0);
  std::vector<io::CloudPoint> block;
  for (std::int64_t k = 0; k < count; ++k) {
    io::CloudPoint& point = block.emplace_back();
    point.position = {500000.0 + random.uniform(0, side_m), 4983000.0 + random.uniform(0, side_m),
                      120.0 + random.uniform(0, 2)};
    point.position = (point.position * 1000.0).array().round() / 1000.0;
    point.rgb = {{static_cast<std::uint8_t>(k), 120, 40}};
    if (block.size() < 65'536 && k + 1 < count) continue;
    writer.write(block);
    block.clear();
  }
  writer.finish();
}

/// The file of a kind, made when it is first asked for and removed at the end of the program.
class Files {
 public:
  Files() : folder_(fs::temp_directory_path() / fmt::format("vinerow_bench_{}", getpid())) {
    fs::create_directories(folder_);
  }
  ~Files() { fs::remove_all(folder_); }

  fs::path get(const std::string& kind, std::int64_t count) {
    const fs::path file = folder_ / fmt::format("{}.{}", count, kind);
    if (fs::exists(file)) return file;
    if (kind.ends_with("pcd")) {
      PcdWriter writer(file, count);
      write_parcel(writer, count);
      return file;
    }
    io::PointCloudWriterOptions options;
    options.has_colour = true;
    options.las_offset = {500000, 4983000, 0};
    if (kind == "utm.las") options.crs = "EPSG:25832";
    write_parcel(*io::create_point_cloud(file, options), count);
    return file;
  }

 private:
  const fs::path folder_;
};

Files& files() {
  static Files all;
  return all;
}

void set_counters(benchmark::State& state, const fs::path& file) {
  const auto rounds = static_cast<std::int64_t>(state.iterations());
  state.SetItemsProcessed(rounds * state.range(0));
  state.SetBytesProcessed(rounds * static_cast<std::int64_t>(fs::file_size(file)));
}

void read_points(benchmark::State& state, const std::string& kind) {
  const fs::path file = files().get(kind, state.range(0));
  std::vector<io::CloudPoint> block(4096);
  for (auto _ : state) {
    const auto reader = io::open_point_cloud(file);
    while (reader->read(block) == block.size()) benchmark::DoNotOptimize(block.data());
  }
  set_counters(state, file);
}

void read_parcel(benchmark::State& state, const std::string& kind) {
  const fs::path file = files().get(kind, state.range(0));
  for (auto _ : state) {
    mapping::CloudReadReport report;
    benchmark::DoNotOptimize(mapping::read_parcel_cloud(file, {}, report));
  }
  set_counters(state, file);
}

constexpr std::int64_t kSmall = 700'000, kParcelF = 7'000'000, kFourHectares = 60'000'000;

BENCHMARK_CAPTURE(read_points, las, "las")
    ->Arg(kSmall)
    ->Arg(kParcelF)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_points, ply, "ply")
    ->Arg(kSmall)
    ->Arg(kParcelF)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_points, pcd, "pcd")
    ->Arg(kSmall)
    ->Arg(kParcelF)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_points, xyz, "xyz")
    ->Arg(kSmall)
    ->Arg(kParcelF)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_parcel, las, "las")
    ->Arg(kSmall)
    ->Arg(kParcelF)
    ->Arg(kFourHectares)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_parcel, las_utm, "utm.las")
    ->Arg(kSmall)
    ->Arg(kParcelF)
    ->Arg(kFourHectares)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_parcel, ply, "ply")->Arg(kParcelF)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_parcel, xyz, "xyz")->Arg(kParcelF)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vinerow::point_cloud_bench
