#include "engine/io/robots/urdf_writer.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <set>

namespace vinerow::io {
namespace {

void push_link(const std::string& name, const std::string& mesh_url, tinyxml2::XMLPrinter& xml) {
  xml.OpenElement("link");
  xml.PushAttribute("name", name.c_str());
  if (!mesh_url.empty()) {
    xml.OpenElement("visual");
    xml.OpenElement("geometry");
    xml.OpenElement("mesh");
    xml.PushAttribute("filename", mesh_url.c_str());
    for (int i = 0; i < 3; ++i) xml.CloseElement();
  }
  xml.CloseElement();
}

void push_joint(const std::string& root, const DrawnLink& link, tinyxml2::XMLPrinter& xml) {
  const auto push_end = [&](const char* end, const std::string& name) {
    xml.OpenElement(end);
    xml.PushAttribute("link", name.c_str());
    xml.CloseElement();
  };
  xml.OpenElement("joint");
  xml.PushAttribute("name", (link.name + "_joint").c_str());
  xml.PushAttribute("type", "floating");
  push_end("parent", root);
  push_end("child", link.name);
  const RollPitchYaw rpy = rpy_from_quaternion(link.X_RL.q);
  const Eigen::Vector3d& p = link.X_RL.p;
  xml.OpenElement("origin");
  xml.PushAttribute("xyz", fmt::format("{:.9f} {:.9f} {:.9f}", p.x(), p.y(), p.z()).c_str());
  xml.PushAttribute(
      "rpy", fmt::format("{:.9f} {:.9f} {:.9f}", rpy.roll_rad, rpy.pitch_rad, rpy.yaw_rad).c_str());
  xml.CloseElement();
  xml.CloseElement();
}

}  // namespace

std::string urdf_text(const std::string& robot, const std::string& root,
                      std::span<const DrawnLink> links) {
  std::set<std::string> names = {root};
  std::string root_mesh;
  for (const DrawnLink& link : links) {
    if (link.name == root && root_mesh.empty()) root_mesh = link.mesh_url;
  }
  tinyxml2::XMLPrinter xml;
  xml.PushHeader(false, true);
  xml.OpenElement("robot");
  xml.PushAttribute("name", robot.c_str());
  push_link(root, root_mesh, xml);
  for (const DrawnLink& link : links) {
    if (!names.insert(link.name).second) continue;
    push_link(link.name, link.mesh_url, xml);
    push_joint(root, link, xml);
  }
  xml.CloseElement();
  return xml.CStr();
}

}  // namespace vinerow::io
