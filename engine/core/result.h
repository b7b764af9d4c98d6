#pragma once
/// Result of an operation: a value, or a reason for its absence. For failures that are part of
/// normal work (no path, infeasible QP).

#include <optional>
#include <string>
#include <utility>

#include "engine/core/check.h"

namespace vinerow {

/// The reason of an expected failure, one sentence.
struct Failure {
  std::string reason;
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}              // NOLINT: implicit on purpose
  Result(Failure failure) : failure_(std::move(failure)) {}  // NOLINT: implicit on purpose

  explicit operator bool() const { return value_.has_value(); }
  bool ok() const { return value_.has_value(); }

  /// @pre ok()
  const T& value() const& {
    VINEROW_DEMAND(ok());
    return *value_;
  }
  T&& value() && {
    VINEROW_DEMAND(ok());
    return std::move(*value_);
  }
  const T& operator*() const { return value(); }
  const T* operator->() const { return &value(); }

  /// @pre !ok()
  const std::string& reason() const {
    VINEROW_DEMAND(!ok());
    return failure_.reason;
  }

 private:
  std::optional<T> value_;
  Failure failure_;
};

}  // namespace vinerow
