"""Parts that misbehave from 0.5 s on, each in its own way."""

import math
import sys
import threading
import time

from vinerow import parts

KEPT = []


class Bad(parts.Controller):
    def connect(self, ports):
        self.estimate, self.out = ports.read("estimate"), ports.write("actuators")

    def step(self, now_s):
        if now_s >= 0.5:
            return self.fail()
        self.out.write({"wheel_fl_speed_radps": 1.0})


def bad(name):
    return parts.controller(name, rate_Hz=20, description="fails")


@bad("raises")
class Raises(Bad):
    def fail(self):
        return 1 / 0  # LINE raises


@bad("exits")
class Exits(Bad):
    def fail(self):
        sys.exit(3)


@bad("loops")
class Loops(Bad):
    def fail(self):
        print("looping", flush=True)
        while True:
            pass


@bad("loops_in_init")
class LoopsInInit(Bad):
    def __init__(self):
        while True:
            pass


@bad("writes_nan")
class WritesNan(Bad):
    def fail(self):
        self.out.write({"wheel_fl_speed_radps": math.nan})


@bad("wrong_actuator")
class WrongActuator(Bad):
    def fail(self):
        self.out.write({"wheel_front": 1.0})


@bad("wrong_type")
class WrongType(Bad):
    def fail(self):
        self.out.write({"wheel_fl_speed_radps": "fast"})


@bad("no_dict")
class NoDict(Bad):
    def fail(self):
        self.out.write([1.0, 2.0])


@bad("returns")
class Returns(Bad):
    def fail(self):
        return {"wheel_fl_speed_radps": 1.0}


@bad("wrong_field")
class WrongField(Bad):
    def fail(self):
        return self.estimate["pos"]


@bad("odd_finish")
class OddFinish(Bad):
    def fail(self):
        return None

    def finished(self):
        return "yes"


@bad("uses_the_session")
class UsesTheSession(Bad):
    session = None

    def fail(self):
        sys.modules["__main__"].SESSION.close()


@bad("no_field")
class NoField(Bad):
    def fail(self):
        self.estimate[0]


@bad("keeps")
class Keeps(Bad):
    def fail(self):
        KEPT.append((self, self.estimate, self.estimate["pose"], self.context, self.out))
        self.out.write({"wheel_fl_speed_radps": 1.0})


@bad("starts_threads")
class StartsThreads(Bad):
    def fail(self):
        KEPT.append("started")

        def read():
            try:
                self.estimate["pose"]
            except Exception as error:
                KEPT.append(str(error))

        thread = threading.Thread(target=read)
        thread.start()
        thread.join()
        threading.Thread(target=time.sleep, args=(60,), daemon=True).start()


@bad("no_signal")
class NoSignal(Bad):
    def connect(self, ports):
        ports.read("sonar_left")


@bad("no_name")
class NoName(Bad):
    def connect(self, ports):
        ports.read(1)


@bad("nobody_writes")
class NobodyWrites(Bad):
    def connect(self, ports):
        ports.read("estimat", "Odometry")


@bad("raises_in_init")
class RaisesInInit(Bad):
    def __init__(self):
        raise ValueError("no")


@parts.planner("bad_path", description="a path of one point")
class BadPath(parts.Planner):
    def plan(self, start):
        return {"points": [{"position": [0, 0, 0]}]}


@parts.planner("bad_shape", description="a point with two numbers")
class BadShape(parts.Planner):
    def plan(self, start):
        return {"points": [{"position": [0, 0]}] * 2}
