#pragma once
/// The papers that the page cites. It names each in full once, in its chapter Sources.

#include <string>

namespace vinerow::tools::report {

/// HTML in which each "paper A" is a link "[A]" to its entry. @param html  escaped where it must be
std::string with_citations(const std::string& html);

/// The entries of those papers that a page cites by such links; "" where it cites none.
std::string source_list(const std::string& page);

}  // namespace vinerow::tools::report
