#pragma once
/// Conversions between Eigen and Bullet. Only included inside engine/physics.

#include <LinearMath/btTransform.h>

#include "engine/math/pose.h"

namespace vinerow::physics {

inline btVector3 to_bullet(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
inline btQuaternion to_bullet(const Eigen::Quaterniond& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}
inline btTransform to_bullet(const Pose& X) {
  return btTransform(to_bullet(X.q), to_bullet(X.p));
}
inline Eigen::Vector3d from_bullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
inline Eigen::Quaterniond from_bullet(const btQuaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace vinerow::physics
