#include "engine/io/robots/sdf.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <cmath>
#include <map>
#include <sstream>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

void load_document(XMLDocument& document, const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw ConfigError(fmt::format("SDF file '{}' does not exist", file.string()));
  }
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) {
    throw ConfigError(fmt::format("{}:{}: SDF is not well-formed XML ({})", file.string(),
                                  document.ErrorLineNum(), document.ErrorName()));
  }
}

std::vector<double> read_numbers(const XMLElement& element, std::size_t count,
                                 const std::filesystem::path& file) {
  std::vector<double> numbers;
  std::istringstream stream(element.GetText() ? element.GetText() : "");
  // operator>> does not read "nan": reading stops there, and the check below rejects the text.
  for (double number; stream >> number;) numbers.push_back(number);
  bool finite = stream.eof() && numbers.size() == count;
  for (const double number : numbers) finite = finite && std::isfinite(number);
  if (!finite) {
    throw ConfigError(fmt::format("{}:{}: <{}> = '{}', must be {} finite numbers", file.string(),
                                  element.GetLineNum(), element.Name(),
                                  element.GetText() ? element.GetText() : "", count));
  }
  return numbers;
}

/// Child <pose>; identity if absent or empty.
Pose read_pose(const XMLElement& parent, const std::filesystem::path& file) {
  Pose pose;
  const XMLElement* element = parent.FirstChildElement("pose");
  if (element == nullptr || element->GetText() == nullptr) return pose;
  const std::vector<double> n = read_numbers(*element, 6, file);
  pose.p = {n[0], n[1], n[2]};
  pose.q = quaternion_from_rpy({n[3], n[4], n[5]});
  return pose;
}

std::string child_text(const XMLElement& parent, const char* name) {
  const XMLElement* element = parent.FirstChildElement(name);
  return element != nullptr && element->GetText() != nullptr ? element->GetText() : "";
}

/// "model://a/b" -> ("model", "a/b"); without a scheme ("", as written).
std::pair<std::string, std::string> split_scheme(const std::string& uri) {
  const std::size_t colon = uri.find("://");
  if (colon == std::string::npos) return {"", uri};
  return {uri.substr(0, colon), uri.substr(colon + 3)};
}

/// True for "model" and "package": the first component of such a URI is a model's name, not a
/// folder.
bool names_a_model(const std::string& scheme) {
  return scheme == "model" || scheme == "package";
}

/// "a/b/" -> "b"; "model://a/b" -> "a"
std::string model_of(const std::string& uri) {
  auto [scheme, rest] = split_scheme(uri);
  while (!rest.empty() && rest.back() == '/') rest.pop_back();
  if (names_a_model(scheme)) return rest.substr(0, rest.find('/'));
  return rest.substr(rest.find_last_of('/') + 1);
}

/// Possible paths of a mesh. The first existing one is used.
std::vector<std::filesystem::path> candidates(const std::string& uri,
                                              const std::filesystem::path& folder,
                                              const std::vector<std::filesystem::path>& search) {
  const auto [scheme, rest] = split_scheme(uri);
  // A plain path: absolute, or relative to the folder of the file that names it, as Gazebo writes
  // it.
  if (!names_a_model(scheme)) return {folder / rest};
  // Copies of models are often renamed: their own folder comes first.
  const std::size_t slash = rest.find('/');
  std::vector<std::filesystem::path> found;
  if (slash != std::string::npos) found.push_back(folder / rest.substr(slash + 1));
  for (const std::filesystem::path& models : search) found.push_back(models / rest);
  if (found.empty()) found.push_back(folder / rest);
  return found;
}

std::filesystem::path find_mesh(const std::string& uri, const std::filesystem::path& folder,
                                const std::vector<std::filesystem::path>& search) {
  const std::vector<std::filesystem::path> places = candidates(uri, folder, search);
  for (const std::filesystem::path& place : places) {
    std::error_code error;
    if (std::filesystem::is_regular_file(place, error)) return place;
  }
  return places.front();
}

/// Locations of a model's file and meshes.
struct ModelSource {
  const std::filesystem::path& file;
  std::filesystem::path folder;
  const std::vector<std::filesystem::path>& search_folders;
};

void read_geometries(const XMLElement& link, const char* kind, const Pose& X_ML,
                     const ModelSource& source, SdfModel& model) {
  for (const XMLElement* shape = link.FirstChildElement(kind); shape != nullptr;
       shape = shape->NextSiblingElement(kind)) {
    const XMLElement* geometry = shape->FirstChildElement("geometry");
    const XMLElement* first = geometry ? geometry->FirstChildElement() : nullptr;
    if (first == nullptr) continue;
    const XMLElement* mesh = geometry->FirstChildElement("mesh");
    if (mesh == nullptr) {
      model.other_shapes.emplace_back(first->Name());
      continue;
    }
    SdfMesh entry;
    entry.uri = child_text(*mesh, "uri");
    entry.file = find_mesh(entry.uri, source.folder, source.search_folders);
    entry.X_MG = X_ML * read_pose(*shape, source.file);
    if (const XMLElement* scale = mesh->FirstChildElement("scale")) {
      const std::vector<double> n = read_numbers(*scale, 3, source.file);
      entry.scale = {n[0], n[1], n[2]};
    }
    model.meshes.push_back(std::move(entry));
  }
}

/// Visuals of a model's links, or collisions if there are no visuals. @param X_M  pose of the model
/// in its parent
SdfModel read_links(const XMLElement& model, const Pose& X_M, const ModelSource& source) {
  SdfModel result;
  for (const char* kind : {"visual", "collision"}) {
    for (const XMLElement* link = model.FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      read_geometries(*link, kind, X_M * read_pose(*link, source.file), source, result);
    }
    if (!result.meshes.empty() || !result.other_shapes.empty()) break;
  }
  return result;
}

/// Poses of models in the saved state of the world; they override those of the models.
std::map<std::string, Pose> read_saved_poses(const XMLElement& world,
                                             const std::filesystem::path& file) {
  std::map<std::string, Pose> poses;
  const XMLElement* state = world.FirstChildElement("state");
  if (state == nullptr) return poses;
  for (const XMLElement* model = state->FirstChildElement("model"); model != nullptr;
       model = model->NextSiblingElement("model")) {
    const char* name = model->Attribute("name");
    if (name != nullptr && model->FirstChildElement("pose") != nullptr) {
      poses[name] = read_pose(*model, file);
    }
  }
  return poses;
}

double child_number(const XMLElement& parent, const char* name, double limit,
                    const std::filesystem::path& file) {
  const XMLElement* element = parent.FirstChildElement(name);
  if (element == nullptr) return 0.0;
  const double number = read_numbers(*element, 1, file)[0];
  if (std::abs(number) > limit) {
    throw ConfigError(fmt::format("{}:{}: <{}> = {}, must be between {} and {}", file.string(),
                                  element->GetLineNum(), name, number, -limit, limit));
  }
  return number;
}

std::optional<SdfOrigin> read_place_on_earth(const XMLElement& world, const std::filesystem::path& file) {
  const XMLElement* element = world.FirstChildElement("spherical_coordinates");
  if (element == nullptr) return std::nullopt;
  SdfOrigin origin;
  origin.latitude_rad = rad_from_deg(child_number(*element, "latitude_deg", 90.0, file));
  origin.longitude_rad = rad_from_deg(child_number(*element, "longitude_deg", 180.0, file));
  origin.altitude_m = child_number(*element, "elevation", 1e4, file);
  origin.heading_rad = rad_from_deg(child_number(*element, "heading_deg", 360.0, file));
  // Gazebo writes zeros if no position was given.
  if (origin.latitude_rad == 0.0 && origin.longitude_rad == 0.0) return std::nullopt;
  return origin;
}

}  // namespace

SdfWorld read_sdf_world(const std::filesystem::path& file,
                        const std::vector<std::filesystem::path>& search_folders) {
  XMLDocument document;
  load_document(document, file);
  const XMLElement* sdf = document.FirstChildElement("sdf");
  const XMLElement* world = sdf ? sdf->FirstChildElement("world") : nullptr;
  if (world == nullptr) {
    throw ConfigError(fmt::format("SDF file '{}' has no <world>", file.string()));
  }
  SdfWorld result;
  result.origin = read_place_on_earth(*world, file);
  const ModelSource source{file, file.parent_path(), search_folders};
  const std::map<std::string, Pose> saved = read_saved_poses(*world, file);
  std::map<std::string, int> count_of_model;
  for (const XMLElement* element = world->FirstChildElement(); element != nullptr;
       element = element->NextSiblingElement()) {
    const std::string kind = element->Name();
    if (kind != "include" && kind != "model") continue;
    SdfInclude include;
    include.line = element->GetLineNum();
    if (kind == "include") {
      include.uri = child_text(*element, "uri");
      include.model = model_of(include.uri);
      include.name = child_text(*element, "name");
    } else {
      const char* name = element->Attribute("name");
      include.model = include.name = name != nullptr ? name : "model";
      include.written_out = read_links(*element, Pose{}, source);
    }
    const int number = count_of_model[include.model]++;
    if (include.name.empty()) include.name = fmt::format("{}_{}", include.model, number);
    const auto known = saved.find(include.name);
    include.X_WM = known != saved.end() ? known->second : read_pose(*element, file);
    result.includes.push_back(std::move(include));
  }
  // The file's axes may be rotated against east and north.
  if (result.origin) {
    Pose X_W;
    X_W.q = quaternion_from_rpy({0.0, 0.0, result.origin->heading_rad});
    for (SdfInclude& include : result.includes) include.X_WM = X_W * include.X_WM;
  }
  return result;
}

std::optional<std::filesystem::path> find_sdf_model(
    const SdfInclude& include, const std::filesystem::path& world_folder,
    const std::vector<std::filesystem::path>& search_folders) {
  std::vector<std::filesystem::path> places;
  const auto [scheme, rest] = split_scheme(include.uri);
  if (!names_a_model(scheme)) places.push_back(world_folder / rest);
  for (const std::filesystem::path& folder : search_folders) {
    places.push_back(folder / include.model);
  }
  for (const std::filesystem::path& place : places) {
    std::error_code error;
    if (std::filesystem::is_regular_file(place / "model.sdf", error)) return place;
  }
  return std::nullopt;
}

SdfModel read_sdf_model(const std::filesystem::path& model_folder,
                        const std::vector<std::filesystem::path>& search_folders) {
  const std::filesystem::path file = model_folder / "model.sdf";
  XMLDocument document;
  load_document(document, file);
  const XMLElement* sdf = document.FirstChildElement("sdf");
  const XMLElement* model = sdf ? sdf->FirstChildElement("model") : nullptr;
  if (model == nullptr) {
    throw ConfigError(fmt::format("SDF file '{}' has no <model>", file.string()));
  }
  return read_links(*model, read_pose(*model, file), {file, model_folder, search_folders});
}

}  // namespace vinerow::io
