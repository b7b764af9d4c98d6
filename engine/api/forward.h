#pragma once
/// Forward declarations of API types, for headers that only use pointers or references. Sources
/// that use the members include the header that defines the type.

namespace vinerow {

class FileShelf;
class Ports;
class RandomStream;
class SceneQuery;
class SignalBase;
class SignalBus;
class Vehicle;
class VehicleScene;
struct HeightField;
struct LinkPoses;
struct MeshInstance;
struct Odometry;
struct OccupancyGrid;
struct PlannedPath;
struct RowMap;
struct RowMesh;
struct TriangleMesh;
struct VehicleDescription;
struct WorldModel;

}  // namespace vinerow
