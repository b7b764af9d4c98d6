// write_sample_clouds FOLDER: LAS files for another reader, without and with colour.
// Point k of 1000: x = 500000.125 + k, y = 4649000.5 - 2.25 k, z = -3.5 + 0.125 k, colour
// (k mod 256, 255 - k mod 256, 7), classification k mod 12
// (copc.js returns 12, the overlap of flight lines, as a flag).
#include <cstdio>
#include <vector>

#include "engine/io/clouds/point_cloud_writer.h"

int main(int argc, char** argv) {
  using namespace vinerow::io;
  if (argc != 2) return std::fprintf(stderr, "usage: write_sample_clouds FOLDER\n"), 2;
  std::vector<CloudPoint> points(1000);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double step = static_cast<double>(k);
    points[k].position = {500000.125 + step, 4649000.5 - 2.25 * step, -3.5 + 0.125 * step};
    const auto byte = static_cast<std::uint8_t>(k % 256);
    points[k].rgb = {{byte, static_cast<std::uint8_t>(255 - byte), 7}};
    points[k].classification = static_cast<std::uint8_t>(k % 12);
  }
  for (const bool has_colour : {false, true}) {
    PointCloudWriterOptions options;
    options.has_colour = has_colour;
    options.has_classification = true;
    options.crs = "EPSG:25832";
    options.las_offset = {500000, 4649000, 0};
    const std::filesystem::path folder = argv[1];
    const auto writer =
        create_las_cloud(folder / (has_colour ? "colour.las" : "plain.las"), options);
    writer->write(points);
    writer->finish();
  }
}
