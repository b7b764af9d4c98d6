#include "engine/api/map.h"

#include "engine/core/indirect_definitions.h"

namespace vinerow {

template class Indirect<RowMap>;

}  // namespace vinerow
