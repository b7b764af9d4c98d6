/// A plug-in compiled for processors with wider vectors than the program was: Eigen aligns its
/// fixed-size types to more bytes, so its messages have other sizes.

#include "engine/api/plugin.h"

namespace {

void register_parts(vinerow::Registry&) {}

}  // namespace

VINEROW_PLUGIN(register_parts)
