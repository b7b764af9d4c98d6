"""HTML of vinerow's objects for notebooks. Every text from a file is escaped."""

from __future__ import annotations

import base64
import html
import math
import pathlib
from typing import TYPE_CHECKING, Any, Iterable, Sequence

import numpy

from . import _core
from .arrays import Array

if TYPE_CHECKING:
    from .logs import Log
    from .messages import Message
    from .pictures import Pictures
    from .runs import Run
    from .studies import Study
    from .tables import Table

_SHOWN_ROWS = 12  # of a long table; half of them from its end
_SHOWN_PICTURES = 4
_THUMBNAIL_PX = 320  # width
_KEY_METRICS = ("time_s", "distance_m", "mean_speed_mps", "cross_track_rms_m", "cross_track_max_m", "average_deviation_m",
                "min_clearance_m", "energy_J")
_COLOURS = {"good": "#2e7d4f", "bad": "#b3402e", "plain": "#5f6b70"}
_STATES = {"succeeded": "good", "met": "good", "failed": "bad", "blocked": "bad", "not met": "bad", "broken off": "bad",
           "crashed": "bad", "invalid": "bad", "out of time": "bad", "out of memory": "bad"}
_CELL = "padding:2px 14px 2px 0;text-align:{};vertical-align:top"


def _text(value: Any) -> str:
    return html.escape(str(value))


def _number(value: float) -> str:
    if isinstance(value, float) and math.isnan(value):
        return "–"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, numpy.number)) and not isinstance(value, (bool, numpy.bool_))


def _badge(text: Any, kind: str) -> str:
    return (f'<span style="background:{_COLOURS[kind]};color:#fff;border-radius:3px;padding:1px 8px;font-size:90%;'
            f'white-space:nowrap">{_text(text)}</span>')


def _value(value: Any) -> str:
    if isinstance(value, numpy.generic):
        value = value.item()
    if isinstance(value, str) and value in _STATES:
        return f'<span style="color:{_COLOURS[_STATES[value]]}">{_text(value)}</span>'
    return _text(_number(value) if _is_number(value) else value)


def _table(head: Sequence[str], rows: Iterable[Sequence[Any]], gap_after: int | None = None) -> str:
    """A table of plain values; columns of numbers are aligned to the right. gap_after: dots follow this number of rows."""
    rows = [list(row) for row in rows]
    styles = [_CELL.format("right" if rows and all(_is_number(row[k]) for row in rows) else "left") for k in range(len(head))]
    lines = ["".join(f'<th style="{style};font-weight:600">{_text(name)}</th>' for name, style in zip(head, styles))]
    for count, row in enumerate(rows):
        if count == gap_after:
            lines.append("".join(f'<td style="{style}">⋮</td>' for style in styles))
        lines.append("".join(f'<td style="{style}">{_value(value)}</td>' for value, style in zip(row, styles)))
    body = "".join(f'<tr style="background:none">{line}</tr>' for line in lines)
    return f'<div style="overflow-x:auto"><table style="border-collapse:collapse;font-size:90%;margin:4px 0">{body}</table></div>'


def _frame(title: str, parts: Iterable[str]) -> str:
    return (f'<div style="margin:4px 0;line-height:1.5"><div style="margin-bottom:4px">{title}</div>'
            f'{"".join(parts)}</div>')


def _title(name: Any, kind: str) -> str:
    return f'<b>{_text(name)}</b> <span style="opacity:.65">{_text(kind)}</span>'


def _line(text: str) -> str:
    return f"<div>{text}</div>"


def _folded(summary: str, body: str) -> str:
    return f'<details><summary style="cursor:pointer">{_text(summary)}</summary>{body}</details>'


def table_html(table: Table) -> str:
    count, half = table.row_count, _SHOWN_ROWS // 2
    indices = range(count) if count <= _SHOWN_ROWS else [*range(half), *range(count - half, count)]
    rows = [[column[k] for column in table.values()] for k in indices]
    note = f'<span style="opacity:.65">{count} rows, {len(table)} columns</span>'
    return _table(list(table), rows, half if count > _SHOWN_ROWS else None) + note


def _thumbnail(picture: Array) -> str:
    """An <img> of the picture, made smaller by the mean of square blocks of pixels."""
    block = max(1, -(-picture.shape[1] // _THUMBNAIL_PX))
    height, width = picture.shape[0] // block, picture.shape[1] // block
    if height and width:
        blocks = picture[: height * block, : width * block].reshape(height, block, width, block, 3)
        picture = (blocks.mean(axis=(1, 3)) + 0.5).astype(numpy.uint8)
    data = base64.b64encode(_core.encode_picture(numpy.ascontiguousarray(picture))).decode()
    return f'<img style="display:block;max-width:100%" src="data:image/png;base64,{data}">'


def _gallery(pictures: Pictures, names: Sequence[str]) -> str:
    figures = "".join(f'<figure style="margin:0 8px 8px 0;flex:0 1 {_THUMBNAIL_PX * 3 // 4}px">{_thumbnail(pictures[name])}'
                      f'<figcaption style="font-size:80%;opacity:.75">{_text(name)}</figcaption></figure>' for name in names)
    return f'<div style="display:flex;flex-wrap:wrap;margin-top:6px">{figures}</div>'


def pictures_html(pictures: Pictures) -> str:
    names = list(pictures)
    rest = len(names) - 3 * _SHOWN_PICTURES
    more = _line(f"and {rest} more: {_text(', '.join(names[-rest:]))}") if rest > 0 else ""
    return _frame(f"{len(names)} pictures", [_gallery(pictures, names[: 3 * _SHOWN_PICTURES]), more])


def run_html(run: Run) -> str:
    parts = [_line(f"{run.simulated_s:g} s simulated, seed {run.seed}, digest <code>{_text(run.digest)}</code>")]
    if run.error:
        parts.append(_line(f'<span style="color:{_COLOURS["bad"]}">{_text(run.error)}</span>'))
    parts += [_line(_text(sentence)) for sentence in run.missing]
    if run.phases:
        parts.append(_table(["phase", "state", "begin, s", "end, s", "reason"],
                            [[p.name, p.state, "–" if p.begin_s is None else p.begin_s, "–" if p.end_s is None else p.end_s, p.reason]
                             for p in run.phases]))
    if run.criteria:
        parts.append(_table(["criterion", "value", "limit", ""],
                            [[c.name, c.value, c.limit, "met" if c.met else "failed"] for c in run.criteria]))
    names = [name for name in _KEY_METRICS if any(not math.isnan(metrics.get(name, math.nan)) for metrics in run.metrics.values())]
    if names:
        owners = [owner for owner, metrics in run.metrics.items() if any(name in metrics for name in names)]
        parts.append(_table(["metric", *owners], [[name, *(run.metrics[owner].get(name, math.nan) for owner in owners)] for name in names]))
    rows = [[owner, name, value] for owner, metrics in run.metrics.items() for name, value in metrics.items() if not math.isnan(value)]
    parts.append(_folded(f"all {len(rows)} numbers", _table(["of", "metric", "value"], rows)))
    pictures = run.pictures
    if pictures:
        parts.append(_gallery(pictures, list(pictures)[-_SHOWN_PICTURES:]))
    title = f"{_title(run.name, 'run')} {_badge(run.verdict, 'good' if run.met else 'bad')}"
    return _frame(title, parts)


def log_html(log: Log) -> str:
    rows = [[name, type, count] for name, (type, count) in log.topics().items()]
    complete = "" if log.complete else " " + _badge("interrupted", "bad")
    parts = [_line(f"{log.first_s:g} s to {log.last_s:g} s, <code>{_text(log.file)}</code>")]
    parts += [_line(_text(sentence)) for sentence in log.warnings]
    return _frame(_title(log.metadata.get("scenario", ""), "log") + complete, [*parts, _table(["topic", "type", "messages"], rows)])


def message_html(message: Message) -> str:
    def shape(value: Any) -> str:
        if hasattr(value, "_asdict"):
            return ", ".join(f"{name} {part.shape}" for name, part in value._asdict().items())
        return str(value.shape) if isinstance(value, numpy.ndarray) else f"list of {len(value)}" if isinstance(value, list) else repr(value)
    return _frame(_title(message.type, "message"), [_table(["field", "shape or value"], [[name, shape(value)] for name, value in message.items()])])


def scenario_html(scenario: _core.Scenario) -> str:
    description = [_line(_text(scenario.description))] if scenario.description else []
    facts = (f"at most {scenario.duration_s:g} s, seed {scenario.seed}, step {scenario.physics_step_s:g} s, vehicles: "
             f"{', '.join(scenario.vehicles) or 'none'}")
    yaml = _folded("as resolved", f"<pre style='max-height:400px;overflow:auto;font-size:85%'>{_text(scenario.yaml)}</pre>")
    return _frame(_title(scenario.name, "scenario"), [*description, _line(_text(facts)), yaml])


def session_html(session: _core.Session) -> str:
    if session.closed:
        return _frame(_title("closed", "session"), [])
    state = ("over" + (", finished" if session.finished else "")) if session.over else "running"
    rows = [[name, type, writer] for name, (type, writer) in session.signals().items()]
    return _frame(f"{_title(', '.join(session.vehicles), 'session')} {_badge(state, 'plain')}",
                  [_line(f"at {session.now_s:g} s, seed {session.seed}, digest <code>{_text(session.digest)}</code>"),
                   _folded(f"{len(rows)} signals", _table(["signal", "type", "writer"], rows))])


def study_html(study: Study) -> str:
    states = study.cells.get("state", numpy.array([], object))
    counts = {state: int((states == state).sum()) for state in dict.fromkeys(states)}
    badges = " ".join(_badge(f"{count} {state}", _STATES.get(state, "plain")) for state, count in counts.items())
    return _frame(f"{_title(study.folder.name, 'study')} {badges}",
                  [_line("settings"), table_html(study.settings), _folded("cells", table_html(study.cells))])


class Page:
    """A page of a run in a frame of a notebook.

    The notebook contains the page, which needs neither the file nor a network. Its scripts cannot reach the notebook.
    """

    def __init__(self, file: pathlib.Path, height: int):
        self.file, self.height = file, height

    def __repr__(self) -> str:
        return f"Page('{self.file}')"

    def _repr_html_(self) -> str:
        text = html.escape(self.file.read_text(encoding="utf-8"))
        return (f'<iframe sandbox="allow-scripts allow-popups" allowfullscreen style="width:100%;height:{int(self.height)}px;'
                f'border:1px solid #8886" srcdoc="{text}"></iframe>')
