"""Parts that do what parts of the tree do, for parts_test.py."""

import math

import numpy

from vinerow import elementary, parts


@parts.controller("sine_py", rate_Hz=100, writes=["actuators"])
class Sine(parts.Controller):
    """tests/scenarios/plugins/sine_controller.cpp"""

    def connect(self, ports):
        self.actuators = ports.write("actuators")

    def step(self, now_s):
        names = [actuator.name for actuator in self.context.vehicle.actuators]
        self.actuators.write({name: 2.0 + elementary.sin(7.0 * now_s + float(i)) for i, name in enumerate(names)})


@parts.controller("machine_sine", rate_Hz=100, writes=["actuators"])
class MachineSine(Sine):
    """With the sines of math and numpy, which must be the same in the command and here"""

    def step(self, now_s):
        names = [actuator.name for actuator in self.context.vehicle.actuators]
        self.actuators.write({name: 2.0 + math.exp(math.sin(7.0 * now_s + i)) * numpy.tanh(now_s + i) for i, name in enumerate(names)})


@parts.controller("random_walk", rate_Hz=20, writes=["actuators"])
class RandomWalk(Sine):
    """Random wheel speeds"""

    def __init__(self):
        self.generator = self.context.random("wheels")

    def step(self, now_s):
        self.actuators.write({actuator.name: self.generator.uniform(1.0, 5.0) for actuator in self.context.vehicle.actuators})


@parts.controller("until", rate_Hz=20, writes=["actuators"])
class Until(Sine):
    """Drives until a time, then finishes or gives up"""

    end_s = parts.Number(1.0, "s", "end of the task", at_least=0)
    gives_up = parts.Boolean(False, "give up instead")
    wheels_radps = parts.Numbers([1.0, 1.0, 1.0, 1.0], "rad/s", "of each wheel", size=4, at_most=10)
    side = parts.Text("left", "a word", one_of=["left", "right"])
    count = parts.Integer(3, "a number", at_least=1)
    words = parts.Texts(["a"], "words")
    must_mps = parts.Number(parts.REQUIRED, "m/s", "a value that must be given")
    maybe_m = parts.Number(None, "m", "a value that may be absent")

    def step(self, now_s):
        self.now_s = now_s
        self.actuators.write(dict(zip([actuator.name for actuator in self.context.vehicle.actuators], self.wheels_radps)))

    def finished(self):
        return not self.gives_up and self.now_s >= self.end_s

    def failure(self):
        return "ran out of patience" if self.gives_up and self.now_s >= self.end_s else ""


@parts.estimator("copy", rate_Hz=50, reads=["truth"])
class Copy(parts.Estimator):
    """The truth itself"""

    def connect(self, ports):
        self.truth, self.estimate = ports.read("truth"), ports.write("estimate")

    def step(self, now_s):
        self.estimate.write(dict(self.truth.value))


@parts.planner("line")
class Line(parts.Planner):
    """A straight path along the alley of the map"""

    def plan(self, start):
        first, last = self.context.map.alleys[0].line[[0, -1]]
        if len(self.context.map.rows) > 2:
            raise parts.NoPath("only for two rows")
        yaw = math.atan2(last[1] - first[1], last[0] - first[0])
        self.numbers = {"alleys": 1}
        return {"points": [{"position": first + (last - first) * k / 40, "yaw": yaw, "alley": 0} for k in range(41)]}


@parts.guidance("forward_py", rate_Hz=20, reads=["estimate"], writes=["local_command"])
class Forward(parts.Guidance):
    """Signed speed and straight axles"""

    def connect(self, ports):
        self.estimate, self.command = ports.read("estimate"), ports.write("local_command")

    def step(self, now_s):
        self.command.write({"mode": "DRIVE", "speed": 0.5 if self.estimate["pose"].position[2] < 1e3 else 0.0})
