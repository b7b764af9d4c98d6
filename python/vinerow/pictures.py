"""Pictures as arrays."""

from __future__ import annotations

import pathlib
from typing import Iterator, Mapping

import numpy

from . import _core, display
from .arrays import Array


class Picture(Array):
    """Pixels (h, w, 3), uint8, sRGB; a notebook shows them."""

    def _repr_png_(self) -> bytes | None:
        is_picture = self.ndim == 3 and self.shape[2] == 3 and self.dtype == numpy.uint8 and self.size > 0
        return _core.encode_picture(self) if is_picture else None


class Pictures(Mapping[str, Picture]):
    """Pictures of a run by name, read when they are used: "chase_000004000" is camera and time in ms."""

    def __init__(self, folder: pathlib.Path):
        frames = {file.stem: file for file in sorted((folder / "frames").glob("*.png"))}
        others = {file.relative_to(folder).with_suffix("").as_posix(): file
                  for pattern in ("coverage*.png", "products/*/*.png") for file in sorted(folder.glob(pattern))}
        self._files = {**frames, **others}

    def file(self, name: str) -> pathlib.Path:
        """Path of a picture."""
        if name not in self._files:
            raise KeyError(f"the run has no picture '{name}' (known: {', '.join(self._files) or 'none'})")
        return self._files[name]

    def __getitem__(self, name: str) -> Picture:
        return _core.read_picture(str(self.file(name))).view(Picture)

    def __iter__(self) -> Iterator[str]:
        return iter(self._files)

    def __len__(self) -> int:
        return len(self._files)

    def __repr__(self) -> str:
        return f"Pictures({', '.join(self._files) or 'none'})"

    def _repr_html_(self) -> str:
        return display.pictures_html(self)
