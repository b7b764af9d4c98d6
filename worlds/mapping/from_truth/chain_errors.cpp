#include "worlds/mapping/from_truth/chain_errors.h"

#include <algorithm>
#include <cmath>

namespace vinerow::mapping {
namespace {

double correlation(double apart_m, double length_m) {
  return length_m > 0.0 ? std::exp(-std::abs(apart_m) / length_m) : 0.0;
}

}  // namespace

void fill_gaps(std::vector<SectionChain>& chains, const CanopySurveyOptions& options,
               RandomStream& random) {
  if (chains.size() < 2) return;
  SectionChain joined;
  for (std::size_t k = 0; k < chains.size(); ++k) {
    SectionChain chain = chains[k];
    if (k > 0) {
      if (chain.size() > 2) chain.erase(chain.begin());
      if (joined.size() > 2) joined.pop_back();
      const SectionChain ends{joined.back(), chain.front()};
      const auto stations = draw_stations(ends.front().s_m, ends.back().s_m, options, 2, random);
      for (std::size_t i = 1; i + 1 < stations.size(); ++i) {
        joined.push_back(cut_at(ends, stations[i]));
      }
    }
    joined.insert(joined.end(), chain.begin(), chain.end());
  }
  chains = {std::move(joined)};
}

void remove_stretch(std::vector<SectionChain>& chains, double from_m, double to_m) {
  std::vector<SectionChain> kept;
  const auto keep = [&](const SectionChain& chain, double low_m, double high_m) {
    low_m = std::max(low_m, chain.front().s_m);
    high_m = std::min(high_m, chain.back().s_m);
    if (high_m - low_m < kMinStretch_m) return;
    SectionChain piece{cut_at(chain, low_m)};
    for (const CanopyCut& cut : chain) {
      if (cut.s_m > low_m + 1e-6 && cut.s_m < high_m - 1e-6) piece.push_back(cut);
    }
    piece.push_back(cut_at(chain, high_m));
    kept.push_back(std::move(piece));
  };
  for (const SectionChain& chain : chains) {
    if (chain.back().s_m <= from_m || chain.front().s_m >= to_m) {
      kept.push_back(chain);
      continue;
    }
    keep(chain, -1e9, from_m);
    keep(chain, to_m, 1e9);
  }
  chains = std::move(kept);
}

void add_surface_noise(SectionChain& chain, double std_m, double correlation_length_m,
                       RandomStream& random) {
  if (std_m <= 0.0) return;
  const std::size_t levels = chain.front().left_m.size();
  const std::vector<double> shares = level_shares(static_cast<int>(levels));
  for (const bool left : {true, false}) {
    std::vector<double> error(levels, 0.0);
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const double along =
          i == 0 ? 0.0 : correlation(chain[i].s_m - chain[i - 1].s_m, correlation_length_m);
      // The fresh part of a section is itself correlated over height.
      double fresh = 0.0;
      for (std::size_t k = 0; k < levels; ++k) {
        const double up_m =
            k == 0 ? 1e9 : (shares[k] - shares[k - 1]) * (chain[i].top_m - chain[i].base_m);
        const double stays = correlation(up_m, correlation_length_m);
        fresh = stays * fresh + std::sqrt(1.0 - stays * stays) * random.normal();
        error[k] = along * error[k] + std::sqrt(1.0 - along * along) * fresh;
        (left ? chain[i].left_m : chain[i].right_m)[k] += std_m * error[k];
      }
    }
  }
  keep_open(chain);
}

}  // namespace vinerow::mapping
