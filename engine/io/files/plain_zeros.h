#pragma once
/// Numbers in texts for people.

#include <string>

namespace vinerow::io {

/// The same text without the sign of rounded zeros: "(-0.0, 2.1) heading -0.0 deg" becomes
/// "(0.0, 2.1) heading 0.0 deg". A minus counts if nothing, a space or an opening bracket is before
/// it.
std::string plain_zeros(const std::string& text);

}  // namespace vinerow::io
