# SPDX-License-Identifier: MIT
"""Scenes on a Vulkan device: the host's answers; and pictures."""
import functools
import os
import subprocess
import sys
import zlib

import numpy as np
import pytest

import voxtact as vx
from conftest import cube, half_space, placed, random_poses


def both(device, volume, **options):
    return vx.Scene(volume, opacity=[(40, 0), (80, 1)], **options), vx.Scene(volume, opacity=[(40, 0), (80, 1)],
                                                                            device=device, **options)


def test_devices(device):
    assert device.info in vx.devices()
    assert device.info.name in repr(device)
    assert device.methods["compute"] is None
    again = vx.Device(device.info.number)
    assert again.info == device.info and vx.Device(device.info.name[:6].lower()).info.name
    with pytest.raises(vx.InvalidArgumentError, match="device='nonsense' is not part of the name.*there are: 0 "):
        vx.Device("nonsense")
    with pytest.raises(vx.InvalidArgumentError, match="not the number of a device"):
        vx.Device(99)


def test_the_certified_answer_is_the_hosts(device, head, knife):
    host, there = both(device, head, labels=head)
    poses = random_poses(40, 31)
    asked = dict(contacts=True, triangles=True, bounds=True, labels=True)
    expected, answer = host.detect(knife, poses, **asked), there.detect(knife, poses, **asked)
    assert (answer.method, expected.method) == ("compute", "cpu") and expected.hit.any()
    np.testing.assert_array_equal(answer.count, expected.count)
    np.testing.assert_array_equal(answer.triangles, expected.triangles)
    np.testing.assert_array_equal(answer.labels, expected.labels)
    np.testing.assert_allclose(answer.contacts["position"], expected.contacts["position"], atol=1e-4)
    np.testing.assert_allclose(answer.bounds, expected.bounds, atol=1e-4)
    np.testing.assert_array_equal(there.detect(knife, poses, yes_no=True).hit, expected.hit)
    assert repr(there).endswith(f"on {device.info.name!r}>")


def test_the_first_piece_of_a_device_is_small(device, head):
    def stop(done, of):
        told.append(done)
        raise StopIteration("enough")

    told = []
    triangle = vx.read_mesh(([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]]))
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], device=device)
    with pytest.raises(StopIteration, match="enough"):
        scene.detect(triangle, random_poses(1000, 32), progress=stop)
    assert told == [8]


def hits_of_both(ask):
    """How many poses hit by a question that `ask` puts: device and host never contradict each other."""
    expected, answer = ask(), ask(method="compute")
    assert (answer.method, expected.method) == ("compute", "cpu")
    sure = ~(answer.possible | expected.possible)
    assert sure.mean() > 0.9
    np.testing.assert_array_equal(answer.hit[sure], expected.hit[sure])
    return int(answer.hit.sum())


def test_a_margin_is_decided_by_the_device_that_is_asked(device, head, knife):
    host, there = both(device, head)
    poses = random_poses(40, 33)
    hits = [hits_of_both(functools.partial(there.within, knife, poses, margin=margin)) for margin in (0, 1.5, 6)]
    assert hits[0] < hits[2]
    with pytest.raises(vx.UnsupportedError, match="needs a Vulkan device"):
        host.within(knife, poses, margin=1, method="compute")
    with pytest.raises(vx.InvalidArgumentError, match="method is 'query'"):
        there.within(knife, poses, margin=1, method="query")
    with pytest.raises(vx.InvalidArgumentError, match="margin"):
        there.within(knife, poses, margin=1e7, method="compute")
    with pytest.raises(vx.NotReadyError):
        there.within(knife, poses, margin=1, method="compute").contacts


def test_a_pose_tolerance_is_decided_by_the_device_that_is_asked(device, head, knife):
    host, there = both(device, head)
    poses = random_poses(40, 34)
    hits = [hits_of_both(functools.partial(there.around, knife, poses, distance=distance, angle=angle))
            for distance, angle in ((0, 0), (1, 2), (6, 2))]
    assert hits[0] < hits[2]
    with pytest.raises(vx.UnsupportedError, match="needs a Vulkan device"):
        host.around(knife, poses, distance=1, angle=2, method="compute")
    with pytest.raises(vx.InvalidArgumentError, match="method is 'query'"):
        there.around(knife, poses, distance=1, angle=2, method="query")
    with pytest.raises(vx.InvalidArgumentError, match="the most on a device"):
        there.around(knife, poses, distance=1e7, angle=2, method="compute")
    with pytest.raises(vx.InvalidArgumentError, match="outside of 0 to 180"):
        there.around(knife, poses, distance=1, angle=181, method="compute")


def test_a_clearance_is_measured_by_the_device_that_is_asked(device, head, knife):
    host, there = both(device, head)
    poses = random_poses(24, 34)
    for maximum in (np.inf, 4):
        expected = there.clearance([(knife, poses[:10]), (knife, poses[10:])], tolerance=0.1, maximum=maximum)
        found = there.clearance([(knife, poses[:10]), (knife, poses[10:])], tolerance=0.1, maximum=maximum, method="compute")
        assert len(found) == 24 and (found.item == expected.item).all() and (found.pose == expected.pose).all()
        assert (found.lo <= expected.hi).all() and (expected.lo <= found.hi).all()
        np.testing.assert_array_equal(found.hi == 0, expected.hi == 0)
        closed = found.end == "closed"
        assert (found.hi[closed] - found.lo[closed] <= 0.1).all() and closed.mean() > 0.3
        beyond = found.end == "beyond"
        assert (found.lo[beyond] == maximum).all() and beyond.any() == np.isfinite(maximum)
        finite = np.isfinite(found.hi)
        np.testing.assert_array_equal(found.closest["triangle"] >= 0, finite)
        apart = np.linalg.norm(found.closest["mesh"] - found.closest["volume"], axis=1)
        assert (apart[finite] <= found.hi[finite] * (1 + 1e-6)).all() and (apart[finite] >= found.lo[finite] - 1e-4).all()
        free = finite & (found.hi > 0)
        away = (found.closest["mesh"] - found.closest["volume"])[free] / apart[free, None]
        np.testing.assert_allclose(found.closest["per_translation"][free], away, atol=1e-9)
        assert free.any() and (found.hi == 0).any()
    with pytest.raises(vx.UnsupportedError, match="needs a Vulkan device"):
        host.clearance(knife, poses, method="compute")
    with pytest.raises(vx.InvalidArgumentError, match="method is 'query'; a clearance is measured by"):
        there.clearance(knife, poses, method="query")
    with pytest.raises(vx.InvalidArgumentError, match="tolerance"):
        there.clearance(knife, poses, tolerance=0, method="compute")
    with pytest.raises(vx.InvalidArgumentError, match="most_steps"):
        there.clearance(knife, poses, most_steps=5, method="compute")


def test_clearances_to_labels_are_measured_by_the_device_that_is_asked(device, head, knife):
    host, there = both(device, head, labels=head)
    poses = random_poses(8, 36)
    for asked in (dict(labels=[70, 999, 0]), dict(labels=[90], labels_at_any_opacity=True), dict(labels=[70], maximum=4)):
        expected = there.clearance([(knife, poses[:3]), (knife, poses[3:])], tolerance=0.1, **asked)
        found = there.clearance([(knife, poses[:3]), (knife, poses[3:])], tolerance=0.1, method="compute", **asked)
        assert found.lo.shape == (8, len(asked["labels"])) and (found.labels == asked["labels"]).all()
        assert (found.lo <= expected.hi).all() and (expected.lo <= found.hi).all()
        np.testing.assert_array_equal(np.isinf(found.lo), np.isinf(expected.lo))
        assert (found.item == expected.item).all() and (found.pose == expected.pose).all()
        with pytest.raises(vx.NotReadyError, match="no closest points"):
            found.closest
    assert there.clearance(knife, poses, labels=[], method="compute").lo.shape == (8, 0)
    with pytest.raises(vx.UnsupportedError, match="needs a Vulkan device"):
        host.clearance(knife, poses, labels=[70], method="compute")
    with pytest.raises(vx.LimitExceededError, match="5000 labels are asked for, one call measures at most 4096"):
        there.clearance(knife, poses, labels=[70] * 5000, method="compute")


def test_more_contacts_than_a_device_has_room_for(device, head, knife):
    with pytest.raises(vx.LimitExceededError, match="; ask for fewer by most_contacts, which is 4294967295$"):
        vx.Scene(head, device=device).detect(knife, np.eye(4), contacts=True, most_contacts=2**32 - 1, method="compute")


def test_a_motion_is_checked_by_the_device_that_is_asked(device, head, knife):
    host, there = both(device, head)
    poses = random_poses(9, 35)
    by_host = host.motion([(knife, poses[:5]), (knife, poses[5:9])])
    found = there.motion([(knife, poses[:5]), (knife, poses[5:9])], method="compute")
    assert len(found) == 7 and found.item.tolist() == by_host.item.tolist() and found.pose.tolist() == by_host.pose.tolist()
    for one, other in ((found, by_host), (by_host, found), (found, found)):
        touches = other.hit
        assert (one.free_until[touches] <= other.touches["at"][touches]).all()
    assert ((found.free_until < 1) & ~found.hit == found.possible).all()
    with pytest.raises(vx.UnsupportedError, match="needs a Vulkan device"):
        host.motion(knife, poses, method="compute")
    with pytest.raises(vx.InvalidArgumentError, match="method is 'query'"):
        there.motion(knife, poses, method="query")
    with pytest.raises(vx.InvalidArgumentError, match="resolution"):
        there.motion(knife, poses, resolution=0, method="compute")
    with pytest.raises(vx.InvalidArgumentError, match="most_steps is about the host's search"):
        there.motion(knife, poses, most_steps=5, method="compute")


@pytest.mark.parametrize("method", ["query", "atomic", "subgroup", "compute"])
def test_methods(device, head, knife, method):
    if device.methods[method] is not None:
        pytest.skip(device.methods[method])
    host, there = both(device, head)
    poses = random_poses(10, 32)
    answer = there.detect(knife, poses, projection="view", method=method, filter="exact")
    assert answer.method == method
    np.testing.assert_allclose(answer.count.astype(float), host.detect(knife, poses, projection="view").count, atol=20,
                               rtol=0.05)


def test_changes_reach_the_device(device, knife):
    volume = vx.read_volume(half_space(np.int16), affine=np.eye(4), space="lps")
    scene = vx.Scene(volume, opacity=[(99, 0), (101, 1)], device=device)
    touching, free = placed((4, 4, 4)), placed((9, 4, 4))
    assert scene.detect(cube(), touching).hit[0] and not scene.detect(cube(), free).hit[0]
    scene.edit(ball=(4, 4, 4, 3), value=-1000)
    scene.edit(at=(8, 3, 3), voxels=np.full((2, 2, 2), 200))
    assert not scene.detect(cube(), touching).hit[0] and scene.detect(cube(), free).hit[0]
    # The host's side is made now, and gets the edits that there were.
    assert scene.clearance(cube(), touching).lo[0] > 0 and scene.clearance(cube(), free).lo[0] == 0
    scene.opacity = [(299, 0), (301, 1)]
    assert not scene.detect(cube(), free).hit[0] and scene.clearance(cube(), free).lo[0] == np.inf
    with pytest.raises(vx.InvalidArgumentError):
        scene.edit(ball=(4, 4, 4, 3), value=1.5)


def test_pieces_with_outputs(device, head):
    """Counters of all triangles of a first piece of pairs, and of the next ones."""
    mesh = vx.read_mesh("builtin:ellipsoid:49998")
    poses = placed(*[(500, 0, z) for z in range(60)], (0, 0, 0))
    answer = vx.Scene(head, opacity=[(40, 0), (80, 1)], device=device).detect(mesh, poses, triangles=True, yes_no=False)
    assert answer.hit.tolist() == [False] * 60 + [True]
    assert (answer.triangles["pair"] == 60).all() and len(answer.triangles) > 0


def test_a_device_after_a_fork(device, head, knife):
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], device=device)
    scene.detect(knife, np.eye(4))
    child = os.fork()
    if child == 0:
        status = 1
        try:
            try:
                scene.detect(knife, np.eye(4))
            except vx.UnsupportedError as error:
                status = 0 if "forked" in str(error) else 2
            del scene
        finally:
            os._exit(status)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert len(scene.detect(knife, np.eye(4))) == 1


def test_pictures(device, head, knife):
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], device=device)
    alone = scene.picture(size=(96, 64), background=(0, 0, 1))
    assert alone.shape == (64, 96, 4) and alone.dtype == np.uint8
    assert alone[0, 0].tolist() == [0, 0, 255, 255], "the corner is the background"
    assert alone[32, 48, 0] > 100, "the middle is the head"
    pose = placed((0, 0, 0))[0]
    with_mesh = scene.picture(knife, pose, size=(96, 64), view=(20, 10), show="contacts", through=1.0)
    red = (with_mesh[..., 0] > 120) & (with_mesh[..., 1] < 80)
    assert red.any(), "what touches is red"
    assert not ((alone[..., 0] > 120) & (alone[..., 1] < 80)).any()
    assert not np.array_equal(scene.picture(size=(96, 64), view="left"), scene.picture(size=(96, 64), view="top"))
    scene.edit(box=(0, 0, 0, *reversed(head.shape)), value=0)
    assert (scene.picture(size=(32, 32)) == [0, 0, 0, 255]).all(), "nothing is left to be seen"
    for wrong, text in (({"view": "nowhere"}, "view 'nowhere'"), ({"size": (0, 5)}, "size"), ({"size": (1.5, 5)}, "size"),
                        ({"preset": "nonsense"}, "nonsense"), ({"show": "all"}, "show"), ({"background": (2, 0, 0)}, "background"),
                        ({"view": np.zeros((4, 4))}, "singular|inverted|invert")):
        with pytest.raises(vx.InvalidArgumentError, match=text):
            scene.picture(**wrong)
    with pytest.raises(TypeError, match="read_mesh"):
        scene.picture("tool.stl")


def test_a_picture_of_a_scene_of_the_host_has_its_edits(device):
    scene = vx.Scene(vx.read_volume(half_space(np.int16), affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])
    scene.edit(ball=(4, 4, 4, 30), value=0)
    assert (scene.picture(size=(32, 32))[..., :3] == 0).all()


def test_png(device, head, tmp_path):
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], device=device)
    content = scene._repr_png_()
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    at = content.index(b"IDAT")
    rows = zlib.decompress(content[at + 4:-16])
    assert len(rows) == 320 * (1 + 4 * 320)
    np.testing.assert_array_equal(np.frombuffer(rows, np.uint8).reshape(320, -1)[:, 1:].reshape(320, 320, 4),
                                  scene.picture(size=(320, 320)))
    vx.write_png(tmp_path / "a.png", scene.picture(size=(16, 8)))
    assert (tmp_path / "a.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    with pytest.raises(vx.InvalidArgumentError, match="uint8"):
        vx.write_png(tmp_path / "b.png", np.zeros((8, 8, 3)))


WITHOUT = """
import numpy as np
import voxtact as vx
scene = vx.Scene("builtin:head:16", opacity=[(40, 0), (80, 1)])
print(len(scene.detect(vx.read_mesh("builtin:scalpel:300"), np.eye(4))), scene._repr_png_())
for ask in (scene.picture, vx.devices, vx.Device, lambda: vx.Scene("builtin:head:16", device=True)):
    try:
        ask()
    except vx.UnsupportedError as error:
        print(error)
"""


def test_without_a_device():
    """The loader finds no driver: the host answers, and what needs a device says what to install."""
    env = {**os.environ, "VK_ICD_FILENAMES": "/nonexistent.json", "VK_DRIVER_FILES": "/nonexistent.json"}
    done = subprocess.run([sys.executable, "-c", WITHOUT], env=env, capture_output=True, text=True)
    lines = done.stdout.splitlines()
    assert done.returncode == 0 and lines[0] == "1 None", done.stderr
    assert len(lines) == 5 and all("mesa-vulkan-drivers" in line for line in lines[1:]), lines


VALIDATED = """
import numpy as np
import voxtact as vx
from conftest import cube, placed
volume = vx.read_volume(np.full((8, 8, 8), 200, dtype=np.uint8), affine=np.eye(4), space="lps")
scene = vx.Scene(volume, opacity=[(99, 0), (101, 1)], device=True)
try:
    scene.edit(box=(0, 0, 0, 99, 1, 1), value=1)
except vx.Error:
    print("refused")
scene.edit(box=(0, 0, 0, 8, 8, 8), value=0)
print("hit", scene.detect(cube(), placed((4, 4, 4))).hit[0])
"""


def test_a_refused_edit_leaves_the_device_usable(device):
    """Under validation: commands that were begun and then refused must not be begun again as they are."""
    environment = dict(os.environ, VK_INSTANCE_LAYERS="VK_LAYER_KHRONOS_validation",
                       PYTHONPATH=os.pathsep.join([os.path.dirname(__file__), *sys.path]))
    ran = subprocess.run([sys.executable, "-c", VALIDATED], capture_output=True, text=True, env=environment)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.split("\n")[:2] == ["refused", "hit False"] and "VUID" not in ran.stdout + ran.stderr
