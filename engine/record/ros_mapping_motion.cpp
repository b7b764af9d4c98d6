/// Mappings of poses, commands and paths.

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {
namespace {

/// Fills the block of x, y, z: diagonal and off-diagonal elements (xy, xz, yz).
void fill_position(const Eigen::Vector3d& diagonal, const Eigen::Vector3d& off_diagonal,
                   double* covariance) {
  covariance[0] = diagonal.x(), covariance[7] = diagonal.y(), covariance[14] = diagonal.z();
  covariance[1] = covariance[6] = off_diagonal.x();
  covariance[2] = covariance[12] = off_diagonal.y();
  covariance[8] = covariance[13] = off_diagonal.z();
}

// Minimum bytes of one element of a sequence; bounds a damaged count.
constexpr std::size_t kMinTransform = 8 + 4 + 4 + 7 * 8;

}  // namespace

FrameNames FrameNames::of_signal(const std::string& signal) {
  const std::string vehicle = signal.substr(0, signal.find('/'));
  FrameNames names;
  names.prefix = vehicle + "/";
  // Signals of the run do not belong to a vehicle and have no body.
  names.body = vehicle == "run" ? names.world : names.prefix + "base_link";
  names.own = signal;
  return names;
}

void RosMapping<Odometry>::write(CdrWriter& out, const WriteContext& to, const Odometry& value) {
  write_header(out, to.stamp, to.frames.world);
  out.add(std::string_view(to.frames.body));
  write_pose(out, value.X_WB);
  double covariance[kCovarianceSize] = {};
  fill_position(value.position_variance_m2, value.position_covariance_m2, covariance);
  covariance[kCovarianceYaw] = variance(value.yaw_std_rad);
  out.add_doubles(covariance, kCovarianceSize);
  out.add(value.v_WB_B);
  out.add(value.w_WB_B);
  out.add_zero_doubles(kCovarianceSize);
}

bool RosMapping<Odometry>::read(CdrReader& in, const FrameNames&, Odometry& value) {
  skip_header(in);
  in.read_text();
  read_pose(in, value.X_WB);
  value.yaw_std_rad = std_of_variance(
      read_pose_covariance(in, value.position_variance_m2, value.position_covariance_m2));
  in.read(value.v_WB_B);
  in.read(value.w_WB_B);
  in.skip_doubles(kCovarianceSize);
  return in.ok();
}

void RosMapping<DeadReckoning>::write(CdrWriter& out, const WriteContext& to,
                                      const DeadReckoning& value) {
  write_time(out, to.stamp);
  out.add_joined(to.frames.prefix, kOdometryFrame);
  out.add(std::string_view(to.frames.body));
  write_pose(out, value.X_OB);
  // Its errors grow without limit; listeners use the twist.
  out.add_zero_doubles(kCovarianceSize);
  out.add(value.v_OB_B);
  out.add(value.w_OB_B);
  double covariance[kCovarianceSize] = {};
  fill_position(value.velocity_std_mps.unaryExpr(&variance), Eigen::Vector3d::Zero(), covariance);
  covariance[kCovarianceYaw] = variance(value.yaw_rate_std_radps);
  out.add_doubles(covariance, kCovarianceSize);
}

bool RosMapping<DeadReckoning>::read(CdrReader& in, const FrameNames&, DeadReckoning& value) {
  skip_header(in);
  in.read_text();
  read_pose(in, value.X_OB);
  in.skip_doubles(kCovarianceSize);
  in.read(value.v_OB_B);
  in.read(value.w_OB_B);
  Eigen::Vector3d variances, beside;
  value.yaw_rate_std_radps = std_of_variance(read_pose_covariance(in, variances, beside));
  value.velocity_std_mps = variances.unaryExpr(&std_of_variance);
  return in.ok();
}

void RosMapping<PositionEllipsoid>::write(CdrWriter& out, const WriteContext& to,
                                          const PositionEllipsoid& value) {
  write_header(out, to.stamp, to.frames.world);
  write_pose(out, {Eigen::Quaterniond::Identity(), value.centre_W});
  double covariance[kCovarianceSize] = {};
  fill_position(value.shape_diagonal_m2, value.shape_beside_m2, covariance);
  out.add_doubles(covariance, kCovarianceSize);
}

bool RosMapping<PositionEllipsoid>::read(CdrReader& in, const FrameNames&,
                                         PositionEllipsoid& value) {
  skip_header(in);
  Pose pose;
  read_pose(in, pose);
  value.centre_W = pose.p;
  read_pose_covariance(in, value.shape_diagonal_m2, value.shape_beside_m2);
  return in.ok();
}

void RosMapping<PoseTarget>::write(CdrWriter& out, const WriteContext& to,
                                   const PoseTarget& value) {
  write_header(out, to.stamp, to.frames.world);
  write_pose(out, value.X_WB);
}

bool RosMapping<PoseTarget>::read(CdrReader& in, const FrameNames&, PoseTarget& value) {
  skip_header(in);
  read_pose(in, value.X_WB);
  return in.ok();
}

void RosMapping<VelocityCommand>::write(CdrWriter& out, const WriteContext& to,
                                        const VelocityCommand& value) {
  write_header(out, to.stamp, to.frames.body);
  out.add(Eigen::Vector3d(value.v_mps, 0, 0));
  out.add(Eigen::Vector3d(0, 0, value.yaw_rate_radps));
}

bool RosMapping<VelocityCommand>::read(CdrReader& in, const FrameNames&, VelocityCommand& value) {
  skip_header(in);
  value.v_mps = in.read<double>();
  in.skip_doubles(4);
  value.yaw_rate_radps = in.read<double>();
  return in.ok();
}

void RosMapping<LinkPoses>::write(CdrWriter& out, const WriteContext& to, const LinkPoses& value) {
  const std::size_t count = std::min(value.names.size(), value.X_WL.size());
  // A tree world -> body -> links if the body is known, else all links in the world.
  const bool is_tree = to.X_WB != nullptr && count > 0;
  const bool has_odometry = is_tree && to.X_OB != nullptr;
  out.add_count(count + (is_tree ? 1 : 0) + (has_odometry ? 1 : 0));
  if (is_tree) {
    write_header(out, to.stamp, to.frames.world);
    out.add(std::string_view(to.frames.body));
    write_pose(out, *to.X_WB);
  }
  for (std::size_t i = 0; i < count; ++i) {
    write_header(out, to.stamp, is_tree ? to.frames.body : to.frames.world);
    out.add_joined(to.frames.prefix, value.names[i]);
    write_pose(out, is_tree ? pose_in_body(*to.X_WB, value.X_WL[i]) : value.X_WL[i]);
  }
  if (!has_odometry) return;
  // Where viewers find the frame of dead reckoning: so that it puts the body where it is. The body
  // itself already has a parent.
  write_header(out, to.stamp, to.frames.world);
  out.add_joined(to.frames.prefix, kOdometryFrame);
  write_pose(out, *to.X_WB * to.X_OB->inverse());
}

bool RosMapping<LinkPoses>::read(CdrReader& in, const FrameNames& frames, LinkPoses& value) {
  std::size_t count = in.read_count(kMinTransform);
  value.names.resize(count);
  value.X_WL.resize(count);
  Pose X_WB;
  std::size_t k = 0;
  bool is_tree = false;
  for (std::size_t i = 0; i < count; ++i) {
    skip_time(in);
    const bool is_in_body = in.read_text() == frames.body;
    // If the second transform is in the body's frame, the first one was the body.
    if (is_in_body && i == 1) {
      X_WB = value.X_WL[0];
      k = 0;
      is_tree = true;
    }
    std::string_view name = in.read_text();
    if (is_tree && !is_in_body) {  // the frame of dead reckoning
      Pose X_WO;
      read_pose(in, X_WO);
      continue;
    }
    if (name.starts_with(frames.prefix)) name.remove_prefix(frames.prefix.size());
    value.names[k].assign(name.data(), name.size());
    read_pose(in, value.X_WL[k]);
    if (is_in_body) value.X_WL[k] = X_WB * value.X_WL[k];
    ++k;
  }
  value.names.resize(k);
  value.X_WL.resize(k);
  return in.ok();
}

void RosMapping<PlannedPath>::write(CdrWriter& out, const WriteContext& to,
                                    const PlannedPath& value) {
  write_header(out, to.stamp, to.frames.world);
  out.add_count(value.points.size());
  for (const PathPoint& point : value.points) {
    write_header(out, to.stamp, to.frames.world);
    write_pose(out, {quaternion_from_rpy({0, 0, point.yaw_rad}), point.p_W});
  }
}

}  // namespace vinerow::record
