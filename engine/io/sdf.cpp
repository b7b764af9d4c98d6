#include "engine/io/sdf.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <cmath>
#include <map>
#include <sstream>

#include "engine/core/error.h"

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
  // operator>> does not read "nan": such text stops the reading and is refused below.
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

/// Child <pose>, identity where absent or empty.
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

/// "model://a/b" -> ("a", "b")
std::pair<std::string, std::string> split_model_uri(const std::string& uri) {
  const std::string kScheme = "model://";
  std::string rest = uri.rfind(kScheme, 0) == 0 ? uri.substr(kScheme.size()) : uri;
  const std::size_t slash = rest.find('/');
  if (slash == std::string::npos) return {rest, ""};
  return {rest.substr(0, slash), rest.substr(slash + 1)};
}

void read_geometries(const XMLElement& link, const char* kind, const Pose& X_ML,
                     const std::filesystem::path& folder, const std::filesystem::path& file,
                     std::vector<SdfMesh>& meshes) {
  for (const XMLElement* shape = link.FirstChildElement(kind); shape != nullptr;
       shape = shape->NextSiblingElement(kind)) {
    const XMLElement* geometry = shape->FirstChildElement("geometry");
    const XMLElement* mesh = geometry ? geometry->FirstChildElement("mesh") : nullptr;
    if (mesh == nullptr) continue;
    SdfMesh entry;
    entry.uri = child_text(*mesh, "uri");
    entry.file = folder / split_model_uri(entry.uri).second;
    entry.X_MG = X_ML * read_pose(*shape, file);
    if (const XMLElement* scale = mesh->FirstChildElement("scale")) {
      const std::vector<double> n = read_numbers(*scale, 3, file);
      entry.scale = {n[0], n[1], n[2]};
    }
    meshes.push_back(std::move(entry));
  }
}

}  // namespace

std::vector<SdfInclude> read_sdf_includes(const std::filesystem::path& file) {
  XMLDocument document;
  load_document(document, file);
  const XMLElement* sdf = document.FirstChildElement("sdf");
  const XMLElement* world = sdf ? sdf->FirstChildElement("world") : nullptr;
  if (world == nullptr) {
    throw ConfigError(fmt::format("SDF file '{}' has no <world>", file.string()));
  }
  std::vector<SdfInclude> includes;
  std::map<std::string, int> count_of_model;
  for (const XMLElement* element = world->FirstChildElement("include"); element != nullptr;
       element = element->NextSiblingElement("include")) {
    SdfInclude include;
    include.uri = child_text(*element, "uri");
    include.model = split_model_uri(include.uri).first;
    include.line = element->GetLineNum();
    include.name = child_text(*element, "name");
    const int number = count_of_model[include.model]++;
    if (include.name.empty()) include.name = fmt::format("{}_{}", include.model, number);
    include.X_WM = read_pose(*element, file);
    includes.push_back(std::move(include));
  }
  return includes;
}

std::optional<std::filesystem::path> find_sdf_model(
    const std::string& model, const std::vector<std::filesystem::path>& search_folders) {
  for (const std::filesystem::path& folder : search_folders) {
    std::error_code error;
    if (std::filesystem::is_regular_file(folder / model / "model.sdf", error)) {
      return folder / model;
    }
  }
  return std::nullopt;
}

std::vector<SdfMesh> read_sdf_meshes(const std::filesystem::path& model_folder) {
  const std::filesystem::path file = model_folder / "model.sdf";
  XMLDocument document;
  load_document(document, file);
  const XMLElement* sdf = document.FirstChildElement("sdf");
  const XMLElement* model = sdf ? sdf->FirstChildElement("model") : nullptr;
  if (model == nullptr) {
    throw ConfigError(fmt::format("SDF file '{}' has no <model>", file.string()));
  }
  std::vector<SdfMesh> meshes;
  for (const char* kind : {"visual", "collision"}) {
    for (const XMLElement* link = model->FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      const Pose X_ML = read_pose(*model, file) * read_pose(*link, file);
      read_geometries(*link, kind, X_ML, model_folder, file, meshes);
    }
    if (!meshes.empty()) break;
  }
  return meshes;
}

}  // namespace vinerow::io
