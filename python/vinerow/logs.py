"""Logs of runs."""

from __future__ import annotations

import os
from typing import Any, Mapping, Sequence, overload

import numpy

from . import _arguments, _core, display
from .arrays import Array
from .errors import ConfigError
from .pictures import Picture


class Log(_core.Log):
    """A log of a run, by topic.

    log["rover/truth"] reads all messages of a signal: a Message with `stamp_s` (n,) and one column per field.
    """

    def frame(self, topic: str) -> Any:
        """All messages of a signal as a pandas.DataFrame with the index stamp_s.

        Vectors have a column for each component, "pose.position.x"; actuators and wheels one for each name.
        """
        return self[topic].to_pandas()

    @overload
    def render(self, time_s: float, camera: str | Mapping[str, Any] | None = None, *, width: int | None = None,
               height: int | None = None) -> Picture: ...

    @overload
    def render(self, time_s: Sequence[float] | Array, camera: str | Mapping[str, Any] | None = None, *,
               width: int | None = None, height: int | None = None) -> Array: ...

    def render(self, time_s: Any, camera: str | Mapping[str, Any] | None = None, *, width: int | None = None,
               height: int | None = None) -> Any:
        """Draws the run, as `vinerow render` does.

        Args:
            time_s: a simulated time, or several, which then share the work of building the scene
            camera: name of a camera of the scenario, or a dict with the keys of one, {"kind": "chase", "vehicle": "rover"};
                default: the first, else one behind the first vehicle
            width, height: pixels; default: those of the scenario
        Returns:
            a Picture (h, w, 3), or an array (n, h, w, 3) for several times, uint8
        Raises:
            ConfigError: on a time outside the log or a camera that does not exist
            UsageError: if this machine cannot draw (OSMesa is missing)
        """
        try:
            times = numpy.asarray(time_s, float)
        except (TypeError, ValueError):
            raise ConfigError(f"time_s must be a number or a list of numbers, not {time_s!r}") from None
        if times.ndim > 1 or times.size == 0 or not numpy.isfinite(times).all():
            raise ConfigError("time_s must be a finite number or a list of them")
        for name, size in (("width", width), ("height", height)):
            if size is not None:
                _arguments.whole(name, size)
        distinct, which = numpy.unique(times.ravel(), return_inverse=True)
        pictures = self.render_at(list(distinct), dict(camera) if isinstance(camera, Mapping) else camera, width, height)
        if times.ndim == 0:
            return pictures[0].view(Picture)
        return numpy.stack([pictures[k] for k in which])

    def __repr__(self) -> str:
        return f"Log('{self.file}', {self.first_s:g} s to {self.last_s:g} s)"

    def _repr_html_(self) -> str:
        return display.log_html(self)


def read_log(file: str | os.PathLike[str]) -> Log:
    """Opens a log of a run, or the log in a run's folder; `log["rover/truth"]` then reads all messages of a signal as arrays."""
    path = _arguments.path("file", file)
    return Log(os.path.join(path, "log.mcap") if os.path.isdir(path) else path)
