#pragma once
/// Papers cited by the page. The chapter Sources gives each in full once.

#include <string>

namespace vinerow::tools::report {

/// HTML in which each "paper A" is a link "[A]" to its entry. @param html  escaped already
std::string with_citations(const std::string& html);

/// Entries of the papers that a page cites with such links; "" if it cites none.
std::string source_list(const std::string& page);

}  // namespace vinerow::tools::report
