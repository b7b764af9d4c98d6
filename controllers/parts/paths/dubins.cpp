#include "controllers/parts/paths/dubins.h"

#include <algorithm>

#include "engine/core/check.h"
#include "engine/math/angles.h"

// Derivation. With u(phi) the direction of a heading and n(phi) its left normal, a vehicle at p
// turns left about p + R n and right about p - R n. At heading phi it is at c - R n(phi) on a
// left circle and at c + R n(phi) on a right one. D is the vector from the first to the last
// circle's centre.
//   LSL, RSR: the straight piece is D itself: length |D|, heading phi = angle(D).
//   LSR: D = S u(phi) - 2R n(phi), so S = sqrt(|D|^2 - 4R^2) and phi = angle(D) + atan2(2R, S).
//   RSL: D = S u(phi) + 2R n(phi), so phi = angle(D) - atan2(2R, S).
//   LRL, RLR: the middle circle touches both, its centre is 2R from either: two mirror images.

namespace vinerow::controllers {
namespace {

// Turned angles this close to a full turn are rounding of "no turn".
constexpr double kFullTurnSlack_rad = 1e-9;

double positive_turn(double angle_rad) {
  double turn = std::fmod(angle_rad, 2.0 * kPi);
  if (turn < 0.0) turn += 2.0 * kPi;
  return turn >= 2.0 * kPi - kFullTurnSlack_rad ? 0.0 : turn;
}

struct Shape {
  double first;   // +1 left, -1 right
  double middle;  // 0 straight
  double last;
};

Shape shape_of(DubinsWord word) {
  switch (word) {
    case DubinsWord::kLSL:
      return {1, 0, 1};
    case DubinsWord::kRSR:
      return {-1, 0, -1};
    case DubinsWord::kLSR:
      return {1, 0, -1};
    case DubinsWord::kRSL:
      return {-1, 0, 1};
    case DubinsWord::kRLR:
      return {-1, 1, -1};
    case DubinsWord::kLRL:
      return {1, -1, 1};
  }
  return {0, 0, 0};
}

DubinsPath make_path(DubinsWord word, double radius_m, double first_rad, double middle,
                     double last_rad) {
  const Shape shape = shape_of(word);
  const double middle_m = shape.middle == 0.0 ? middle : middle * radius_m;
  DubinsPath path;
  path.word = word;
  path.exists = true;
  path.pieces[0] = {first_rad * radius_m, shape.first / radius_m};
  path.pieces[1] = {middle_m, shape.middle / radius_m};
  path.pieces[2] = {last_rad * radius_m, shape.last / radius_m};
  return path;
}

DubinsPath calc_with_straight(const Pose2& start, const Pose2& goal, double radius_m,
                              DubinsWord word, const Eigen::Vector2d& centres) {
  const Shape shape = shape_of(word);
  const double distance = centres.norm();
  DubinsPath none;
  none.word = word;
  double straight = distance;
  // With equal circles the straight piece may have any heading; the start's needs no first turn.
  double heading =
      distance > 1e-12 * radius_m ? std::atan2(centres.y(), centres.x()) : start.yaw_rad;
  if (shape.first != shape.last) {
    const double square = (distance - 2.0 * radius_m) * (distance + 2.0 * radius_m);
    if (square < -1e-12 * radius_m * radius_m) return none;
    straight = std::sqrt(std::max(square, 0.0));
    heading += shape.first * std::atan2(2.0 * radius_m, straight);
  }
  const double first = positive_turn(shape.first * (heading - start.yaw_rad));
  const double last = positive_turn(shape.last * (goal.yaw_rad - heading));
  return make_path(word, radius_m, first, straight, last);
}

DubinsPath calc_three_turns(const Pose2& start, const Pose2& goal, double radius_m, DubinsWord word,
                            const Eigen::Vector2d& first_centre,
                            const Eigen::Vector2d& last_centre) {
  const double side = shape_of(word).first;
  const Eigen::Vector2d centres = last_centre - first_centre;
  const double distance = centres.norm();
  DubinsPath best;
  best.word = word;
  const double square = 4.0 * radius_m * radius_m - 0.25 * distance * distance;
  if (square < 0.0) return best;
  const Eigen::Vector2d along =
      distance > 1e-12 * radius_m ? Eigen::Vector2d(centres / distance) : direction(start.yaw_rad);
  for (const double half : {1.0, -1.0}) {
    const Eigen::Vector2d middle_centre =
        first_centre + 0.5 * centres + half * std::sqrt(square) * left_of(along);
    // Where two circles touch, the heading is perpendicular to the line between their centres.
    const Eigen::Vector2d out = middle_centre - first_centre, back = middle_centre - last_centre;
    const double heading_1 = std::atan2(out.y(), out.x()) + side * 0.5 * kPi;
    const double heading_2 = std::atan2(back.y(), back.x()) + side * 0.5 * kPi;
    const DubinsPath path = make_path(word, radius_m,  //
                                      positive_turn(side * (heading_1 - start.yaw_rad)),
                                      positive_turn(-side * (heading_2 - heading_1)),
                                      positive_turn(side * (goal.yaw_rad - heading_2)));
    if (path.length_m() < best.length_m()) best = path;
  }
  return best;
}

}  // namespace

const char* to_string(DubinsWord word) {
  constexpr const char* kNames[] = {"LSL", "RSR", "LSR", "RSL", "RLR", "LRL"};
  return kNames[static_cast<int>(word)];
}

DubinsPath calc_dubins_word(const Pose2& start, const Pose2& goal, double radius_m,
                            DubinsWord word) {
  VINEROW_DEMAND(radius_m > 0.0);
  const Shape shape = shape_of(word);
  const Eigen::Vector2d first_centre =
      start.p + shape.first * radius_m * left_of(direction(start.yaw_rad));
  const Eigen::Vector2d last_centre =
      goal.p + shape.last * radius_m * left_of(direction(goal.yaw_rad));
  if (shape.middle == 0.0) {
    return calc_with_straight(start, goal, radius_m, word, last_centre - first_centre);
  }
  return calc_three_turns(start, goal, radius_m, word, first_centre, last_centre);
}

DubinsPath calc_dubins(const Pose2& start, const Pose2& goal, double radius_m) {
  DubinsPath best;
  for (const DubinsWord word : kDubinsWords) {
    const DubinsPath path = calc_dubins_word(start, goal, radius_m, word);
    if (path.length_m() < best.length_m() - 1e-9 * radius_m || !best.exists) {
      if (path.exists) best = path;
    }
  }
  return best;  // LSL and RSR always exist
}

Pose2 pose_on_dubins(const Pose2& start, const DubinsPath& path, double length_m) {
  Pose2 pose = start;
  for (const DubinsPath::Piece& piece : path.pieces) {
    const double part = std::clamp(length_m, 0.0, piece.length_m);
    pose = advance(pose, part, part * piece.curvature_per_m);
    length_m -= piece.length_m;
  }
  return pose;
}

}  // namespace vinerow::controllers
