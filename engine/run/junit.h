#pragma once
/// Writer of junit.xml: verdicts as test cases, for CI systems.

#include <string>

#include "engine/run/run.h"

namespace vinerow::run {

/// One suite named after the scenario, with a case for each phase (class "phases"), for each
/// criterion of the run (class "criteria") and for the run itself. Failed phases and criteria are
/// failures; phases that were blocked, stopped or not started are skipped; a run that broke off is
/// an error. Times are simulated seconds, so equal runs give equal files.
/// @returns the XML text, UTF-8
std::string junit_xml(const std::string& scenario, const RunResult& result);

}  // namespace vinerow::run
