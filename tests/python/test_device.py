# SPDX-License-Identifier: MIT
"""Scenes on a Vulkan device: the host's answers; and pictures."""
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
    expected, answer = host.count(knife, poses, **asked), there.count(knife, poses, **asked)
    assert (answer.method, expected.method) == ("compute", "cpu") and expected.touches.any()
    np.testing.assert_array_equal(answer.count, expected.count)
    np.testing.assert_array_equal(answer.triangles, expected.triangles)
    np.testing.assert_array_equal(answer.labels, expected.labels)
    np.testing.assert_allclose(answer.contacts["position"], expected.contacts["position"], atol=1e-4)
    np.testing.assert_allclose(answer.bounds, expected.bounds, atol=1e-4)
    np.testing.assert_array_equal(there.touch(knife, poses).touches, expected.touches)
    assert repr(there).endswith(f"on {device.info.name!r}>")


def test_the_first_piece_of_a_device_is_small(device, head):
    def stop(done, of):
        told.append(done)
        raise StopIteration("enough")

    told = []
    triangle = vx.read_mesh(([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]]))
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], device=device)
    with pytest.raises(StopIteration, match="enough"):
        scene.count(triangle, random_poses(1000, 32), progress=stop)
    assert told == [8]


def test_distances_and_motions_are_the_hosts_also_for_a_scene_on_a_device(device, head, knife):
    host, there = both(device, head)
    poses = random_poses(9, 33)
    for ask in (lambda scene: scene.touch(knife, poses, margin=3).touches,
                lambda scene: scene.touch(knife, poses, uncertainty=(2, 3)).touches,
                lambda scene: scene.distance(knife, poses).upper,
                lambda scene: scene.motion(knife, poses).toi_lower):
        np.testing.assert_array_equal(ask(there), ask(host))
    assert there.touch(knife, poses, margin=3).method == "cpu"


def test_more_contacts_than_a_device_has_room_for(device, head, knife):
    with pytest.raises(vx.LimitExceededError, match="; ask for fewer by max_contacts, which is 4294967295$"):
        vx.Scene(head, device=device).count(knife, np.eye(4), contacts=True, max_contacts=2**32 - 1, method="compute")


@pytest.mark.parametrize("method", ["query", "atomic", "subgroup", "compute"])
def test_methods(device, head, knife, method):
    if device.methods[method] is not None:
        pytest.skip(device.methods[method])
    host, there = both(device, head)
    poses = random_poses(10, 32)
    answer = there.count(knife, poses, projection="view", method=method, filter="exact")
    assert answer.method == method
    np.testing.assert_allclose(answer.count.astype(float), host.count(knife, poses, projection="view").count, atol=20,
                               rtol=0.05)


def test_changes_reach_the_device(device, knife):
    volume = vx.read_volume(half_space(np.int16), axes="zyx", affine=np.eye(4), space="lps")
    scene = vx.Scene(volume, opacity=[(99, 0), (101, 1)], device=device)
    touching, free = placed((4, 4, 4)), placed((9, 4, 4))
    assert scene.count(cube(), touching).touches[0] and not scene.count(cube(), free).touches[0]
    scene.edit(ball=(4, 4, 4, 3), value=-1000)
    scene.edit(at=(8, 3, 3), voxels=np.full((2, 2, 2), 200))
    assert not scene.count(cube(), touching).touches[0] and scene.count(cube(), free).touches[0]
    # The host's side is made now, and gets the edits that there were.
    assert scene.distance(cube(), touching).lower[0] > 0 and scene.distance(cube(), free).lower[0] == 0
    scene.opacity = [(299, 0), (301, 1)]
    assert not scene.count(cube(), free).touches[0] and scene.distance(cube(), free).lower[0] == np.inf
    with pytest.raises(vx.InvalidArgumentError):
        scene.edit(ball=(4, 4, 4, 3), value=1.5)


def test_pieces_with_outputs(device, head):
    """Counters of all triangles of a first piece of pairs, and of the next ones."""
    mesh = vx.read_mesh("builtin:ellipsoid:49998")
    poses = placed(*[(500, 0, z) for z in range(60)], (0, 0, 0))
    answer = vx.Scene(head, opacity=[(40, 0), (80, 1)], device=device).count(mesh, poses, triangles=True, stop_at_first=False)
    assert answer.touches.tolist() == [False] * 60 + [True]
    assert (answer.triangles["pair"] == 60).all() and len(answer.triangles) > 0


def test_a_device_after_a_fork(device, head, knife):
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], device=device)
    scene.count(knife, np.eye(4))
    child = os.fork()
    if child == 0:
        status = 1
        try:
            try:
                scene.count(knife, np.eye(4))
            except vx.UnsupportedError as error:
                status = 0 if "forked" in str(error) else 2
            del scene
        finally:
            os._exit(status)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert len(scene.count(knife, np.eye(4))) == 1


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
    scene = vx.Scene(vx.read_volume(half_space(np.int16), axes="zyx", affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])
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
print(len(scene.count(vx.read_mesh("builtin:scalpel:300"), np.eye(4))), scene._repr_png_())
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
volume = vx.read_volume(np.full((8, 8, 8), 200, dtype=np.uint8), axes="zyx", affine=np.eye(4), space="lps")
scene = vx.Scene(volume, opacity=[(99, 0), (101, 1)], device=True)
try:
    scene.edit(box=(0, 0, 0, 99, 1, 1), value=1)
except vx.Error:
    print("refused")
scene.edit(box=(0, 0, 0, 8, 8, 8), value=0)
print("hit", scene.count(cube(), placed((4, 4, 4))).touches[0])
"""


def test_a_refused_edit_leaves_the_device_usable(device):
    """Under validation: commands that were begun and then refused must not be begun again as they are."""
    environment = dict(os.environ, VK_INSTANCE_LAYERS="VK_LAYER_KHRONOS_validation",
                       PYTHONPATH=os.pathsep.join([os.path.dirname(__file__), *sys.path]))
    ran = subprocess.run([sys.executable, "-c", VALIDATED], capture_output=True, text=True, env=environment)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.split("\n")[:2] == ["refused", "hit False"] and "VUID" not in ran.stdout + ran.stderr
