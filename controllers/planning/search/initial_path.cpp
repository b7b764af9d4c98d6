#include "controllers/planning/search/initial_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/planning/search/analytic_turn.h"

namespace vinerow::controllers {
namespace {

struct Found {
  std::vector<PathSegment> pieces;
  double cost = std::numeric_limits<double>::infinity();
};

/// Cheapest free analytic turn with a cost below `dearest`.
Found find_cheapest(const Pose2& from, const Pose2& to, double radius_m, double dearest,
                    const Footprint& footprint, const PathCost& cost, double check_step_m) {
  constexpr int kCoarser = 5;  // factor of a first coarse check, at which most candidates fail
  Found best;
  best.cost = dearest;
  AnalyticTurnParams params;
  params.radius_m = radius_m;
  for (const AnalyticTurn& turn : make_analytic_turns(from, to, params)) {
    if (turn.length_m >= best.cost) break;  // the cost is at least the length
    std::vector<PathSegment> pieces = make_pieces(from, to, turn);
    if (!is_free(pieces, footprint, kCoarser * check_step_m)) continue;
    const double its_cost = cost.of(pieces);
    if (its_cost >= best.cost || !is_free(pieces, footprint, check_step_m)) continue;
    best = {std::move(pieces), its_cost};
  }
  return best;
}

}  // namespace

std::optional<InitialPath> find_initial_path(const Pose2& from, const Pose2& to, double radius_m,
                                             double reserve, const Footprint& footprint,
                                             const PathCost& cost, double check_step_m) {
  // The length of a loop between alleys grows about 1.4 times as fast as the radius.
  constexpr double kDearer = 2.0;
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  const Found tightest = find_cheapest(from, to, radius_m, kNoLimit, footprint, cost, check_step_m);
  if (tightest.pieces.empty()) return std::nullopt;
  for (const double share : {1.0, 0.75, 0.5, 0.25}) {
    if (reserve <= 0.0) break;
    const double wider_m = radius_m * (1.0 + share * reserve);
    const double dearest = (1.0 + kDearer * share * reserve) * tightest.cost;
    const Found wider = find_cheapest(from, to, wider_m, dearest, footprint, cost, check_step_m);
    if (!wider.pieces.empty()) return InitialPath{wider.pieces, wider_m};
  }
  return InitialPath{tightest.pieces, radius_m};
}

bool is_free(const std::vector<PathSegment>& pieces, const Footprint& footprint, double step_m) {
  return std::all_of(pieces.begin(), pieces.end(), [&](const PathSegment& piece) {
    return footprint.is_free_along(piece.start, piece.length_m, piece.curvature_per_m, step_m);
  });
}

std::vector<PathSegment> join_poses(const std::vector<Pose2>& poses, double radius_m) {
  constexpr double kShortest_m = 1e-6;
  std::vector<PathSegment> pieces;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    Pose2 pose = poses[i];
    for (const DubinsPath::Piece& piece : calc_dubins(poses[i], poses[i + 1], radius_m).pieces) {
      if (piece.length_m < kShortest_m) continue;
      if (!pieces.empty() && pieces.back().curvature_per_m == piece.curvature_per_m) {
        pieces.back().length_m += piece.length_m;
      } else {
        pieces.push_back({pose, piece.length_m, piece.curvature_per_m, PathKind::kTurn, -1, 0.0});
      }
      pose = advance(pose, piece.length_m, piece.length_m * piece.curvature_per_m);
    }
  }
  return pieces;
}

std::vector<Pose2> sample_poses(const std::vector<PathSegment>& pieces, double step_m) {
  std::vector<Pose2> poses;
  for (const PathSegment& piece : pieces) {
    const int parts = std::max(1, static_cast<int>(std::ceil(piece.length_m / step_m)));
    for (int i = 0; i < parts; ++i) poses.push_back(piece.at(piece.length_m * i / parts));
  }
  if (!pieces.empty()) poses.push_back(pieces.back().end());
  return poses;
}

std::vector<PathSegment> shorten_by_cost(const std::vector<PathSegment>& pieces, double radius_m,
                                         const Footprint& footprint, const PathCost& cost,
                                         double check_step_m) {
  constexpr int kMaxRounds = 4;
  constexpr double kStep_m = 0.5, kGain = 1e-3;
  std::vector<PathSegment> shortened = pieces;
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<Pose2> poses = sample_poses(shortened, kStep_m);
    bool is_shorter = false;
    for (std::size_t i = 0; i + 2 < poses.size(); ++i) {
      for (std::size_t j = poses.size() - 1; j > i + 1; --j) {
        const std::vector<PathSegment> direct = join_poses({poses[i], poses[j]}, radius_m);
        const std::vector<Pose2> stretch(poses.begin() + i, poses.begin() + j + 1);
        const double now = cost.of(join_poses(stretch, radius_m));
        if (calc_length_m(direct) > now - kGain || cost.of(direct) > now - kGain ||
            !is_free(direct, footprint, check_step_m)) {
          continue;
        }
        poses.erase(poses.begin() + i + 1, poses.begin() + j);
        is_shorter = true;
        break;
      }
    }
    if (!is_shorter) break;
    shortened = join_poses(poses, radius_m);
  }
  return shortened;
}

}  // namespace vinerow::controllers
