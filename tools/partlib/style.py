"""One look for all pictures."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLOURS = ["#1f6fb4", "#d9640a", "#3a8a2e", "#8a4fa8", "#b8252b", "#7a6a10", "#0f8f95", "#555555"]
GREY = "0.45"

plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 9.5, "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": "0.9", "grid.linewidth": 0.6, "axes.axisbelow": True, "legend.frameon": False,
    "legend.fontsize": 8, "legend.title_fontsize": 8, "lines.linewidth": 1.3, "figure.constrained_layout.use": True, "font.family": "DejaVu Sans",
    "axes.prop_cycle": matplotlib.cycler(color=COLOURS)})


def panels(rows: int, columns: int, width: float = 8.6, height: float = 3.0, **options):
    """Figure and a flat list of axes; height is that of a row, in inches."""
    figure, axes = plt.subplots(rows, columns, figsize=(width, height * rows), squeeze=False, **options)
    return figure, list(axes.flat)


def bare(axes) -> None:
    """Axes of a photograph."""
    axes.grid(False)
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)
