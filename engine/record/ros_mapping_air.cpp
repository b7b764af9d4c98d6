/// Mapping of the speed through the air.

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {

void RosMapping<AirData>::write(CdrWriter& out, const WriteContext& to, const AirData& value) {
  write_header(out, to.stamp, to.frames.body);
  out.add(value.v_air_B);
}

bool RosMapping<AirData>::read(CdrReader& in, const FrameNames&, AirData& value) {
  skip_header(in);
  in.read(value.v_air_B);
  return in.ok();
}

}  // namespace vinerow::record
