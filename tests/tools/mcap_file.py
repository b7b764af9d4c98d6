"""Writes small MCAP logs by hand, for tests that need to know every byte (https://mcap.dev/spec)."""

import pathlib
import struct

# Definitions of messages, to be appended to others.
HEADER = """
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
# sensor_msgs/PointCloud2.
CLOUD = """std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
================================================================================
MSG: sensor_msgs/PointField
uint8 INT8=1
string name
uint32 offset
uint8 datatype
uint32 count
""" + HEADER.lstrip("\n")

MAGIC = b"\x89MCAP0\r\n"


def text(value: str) -> bytes:
    data = value.encode()
    return struct.pack("<I", len(data)) + data


def record(opcode: int, content: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(content)) + content


class Cdr:
    """Little-endian CDR of XCDR version 1: every number aligned to its own size."""

    def __init__(self):
        self.data = b""

    def add(self, code: str, *values):
        size = struct.calcsize("<" + code)
        for value in values:
            self.data += bytes(-len(self.data) % size) + struct.pack("<" + code, value)
        return self

    def text(self, value: str | bytes):
        data = (value.encode() if isinstance(value, str) else value) + b"\0"
        self.add("I", len(data))
        self.data += data
        return self

    def header(self, stamp_ns: int, frame: str = "map"):
        return self.add("i", stamp_ns // 10**9).add("I", stamp_ns % 10**9).text(frame)

    def message(self) -> bytes:
        return b"\x00\x01\x00\x00" + self.data


class Log:
    """One that has no summary, as a killed run leaves it; chunks are not needed."""

    def __init__(self):
        self.records = [record(0x01, text("") + text("test"))]
        self.channels = 0

    def channel(self, topic: str, schema: str, definition: str, encoding: str = "cdr") -> int:
        self.channels += 1
        schema_id = struct.pack("<H", self.channels)
        self.records.append(record(0x03, schema_id + text(schema) + text("ros2msg") + text(definition)))
        content = struct.pack("<HH", self.channels, self.channels) + text(topic) + text(encoding)
        self.records.append(record(0x04, content + struct.pack("<I", 0)))
        return self.channels

    def message(self, channel: int, stamp_ns: int, data: bytes, logged_ns: int | None = None):
        times = struct.pack("<HIQQ", channel, 0, stamp_ns if logged_ns is None else logged_ns, stamp_ns)
        self.records.append(record(0x05, times + data))

    def write(self, file: pathlib.Path):
        end = record(0x0F, struct.pack("<I", 0)) + record(0x02, struct.pack("<QQI", 0, 0, 0))
        file.write_bytes(MAGIC + b"".join(self.records) + end + MAGIC)
