# SPDX-License-Identifier: MIT
"""What test_fuzz.py runs in a process of its own: fuzz_child.py SEED CALLS LOG FOLDER.

Calls everything public with arguments of which some are good and the others are anything. LOG has the call that is being
made, so that a crash tells which it was. What is raised must be a voxtact.Error, TypeError or ValueError.
"""
import faulthandler
import inspect
import os
import pathlib
import random
import resource
import sys

import numpy as np

import voxtact as vx

faulthandler.enable()
resource.setrlimit(resource.RLIMIT_AS, (3 << 30, resource.RLIM_INFINITY))  # what asks for too much gets no memory
SEED, CALLS, LOG, FOLDER = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3], pathlib.Path(sys.argv[4])
dice = random.Random(SEED)
numbers = np.random.default_rng(SEED)

# MemoryError is numpy's own word for no memory, RecursionError the interpreter's for lists in themselves.
ALLOWED = (vx.Error, TypeError, ValueError, MemoryError, RecursionError)


class Liar:
    """Looks like an array, and is none."""

    shape = (4, 4)
    ndim = 2
    vertices = faces = affine = property(lambda self: self.oops)

    def __len__(self):
        return 3

    def __getitem__(self, key):
        raise KeyError(key)


class Raises:
    def __array__(self, *_, **__):
        raise ValueError("no array today")


class HalfAMesh:
    vertices = np.zeros((3, 3))
    faces = "none"


class HalfAnImage:
    """Of nibabel, so it says."""

    affine = np.eye(3)
    dataobj = np.zeros((2, 2, 2))
    header = {}


def an_array():
    """Of any shape, type and order of memory."""
    kind = dice.randrange(9)
    shape = tuple(dice.choice((0, 1, 2, 3, 4, 5)) for _ in range(dice.randrange(5)))
    if dice.random() < 0.4:
        shape = dice.choice(((4, 4), (3, 4, 4), (2, 4, 4), (5, 3), (3,), (4, 2), (2, 4, 3), (0, 4, 4), (0, 3), (0, 2)))
    array = numbers.normal(scale=dice.choice((0.1, 1, 100, 1e30)), size=shape)
    if kind == 0:
        with np.errstate(all="ignore"):
            array = array.astype(dice.choice((np.int8, np.uint8, np.int16, np.uint16, np.int64, np.uint64, bool, np.float16,
                                              np.complex128, ">f8", ">i2", "U3", "S2", object, np.longdouble)))
    elif kind == 1 and array.size:
        array.flat[dice.randrange(array.size)] = dice.choice((np.nan, np.inf, -np.inf, 1e308, 5e-324))
    elif kind == 2 and array.ndim:
        array = array[::-1]
    elif kind == 3:
        array = np.asfortranarray(array)
    elif kind == 4:
        array.setflags(write=False)
    elif kind == 5:
        array = np.lib.stride_tricks.as_strided(array[..., None][..., 0], array.shape, array.strides)
    elif kind == 6:
        array = np.zeros(shape, dtype=[("x", float), ("y", np.int32)])
    elif kind == 7:
        array = np.broadcast_to(np.float64(dice.random()), shape)
    elif kind == 8:
        array = array.astype("datetime64[s]") if dice.random() < 0.5 else np.ma.masked_array(array, mask=array > 0)
    return array


def a_list():
    deep = []
    deep.append(deep)
    return dice.choice(([], [[]], [1, [2, 3]], [None] * 4, ["a"] * 3, [[1, 2], [3, 4]], [(1, 0), (2, 1)], [[np.nan] * 4] * 4, deep,
                        list(range(6)), [2**70] * 3, ((1, 2), (3,)), iter([1, 2]), range(4), {1, 2}, {"a": 1}))


ANYTHING = (an_array, an_array, an_array, a_list,
            lambda: dice.choice((None, True, False, "", "text", "40:0,80:1", "head", "\0", "a\nb", "\udcff", b"\xff", Ellipsis, ...,
                                 NotImplemented, object(), Liar(), Raises(), HalfAMesh(), HalfAnImage(), int, len,
                                 FOLDER / "none", FOLDER, "builtin:head:8", "builtin:nothing", slice(3), 1j)),
            lambda: dice.choice((0, 1, -1, 3, 2**31, 2**32 - 1, 2**32, 2**63, 2**64, -2**63, 10**30, 10**400)),
            lambda: dice.choice((0.0, -0.0, 0.5, 1.5, -1.0, 1e-300, 1e300, np.nan, np.inf, -np.inf, np.float32(2), np.int64(-3))))

HEAD = vx.read_volume("builtin:head:16")
BLOCKS = vx.read_volume((np.indices(HEAD.shape).sum(0) // 9 % 4).astype(np.uint8), axes="zyx", affine=HEAD.affine)
LABELS = vx.read_labels(BLOCKS, names={1: "one", 2: "two"})
KNIFE = vx.read_mesh("builtin:scalpel:300")
SCENE = vx.Scene(HEAD, opacity=[(40, 0), (80, 1)], labels=LABELS, threads=2)
CLOSED = vx.Scene(HEAD)
CLOSED.close()
POSES = np.tile(np.eye(4), (3, 1, 1))
POSES[:, 2, 3] = 0, 40, 200
OBJECTS = (HEAD, LABELS, KNIFE, SCENE, CLOSED, SCENE.count(KNIFE, POSES), SCENE.distance(KNIFE, POSES), SCENE.touch(KNIFE, POSES), SCENE.overlap(KNIFE, POSES), SCENE.tracker(KNIFE),
           SCENE.motion(KNIFE, POSES), SCENE.plan((0, 0, 0), avoid=[1], entries=12))

#: What each parameter is called, and what is good for it.
GOOD = {
    "mesh": (KNIFE,), "poses": (POSES, np.eye(4)), "pose": (np.eye(4),), "progress": (None, lambda *_: None), "volume": (HEAD,),
    "opacity": ([(40, 0), (80, 1)], "40:0,80:1", None), "threshold": (0.1,), "labels": (None, LABELS, [1, 2], True), "threads": (0, 1),
    "device": (None,), "target": ((0.0, 0.0, 0.0),), "avoid": ([1], ["two"]), "entries": (12, 42), "tolerance": (0.1,), "margin": (1.0,),
    "uncertainty": ((1.0, 2.0),), "bands": ([20.0, 80.0],), "max": (10.0,), "source": (HEAD, (KNIFE.vertices, KNIFE.faces), KNIFE), "affine": (np.eye(4),),
    "space": ("lps", "ras"), "axes": ("zyx", "xyz"), "first": (np.eye(4),), "second": (POSES[1],), "at": (0.5, (1, 2, 3)),
    "ball": ((0, 0, 0, 5),), "box": ((0, 0, 0, 2, 2, 2),), "value": (7,), "voxels": (np.zeros((2, 2, 2), np.uint8),), "points": (np.zeros((2, 3)),),
    "domain": (None, (0, 255)), "table_size": (256,), "row": (0,), "resolution": (0.5,), "picture": (np.zeros((2, 2, 4), np.uint8),),
    "size": ((8, 8),), "needle": ((2.0, 50.0),), "entry_radius": (40.0,), "tip": ((0, 0, 0),), "axis": ((0, 0, 1),), "array": (np.zeros((2, 2, 2)),),
}
#: Nothing of these is drawn: a callback's work is its own, and a good number would only take long.
LEFT_OUT = {"max_steps"}
#: They would open windows or look for devices.
NOT_CALLED = {"plot", "picture", "devices", "Device", "DeviceInfo", "close"}


def value_for(name):
    if name in ("path", "file"):
        return dice.choice((FOLDER / dice.choice(("a.nii", "a.stl", "a.png", "a", "a.mha")), FOLDER, FOLDER / "none" / "a.nii", "", "\0", 3, None, b""))
    if dice.random() < 0.8 and name in GOOD:
        return dice.choice(GOOD[name])
    if dice.random() < 0.1:
        return dice.choice(OBJECTS)
    return dice.choice(ANYTHING)()


def arguments_for(function):
    """Positional and named ones, by its signature."""
    parameters = [one for one in inspect.signature(function).parameters.values() if one.name not in LEFT_OUT and one.name != "self"]
    given, named = [], {}
    for one in parameters:
        if one.default is not one.empty and dice.random() < 0.6:
            continue
        if one.kind in (one.VAR_POSITIONAL, one.VAR_KEYWORD):
            continue
        named[one.name] = value_for(one.name)
    return given, named


def setter(one, name):
    def set_(value):
        setattr(one, name, value)

    return set_


def targets():
    for name in vx.__all__:
        thing = getattr(vx, name)
        if name in NOT_CALLED or not callable(thing) or (inspect.isclass(thing) and issubclass(thing, Exception)):
            continue
        yield name, thing
    for one in OBJECTS:
        for name, member in inspect.getmembers(type(one), inspect.isfunction):
            if not name.startswith("_") and name not in NOT_CALLED:
                yield f"{type(one).__name__}.{name}", getattr(one, name)
        for name, member in inspect.getmembers(type(one), lambda member: isinstance(member, property)):
            if member.fset is not None:
                yield f"{type(one).__name__}.{name} =", setter(one, name)


def shown(value):
    try:
        return f"{type(value).__name__} {value!r}".replace("\n", " ")[:200]
    except Exception as error:  # its own repr
        return f"{type(value).__name__} ({error})"


ALL = sorted(targets(), key=lambda pair: pair[0])
bad, done, refused = 0, 0, 0
with open(LOG, "w") as log:
    for number in range(CALLS):
        name, function = ALL[number % len(ALL)]
        given, named = arguments_for(function)
        log.seek(0)
        log.truncate()
        log.write(f"call {number}: {name}({', '.join(f'{key}={shown(value)}' for key, value in named.items())})\n")
        log.flush()
        try:
            result = function(*given, **named)
            repr(result)
            done += 1
        except ALLOWED as error:
            refused += 1
            text = str(error)
            if isinstance(error, vx.Error) and ("\n" in text or "_core" in text or not text):
                bad += 1
                print(f"call {number}: {name}: {text!r}")
        except IndexError as error:
            if "row" not in named:  # of a row that is not there it is Python's own word
                bad += 1
                print(f"call {number}: {name}({named}): {error!r}")
        except BaseException as error:
            bad += 1
            print(f"call {number}: {name}({', '.join(f'{key}={shown(value)}' for key, value in named.items())})\n"
                  f"    raised {type(error).__name__}: {error}")
SCENE.opacity = [(40, 0), (80, 1)]
SCENE.threshold = 0.1
print(f"{len(ALL)} functions, {done} calls done, {refused} refused, {bad} bad")
sys.exit(1 if bad else 0)
