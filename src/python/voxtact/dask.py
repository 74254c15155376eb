# SPDX-License-Identifier: MIT
"""Questions about many poses, over the workers of a Dask cluster.

    from dask.distributed import Client
    from voxtact.dask import ask

    def scene():                                       # each worker calls it once
        return vx.Scene("head.nii.gz", opacity=[(40, 0), (80, 1)], threads=1)

    with Client("tcp://scheduler:8786") as client:
        answer = ask("touch", scene, knife, poses, client, margin=2)

Scenes cannot be sent: each worker creates its own. Meshes, poses and answers are sent.
"""
from __future__ import annotations

import copy
import functools
from collections.abc import Callable
from typing import Any, Optional

import numpy as np

from ._answer import Touch
from ._arguments import Poses, count_of
from ._common import numbers, whole_number
from ._library import named, questions
from ._mesh import Mesh
from ._motion import Motion
from ._scene import Scene
from ._tables import Tables

#: Minimum poses per task; a smaller task takes longer to send than to answer.
PER_TASK = 100_000


@functools.lru_cache(maxsize=4)
def _kept_scene(make: Callable[[], Scene]) -> Scene:
    return make()


def _part(question: str, make: Callable[[], Scene], mesh: Mesh, poses: Any, options: dict[str, Any]) -> Any:
    """Runs a worker's part."""
    scene = _kept_scene(make)
    by_method = getattr(scene, question, None)
    return scene.ask(question, mesh, poses, **options) if by_method is None else by_method(mesh, poses, **options)


def ask(question: str, scene_factory: Callable[[], Scene], mesh: Mesh,
        poses: Poses, client: Optional[Any] = None, *, per_task: int = PER_TASK, **options: Any) -> Any:
    """Answers like `Scene.QUESTION(mesh, poses, **options)`, row for row, by the workers of a cluster.

    question
        a name in `voxtact.questions()`; `Scene.ask` answers those without a method
    scene_factory
        creates the scene; each worker calls it once. A function of a module, or another object that Dask can send
    client
        client of dask.distributed; None: the current one
    per_task
        number of poses per task
    options
        options of the question. Later requests of outputs are refused: `count(contacts=True)` requests contacts

    Answers do not depend on the division into tasks. Raises the question's errors; an invalid pose is named by its index
    in its task.
    """
    if client is None:
        from dask.distributed import get_client

        client = get_client()
    named(question, "question", tuple(one.name for one in questions()))
    matrices = numbers(poses, "poses")
    whole = matrices.reshape(-1, 4, 4) if matrices.shape[-2:] == (4, 4) else matrices
    size = whole_number(per_task, "per_task", 1)
    # A segment needs both of its poses.
    last, more = (count_of(whole) - 1, 1) if question == "motion" else (count_of(whole), 0)
    there = client.scatter(mesh, broadcast=True) if last > size else mesh
    tasks = [client.submit(_part, question, scene_factory, there, whole[first:min(first + size, last) + more], options, pure=False)
             for first in range(0, max(last, 1), size)]
    return _joined(client.gather(tasks))


def _joined(parts: list[Any]) -> Any:
    """Joins the answers of all parts."""
    joined = copy.copy(parts[0])
    joined._tables = Tables.joined([part._tables for part in parts])
    if isinstance(joined, Motion):
        joined._impacts = np.concatenate([part.impacts for part in parts])
    if isinstance(joined, Touch) and joined._with_witness:
        joined._witness = np.concatenate([part.witness for part in parts])
    return joined
