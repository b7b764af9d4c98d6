#pragma once
/// Range checks for numeric options. The messages of CLI11's own checks print the largest double.

#include <CLI/CLI.hpp>

namespace vinerow::tools {

/// Each also refuses what is above 1e9.
/// "--jobs: must be > 0, is '0'"
CLI::Validator positive();
/// "--from: must be >= 0, is '-1'"
CLI::Validator not_negative();
/// "--tolerance: must be from 0 to 1, is '2'"
CLI::Validator within(double lowest, double highest);

}  // namespace vinerow::tools
