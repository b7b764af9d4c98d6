#include "engine/record/ros_definitions.h"

#include <algorithm>
#include <array>
#include <vector>

#include "engine/core/check.h"

namespace vinerow::record {
namespace {

struct Definition {
  std::string_view type;  ///< "package/Type"
  std::string_view text;
};

// Fields and constants as in ROS 2 Humble (the same in Iron and Jazzy); comments are ours.
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
    Definition{"geometry_msgs/PoseWithCovarianceStamped",
               "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    Definition{"vinerow_msgs/LaserScan",
               "std_msgs/Header header\n# rad, in the plane z = 0 of the sensor, from its x\n"
               "float64 first_angle\nfloat64 angle_step\n# m\nfloat64 min_range\n"
               "float64 max_range\n# +inf: nothing seen\nfloat64[] ranges\n"
               "# of the vehicle in header.frame_id, and of the sensor in the vehicle\n"
               "geometry_msgs/Pose body\ngeometry_msgs/Pose sensor\n"},
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
    Definition{"vinerow_msgs/OccupancyGrid",
               "std_msgs/Header header\n# m\nfloat64 cell\n"
               "# lower left corner of the first cell, m\nfloat64 corner_x\nfloat64 corner_y\n"
               "uint32 columns\nuint32 rows\n# 1 taken, 0 free; x fastest\nuint8[] cells\n"},
    Definition{"vinerow_msgs/LocalCommand",
               "# what a local planner wants of a vehicle with two steered axles\n"
               "uint8 FOLLOW=0\nuint8 DRIVE=1\nuint8 STOP=2\n"
               "std_msgs/Header header\nuint8 mode\n"
               "# m/s: limit when following, signed speed when driving\nfloat64 speed\n"
               "# rad, positive to the left\nfloat64 front_axle\nfloat64 rear_axle\n"
               "# m, least distance to anything known on the way chosen\nfloat64 clearance\n"},
    Definition{"vinerow_msgs/NamedValues",
               "std_msgs/Header header\n# the unit is the end of the name: _m, _rad, _radps, _N\n"
               "string[] name\nfloat64[] value\n"},
    Definition{"vinerow_msgs/FollowerState",
               "# a follower on its path, by its own estimate\n"
               "std_msgs/Header header\n# m, positive left of the path\nfloat64 lateral_error\n"
               "# rad\nfloat64 heading_error\n# m along the path, done and to go\n"
               "float64 distance\nfloat64 remaining\nint32 waypoint\nbool finished\n"},
    Definition{"vinerow_msgs/MovementAuthority",
               "# how far a vehicle may go along its plan\n"
               "std_msgs/Header header\n# m along the path; infinity: to its end\n"
               "float64 stop_at\n# waited for, and who has it; -1: none\n"
               "int32 alley\nstring holder\n"},
    Definition{"trajectory_msgs/MultiDOFJointTrajectory",
               "std_msgs/Header header\nstring[] joint_names\n"
               "trajectory_msgs/MultiDOFJointTrajectoryPoint[] points\n"},
    Definition{"trajectory_msgs/MultiDOFJointTrajectoryPoint",
               "# one of each per joint, in header.frame_id\n"
               "geometry_msgs/Transform[] transforms\ngeometry_msgs/Twist[] velocities\n"
               "geometry_msgs/Twist[] accelerations\n"
               "builtin_interfaces/Duration time_from_start\n"},
    Definition{"vinerow_msgs/TrajectoryPoint",
               "# of the body's origin in header.frame_id: m, m/s, m/s^2\n"
               "geometry_msgs/Point position\ngeometry_msgs/Vector3 velocity\n"
               "geometry_msgs/Vector3 acceleration\n"
               "# rad, continuous; rad/s\nfloat64 yaw\nfloat64 yaw_rate\n"},
    Definition{"vinerow_msgs/ReferenceTrajectory",
               "# where a flying vehicle should be now and in the coming moments\n"
               "uint8 WAIT=0\nuint8 TAKE_OFF=1\nuint8 TRANSIT=2\nuint8 ROW=3\nuint8 TURN=4\n"
               "uint8 RETURN=5\nuint8 LAND=6\nuint8 DONE=7\nuint8 HOVER=8\n"
               "std_msgs/Header header\nuint8 phase\n"
               "# m along the plan, flown and to go\nfloat64 distance\nfloat64 remaining\n"
               "# s from one point to the next; the first holds at the stamp\nfloat64 step\n"
               "vinerow_msgs/TrajectoryPoint[] points\n"},
    Definition{"vinerow_msgs/RangeRay",
               "# m; +inf: nothing seen\nstd_msgs/Header header\nfloat64 range\n"
               "float64 min_range\nfloat64 max_range\n# rad, half of the cone\n"
               "float64 half_angle\n"
               "# of the vehicle in header.frame_id, and of the sensor (looking along its x) in "
               "the vehicle\n"
               "geometry_msgs/Pose body\ngeometry_msgs/Pose sensor\n"},
    Definition{"vinerow_msgs/GnssFix",
               "std_msgs/Header header\nbool valid\n# rad, rad, m above the ellipsoid\n"
               "float64 latitude\nfloat64 longitude\nfloat64 altitude\n"
               "# antenna in header.frame_id (east, north, up): m, m/s, 1 sigma m\n"
               "geometry_msgs/Point position\ngeometry_msgs/Vector3 velocity\n"
               "geometry_msgs/Vector3 position_std\n# m/s, of each component; 0: not told\n"
               "float64 velocity_std\n"
               "uint8 NONE=0\nuint8 STANDALONE=1\nuint8 SBAS=2\nuint8 FLOAT=3\nuint8 FIXED=4\n"
               "uint8 mode\n# used; 0: not told\nint32 satellites\n"},
    Definition{"vinerow_msgs/PathPoint",
               "uint8 LEG=0\nuint8 TURN=1\nuint8 TRANSIT=2\nuint8 VERTICAL=3\nuint8 RETURN=4\n"
               "geometry_msgs/Point position\n# rad, direction of travel\nfloat64 yaw\n"
               "# 1/m, positive to the left, of the stretch that starts here\nfloat64 curvature\n"
               "# m/s, 0 = the follower's own\nfloat64 speed\nuint8 kind\n"
               "# index of the alley a leg runs in, -1 elsewhere\nint32 alley\n"},
    Definition{"vinerow_msgs/PlannedPath",
               "std_msgs/Header header\n# m, of the exact curve\nfloat64 length\n"
               "vinerow_msgs/PathPoint[] points\n"},
    Definition{"geometry_msgs/Vector3Stamped",
               "std_msgs/Header header\ngeometry_msgs/Vector3 vector\n"},
    Definition{
        "vinerow_msgs/AirReference",
        "# what a vehicle on wings is to hold now\n"
        "uint8 WAIT=0\nuint8 LAUNCH=1\nuint8 STRAIGHT=2\nuint8 TURN=3\nuint8 LOITER=4\n"
        "uint8 LAND=5\nuint8 DONE=6\n"
        "std_msgs/Header header\nuint8 phase\n# whether the propeller may run\nbool power\n"
        "# m/s, true airspeed\nfloat64 airspeed\n"
        "# rad from east, positive to the left: of the velocity over ground, and of the body\n"
        "float64 course\nfloat64 heading\n# rad/s\nfloat64 heading_rate\n"
        "# rad, positive with the right wing down\nfloat64 bank\n"
        "# m, z in header.frame_id\nfloat64 height\n# rad, of the path through the air\n"
        "float64 climb_angle\n# m/s, mean wind as far as it is known\n"
        "geometry_msgs/Vector3 wind\n# m, positive left of the leg\nfloat64 cross_track\n"
        "int32 waypoint\n# m along the plan, flown and to go\nfloat64 distance\n"
        "float64 remaining\n"},
    Definition{
        "vinerow_msgs/CameraShot",
        "# a picture taken from above\nstd_msgs/Header header\nint32 index\n"
        "# of the vehicle in header.frame_id, and of the camera (looking along its x, z up in "
        "the picture) in the vehicle\n"
        "geometry_msgs/Pose body\ngeometry_msgs/Pose camera\n"
        "# where the corners meet the ground: upper left, upper right, lower right, lower "
        "left, m\n"
        "geometry_msgs/Point[4] corners\n# every corner meets the ground\nbool on_ground\n"
        "# m along the optical axis, and metres per pixel there\n"
        "float64 distance\nfloat64 ground_sampling_distance\n"},
    Definition{"vinerow_msgs/BatteryState",
               "std_msgs/Header header\n# W drawn now\nfloat64 power\n# J since the start\n"
               "float64 energy_used\n# remaining share of the capacity, 0 to 1\n"
               "float64 charge\n"},
};

const Definition& find_definition(std::string_view type) {
  const auto found = std::find_if(kDefinitions.begin(), kDefinitions.end(),
                                  [&](const Definition& d) { return d.type == type; });
  VINEROW_DEMAND(found != kDefinitions.end());
  return *found;
}

/// Types of other packages' messages in a text, in order: the words with a '/' at line starts.
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

std::string full_ros_definition(std::string_view type) {
  // "nav_msgs/msg/Odometry" -> "nav_msgs/Odometry"
  const std::size_t middle = type.find("/msg/");
  VINEROW_DEMAND(middle != std::string_view::npos);
  const std::string short_type =
      std::string(type.substr(0, middle)) + std::string(type.substr(middle + 4));

  std::vector<std::string_view> types = {find_definition(short_type).type};
  std::string text;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const Definition& definition = find_definition(types[i]);
    if (i > 0) {
      text.append(80, '=').append("\nMSG: ").append(definition.type).append("\n");
    }
    text.append(definition.text);
    add_used_types(definition.text, types);
  }
  return text;
}

}  // namespace vinerow::record
