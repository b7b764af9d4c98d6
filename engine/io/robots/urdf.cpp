#include "engine/io/robots/urdf.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <tinyxml2.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/program.h"
#include "engine/core/suggest.h"

namespace vinerow::io {
namespace {

using Packages = std::map<std::string, std::filesystem::path>;

/// Output handler that keeps the parser's messages instead of printing them.
class ComplaintCatcher final : public console_bridge::OutputHandler {
 public:
  ComplaintCatcher() : before_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~ComplaintCatcher() override { console_bridge::useOutputHandler(before_); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) texts_.push_back(text);
  }
  const std::vector<std::string>& texts() const { return texts_; }
  std::string first() const { return texts_.empty() ? "no reason given" : texts_.front(); }

 private:
  console_bridge::OutputHandler* before_;
  std::vector<std::string> texts_;
};

std::string read_urdf_text(const std::filesystem::path& file) {
  std::optional<std::string> text = read_bytes(file);
  if (!text) {
    throw ConfigError(
        fmt::format("URDF file '{}' does not exist or cannot be read", file.string()));
  }
  return std::move(*text);
}

/// `$(optenv NAME some default)` -> `some default`.
std::string replace_optenv(const std::string& text, std::vector<std::string>& notes) {
  constexpr std::string_view kOpen = "$(optenv ";
  std::string result;
  std::size_t at = 0;
  while (true) {
    const std::size_t open = text.find(kOpen, at);
    const std::size_t close = open == std::string::npos ? open : text.find(')', open);
    if (close == std::string::npos) return result + text.substr(at);
    const std::string inside = text.substr(open + kOpen.size(), close - open - kOpen.size());
    const std::size_t space = inside.find(' ');
    const std::string value = space == std::string::npos ? "" : inside.substr(space + 1);
    notes.push_back(
        fmt::format("$(optenv {}) was replaced by '{}'", inside.substr(0, space), value));
    result += text.substr(at, open - at) + value;
    at = close + 1;
  }
}

/// True if there are xacro elements, such as <xacro:include>, which a URDF reader would ignore.
bool has_xacro_element(const tinyxml2::XMLElement& element) {
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (std::string_view(child->Name()).starts_with("xacro:") || has_xacro_element(*child)) {
      return true;
    }
  }
  return false;
}

/// True if the text is well-formed XML that needs xacro to become a URDF.
bool is_xacro(const std::string& text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return false;
  const tinyxml2::XMLElement* root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "robot") return false;
  return text.find("${") != std::string::npos || has_xacro_element(*root);
}

/// @throws ConfigError if xacro is not installed or rejects the file, with its reason
std::string expand_xacro(const std::filesystem::path& file, std::vector<std::string>& notes) {
  if (!has_program("xacro")) {
    throw ConfigError(fmt::format(
        "{0}: a xacro source, not a URDF, and xacro is not installed; expand it elsewhere: xacro "
        "{0} > robot.urdf",
        file.string()));
  }
  // An absolute path cannot be mistaken for an option.
  const ProgramOutput expanded = run_program({"xacro", std::filesystem::absolute(file).string()});
  if (!expanded.succeeded) {
    throw ConfigError(fmt::format("{}: xacro cannot expand it: {}", file.string(),
                                  expanded.complaint.substr(0, 300)));
  }
  notes.push_back("expanded by xacro");
  return expanded.output;
}

/// liburdfdom 3 passes its messages, which quote values and names, as printf formats: a '%' in them
/// would read and write foreign memory. Names of files are not quoted that way.
void check_percent(const tinyxml2::XMLElement& element, const std::string& file) {
  for (const auto* attribute = element.FirstAttribute(); attribute != nullptr;
       attribute = attribute->Next()) {
    const std::string_view value = attribute->Value();
    if (value.find('%') == std::string_view::npos) continue;
    if (std::string_view(attribute->Name()) == "filename") continue;
    throw ConfigError(fmt::format(
        "{}:{}: {}=\"{}\" of <{}>: a '%' is allowed in names of files only", file,
        attribute->GetLineNum(), attribute->Name(), value.substr(0, 60), element.Name()));
  }
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    check_percent(*child, file);
  }
}

/// Checks the XML, and removes a second definition of a material, for which liburdfdom would reject
/// the whole file. @returns the text to parse
std::string check_xml(const std::string& text, const std::string& file,
                      std::vector<std::string>& notes) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw ConfigError(fmt::format("{}:{}: not well-formed XML ({})", file, document.ErrorLineNum(),
                                  tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  if (root == nullptr || std::string(root->Name()) != "robot") {
    throw ConfigError(
        fmt::format("{}:1: not a URDF: the outermost element is <{}>, must be <robot>", file,
                    root ? root->Name() : ""));
  }
  check_percent(*root, file);

  std::set<std::string> materials;
  const std::size_t notes_before = notes.size();
  tinyxml2::XMLElement* material = document.RootElement()->FirstChildElement("material");
  while (material != nullptr) {
    tinyxml2::XMLElement* next = material->NextSiblingElement("material");
    const char* name = material->Attribute("name");
    if (name != nullptr && !materials.insert(name).second) {
      notes.push_back(
          fmt::format("material '{}' is defined again; the first definition is used", name));
      document.DeleteNode(material);
    }
    material = next;
  }
  if (notes.size() == notes_before) return text;
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

std::filesystem::path resolve_mesh(const std::string& name, const std::filesystem::path& urdf,
                                   const Packages& packages, const std::string& link) {
  constexpr std::string_view kPackage = "package://", kFile = "file://";
  std::filesystem::path path;
  if (name.starts_with(kPackage)) {
    const std::string rest = name.substr(kPackage.size());
    const std::string package = rest.substr(0, rest.find('/'));
    const std::string inside = rest.size() > package.size() ? rest.substr(package.size() + 1) : "";
    if (const auto found = packages.find(package); found != packages.end()) {
      path = found->second / inside;
    } else {
      for (auto folder = urdf.parent_path(); folder.has_relative_path() && path.empty();
           folder = folder.parent_path()) {
        if (folder.filename() == package) path = folder / inside;
      }
      if (path.empty()) {
        throw ConfigError(fmt::format(
            "{}: link '{}' uses package '{}', whose folder is not known; give it as '{}=<folder>'",
            urdf.string(), link, package, package));
      }
    }
  } else if (name.starts_with(kFile)) {
    path = name.substr(kFile.size());
  } else {
    path = urdf.parent_path() / name;
  }
  if (!std::filesystem::is_regular_file(path)) {
    throw ConfigError(
        fmt::format("{}: link '{}' uses mesh '{}', which does not exist (looked for {})",
                    urdf.string(), link, name, path.string()));
  }
  return path;
}

Eigen::Vector3d from_urdf(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

Pose pose_of(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  return {Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized(), from_urdf(pose.position)};
}

UrdfShape shape_of(const urdf::Geometry& geometry, const urdf::Pose& origin,
                   const std::filesystem::path& urdf, const Packages& packages,
                   const std::string& link) {
  UrdfShape shape;
  shape.X_LS = pose_of(origin);
  switch (geometry.type) {
    case urdf::Geometry::BOX:
      shape.kind = UrdfShapeKind::kBox;
      shape.size_m = from_urdf(static_cast<const urdf::Box&>(geometry).dim);
      break;
    case urdf::Geometry::CYLINDER:
      shape.kind = UrdfShapeKind::kCylinder;
      shape.radius_m = static_cast<const urdf::Cylinder&>(geometry).radius;
      shape.length_m = static_cast<const urdf::Cylinder&>(geometry).length;
      break;
    case urdf::Geometry::SPHERE:
      shape.kind = UrdfShapeKind::kSphere;
      shape.radius_m = static_cast<const urdf::Sphere&>(geometry).radius;
      break;
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      shape.kind = UrdfShapeKind::kMesh;
      shape.mesh_scale = from_urdf(mesh.scale);
      shape.mesh_file = resolve_mesh(mesh.filename, urdf, packages, link);
      break;
    }
  }
  return shape;
}

UrdfLink link_of(const urdf::Link& source, const std::filesystem::path& file,
                 const Packages& packages) {
  UrdfLink link;
  link.name = source.name;
  if (const auto& inertial = source.inertial) {
    const Pose X_LI = pose_of(inertial->origin);
    Eigen::Matrix3d inertia_I;
    inertia_I << inertial->ixx, inertial->ixy, inertial->ixz,  //
        inertial->ixy, inertial->iyy, inertial->iyz,           //
        inertial->ixz, inertial->iyz, inertial->izz;
    const Eigen::Matrix3d R_LI = X_LI.q.toRotationMatrix();
    link.mass_kg = inertial->mass;
    link.com_L = X_LI.p;
    link.inertia_L = R_LI * inertia_I * R_LI.transpose();
    if (!(link.mass_kg >= 0.0) || !link.inertia_L.allFinite()) {
      throw ConfigError(
          fmt::format("{}: link '{}': mass = {} kg, must be >= 0, and its inertia must be finite",
                      file.string(), link.name, link.mass_kg));
    }
  }
  for (const auto& visual : source.visual_array) {
    if (!visual->geometry) continue;
    link.visuals.push_back(shape_of(*visual->geometry, visual->origin, file, packages, link.name));
    if (const auto& material = visual->material; material && !material->name.empty()) {
      link.visuals.back().colour = {material->color.r, material->color.g, material->color.b};
    }
  }
  for (const auto& collision : source.collision_array) {
    if (!collision->geometry) continue;
    link.collisions.push_back(
        shape_of(*collision->geometry, collision->origin, file, packages, link.name));
  }
  return link;
}

UrdfJointKind kind_of(int type) {
  switch (type) {
    case urdf::Joint::CONTINUOUS:
      return UrdfJointKind::kContinuous;
    case urdf::Joint::REVOLUTE:
      return UrdfJointKind::kRevolute;
    case urdf::Joint::PRISMATIC:
      return UrdfJointKind::kPrismatic;
    case urdf::Joint::FLOATING:
      return UrdfJointKind::kFloating;
    case urdf::Joint::PLANAR:
      return UrdfJointKind::kPlanar;
    default:
      return UrdfJointKind::kFixed;
  }
}

/// Depth first, children in the order of the parser's list, which is sorted by name.
void add_tree(const urdf::Link& source, int parent_joint, const Packages& packages,
              UrdfModel& model) {
  const int index = static_cast<int>(model.links.size());
  model.links.push_back(link_of(source, model.file, packages));
  model.links.back().parent_joint = parent_joint;
  if (parent_joint >= 0) model.joints[static_cast<std::size_t>(parent_joint)].child_link = index;
  for (const auto& child : source.child_links) {
    const urdf::Joint& source_joint = *child->parent_joint;
    UrdfJoint joint;
    joint.name = source_joint.name;
    joint.kind = kind_of(source_joint.type);
    joint.parent_link = index;
    joint.X_PJ = pose_of(source_joint.parent_to_joint_origin_transform);
    const Eigen::Vector3d axis = from_urdf(source_joint.axis);
    if (axis.norm() > 1e-9) joint.axis_J = axis.normalized();
    if (const auto& limits = source_joint.limits) {
      joint.limits = {limits->lower, limits->upper, limits->velocity};
    }
    model.joints.push_back(joint);
    add_tree(*child, static_cast<int>(model.joints.size()) - 1, packages, model);
  }
}

/// liburdfdom leaves out an element with a number that it cannot read, and returns the rest. The
/// looks of a robot may lack it; its masses and shapes may not. The complaint about an element
/// follows those about its parts.
void judge_complaints(const std::vector<std::string>& texts, const std::string& file,
                      std::vector<std::string>& notes) {
  std::vector<std::string> about_one;
  for (const std::string& text : texts) {
    about_one.push_back(text);
    if (!text.starts_with("Could not parse visual element")) continue;
    notes.push_back(join(about_one, ": "));
    about_one.clear();
  }
  if (about_one.empty()) return;
  throw ConfigError(fmt::format("{}: not a URDF ({})", file, join(about_one, ": ")));
}

}  // namespace

UrdfModel load_urdf(const std::filesystem::path& file, const Packages& packages) {
  UrdfModel model;
  model.file = std::filesystem::absolute(file);
  std::string source = read_urdf_text(file);
  if (is_xacro(source)) source = expand_xacro(file, model.notes);
  const std::string text =
      check_xml(replace_optenv(source, model.notes), file.string(), model.notes);

  urdf::ModelInterfaceSharedPtr parsed;
  ComplaintCatcher complaints;
  try {
    parsed = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    throw ConfigError(fmt::format("{}: not a URDF ({})", file.string(), error.what()));
  }
  if (!parsed || !parsed->getRoot()) {
    throw ConfigError(fmt::format("{}: not a URDF ({})", file.string(), complaints.first()));
  }
  judge_complaints(complaints.texts(), file.string(), model.notes);
  model.name = parsed->getName();
  add_tree(*parsed->getRoot(), -1, packages, model);
  return model;
}

}  // namespace vinerow::io
