# SPDX-License-Identifier: MIT
"""Wrong arguments, other threads, forks and what is no longer there: an exception, never a crash or a hang."""
import copy
import gc
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import voxtact as vx
from conftest import cube, half_space, placed, random_poses


@pytest.mark.parametrize("poses", [np.zeros(16), np.zeros((3, 4)), np.zeros((2, 3, 3)), np.zeros((1, 1, 4, 4)), 3.0, [[]],
                                   np.zeros((4, 4, 5)), [[1, 2], [3, 4]]])
def test_poses_of_another_shape(scene, knife, poses):
    for ask in (scene.count, scene.distance, scene.motion, lambda *asked: scene.touch(*asked, margin=1),
                lambda *asked: scene.touch(*asked, uncertainty=(1, 1))):
        with pytest.raises(vx.InvalidArgumentError, match=r"poses have the shape .*\(4,4\) or \(N,4,4\) is needed"):
            ask(knife, poses)


@pytest.mark.parametrize("poses", ["text", object(), [["a"] * 4] * 4, {"a": 1}])
def test_poses_that_are_no_numbers(scene, knife, poses):
    with pytest.raises(TypeError):
        scene.count(knife, poses)


@pytest.mark.parametrize("row, value, text", [(0, np.nan, "not finite"), (1, np.inf, "not finite"), (3, 0.5, "0 0 0 1")])
def test_poses_that_are_no_poses_are_named(scene, knife, row, value, text):
    poses = random_poses(5, 1)
    poses[3, row, 1] = value
    with pytest.raises(vx.InvalidArgumentError, match=f"pose 3.*{text}"):
        scene.count(knife, poses)


def test_a_bad_pose_of_a_later_piece_is_named_by_its_own_number(head):
    poses = random_poses(100, 1)
    poses[97, 0, 0] = np.nan
    with pytest.raises(vx.InvalidArgumentError, match="pose 97"):
        vx.Scene(head).count(vx.read_mesh("builtin:ellipsoid:49998"), poses)


def test_things_that_are_no_meshes(scene):
    for thing in (None, "tool.stl", 3, (cube().vertices, cube().faces), [(1, 2)], [(cube(),)]):
        with pytest.raises(TypeError):
            scene.count(thing, np.eye(4) if not isinstance(thing, list) else None)
    with pytest.raises(TypeError, match="poses are missing"):
        scene.count(cube())


def test_options_of_another_type(scene, knife, head):
    for option, value in (("resolution", "fine"), ("samples_per_voxel", -1), ("max_contacts", 2**40), ("view", 3),
                          ("projection", 3), ("max_depth", None)):
        try:
            scene.count(knife, np.eye(4), **{option: value})
        except (TypeError, RuntimeError, ValueError) as error:
            assert "Unable to cast" not in str(error), error
    for option, value in (("resolution", 0), ("resolution", np.nan), ("samples_per_voxel", 99), ("max_depth", -1)):
        with pytest.raises(vx.InvalidArgumentError):
            scene.count(knife, np.eye(4), contacts=True, projection="certified" if option == "resolution" else
                         "dominant-axis", **{option: value})
    with pytest.raises(vx.InvalidArgumentError, match="threshold"):
        vx.Scene(head, threshold=2)
    for wrong in ({"threads": -1}, {"threads": 1.5}, {"table_size": "many"}, {"threshold": "high"}, {"domain": ("a", "b")}):
        with pytest.raises((ValueError, TypeError)) as caught:
            vx.Scene(head, **wrong)
        assert "_core" not in str(caught.value), "no words of what is inside"
    for ask in (lambda: scene.distance(knife, np.eye(4), tolerance="fine"), lambda: scene.touch(knife, np.eye(4), margin="2 mm"),
                lambda: scene.distance(knife, np.eye(4), max_steps=-1), lambda: scene.touch(knife, np.eye(4), margin=-1)):
        with pytest.raises((ValueError, TypeError)) as caught:
            ask()
        assert "_core" not in str(caught.value)
    for wrong in ({"domain": (3, 3)}, {"table_size": 1}, {"opacity": [(0, np.nan)]}):
        with pytest.raises(vx.InvalidArgumentError):
            vx.Scene(head, **wrong)


def test_what_is_made_of_nothing():
    for thing in (vx.Volume, vx.Mesh):
        with pytest.raises(TypeError, match="makes"):
            thing()
    for hollow in (vx.Volume, vx.Mesh, vx.Scene, vx.Labels, vx.Touch, vx.Count, vx.Distance, vx.Overlap, vx.Motion, vx.Device):
        with pytest.raises((AttributeError, TypeError)):
            repr(hollow.__new__(hollow))
    from voxtact import _engine, _handles, _tables

    for hollow in (_engine.Scene, _handles.Volume, _handles.Mesh, _tables.Tables, _handles.Device):
        with pytest.raises(TypeError):
            hollow().revision


def test_pickling_and_copying_are_refused_by_name(scene, head):
    for thing in (scene, vx.read_labels(head)):
        for way in (pickle.dumps, copy.copy, copy.deepcopy):
            with pytest.raises(TypeError, match=f"voxtact.{type(thing).__name__} cannot be pickled"):
                way(thing)


def test_a_closed_scene(head, knife):
    with vx.Scene(head, opacity=[(40, 0), (80, 1)]) as scene:
        answer = scene.count(knife, np.eye(4))
    scene.close()
    assert "closed" in repr(scene) and answer.count.shape == (1,)
    for ask in (lambda: scene.count(knife, np.eye(4)), lambda: scene.distance(knife, np.eye(4)),
                lambda: scene.motion(knife, random_poses(2, 1)), lambda: scene.edit(ball=(0, 0, 0, 1), value=0), lambda: setattr(scene, "threshold", 0.2),
                lambda: answer.contacts, lambda: scene.picture(knife)):
        with pytest.raises(vx.NotReadyError, match="closed"):
            ask()
    assert scene._repr_png_() is None


def test_arrays_outlive_what_they_came_from():
    def made():
        array = half_space()
        scene = vx.Scene(vx.read_volume(array, axes="zyx", affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])
        answer = scene.count(cube(), placed((4, 4, 4), (9, 4, 4)))
        return scene.volume.array, cube().vertices, answer.count, answer.contacts, scene.distance(cube(), np.eye(4)).closest

    arrays = made()
    gc.collect()
    copies = [array.copy() for array in arrays]
    filler = [np.full(1000, 7.5) for _ in range(200)]
    for array, before in zip(arrays, copies):
        np.testing.assert_array_equal(array, before)
    assert len(filler) == 200


def test_a_callback_that_uses_its_scene_is_refused(scene, knife):
    with pytest.raises(vx.NotReadyError, match="at work for this very thread"):
        scene.count(knife, random_poses(10, 2), progress=lambda *_: scene.count(knife, np.eye(4)))
    assert len(scene.count(knife, np.eye(4))) == 1


def test_a_callback_that_raises_ends_the_call(scene, knife):
    class Enough(Exception):
        pass

    def progress(done, of):
        raise Enough(f"{done} of {of}")

    for ask in (scene.count, scene.distance):
        with pytest.raises(Enough):
            ask(knife, random_poses(10, 2), progress=progress)
    assert len(scene.count(knife, np.eye(4))) == 1


def test_threads(head, knife):
    """Answers of threads that share scenes and meshes are those of one thread; edits come between."""
    scene, other = vx.Scene(head, opacity=[(40, 0), (80, 1)]), vx.Scene(head, opacity=[(100, 0), (200, 1)])
    poses = random_poses(400, 3)
    mesh = vx.read_mesh("builtin:scalpel:302")  # nobody has used it yet
    expected, wrong = {}, []
    for one in (scene, other):
        expected[one] = one.count(vx.read_mesh("builtin:scalpel:302"), poses).count

    def ask(one):
        for _ in range(5):
            if not np.array_equal(one.count(mesh, poses).count, expected[one]):
                wrong.append(one)
            one.threshold = 0.1

    threads = [threading.Thread(target=ask, args=(one,)) for one in (scene, other) * 3]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)
        assert not thread.is_alive()
    assert not wrong


def test_a_scene_that_other_threads_close_and_drop(head, knife):
    """Threads that are in the middle of it get their answer, those that come later are told; nobody crashes or hangs."""
    poses = random_poses(60, 7)
    expected = vx.Scene(head, opacity=[(40, 0), (80, 1)]).count(knife, poses).count
    for _ in range(5):
        shared = [vx.Scene(head, opacity=[(40, 0), (80, 1)])]
        tracker, wrong, told = shared[0].tracker(knife), [], []

        def ask(number):
            try:
                for _ in range(100):
                    scene = shared[0]
                    if number == 0:
                        tracker.update(poses[0])
                    elif number == 1:
                        scene.distance(knife, poses[:1], tolerance=0.1)
                    elif not np.array_equal(scene.count(knife, poses).count, expected):
                        wrong.append(number)
            except (vx.NotReadyError, IndexError):
                told.append(number)
            except BaseException as error:
                wrong.append(error)

        threads = [threading.Thread(target=ask, args=(number,)) for number in range(4)]
        for thread in threads:
            thread.start()
        time.sleep(0.02)
        shared[0].close()
        shared.clear()
        gc.collect()
        for thread in threads:
            thread.join(60)
            assert not thread.is_alive()
        assert not wrong and told


def test_a_tracker_after_a_fork(head, knife):
    tracker = vx.Scene(head, opacity=[(40, 0), (80, 1)]).tracker(knife)
    near = tracker.update(placed((0, 0, 0))[0])
    child = os.fork()
    if child == 0:
        status = 1
        try:
            status = 0 if tracker.update(placed((0, 0, 0))[0])[:2] == near[:2] else 2
        finally:
            os._exit(status)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_work_does_not_hold_the_interpreters_lock(scene, knife):
    """Another thread counts on while this one measures."""
    counted, done = [], threading.Event()

    def count():
        while not done.is_set():
            counted.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    begin = time.perf_counter()
    scene.distance(knife, random_poses(300, 4), tolerance=1e-6)
    end = time.perf_counter()
    done.set()
    thread.join()
    assert sum(begin < at < end for at in counted) > 3, (len(counted), end - begin)


@pytest.mark.parametrize("number", range(3))
def test_a_fork_after_use(head, knife, number):
    """In a child the threads of its parent are not there: it gets its own. One that asks nothing just ends."""
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)])
    poses = random_poses(50, 5)
    expected = scene.count(knife, poses)
    scene.distance(knife, poses[:2])
    scene.motion(knife, poses[:2], resolution=1)
    child = os.fork()
    if child == 0:
        status = 1
        try:
            if number == 0:
                status = 0 if np.array_equal(scene.count(knife, poses).count, expected.count) else 2
                scene.distance(knife, poses[:2])
                scene.motion(knife, poses[:2], resolution=1)
            elif number == 1:
                scene.close()
                del scene
                gc.collect()
                status = 0
            else:
                scene.opacity = [(100, 0), (200, 1)]
                status = 0 if vx.Scene(head, opacity=[(40, 0), (80, 1)]).count(knife, poses).touches.any() else 2
        finally:
            os._exit(status)
    for _ in range(600):
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            break
        time.sleep(0.1)
    else:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        pytest.fail("the child hangs")
    assert os.waitstatus_to_exitcode(status) == 0
    np.testing.assert_array_equal(scene.count(knife, poses).count, expected.count)


def test_errors_are_what_they_say():
    for error in (vx.InvalidArgumentError, vx.UnsupportedError, vx.LimitExceededError, vx.OutOfMemoryError,
                  vx.DeviceLostError, vx.VulkanError, vx.FileError, vx.FormatError, vx.NotReadyError, vx.InternalError):
        assert issubclass(error, vx.Error) and error.code != vx.Error.code and error.__module__ == "voxtact"
    assert issubclass(vx.InvalidArgumentError, ValueError) and issubclass(vx.FileError, OSError)
    with pytest.raises(vx.Error) as caught:
        vx.read_volume("builtin:nonsense")
    assert caught.value.code == "invalid-argument" and caught.value.vk_result == 0
    assert "\n" not in str(caught.value) and "nonsense" in str(caught.value)
    with pytest.raises(vx.InvalidArgumentError, match="device"):
        vx.InvalidArgumentError("device")
        raise vx.InvalidArgumentError("device")


def test_broken_files(tmp_path):
    for name, content in (("a.nii", b"\0" * 400), ("a.nii.gz", b"\x1f\x8b"), ("a.stl", b"solid"), ("a.ply", b"ply\n"),
                          ("\udcff.nii", b"x")):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises((vx.FormatError, vx.FileError, vx.InvalidArgumentError)) as caught:
            (vx.read_volume if ".nii" in name else vx.read_mesh)(path)
        assert "\n" not in str(caught.value)
    (tmp_path / "poses.txt").write_text("1 2 3\n")
    with pytest.raises(vx.Error, match="line 1"):
        vx.read_poses(tmp_path / "poses.txt")


@pytest.mark.parametrize("ask", [lambda scene, *asked, **options: scene.count(*asked, resolution=np.nan, **options),
                                 lambda scene, *asked: scene.count(*asked, max_depth=np.nan),
                                 lambda scene, *asked: scene.distance(*asked, tolerance=np.nan),
                                 lambda scene, *asked: scene.distance(*asked, max=np.nan),
                                 lambda scene, *asked: scene.motion(*asked, resolution=np.nan)])
def test_nan_is_refused_each_time_and_changes_no_later_answer(head, knife, ask):
    poses = random_poses(20, 3)
    fresh = vx.Scene(head)
    counts, lows = fresh.count(knife, poses).count, fresh.distance(knife, poses).lower
    assert counts.max() > 1
    scene = vx.Scene(head)
    for _ in range(2):
        with pytest.raises(vx.InvalidArgumentError, match="nan"):
            ask(scene, knife, poses)
        scene.touch(knife, poses)
        answer = scene.count(knife, poses)
        assert (answer.count == counts).all() and answer.count_exact.any()
        scene.distance(knife, poses, max=1)
        assert (scene.distance(knife, poses).lower == lows).all()
        assert len(scene.motion(knife, poses).touches) == len(poses) - 1


@pytest.mark.parametrize("view", [vx.View("x", 64, 64), vx.View([["a"] * 4] * 4, 64, 64), vx.View(object(), 64, 64)])
def test_a_view_that_is_no_matrix(scene, knife, view):
    with pytest.raises((TypeError, ValueError), match="could not convert|float|number"):
        scene.count(knife, np.eye(4), projection="view", view=view)


def test_properties_while_another_thread_sets_them(head):
    scene = vx.Scene(head)
    end = time.monotonic() + 2
    wrong = []

    def sets():
        generator = np.random.default_rng()
        while time.monotonic() < end:
            values = np.linspace(0, 255, generator.integers(2, 2000))
            scene.opacity = np.stack([values, values / 255], 1)

    def reads():
        while time.monotonic() < end:
            points = scene.opacity
            repr(scene)
            if points[0, 0] != 0 or points[-1, 0] != 255 or (np.diff(points[:, 0]) <= 0).any():
                wrong.append(points)

    threads = [threading.Thread(target=work) for work in (sets, sets, reads, reads)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_labels_that_are_asked_for_twice_or_not_at_all(knife):
    voxels = np.zeros((20, 22, 24), np.uint8)
    voxels[5:15, 6:16, 7:17] = 200
    labels = vx.read_labels((voxels > 0).astype(np.uint8) * 7, axes="zyx", affine=np.eye(4), space="lps")
    scene = vx.Scene(vx.read_volume(voxels, axes="zyx", affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)], labels=labels)
    poses = placed((200, 10, 10), (0, 0, 300))
    once = scene.distance(knife, poses, labels=[7])
    assert np.isfinite(once.lower).all()
    often = scene.distance(knife, poses, labels=[7, 0, 7])
    assert (often.lower[:, 0] == once.lower[:, 0]).all() and (often.lower[:, 2] == once.lower[:, 0]).all()
    none = scene.distance(knife, poses, labels=[])
    assert none.lower.shape == none.upper.shape == none.end.shape == (2, 0) and "2 poses to 0 labels" in repr(none)
    with pytest.raises(vx.NotReadyError):
        none.closest


def test_arrays_that_are_none(scene, knife):
    ragged = [[1, 2], [3]]
    for ask in (lambda: scene.count(knife, ragged), lambda: vx.read_volume(ragged, axes="zyx", affine=np.eye(4)),
                lambda: vx.read_volume(np.zeros((2, 2, 2), np.uint8), axes="zyx", affine=ragged),
                lambda: vx.read_mesh((ragged, [[0, 1, 2]])), lambda: vx.read_mesh((np.eye(3), ragged))):
        with pytest.raises(vx.InvalidArgumentError, match="rows differ in length"):
            ask()
    with pytest.raises(TypeError, match="numbers are needed"):
        vx.read_volume(np.zeros((2, 2, 2), np.uint8), axes="zyx", affine="x")
    with pytest.raises(TypeError, match="affine has the type complex128"):
        vx.read_volume(np.zeros((2, 2, 2), np.uint8), axes="zyx", affine=np.eye(4) + 1j)
    with pytest.raises(TypeError, match="what is no number"):
        scene.count(knife, np.array([[object()] * 4] * 4))
    with pytest.raises(TypeError, match="avoid is a int; a sequence is needed"):
        scene.plan([[0, 0, 0]], avoid=70)


def test_what_is_masked_has_no_value(scene, knife):
    voxels = np.ma.masked_array(np.zeros((2, 2, 2), np.uint8), mask=False)
    vx.read_volume(voxels, axes="zyx", affine=np.eye(4))
    voxels[0, 0, 0] = np.ma.masked
    poses = np.ma.masked_array(np.eye(4)[None], mask=np.eye(4)[None] > 0)
    corners = np.ma.masked_array(np.eye(3), mask=np.eye(3) > 0)
    for ask in (lambda: vx.read_volume(voxels, axes="zyx", affine=np.eye(4)), lambda: scene.count(knife, poses),
                lambda: vx.read_mesh((corners, [[0, 1, 2]])), lambda: scene.edit(voxels=voxels, at=(0, 0, 0))):
        with pytest.raises(vx.InvalidArgumentError, match="is masked and has no value"):
            ask()
