#include "engine/record/ros_definitions.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "engine/core/check.h"

namespace vinerow::record {
namespace {

struct Definition {
  std::string_view type;  ///< "package/Type"
  std::string_view text;
};

// Fields and constants as in ROS 2 Humble; comments are ours. In Iron and Jazzy only Range differs,
// which ends with a variance: a live run adds it (engine/live/ros2_topics.cpp).
constexpr std::array kDefinitions = {
    Definition{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    Definition{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    Definition{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    Definition{"geometry_msgs/Pose",
               "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    Definition{"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    Definition{"geometry_msgs/PoseWithCovariance",
               "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    Definition{"geometry_msgs/Twist",
               "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    Definition{"geometry_msgs/TwistStamped", "std_msgs/Header header\ngeometry_msgs/Twist twist\n"},
    Definition{"geometry_msgs/TwistWithCovariance",
               "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    Definition{"geometry_msgs/Transform",
               "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    Definition{"geometry_msgs/TransformStamped",
               "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform "
               "transform\n"},
    Definition{"nav_msgs/Odometry",
               "std_msgs/Header header\nstring child_frame_id\n"
               "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance "
               "twist\n"},
    Definition{"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    Definition{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    Definition{"sensor_msgs/Imu",
               "std_msgs/Header header\n"
               "# first covariance -1: there is no orientation\n"
               "geometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
               "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
               "geometry_msgs/Vector3 linear_acceleration\n"
               "float64[9] linear_acceleration_covariance\n"},
    Definition{"sensor_msgs/NavSatStatus",
               "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\n"
               "int8 STATUS_GBAS_FIX=2\nint8 status\n"
               "uint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\n"
               "uint16 SERVICE_GALILEO=8\nuint16 service\n"},
    Definition{"sensor_msgs/NavSatFix",
               "std_msgs/Header header\nsensor_msgs/NavSatStatus status\n"
               "# degrees, degrees, metres above the ellipsoid\n"
               "float64 latitude\nfloat64 longitude\nfloat64 altitude\n"
               "# m^2, east north up\n"
               "float64[9] position_covariance\n"
               "uint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 COVARIANCE_TYPE_APPROXIMATED=1\n"
               "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 COVARIANCE_TYPE_KNOWN=3\n"
               "uint8 position_covariance_type\n"},
    Definition{"sensor_msgs/FluidPressure",
               "std_msgs/Header header\n# Pa\nfloat64 fluid_pressure\n# Pa^2\n"
               "float64 variance\n"},
    Definition{"sensor_msgs/MagneticField",
               "std_msgs/Header header\n# T\ngeometry_msgs/Vector3 magnetic_field\n"
               "float64[9] magnetic_field_covariance\n"},
    Definition{"sensor_msgs/LaserScan",
               "std_msgs/Header header\n# rad\nfloat32 angle_min\nfloat32 angle_max\n"
               "float32 angle_increment\n# s\nfloat32 time_increment\nfloat32 scan_time\n"
               "# m\nfloat32 range_min\nfloat32 range_max\n# +inf: nothing seen\n"
               "float32[] ranges\nfloat32[] intensities\n"},
    Definition{"sensor_msgs/PointField",
               "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\n"
               "uint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\n"
               "string name\n# bytes from the start of a point\nuint32 offset\nuint8 datatype\n"
               "uint32 count\n"},
    Definition{"sensor_msgs/PointCloud2",
               "std_msgs/Header header\nuint32 height\nuint32 width\n"
               "sensor_msgs/PointField[] fields\nbool is_bigendian\n# bytes of a point\n"
               "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    Definition{"sensor_msgs/CompressedImage",
               "std_msgs/Header header\n# \"rgb8; png compressed bgr8\" and the like\n"
               "string format\nuint8[] data\n"},
    Definition{"sensor_msgs/RegionOfInterest",
               "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\n"
               "bool do_rectify\n"},
    Definition{"sensor_msgs/CameraInfo",
               "std_msgs/Header header\nuint32 height\nuint32 width\n"
               "# plumb_bob: k1, k2, p1, p2, k3; equidistant: k1, k2, k3, k4\n"
               "string distortion_model\nfloat64[] d\nfloat64[9] k\nfloat64[9] r\n"
               "float64[12] p\nuint32 binning_x\nuint32 binning_y\n"
               "sensor_msgs/RegionOfInterest roi\n"},
    Definition{"geometry_msgs/PoseWithCovarianceStamped",
               "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    Definition{"sensor_msgs/Range",
               "std_msgs/Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\n"
               "uint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\n"
               "float32 max_range\n# +inf: nothing seen\nfloat32 range\n"},
    Definition{"sensor_msgs/BatteryState",
               "uint8 POWER_SUPPLY_STATUS_UNKNOWN=0\nuint8 POWER_SUPPLY_STATUS_CHARGING=1\n"
               "uint8 POWER_SUPPLY_STATUS_DISCHARGING=2\n"
               "uint8 POWER_SUPPLY_STATUS_NOT_CHARGING=3\nuint8 POWER_SUPPLY_STATUS_FULL=4\n"
               "uint8 POWER_SUPPLY_HEALTH_UNKNOWN=0\nuint8 POWER_SUPPLY_HEALTH_GOOD=1\n"
               "uint8 POWER_SUPPLY_HEALTH_OVERHEAT=2\nuint8 POWER_SUPPLY_HEALTH_DEAD=3\n"
               "uint8 POWER_SUPPLY_HEALTH_OVERVOLTAGE=4\n"
               "uint8 POWER_SUPPLY_HEALTH_UNSPEC_FAILURE=5\nuint8 POWER_SUPPLY_HEALTH_COLD=6\n"
               "uint8 POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE=7\n"
               "uint8 POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE=8\n"
               "uint8 POWER_SUPPLY_TECHNOLOGY_UNKNOWN=0\nuint8 POWER_SUPPLY_TECHNOLOGY_NIMH=1\n"
               "uint8 POWER_SUPPLY_TECHNOLOGY_LION=2\nuint8 POWER_SUPPLY_TECHNOLOGY_LIPO=3\n"
               "uint8 POWER_SUPPLY_TECHNOLOGY_LIFE=4\nuint8 POWER_SUPPLY_TECHNOLOGY_NICD=5\n"
               "uint8 POWER_SUPPLY_TECHNOLOGY_LIMN=6\n"
               "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\n"
               "float32 charge\nfloat32 capacity\nfloat32 design_capacity\nfloat32 percentage\n"
               "uint8 power_supply_status\nuint8 power_supply_health\n"
               "uint8 power_supply_technology\nbool present\nfloat32[] cell_voltage\n"
               "float32[] cell_temperature\nstring location\nstring serial_number\n"},
    Definition{"rcl_interfaces/Log",
               "byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\nbyte FATAL=50\n"
               "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\n"
               "string file\nstring function\nuint32 line\n"},
    Definition{"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    Definition{"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    Definition{"sensor_msgs/CompressedImage",
               "std_msgs/Header header\nstring format\nuint8[] data\n"},
    Definition{"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
    Definition{"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    Definition{"visualization_msgs/Marker",
               "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\n"
               "int32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 CUBE_LIST=6\n"
               "int32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\n"
               "int32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\n"
               "int32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
               "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
               "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\n"
               "std_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\n"
               "bool frame_locked\ngeometry_msgs/Point[] points\n"
               "std_msgs/ColorRGBA[] colors\nstring texture_resource\n"
               "sensor_msgs/CompressedImage texture\n"
               "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n"
               "string mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
               "bool mesh_use_embedded_materials\n"},
    Definition{"nav_msgs/MapMetaData",
               "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\n"
               "uint32 height\ngeometry_msgs/Pose origin\n"},
    Definition{"nav_msgs/OccupancyGrid",
               "std_msgs/Header header\nnav_msgs/MapMetaData info\n"
               "# 100 taken, 0 free; x fastest\nint8[] data\n"},
    Definition{"trajectory_msgs/MultiDOFJointTrajectory",
               "std_msgs/Header header\nstring[] joint_names\n"
               "trajectory_msgs/MultiDOFJointTrajectoryPoint[] points\n"},
    Definition{"trajectory_msgs/MultiDOFJointTrajectoryPoint",
               "# one of each per joint, in header.frame_id\n"
               "geometry_msgs/Transform[] transforms\ngeometry_msgs/Twist[] velocities\n"
               "geometry_msgs/Twist[] accelerations\n"
               "builtin_interfaces/Duration time_from_start\n"},
    // Foxglove's own messages, package foxglove_msgs.
    Definition{"foxglove_msgs/Color", "float64 r\nfloat64 g\nfloat64 b\nfloat64 a\n"},
    Definition{"foxglove_msgs/KeyValuePair", "string key\nstring value\n"},
    Definition{"foxglove_msgs/ArrowPrimitive",
               "geometry_msgs/Pose pose\nfloat64 shaft_length\nfloat64 shaft_diameter\n"
               "float64 head_length\nfloat64 head_diameter\nfoxglove_msgs/Color color\n"},
    Definition{"foxglove_msgs/CubePrimitive",
               "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfoxglove_msgs/Color color\n"},
    Definition{"foxglove_msgs/SpherePrimitive",
               "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfoxglove_msgs/Color color\n"},
    Definition{"foxglove_msgs/CylinderPrimitive",
               "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfloat64 bottom_scale\n"
               "float64 top_scale\nfoxglove_msgs/Color color\n"},
    Definition{"foxglove_msgs/LinePrimitive",
               "uint8 LINE_STRIP=0\nuint8 LINE_LOOP=1\nuint8 LINE_LIST=2\nuint8 type\n"
               "geometry_msgs/Pose pose\nfloat64 thickness\nbool scale_invariant\n"
               "geometry_msgs/Point[] points\nfoxglove_msgs/Color color\n"
               "foxglove_msgs/Color[] colors\nuint32[] indices\n"},
    Definition{"foxglove_msgs/TriangleListPrimitive",
               "geometry_msgs/Pose pose\ngeometry_msgs/Point[] points\n"
               "foxglove_msgs/Color color\nfoxglove_msgs/Color[] colors\nuint32[] indices\n"},
    Definition{"foxglove_msgs/TextPrimitive",
               "geometry_msgs/Pose pose\nbool billboard\nfloat64 font_size\n"
               "bool scale_invariant\nfoxglove_msgs/Color color\nstring text\n"},
    Definition{"foxglove_msgs/ModelPrimitive",
               "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\n"
               "foxglove_msgs/Color color\nbool override_color\nstring url\n"
               "string media_type\nuint8[] data\n"},
    Definition{"foxglove_msgs/SceneEntityDeletion",
               "builtin_interfaces/Time timestamp\nuint8 MATCHING_ID=0\nuint8 ALL=1\n"
               "uint8 type\nstring id\n"},
    Definition{"foxglove_msgs/SceneEntity",
               "builtin_interfaces/Time timestamp\nstring frame_id\nstring id\n"
               "builtin_interfaces/Duration lifetime\nbool frame_locked\n"
               "foxglove_msgs/KeyValuePair[] metadata\nfoxglove_msgs/ArrowPrimitive[] arrows\n"
               "foxglove_msgs/CubePrimitive[] cubes\nfoxglove_msgs/SpherePrimitive[] spheres\n"
               "foxglove_msgs/CylinderPrimitive[] cylinders\n"
               "foxglove_msgs/LinePrimitive[] lines\n"
               "foxglove_msgs/TriangleListPrimitive[] triangles\n"
               "foxglove_msgs/TextPrimitive[] texts\nfoxglove_msgs/ModelPrimitive[] models\n"},
    Definition{"foxglove_msgs/SceneUpdate",
               "foxglove_msgs/SceneEntityDeletion[] deletions\n"
               "foxglove_msgs/SceneEntity[] entities\n"},
    Definition{"geometry_msgs/Vector3Stamped",
               "std_msgs/Header header\ngeometry_msgs/Vector3 vector\n"},
    // Commands and services of live runs.
    Definition{"geometry_msgs/Accel",
               "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    Definition{"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
    Definition{"sensor_msgs/JointState",
               "std_msgs/Header header\nstring[] name\n# rad or m, rad/s or m/s, Nm or N\n"
               "float64[] position\nfloat64[] velocity\nfloat64[] effort\n"},
    Definition{"simulation_interfaces/Result",
               "uint8 RESULT_FEATURE_UNSUPPORTED=0\nuint8 RESULT_OK=1\n"
               "uint8 RESULT_NOT_FOUND=2\nuint8 RESULT_INCORRECT_STATE=3\n"
               "uint8 RESULT_OPERATION_FAILED=4\nuint8 result\nstring error_message\n"},
    Definition{"simulation_interfaces/SimulationState",
               "uint8 STATE_STOPPED=0\nuint8 STATE_PLAYING=1\nuint8 STATE_PAUSED=2\n"
               "uint8 STATE_QUITTING=3\nuint8 state\n"},
    Definition{"simulation_interfaces/SimulatorFeatures",
               "uint8 ENTITY_STATE_GETTING=10\nuint8 SIMULATION_RESET=20\n"
               "uint8 SIMULATION_RESET_TIME=21\nuint8 SIMULATION_RESET_STATE=22\n"
               "uint8 SIMULATION_STATE_GETTING=24\nuint8 SIMULATION_STATE_SETTING=25\n"
               "uint8 SIMULATION_STATE_PAUSE=26\nuint8 STEP_SIMULATION_SINGLE=31\n"
               "uint8 STEP_SIMULATION_MULTIPLE=32\nuint16[] features\nstring[] spawn_formats\n"
               "string custom_info\n"},
    Definition{"simulation_interfaces/EntityCategory",
               "uint8 CATEGORY_OBJECT=0\nuint8 CATEGORY_ROBOT=1\nuint8 category\n"},
    Definition{"simulation_interfaces/TagsFilter",
               "string[] tags\nuint8 FILTER_MODE_ANY=0\nuint8 FILTER_MODE_ALL=1\n"
               "uint8 filter_mode\n"},
    Definition{"simulation_interfaces/Bounds",
               "uint8 TYPE_EMPTY=0\nuint8 TYPE_BOX=1\nuint8 TYPE_CONVEX_HULL=2\n"
               "uint8 TYPE_SPHERE=3\nuint8 type\ngeometry_msgs/Vector3[] points\n"},
    Definition{"simulation_interfaces/EntityFilters",
               "string filter\nsimulation_interfaces/EntityCategory[] categories\n"
               "simulation_interfaces/TagsFilter tags\nsimulation_interfaces/Bounds bounds\n"},
    Definition{"simulation_interfaces/EntityState",
               "std_msgs/Header header\ngeometry_msgs/Pose pose\ngeometry_msgs/Twist twist\n"
               "geometry_msgs/Accel acceleration\n"},
};

std::string_view find_text(std::string_view type, std::span<const RosDefinition> inside) {
  for (const RosDefinition& definition : inside) {
    if (definition.type == type) return definition.text;
  }
  const auto found = std::find_if(kDefinitions.begin(), kDefinitions.end(),
                                  [&](const Definition& d) { return d.type == type; });
  VINEROW_DEMAND(found != kDefinitions.end());
  return found->text;
}

/// Adds the types of other packages in a text, in order: the words with a '/' at line starts.
void add_used_types(std::string_view text, std::vector<std::string_view>& types) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    std::string_view word = line.substr(0, line.find_first_of(" ["));
    if (line.starts_with('#') || word.find('/') == std::string_view::npos) continue;
    if (std::find(types.begin(), types.end(), word) == types.end()) types.push_back(word);
  }
}

}  // namespace

std::string full_ros_definition(std::string_view text, std::span<const RosDefinition> inside) {
  std::vector<std::string_view> types;
  add_used_types(text, types);
  std::string full(text);
  for (std::size_t i = 0; i < types.size(); ++i) {
    const std::string_view used = find_text(types[i], inside);
    full.append(80, '=').append("\nMSG: ").append(types[i]).append("\n").append(used);
    add_used_types(used, types);
  }
  return full;
}

std::string full_ros_definition(std::string_view type) {
  // "nav_msgs/msg/Odometry" -> "nav_msgs/Odometry"
  const std::size_t middle = type.find("/msg/");
  VINEROW_DEMAND(middle != std::string_view::npos);
  const std::string short_type =
      std::string(type.substr(0, middle)) + std::string(type.substr(middle + 4));
  return full_ros_definition(find_text(short_type, {}), {});
}

}  // namespace vinerow::record
