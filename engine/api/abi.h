#pragma once
/// ABI tag: text that describes everything a plug-in and the program must have in common. A plug-in
/// computes it when it is compiled, with its own compiler and flags; the loader compares it with
/// the program's tag field by field.
///
/// Everything here has internal linkage. With inline functions the dynamic linker would give a
/// plug-in the program's tag instead of its own.

#include <Eigen/Core>
#include <string>

#include "engine/api/abi_version.h"
#include "engine/api/map.h"
#include "engine/api/messages.h"
#include "engine/api/product.h"
#include "engine/api/registry.h"
#include "engine/api/world_model.h"

/// All messages, and the classes and structs that pass between plug-in and program.
#define VINEROW_ABI_TYPES(F)                                                                     \
  F(Odometry) F(DeadReckoning) F(ImuSample) F(GnssFix) F(GnssHeading) F(RangeSample) F(PressureSample) \
  F(MagneticSample) F(PoseTarget)                                                                \
  F(LaserScan) F(PointCloud) F(Picture) F(CameraInfo) F(PositionEllipsoid) F(VelocityCommand) F(LocalCommand) F(LineList) \
  F(OccupancyGrid) F(NamedValues) F(LinkPoses) F(PathPoint) F(PlannedPath) F(FollowerState)      \
  F(MovementAuthority) F(TrajectoryPoint) F(ReferenceTrajectory) F(AirReference) F(AirData)      \
  F(CameraShot) F(BatteryState) F(Event) F(Pose) F(Signal<Odometry>) F(SignalBus) F(Ports)       \
  F(ParameterSpec) F(ParameterSet) F(PartSpec) F(PartContext) F(SensorContext) F(MapContext)     \
  F(EstimatorContext) F(PlannerContext) F(ControllerContext) F(AutopilotContext)                 \
  F(MetricContext) F(PayloadContext) F(JobContext) F(JobOutcome) F(PlanReport) F(SensorMounting) \
  F(Product) F(PictureSet)                                                                       \
  F(VehicleDescription) F(VehicleLink) F(MeshInstance) F(TriangleMesh) F(HeightField) F(RowMap)  \
  F(RowMesh) F(PlantRow) F(Alley) F(WorldModel) F(CanopyCoverage) F(CanopyPatch) F(AirPoint)     \
  F(AirLoad) F(RayHit) F(Registry)

namespace vinerow {
namespace {

/// "vinerow-abi 9; headers 0a1b...; alignment 16; ...; Odometry 176/16; ...": facts of the build,
/// then size/alignment of every type in bytes.
[[maybe_unused]] const char* abi_tag() {
  static const std::string tag = [] {
    std::string text = "vinerow-abi " + std::to_string(VINEROW_ABI_VERSION);
    const auto add = [&text](const char* name, const std::string& value) {
      text.append("; ").append(name).append(" ").append(value);
    };
    add("headers", VINEROW_ABI_HEADERS);
    // Alignment of Eigen's fixed-size types; -mavx and -march=native raise it.
    add("alignment", std::to_string(EIGEN_MAX_STATIC_ALIGN_BYTES));
#if defined(NDEBUG)
    add("ndebug", "1");
#else
    add("ndebug", "0");
#endif
#if defined(_GLIBCXX_USE_CXX11_ABI)
    add("cxx11_abi", std::to_string(_GLIBCXX_USE_CXX11_ABI));
#else
    add("cxx11_abi", "none");
#endif
#if defined(__GXX_ABI_VERSION)
    add("gxx_abi", std::to_string(__GXX_ABI_VERSION));
#else
    add("gxx_abi", "none");
#endif
#define VINEROW_ABI_ADD(T) add(#T, std::to_string(sizeof(T)) + "/" + std::to_string(alignof(T)));
    VINEROW_ABI_TYPES(VINEROW_ABI_ADD)
#undef VINEROW_ABI_ADD
    return text;
  }();
  return tag.c_str();
}

}  // namespace
}  // namespace vinerow

#define VINEROW_ABI_TAG ::vinerow::abi_tag()
