#pragma once
/// Nearest neighbours for an expensive, asymmetric distance with a cheap lower bound.

#include <ompl/datastructures/NearestNeighbors.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

namespace vinerow::controllers {

/// A plain list. The distance from an element to the query is computed only if the bound does not
/// exceed the worst distance to be kept. Exact; among equals, the one added first. nearestK()
/// leaves out elements farther away than `longest`, to which a tree has no edges.
template <typename T>
class BoundedNearest final : public ompl::NearestNeighbors<T> {
 public:
  /// @param bound  bound(element, query) <= distance(element, query)
  BoundedNearest(std::function<double(const T&, const T&)> bound, double longest)
      : bound_(std::move(bound)), longest_(longest) {}

  bool reportsSortedResults() const override { return true; }
  void clear() override { elements_.clear(); }
  void add(const T& element) override { elements_.push_back(element); }
  bool remove(const T& element) override {
    const auto found = std::find(elements_.rbegin(), elements_.rend(), element);
    if (found == elements_.rend()) return false;
    elements_.erase(std::next(found).base());
    return true;
  }
  T nearest(const T& query) const override {
    // The element of the smallest bound first: it leaves few others to evaluate.
    bounds_.clear();
    std::size_t smallest = 0;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      bounds_.push_back({bound_(elements_[i], query), i});
      if (bounds_[i] < bounds_[smallest]) smallest = i;
    }
    Place best{this->distFun_(elements_[smallest], query), smallest};
    for (const Place& candidate : bounds_) {
      if (candidate.index == smallest || candidate.distance > best.distance) continue;
      const Place place{this->distFun_(elements_[candidate.index], query), candidate.index};
      if (place < best) best = place;
    }
    return elements_[best.index];
  }
  void nearestK(const T& query, std::size_t k, std::vector<T>& found) const override {
    search(query, std::min(k, elements_.size()), longest_, found);
  }
  void nearestR(const T& query, double radius, std::vector<T>& found) const override {
    search(query, elements_.size(), radius, found);
  }
  std::size_t size() const override { return elements_.size(); }
  void list(std::vector<T>& elements) const override { elements = elements_; }

 private:
  struct Place {
    double distance;
    std::size_t index;
    bool operator<(const Place& other) const {
      return distance != other.distance ? distance < other.distance : index < other.index;
    }
  };

  void search(const T& query, std::size_t k, double radius, std::vector<T>& found) const {
    found.clear();
    if (k == 0) return;
    // Smallest bounds first: the worst of the k kept falls quickly and ends the search.
    bounds_.clear();
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const double bound = bound_(elements_[i], query);
      if (bound <= radius) bounds_.push_back({bound, i});
    }
    const auto later = [](const Place& a, const Place& b) { return b < a; };
    std::make_heap(bounds_.begin(), bounds_.end(), later);
    kept_.clear();  // heap with the worst on top
    while (!bounds_.empty()) {
      std::pop_heap(bounds_.begin(), bounds_.end(), later);
      const Place next = bounds_.back();
      bounds_.pop_back();
      if (kept_.size() == k && next.distance > kept_.front().distance) break;
      const Place place{this->distFun_(elements_[next.index], query), next.index};
      if (place.distance > radius) continue;
      if (kept_.size() == k) {
        if (!(place < kept_.front())) continue;
        std::pop_heap(kept_.begin(), kept_.end());
        kept_.pop_back();
      }
      kept_.push_back(place);
      std::push_heap(kept_.begin(), kept_.end());
    }
    std::sort(kept_.begin(), kept_.end());
    for (const Place& place : kept_) found.push_back(elements_[place.index]);
  }

  std::function<double(const T&, const T&)> bound_;
  double longest_;
  std::vector<T> elements_;
  mutable std::vector<Place> bounds_;
  mutable std::vector<Place> kept_;
};

}  // namespace vinerow::controllers
