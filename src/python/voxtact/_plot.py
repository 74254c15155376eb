# SPDX-License-Identifier: MIT
"""Plots, with matplotlib if it is installed."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Union

import numpy as np

if TYPE_CHECKING:
    from ._answer import Area, Count, Distance, Overlap, Touch
    from ._motion import Motion


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    from matplotlib import pyplot

    return pyplot.subplots()[1]


def _plot_verdicts(answer: Union[Touch, Count], values: Any, name: str, ax: Any) -> Any:
    axes = _axes(ax)
    rows = np.arange(len(answer))
    touching, undecided = answer.touches, answer.undecided
    free = ~touching & ~undecided
    axes.plot(rows[free], values[free], ".", color="tab:gray", label="free")
    axes.plot(rows[touching], values[touching], ".", color="tab:red", label="touches")
    axes.plot(rows[undecided], values[undecided], "o", color="tab:red", fillstyle="none", label="undecided")
    axes.set_xlabel("pose")
    axes.set_ylabel(name)
    axes.legend()
    return axes


def plot_touch(answer: Touch, ax: Any) -> Any:
    axes = _plot_verdicts(answer, answer.touches + 0.5 * answer.undecided, "touches", ax)
    axes.set_yticks([0, 0.5, 1], ["no", "undecided", "yes"])
    return axes


def plot_count(answer: Count, ax: Any) -> Any:
    return _plot_verdicts(answer, answer.count, "fragments in contact", ax)


def _plot_bounds(of: Union[Area, Distance, Overlap], name: str, unit: str, ax: Any) -> Any:
    axes = _axes(ax)
    rows = np.arange(len(of))
    columns = of.lower.reshape(len(of), -1).shape[1] if len(of) else 0
    for column in range(columns):
        lower = of.lower.reshape(len(of), -1)[:, column]
        upper = of.upper.reshape(len(of), -1)[:, column]
        line = axes.plot(rows, lower, label=f"label {of.labels[column]}" if of.labels.size else name)[0]
        axes.fill_between(rows, lower, np.where(np.isfinite(upper), upper, lower), color=line.get_color(), alpha=0.3)
    axes.set_xlabel("pose")
    axes.set_ylabel(unit)
    axes.legend()
    return axes


def plot_distance(of: Distance, ax: Any) -> Any:
    return _plot_bounds(of, "distance", "mm", ax)


def plot_area(area: Area, ax: Any) -> Any:
    return _plot_bounds(area, "contact area", "mm²", ax)


def plot_overlap(overlap: Overlap, ax: Any) -> Any:
    """Plots overlaps; bands are bars, one line per pose."""
    if not len(overlap.bands):
        return _plot_bounds(overlap, "overlap", "mm³", ax)
    axes = _axes(ax)
    names = [f"< {end:g}" if begin == -np.inf else f"≥ {begin:g}" if end == np.inf else f"{begin:g} to {end:g}"
             for begin, end in overlap.bands]
    columns = np.arange(len(names))
    width = 0.8 / max(len(overlap), 1)
    for row, (lower, upper) in enumerate(zip(overlap.lower, overlap.upper)):
        at = columns + (row + 0.5) * width - 0.4
        axes.bar(at, lower, width, label=f"pose {row}")
        axes.bar(at, upper - lower, width, bottom=lower, color="tab:gray", alpha=0.5)
    axes.set_xticks(columns, names)
    axes.set_xlabel("value")
    axes.set_ylabel("mm³")
    if 1 < len(overlap) <= 10:
        axes.legend()
    return axes


def plot_motion(motion: Motion, ax: Any) -> Any:
    axes = _axes(ax)
    rows = np.arange(len(motion))
    axes.vlines(rows, 0, motion.toi_lower, color="tab:green", label="collision-free until")
    axes.plot(rows[motion.touches], motion.toi_upper[motion.touches], ".", color="tab:red", label="touches at")
    axes.plot(rows[motion.undecided], motion.toi_lower[motion.undecided], "o", color="tab:red", fillstyle="none",
              label="undecided from")
    axes.set_xlabel("segment")
    axes.set_ylabel("parameter")
    axes.set_ylim(0, 1.02)
    axes.legend()
    return axes
