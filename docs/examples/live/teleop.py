#!/usr/bin/env python3
"""Drives a rover of a live run from a terminal, over Foxglove's WebSocket protocol.

    vinerow run vineyard_teleop.yaml --live
    teleop.py [ws://localhost:8765] [--script "forward 2; left 1"]

Keys: w, a, s, d or the arrows; a motion lasts until the next key. Space stops, q quits. A script has motions (forward, back,
left, right, stop) with simulated seconds. Needs the package websockets, version 15 or later.
"""

import argparse
import contextlib
import json
import os
import select
import struct
import sys
import termios
import time
import tty

from websockets.exceptions import ConnectionClosed, InvalidStatus, WebSocketException
from websockets.sync.client import ClientConnection, connect

MOTIONS = {"forward": (0.8, 0.0), "back": (-0.8, 0.0), "left": (0.0, 0.6), "right": (0.0, -0.6), "stop": (0.0, 0.0)}
KEYS = {b"w": "forward", b"s": "back", b"a": "left", b"d": "right", b" ": "stop", b"q": "quit",
        b"\x1b[A": "forward", b"\x1b[B": "back", b"\x1b[D": "left", b"\x1b[C": "right"}
PERIOD_s = 0.05  # of commands; the rover stops if none has come for 0.5 s


def read_odometry(cdr: bytes) -> tuple[float, float, float, float]:
    """x, y, speed and yaw rate of a nav_msgs/Odometry. CDR aligns numbers to their size, counted from byte 4."""
    at = 12  # encapsulation, stamp
    for _ in ("header.frame_id", "child_frame_id"):
        at += -at % 4
        at += 4 + struct.unpack_from("<I", cdr, at)[0]
    at += (4 - at) % 8
    pose, twist = struct.unpack_from("<7d", cdr, at), struct.unpack_from("<6d", cdr, at + 8 * (7 + 36))
    return pose[0], pose[1], twist[0], twist[5]


def script(text: str) -> list[tuple[str, float]]:
    motions = [(name, float(seconds)) for name, seconds in map(str.split, text.split(";"))]
    if any(name not in MOTIONS for name, _ in motions):
        raise ValueError
    return motions


class Teleop:
    def __init__(self, socket: ClientConnection):
        self.socket, self.time_s, self.shown = socket, None, ""
        while self.time_s is None:  # the run has not begun
            self.listen()

    def listen(self) -> None:
        end = time.monotonic() + PERIOD_s
        with contextlib.suppress(TimeoutError):
            while (left_s := end - time.monotonic()) > 0:
                self.handle(self.socket.recv(timeout=left_s))

    def handle(self, frame: str | bytes) -> None:
        message = json.loads(frame) if isinstance(frame, str) else {"op": frame[0]}  # text or binary
        if message["op"] == 2:  # simulated time
            self.time_s = struct.unpack_from("<Q", frame, 1)[0] / 1e9
        elif message["op"] == 1:  # a message: subscription, time, CDR
            self.shown = "x %.2f m, y %.2f m, %.2f m/s, %.2f rad/s" % read_odometry(frame[13:])
        elif message["op"] == "status" and message["level"] == 2:
            sys.exit(f"teleop: {message['message']}")
        elif message["op"] == "advertise" and message["channels"]:  # the run begins, or begins again after a reset
            wanted = [{"id": 1, "channelId": each["id"]} for each in message["channels"] if each["topic"] == "/rover/truth"]
            commands = {"id": 1, "topic": "/rover/cmd_vel", "encoding": "json", "schemaName": "geometry_msgs/msg/Twist"}
            self.socket.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))
            self.socket.send(json.dumps({"op": "advertise", "channels": [commands]}))

    def command(self, motion: str) -> None:
        """Sends a motion, and listens for one period."""
        speed_mps, yaw_rate_radps = MOTIONS[motion]
        twist = {"linear": {"x": speed_mps}, "angular": {"z": yaw_rate_radps}}
        self.socket.send(struct.pack("<BI", 1, 1) + json.dumps(twist).encode())  # message, channel
        self.listen()

    def run_script(self, motions: list[tuple[str, float]]) -> None:
        for motion, seconds in [*motions, ("stop", 1.0)]:
            end_s = self.time_s + seconds
            while self.time_s < end_s:
                self.command(motion)
            print(f"{motion:8}{self.shown}", flush=True)

    def follow_keys(self) -> None:
        settings, motion = termios.tcgetattr(sys.stdin), "stop"
        tty.setcbreak(sys.stdin)
        try:
            while motion != "quit":
                self.command(motion)
                print(f"\r{motion:8}{self.shown:56}", end="", flush=True)
                if select.select([sys.stdin], [], [], 0)[0]:
                    typed = os.read(sys.stdin.fileno(), 64) or b"q"
                    motion = next((KEYS[key] for key in KEYS if typed.endswith(key)), motion)
            self.command("stop")
        finally:
            termios.tcsetattr(sys.stdin, termios.TCSADRAIN, settings)
            print()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address", nargs="?", default="ws://localhost:8765", help="with ?token=... if the run has a token")
    parser.add_argument("--script", type=script, help="motions in place of keys")
    options = parser.parse_args()
    options.script or sys.stdin.isatty() or parser.error("standard input is no terminal: give --script")
    try:
        with contextlib.suppress(KeyboardInterrupt), connect(options.address, subprotocols=["foxglove.websocket.v1"],
                                                             max_size=None, proxy=None) as socket:
            teleop = Teleop(socket)
            teleop.run_script(options.script) if options.script else teleop.follow_keys()
    except ConnectionClosed:
        sys.exit("teleop: the run is over")
    except (OSError, WebSocketException) as error:
        reason = error.response.body.decode().strip() if isinstance(error, InvalidStatus) else error
        sys.exit(f"teleop: no live run at {options.address}: {reason}")
