#pragma once
/// What numbers of options may be. CLI11's own checks name the largest double there is.

#include <CLI/CLI.hpp>

namespace vinerow::tools {

/// "--jobs: must be > 0, is '0'"
CLI::Validator positive();
/// "--from: must be >= 0, is '-1'"
CLI::Validator not_negative();

}  // namespace vinerow::tools
