"""Small whole files of every format that Vinerow reads, made here."""

import base64
import json
import math
import struct

GRID = 6  # points along a side of the seeds' ground
LATITUDE, LONGITUDE = 46.05, 14.5


def _ground() -> tuple[list[tuple[float, float, float]], list[tuple[int, int, int]]]:
    points = [(4.0 * i - 10, 4.0 * j - 10, 0.3 * math.sin(i) + 0.2 * j) for j in range(GRID) for i in range(GRID)]
    triangles = []
    for j in range(GRID - 1):
        for i in range(GRID - 1):
            a = j * GRID + i
            triangles += [(a, a + 1, a + GRID + 1), (a, a + GRID + 1, a + GRID)]
    return points, triangles


def obj() -> bytes:
    points, triangles = _ground()
    text = "mtllib none.mtl\no ground\n" + "".join("v %.3f %.3f %.3f\n" % p for p in points)
    return (text + "vn 0 0 1\n" + "".join("f %d//1 %d//1 %d//1\n" % tuple(k + 1 for k in t) for t in triangles)).encode()


def stl_text() -> bytes:
    points, triangles = _ground()
    text = "solid ground\n"
    for t in triangles:
        text += "facet normal 0 0 1\nouter loop\n" + "".join("vertex %.3f %.3f %.3f\n" % points[k] for k in t)
        text += "endloop\nendfacet\n"
    return (text + "endsolid ground\n").encode()


def stl_binary() -> bytes:
    points, triangles = _ground()
    data = b"made here".ljust(80, b"\0") + struct.pack("<I", len(triangles))
    for t in triangles:
        data += struct.pack("<12fH", 0, 0, 1, *points[t[0]], *points[t[1]], *points[t[2]], 0)
    return data


def ply(form: str) -> bytes:
    points, triangles = _ground()
    head = (f"ply\nformat {form} 1.0\ncomment made here\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face {len(triangles)}\n"
            "property list uchar int vertex_indices\nend_header\n").encode()
    if form == "ascii":
        return head + ("".join("%.3f %.3f %.3f 90 80 70\n" % p for p in points)
                       + "".join("3 %d %d %d\n" % t for t in triangles)).encode()
    order = "<" if "little" in form else ">"
    return (head + b"".join(struct.pack(order + "3f3B", *p, 90, 80, 70) for p in points)
            + b"".join(struct.pack(order + "B3i", 3, *t) for t in triangles))


def dae() -> bytes:
    points, triangles = _ground()
    numbers = " ".join("%.3f %.3f %.3f" % p for p in points)
    indices = " ".join("%d %d %d" % t for t in triangles)
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="metre" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><diffuse><color>0.4 0.5 0.2 1</color></diffuse>
</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="a" count="{3 * len(points)}">{numbers}</float_array>
<technique_common><accessor source="#a" count="{len(points)}" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{len(triangles)}" material="s"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n" name="ground"><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>
<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="s" target="#m"/></technique_common>
</bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
""".encode()


def _gltf() -> tuple[dict, bytes]:
    points, triangles = _ground()
    data = b"".join(struct.pack("<3f", p[0], p[2], -p[1]) for p in points)
    at = len(data)
    data += b"".join(struct.pack("<3H", *t) for t in triangles)
    data += b"\0" * (-len(data) % 4)
    axes = list(zip(*[(p[0], p[2], -p[1]) for p in points]))
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "ground"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.4, 0.5, 0.2, 1]}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                       "min": [min(a) for a in axes], "max": [max(a) for a in axes]},
                      {"bufferView": 1, "componentType": 5123, "count": 3 * len(triangles), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": at},
                        {"buffer": 0, "byteOffset": at, "byteLength": 6 * len(triangles)}],
        "buffers": [{"byteLength": len(data)}]}, data


def gltf() -> bytes:
    root, data = _gltf()
    root["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return json.dumps(root, indent=1).encode()


def glb() -> bytes:
    root, data = _gltf()
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(data)
    return (struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(data), b"BIN\0") + data)


def sdf() -> bytes:
    return b"""<?xml version="1.0"?>
<sdf version="1.6"><world name="w">
<include><uri>model://field</uri><pose>0 0 0 0 0 0</pose></include>
<model name="crate"><static>true</static><pose>3 2 0.5 0 0 0.3</pose><link name="l">
<collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>
<visual name="v"><geometry><box><size>1 1 1</size></box></geometry></visual></link></model>
</world></sdf>
"""


def sdf_model() -> bytes:
    return b"""<?xml version="1.0"?>
<sdf version="1.6"><model name="field"><static>true</static><link name="l">
<visual name="v"><geometry><mesh><uri>model://field/ground.obj</uri><scale>1 1 1</scale></mesh></geometry></visual>
<collision name="c"><geometry><mesh><uri>model://field/ground.obj</uri></mesh></geometry></collision></link></model></sdf>
"""


def urdf() -> bytes:
    wheels = ""
    for name, x, y in (("fl", 0.3, 0.3), ("fr", 0.3, -0.3), ("rl", -0.3, 0.3), ("rr", -0.3, -0.3)):
        wheels += f"""<link name="{name}"><inertial><origin xyz="0 0 0"/><mass value="2"/>
<inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.02"/></inertial>
<visual><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.15" length="0.1"/></geometry></visual>
<collision><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.15" length="0.1"/></geometry></collision></link>
<joint name="{name}_wheel" type="continuous"><parent link="base_link"/><child link="{name}"/>
<origin xyz="{x} {y} 0"/><axis xyz="0 1 0"/></joint>
"""
    return f"""<?xml version="1.0"?><robot name="cart"><link name="base_link">
<inertial><origin xyz="0 0 0.1"/><mass value="40"/><inertia ixx="1.5" ixy="0" ixz="0" iyy="2" iyz="0" izz="3"/></inertial>
<visual><origin xyz="0 0 0.15"/><geometry><box size="0.8 0.5 0.2"/></geometry></visual>
<collision><origin xyz="0 0 0.15"/><geometry><box size="0.8 0.5 0.2"/></geometry></collision></link>
{wheels}</robot>
""".encode()


def _degrees(x_m: float, y_m: float) -> list[float]:
    return [LONGITUDE + x_m / (111320.0 * math.cos(math.radians(LATITUDE))), LATITUDE + y_m / 111320.0]


def _rows() -> list[list[list[float]]]:
    return [[_degrees(-30, 2.5 * k), _degrees(0, 2.5 * k + 0.3), _degrees(30, 2.5 * k)] for k in range(4)]


def geojson() -> bytes:
    features = [{"type": "Feature", "properties": {"type": "row", "name": f"r{k}"},
                 "geometry": {"type": "LineString", "coordinates": row}} for k, row in enumerate(_rows())]
    features += [{"type": "Feature", "properties": {"type": "pole"},
                  "geometry": {"type": "Point", "coordinates": row[0] + [300.0]}} for row in _rows()]
    return json.dumps({"type": "FeatureCollection", "features": features}, indent=1).encode()


def polygon() -> bytes:
    ring = [_degrees(*p) for p in ((-60, -40), (60, -40), (70, 50), (-50, 60), (-60, -40))]
    return json.dumps({"type": "Polygon", "coordinates": [ring]}, indent=1).encode()


def kml() -> bytes:
    text = '<?xml version="1.0" encoding="UTF-8"?>\n<kml xmlns="http://www.opengis.net/kml/2.2"><Document>\n'
    for k, row in enumerate(_rows()):
        points = " ".join("%.9f,%.9f,0" % tuple(p) for p in row)
        text += f"<Placemark><name>row {k}</name><LineString><coordinates>{points}</coordinates></LineString></Placemark>\n"
    return (text + "</Document></kml>\n").encode()


def shapefile() -> dict[str, bytes]:
    """Lines in WGS84; the attribute table holds a number."""
    records, index, at = b"", b"", 50
    for k, row in enumerate(_rows()):
        xs, ys = [p[0] for p in row], [p[1] for p in row]
        content = struct.pack("<i4d2ii", 3, min(xs), min(ys), max(xs), max(ys), 1, len(row), 0)
        content += b"".join(struct.pack("<2d", *p) for p in row)
        records += struct.pack(">2i", k + 1, len(content) // 2) + content
        index += struct.pack(">2i", at, len(content) // 2)
        at += 4 + len(content) // 2
    flat = [p for row in _rows() for p in row]
    box = struct.pack("<8d", min(p[0] for p in flat), min(p[1] for p in flat), max(p[0] for p in flat),
                      max(p[1] for p in flat), 0, 0, 0, 0)

    def head(size: int) -> bytes:
        return struct.pack(">7i", 9994, 0, 0, 0, 0, 0, size // 2) + struct.pack("<2i", 1000, 3) + box

    rows = _rows()
    table = struct.pack("<4BIHH20x", 3, 126, 1, 1, len(rows), 32 + 32 + 1, 1 + 4)
    table += b"row".ljust(11, b"\0") + b"N" + b"\0" * 4 + bytes([4, 0]) + b"\0" * 14 + b"\r"
    table += b"".join(b" " + b"%4d" % k for k in range(len(rows))) + b"\x1a"
    prj = (b'GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],'
           b'PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]')
    return {"rows.shp": head(100 + len(records)) + records, "rows.shx": head(100 + len(index)) + index,
            "rows.dbf": table, "rows.prj": prj}


def geotiff() -> bytes:
    """40 x 40 heights as float, in WGS84."""
    columns = rows = 40
    step = 6e-5
    heights = b"".join(struct.pack("<f", 300 + 0.1 * i + 0.2 * j) for j in range(rows) for i in range(columns))
    keys = [1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326]
    doubles = [step, step, 0.0, 0.0, 0.0, 0.0, LONGITUDE - 20 * step, LATITUDE + 20 * step, 0.0]
    entries = [(256, 3, 1, columns), (257, 3, 1, rows), (258, 3, 1, 32), (259, 3, 1, 1), (262, 3, 1, 1), (273, 4, 1, "data"),
               (277, 3, 1, 1), (278, 3, 1, rows), (279, 4, 1, len(heights)), (339, 3, 1, 3), (33550, 12, 3, "scale"),
               (33922, 12, 6, "tie"), (34735, 3, len(keys), "keys")]
    behind = 8 + 2 + 12 * len(entries) + 4
    places = {"scale": behind, "tie": behind + 24, "keys": behind + 72, "data": behind + 72 + 2 * len(keys)}
    data = struct.pack("<2sHI", b"II", 42, 8) + struct.pack("<H", len(entries))
    for tag, kind, count, value in entries:
        value = places.get(value, value) if isinstance(value, str) else value
        data += struct.pack("<HHI", tag, kind, count) + (struct.pack("<HH", value, 0) if kind == 3 and count == 1
                                                         else struct.pack("<I", value))
    data += struct.pack("<I", 0) + struct.pack("<9d", *doubles) + struct.pack(f"<{len(keys)}H", *keys)
    return data + heights


def _cloud() -> list[tuple[float, float, float]]:
    """Ground and four rows of canopy, 12 points/m2."""
    points = []
    for i in range(80):
        for j in range(50):
            x, y = 0.3 * i, 0.3 * j - 2.0
            points.append((x, y, 0.02 * x + 0.01 * ((7 * i + 3 * j) % 5)))
    for row in range(4):
        for i in range(200):
            for k in range(6):
                points.append((0.12 * i, 3.0 * row + 0.1 * ((i + k) % 5) - 0.2, 0.02 * 0.12 * i + 0.5 + 0.25 * k))
    return points


def xyz() -> bytes:
    return "".join("%.3f %.3f %.3f\n" % p for p in _cloud()).encode()


def csv() -> bytes:
    return b"x,y,z\n" + "".join("%.3f,%.3f,%.3f\n" % p for p in _cloud()).encode()


def pcd(form: str) -> bytes:
    points = _cloud()
    head = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
            f"WIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\nDATA {form}\n").encode()
    if form == "ascii":
        return head + xyz()
    return head + b"".join(struct.pack("<3f", *p) for p in points)


def cloud_ply(form: str) -> bytes:
    points = _cloud()
    head = (f"ply\nformat {form} 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
            "end_header\n").encode()
    return head + (xyz() if form == "ascii" else b"".join(struct.pack("<3f", *p) for p in points))


def las(minor: int) -> bytes:
    points = _cloud()
    header_bytes, form, record = (227, 2, 26) if minor == 2 else (375, 7, 36)
    axes = list(zip(*points))
    head = bytearray(header_bytes)
    head[0:4] = b"LASF"
    head[24:26] = bytes([1, minor])
    struct.pack_into("<HIIBH", head, 94, header_bytes, header_bytes, 0, form, record)
    if minor == 2:
        struct.pack_into("<I5I", head, 107, len(points), len(points), 0, 0, 0, 0)
    else:
        struct.pack_into("<H", head, 6, 16)
        struct.pack_into("<Q15Q", head, 247, len(points), len(points), *[0] * 14)
    struct.pack_into("<3d3d", head, 131, 0.001, 0.001, 0.001, 0, 0, 0)
    struct.pack_into("<6d", head, 179, max(axes[0]), min(axes[0]), max(axes[1]), min(axes[1]), max(axes[2]), min(axes[2]))
    data = bytes(head)
    for p in points:
        at = struct.pack("<3i", *(round(1000 * c) for c in p))
        data += at + (struct.pack("<HBBbBHHHH", 0, 9, 2, 0, 0, 0, 90, 120, 60) if minor == 2 else
                      struct.pack("<HBBBBhHdHHH", 0, 17, 0, 2, 0, 0, 0, 0.0, 90, 120, 60))
    return data


def plan() -> bytes:
    items = []
    for k, (command, x, y) in enumerate(((22, 0, 0), (16, 40, 0), (16, 40, 40), (16, 0, 40), (21, 0, 0))):
        longitude, latitude = _degrees(x, y)
        items.append({"autoContinue": True, "command": command, "doJumpId": k + 1, "frame": 3, "type": "SimpleItem",
                      "params": [15 if command == 22 else 0, 0, 0, None, latitude, longitude, 0 if command == 21 else 40]})
    return json.dumps({"fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
                       "geoFence": {"version": 2, "circles": [], "polygons": []},
                       "rallyPoints": {"version": 2, "points": []},
                       "mission": {"version": 2, "firmwareType": 12, "vehicleType": 1, "cruiseSpeed": 15, "hoverSpeed": 5,
                                   "plannedHomePosition": [LATITUDE, LONGITUDE, 300], "items": items}}, indent=1).encode()


def waypoints() -> bytes:
    text = "QGC WPL 110\n"
    places = ((16, 0, 0, 300, 0), (22, 0, 0, 40, 3), (16, 40, 0, 40, 3), (16, 40, 40, 40, 3), (21, 0, 0, 0, 3))
    for k, (command, x, y, height, frame) in enumerate(places):
        longitude, latitude = _degrees(x, y)
        text += f"{k}\t{int(k == 0)}\t{frame}\t{command}\t0\t0\t0\t0\t{latitude:.8f}\t{longitude:.8f}\t{height}\t1\n"
    return text.encode()
