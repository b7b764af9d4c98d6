#include "worlds/mesh/mesh_params.h"

#include "engine/api/parameter_table.h"
#include "worlds/parts/label_choices.h"

namespace vinerow::worlds {
namespace {

const ParameterTable<MeshItem>& mesh_item_table() {
  using P = MeshItem;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .path("file", &P::file, "mesh file: OBJ, STL, DAE, glTF, GLB or PLY")
          .required()
          .text("name", &P::name, "name of the object; default: the file's name")
          .number(
              "x_m", "m", [](P& p) -> double& { return p.p_WM.x(); }, between(-1e5, 1e5),
              "position east")
          .number(
              "y_m", "m", [](P& p) -> double& { return p.p_WM.y(); }, between(-1e5, 1e5),
              "position north")
          .number(
              "z_m", "m", [](P& p) -> double& { return p.p_WM.z(); }, between(-1e4, 1e4),
              "position up")
          .degrees("roll_deg", inside(&P::rpy, &RollPitchYaw::roll_rad), between(-360.0, 360.0),
                   "turn about x, first")
          .degrees("pitch_deg", inside(&P::rpy, &RollPitchYaw::pitch_rad), between(-360.0, 360.0),
                   "turn about y, second")
          .degrees("yaw_deg", inside(&P::rpy, &RollPitchYaw::yaw_rad), between(-360.0, 360.0),
                   "turn about z, third")
          .number("scale", "", &P::scale, between(1e-6, 1e6), "factor on all axes")
          .choice("up_axis", &P::up_axis,
                  {{"auto", io::UpAxis::kAuto}, {"y", io::UpAxis::kY}, {"z", io::UpAxis::kZ}},
                  "axis of the file that points up; auto: as in the file, else z")
          .number("unit_m", "m", &P::unit_m, between(1e-6, 1e6),
                  "metres per unit of the file; default: as in the file, else 1")
          .choice("surface", &P::surface,
                  {{"terrain", SurfaceClass::kTerrain},
                   {"canopy", SurfaceClass::kCanopy},
                   {"post", SurfaceClass::kPost},
                   {"trunk", SurfaceClass::kTrunk},
                   {"wire", SurfaceClass::kWire},
                   {"obstacle", SurfaceClass::kObstacle}},
                  "kind of object; absent: terrain if it is under the whole world, else obstacle")
          .choice("label", &P::label, kLabelChoices, "what cameras call it; absent: by its surface")
          .number("leaf_area_density_m2pm3", "m2/m3", &P::leaf_area_density_m2pm3,
                  between(0.0, 100.0),
                  "with surface: canopy, leaf area (one side) in its closed meshes; absent: not "
                  "known")
          .boolean("collides", &P::collides, "true: vehicles and rays collide with it")
          .boolean("visible", &P::visible, "true: pictures show it")
          .rule([](const P& p) -> std::string {
            if (!p.leaf_area_density_m2pm3 || p.surface == SurfaceClass::kCanopy) return "";
            return "leaf_area_density_m2pm3 is only for surface: canopy";
          });
  return table;
}

}  // namespace

const ParameterTable<MeshWorldParams>& mesh_world_table() {
  using P = MeshWorldParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .groups("items", &P::items, mesh_item_table(), "mesh files with their poses")
          .path("sdf_file", &P::sdf_file, "SDF world whose includes are read for models and poses")
          .texts("model_folders", &P::model_folders,
                 "folders with SDF models, absolute or beside sdf_file; default: ../models of "
                 "sdf_file")
          .text("vine_model", &P::vine_model, "prefix of the models that are pieces of vine rows")
          .number("vine_piece_length_m", "m", &P::vine_piece_length_m, between(0.1, 5000.0),
                  "length of one such piece along its x axis")
          .choice("ground", &P::ground,
                  {{"auto", MeshGround::kAuto},
                   {"none", MeshGround::kNone},
                   {"flat", MeshGround::kFlat}},
                  "flat height field under everything; auto: if no mesh is terrain")
          .number("ground_margin_m", "m", &P::ground_margin_m, between(0.0, 500.0),
                  "width of the flat ground around the objects")
          .number("vine_spacing_m", "m", &P::vine_spacing_m, between(0.1, 100.0),
                  "distance between vines of a placeholder row")
          .include(&P::terrain, terrain_table())
          .include(&P::planting, planting_table())
          .include(&P::origin, origin_table())
          .reword("origin_latitude_deg",
                  "WGS84 latitude of the world's origin; latitude and longitude 0: as in "
                  "<spherical_coordinates> of sdf_file")
          .include(&P::surroundings, surroundings_table())
          .include(&P::map, mapping::map_table());
  return table;
}

}  // namespace vinerow::worlds
