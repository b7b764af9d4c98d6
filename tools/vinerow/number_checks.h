#pragma once
/// Range checks for numeric options. The messages of CLI11's own checks print the largest double.

#include <CLI/CLI.hpp>

namespace vinerow::tools {

/// "--jobs: must be > 0, is '0'"
CLI::Validator positive();
/// "--from: must be >= 0, is '-1'"
CLI::Validator not_negative();

}  // namespace vinerow::tools
