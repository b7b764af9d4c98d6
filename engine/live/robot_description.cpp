#include "engine/live/robot_description.h"

#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/vehicle.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "engine/io/meshes/collada_writer.h"
#include "engine/io/robots/urdf_writer.h"
#include "engine/live/request_check.h"

namespace vinerow::live {
namespace {

std::string file_url(const std::filesystem::path& file) {
  std::string url = "file://";
  for (const auto& part : file.relative_path()) url += "/" + percent_encoded(part.string());
  return url;
}

}  // namespace

std::string describe_robot(const std::string& name, const Vehicle& vehicle,
                           const std::filesystem::path& out) {
  const std::vector<VehicleLink>& links = vehicle.links();
  Odometry truth;
  vehicle.read_truth(truth);
  std::vector<Pose> X_WL(links.size());
  vehicle.read_links(X_WL);

  std::filesystem::path folder;
  if (!out.empty()) {
    folder = out / "robot_description" / name;
    io::make_folder(folder);
    // Readers have another working directory.
    folder = std::filesystem::canonical(folder);
  }
  std::vector<io::DrawnLink> drawn;
  for (std::size_t i = 0; i < links.size(); ++i) {
    drawn.push_back({links[i].name, truth.X_WB.inverse() * X_WL[i], ""});
    if (folder.empty() || !links[i].mesh || links[i].mesh->triangles.empty()) continue;
    // The name of a link may have characters that a file's name cannot have.
    const std::filesystem::path file = folder / (percent_encoded(links[i].name) + ".dae");
    io::write_collada(*links[i].mesh, links[i].material, file);
    drawn.back().mesh_url = file_url(file);
  }
  std::string text = io::urdf_text(name, "base_link", drawn);
  if (!folder.empty()) write_whole_file(folder.parent_path() / (name + ".urdf"), text);
  return text;
}

}  // namespace vinerow::live
