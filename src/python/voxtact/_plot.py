# SPDX-License-Identifier: MIT
"""Plots, with matplotlib where it is there."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Union

import numpy as np

if TYPE_CHECKING:
    from ._answer import Answer, Area, Clearance
    from ._motion import Motion


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    from matplotlib import pyplot

    return pyplot.subplots()[1]


def plot_answer(answer: Answer, ax: Any) -> Any:
    axes = _axes(ax)
    rows = np.arange(len(answer))
    touching, possible = answer.hit, answer.possible
    free = ~touching & ~possible
    axes.plot(rows[free], answer.count[free], ".", color="tab:gray", label="free")
    axes.plot(rows[touching], answer.count[touching], ".", color="tab:red", label="touches")
    axes.plot(rows[possible], answer.count[possible], "o", color="tab:red", fillstyle="none", label="possible")
    axes.set_xlabel("pose")
    axes.set_ylabel("fragments in contact")
    axes.legend()
    return axes


def _plot_bounds(of: Union[Area, Clearance], name: str, unit: str, ax: Any) -> Any:
    axes = _axes(ax)
    rows = np.arange(len(of))
    columns = of.lo.reshape(len(of), -1).shape[1] if len(of) else 0
    for column in range(columns):
        lo = of.lo.reshape(len(of), -1)[:, column]
        hi = of.hi.reshape(len(of), -1)[:, column]
        line = axes.plot(rows, lo, label=f"label {of.labels[column]}" if of.labels.size else name)[0]
        axes.fill_between(rows, lo, np.where(np.isfinite(hi), hi, lo), color=line.get_color(), alpha=0.3)
    axes.set_xlabel("pose")
    axes.set_ylabel(unit)
    axes.legend()
    return axes


def plot_clearance(clearance: Clearance, ax: Any) -> Any:
    return _plot_bounds(clearance, "clearance", "mm", ax)


def plot_area(area: Area, ax: Any) -> Any:
    return _plot_bounds(area, "contact area", "mm²", ax)


def plot_motion(motion: Motion, ax: Any) -> Any:
    axes = _axes(ax)
    rows = np.arange(len(motion))
    axes.vlines(rows, 0, motion.free_until, color="tab:green", label="free until")
    axes.plot(rows[motion.hit], motion.touch_at[motion.hit], ".", color="tab:red", label="touches at")
    axes.plot(rows[motion.possible], motion.free_until[motion.possible], "o", color="tab:red", fillstyle="none",
              label="possible from")
    axes.set_xlabel("segment")
    axes.set_ylabel("parameter")
    axes.set_ylim(0, 1.02)
    axes.legend()
    return axes
