#pragma once
/// Misuse of the Python interface itself; RuntimeError in Python (vinerow.UsageError).

#include <stdexcept>

namespace vinerow::python {

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace vinerow::python
