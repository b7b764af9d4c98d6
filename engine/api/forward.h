#pragma once
/// Names of the API's types for headers that only point at them. Whoever looks inside includes the
/// header that defines the type.

namespace vinerow {

class Ports;
class RandomStream;
class SceneQuery;
class SignalBase;
class SignalBus;
class Vehicle;
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
