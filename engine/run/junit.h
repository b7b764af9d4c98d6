#pragma once
/// junit.xml: verdicts as test cases, for CI systems.

#include <string>

#include "engine/run/run.h"

namespace vinerow::run {

/// One suite named after the scenario: a case for each phase (class "phases") and each criterion of
/// the run (class "criteria"), and one for the run itself. Failed phases and criteria are
/// failures, phases that were blocked, stopped or not reached are skipped, a run that broke off is
/// an error. Times are simulated seconds, so that the file is the same every run.
/// @returns the XML text, UTF-8
std::string junit_xml(const std::string& scenario, const RunResult& result);

}  // namespace vinerow::run
