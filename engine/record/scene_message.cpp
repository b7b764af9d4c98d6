#include "engine/record/scene_message.h"

#include <span>

#include "engine/record/ros_fields.h"

namespace vinerow::record {
namespace {

void write_triangles(CdrWriter& out, const SceneTriangles& triangles) {
  write_pose(out, Pose{});
  out.add_count(triangles.points.size());
  out.add(std::span(triangles.points));
  out.add_doubles(triangles.colour.data(), triangles.colour.size());
  out.add_count(0);  // colors: one colour for all
  out.add_count(triangles.indices.size());
  out.add_numbers(triangles.indices.data(), triangles.indices.size(), sizeof(std::uint32_t));
}

}  // namespace

void write_static_transforms(CdrWriter& out, const std::vector<StaticTransform>& transforms) {
  out.add_count(transforms.size());
  for (const StaticTransform& transform : transforms) {
    write_header(out, Time{}, transform.parent);
    out.add(std::string_view(transform.child));
    write_pose(out, transform.X_PC);
  }
}

void write_scene(CdrWriter& out, const std::vector<SceneEntity>& entities) {
  out.add_count(0);  // deletions
  out.add_count(entities.size());
  for (const SceneEntity& entity : entities) {
    write_time(out, Time{});
    out.add(std::string_view(entity.frame));
    out.add(std::string_view(entity.id));
    write_time(out, Time{});  // lifetime: until the end
    out.add(true);            // frame_locked
    // metadata, arrows, cubes, spheres, cylinders, lines
    for (int i = 0; i < 6; ++i) out.add_count(0);
    out.add_count(entity.triangles.size());
    for (const SceneTriangles& triangles : entity.triangles) write_triangles(out, triangles);
    out.add_count(0);  // texts
    out.add_count(0);  // models
  }
}

}  // namespace vinerow::record
