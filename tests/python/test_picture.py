# SPDX-License-Identifier: MIT
"""Pictures: those of `voxtact render`, byte for byte; several meshes, cuts, chosen triangles, looks."""
import json

import matplotlib.image
import numpy as np
import pytest

import voxtact as vx
from conftest import cube, placed, program

VOLUME, OPACITY = "builtin:head:32", "40:0,80:1"
SIZE = (112, 80)


def rendered(folder, *arguments):
    """What the program draws."""
    program("render", "--volume", VOLUME, "--opacity", OPACITY, "--size", f"{SIZE[0]}x{SIZE[1]}", "--no-annotate",
            "--cache", "off", "--output", folder / "picture.png", *arguments, cwd=folder)
    return np.rint(matplotlib.image.imread(folder / "picture.png") * 255).astype(np.uint8)


def red(picture):
    channels = picture.astype(int)
    return channels[..., 0] > 80 + channels[..., 1]


@pytest.fixture(scope="module")
def drawn(device):
    return vx.Scene(VOLUME, opacity=OPACITY, device=device)


@pytest.fixture
def posed(tmp_path):
    """Two poses, as the program reads them."""
    poses = placed((0, 0, 60), (40, -30, 20))
    np.savetxt(tmp_path / "poses.txt", poses.reshape(-1, 16))
    return poses


@pytest.mark.parametrize("arguments, options", [
    ((), {}),
    (("--view", "left", "--lighting", "eye", "--background", "336699"),
     dict(view="left", lighting="eye", background=(0.2, 0.4, 0.6))),
    (("--azimuth", 40, "--elevation", 20, "--lighting", "none", "--clip", "left", "--clip", "top:25"),
     dict(view=(40, 20), lighting="none", clip=["left", ("top", 25)])),
    (("--view", "top", "--clip", "near:10"), dict(view="top", clip=("near", 10))),
    (("--clip", "1,-2,0.5,12"), dict(clip=(1, -2, 0.5, 12))),
    (("--preset", "mr"), dict(preset="mr")),
])
def test_the_volume_is_the_programs(drawn, tmp_path, arguments, options):
    np.testing.assert_array_equal(drawn.picture(size=SIZE, **options), rendered(tmp_path, *arguments))


@pytest.mark.parametrize("arguments, options", [
    ((), dict(show="plain")),
    (("--show", "contacts"), {}),
    (("--show", "discarded", "--through", 0.5), dict(show="discarded", through=0.5)),
    (("--show", "triangles"), dict(show="triangles")),
    (("--clip", "front", "--clip-mesh", "--mesh-colour", "ff0000", "--mesh-colour", "00ff00"),
     dict(show="plain", clip="front", clip_meshes=True, mesh_colours=[(1, 0, 0), (0, 1, 0)])),
])
def test_several_meshes_at_several_poses_are_the_programs(drawn, posed, tmp_path, arguments, options):
    meshes = [(vx.read_mesh(name), posed) for name in ("builtin:scalpel:300", "builtin:ellipsoid:400")]
    there = rendered(tmp_path, "--mesh", "builtin:scalpel:300", "--mesh", "builtin:ellipsoid:400", "--poses", "poses.txt",
                     "--pose", "all", "--view", "right", *arguments)
    picture = drawn.picture(meshes, size=SIZE, view="right", **options)
    np.testing.assert_array_equal(picture, there)
    assert not np.array_equal(picture, drawn.picture(meshes[:1], size=SIZE, view="right", show="plain"))


def test_chosen_triangles(drawn, knife):
    poses = placed((0, 0, 60), (40, -30, 20))
    touching = drawn.count(knife, poses, triangles=True).triangles
    assert len(touching) and set(touching["pair"]) <= {0, 1}
    every = drawn.picture(knife, poses, size=SIZE, triangles=touching)
    np.testing.assert_array_equal(every, drawn.picture(knife, poses, size=SIZE, show="triangles"))
    assert red(every).any()
    none = drawn.picture(knife, poses, size=SIZE, triangles=[])
    np.testing.assert_array_equal(none, drawn.picture(knife, poses, size=SIZE, show="plain"))
    all_of_it = drawn.picture(knife, poses, size=SIZE, triangles=np.arange(len(knife.faces)), through=1)
    assert red(all_of_it).sum() > red(every).sum()
    two = [(knife, poses[:1]), (cube(20), poses[1:])]
    rows = drawn.count(two, triangles=True).triangles
    np.testing.assert_array_equal(drawn.picture(two, size=SIZE, triangles=rows),
                                  drawn.picture(two, size=SIZE, show="triangles"))
    with pytest.raises(vx.InvalidArgumentError, match="2 meshes: give rows with pair"):
        drawn.picture(two, size=SIZE, triangles=[0])
    with pytest.raises(vx.InvalidArgumentError, match="99999"):
        drawn.picture(knife, poses, size=SIZE, triangles=[99999])
    with pytest.raises(vx.InvalidArgumentError, match="pair 1, and there are 1 pairs"):
        drawn.picture(knife, poses[0], size=SIZE, triangles=touching[touching["pair"] == 1])
    with pytest.raises(vx.InvalidArgumentError, match="neither rows with pair"):
        drawn.picture(knife, size=SIZE, triangles=[0.5])
    with pytest.raises(vx.InvalidArgumentError, match="show='plain' does not show"):
        drawn.picture(knife, size=SIZE, triangles=[0], show="plain")


def test_a_view_from_a_side_is_the_pictures(drawn, knife, tmp_path):
    pose = placed((0, 0, 60))
    head = drawn.volume
    view = vx.view_from("left", head, knife, pose, size=SIZE)
    assert (view.width, view.height) == SIZE
    np.testing.assert_array_equal(drawn.picture(knife, pose, view=view), drawn.picture(knife, pose, view="left", size=SIZE))
    np.testing.assert_array_equal(vx.view_from((90, 0), head, knife, pose, size=SIZE).clip_from_world, view.clip_from_world)
    counted = drawn.count(knife, pose, projection="view", view=view).count[0]
    painted = red(drawn.picture(knife, pose, view=view, through=1, show="contacts")).sum()
    assert counted > 0 and painted > 0
    assert drawn.count(knife, pose, projection="view", view=view).device_seconds >= 0
    for wrong in ("above", (np.nan, 0)):
        with pytest.raises(vx.InvalidArgumentError, match="view"):
            vx.view_from(wrong, head)
    with pytest.raises(vx.InvalidArgumentError, match="size"):
        vx.view_from("left", head, size=(0, 5))
    with pytest.raises(TypeError, match="a name or"):
        vx.view_from(np.eye(4), head)
    with pytest.raises(TypeError, match="view is .*; a number is needed"):
        vx.view_from(((1, 2), (3,)), head)
    with pytest.raises(TypeError, match="read_volume"):
        vx.view_from("left", "head.nii")


def test_looks(device, tmp_path):
    assert {"mr", "ct-bone"} <= set(vx.looks())
    head = vx.read_volume(VOLUME)
    mr = vx.look("mr", head)
    assert mr.opacity.shape[1] == 2 and mr.colours.shape[1] == 4
    assert (np.diff(mr.opacity[:, 0]) > 0).all() and head.range[0] <= mr.opacity[0, 0] < mr.opacity[-1, 0] <= head.range[1]
    scene = vx.Scene(head, opacity=mr.opacity, device=device)
    program("render", "--volume", VOLUME, "--preset", "mr", "--size", "112x80", "--no-annotate", "--cache", "off",
            "--output", "mr.png", cwd=tmp_path)
    there = np.rint(matplotlib.image.imread(tmp_path / "mr.png") * 255).astype(np.uint8)
    np.testing.assert_array_equal(scene.picture(size=SIZE, preset="mr"), there)
    np.testing.assert_array_equal(scene.picture(size=SIZE, colours=mr.colours), there)
    (tmp_path / "tf.json").write_text(json.dumps({"points": [[0, 0], [80, 1]], "colours": [[0, 1, 0, 0], [80, 0, 0, 1]]}))
    np.testing.assert_array_equal(vx.read_colours(tmp_path / "tf.json"), [[0, 1, 0, 0], [80, 0, 0, 1]])
    with pytest.raises(vx.InvalidArgumentError, match="nonsense.*take one of mr"):
        vx.look("nonsense", head)
    with pytest.raises(TypeError, match="read_volume"):
        vx.look("mr", "head.nii")
    with pytest.raises(vx.FileError, match="none.json"):
        vx.read_colours(tmp_path / "none.json")


@pytest.mark.parametrize("options, text", [
    (dict(clip="behind"), "clip 'behind' is none of left"),
    (dict(show="plain"), "show is about meshes, and there is none"),
    (dict(through=0.5), "through is about meshes, and there is none"),
    (dict(clip="left", clip_meshes=True), "clip_meshes is about meshes, and there is none"),
    (dict(pose=np.eye(4)), "pose is about a mesh, and there is none"),
    (dict(clip=[("left", float("nan"))]), "clip 'left' is at nan"),
    (dict(clip=[(0, 0, 0, 1)]), "normal"),
    (dict(clip=["left"] * 7), "7|six|6"),
    (dict(clip="near", view=np.eye(4)), "'near' needs a view by name"),
    (dict(clip=[(1, 2, 3)]), "a plane"),
    (dict(lighting="dark"), "lighting 'dark' is none of soft"),
    (dict(mesh_colours=[(1, 0, 0)]), "1 colours, and there are 0 meshes"),
    (dict(colours=[(0, 1, 1)]), "colours"),
    (dict(colours=[(0, 1, 1, 7)]), "colour"),
    (dict(preset="mr", colours=[(0, 1, 1, 1)]), "leave out one"),
    (dict(through=2), "through"),
    (dict(background=(1, 2)), "background"),
    (dict(triangles=[0]), "0 meshes"),
])
def test_refusals(drawn, options, text):
    with pytest.raises(vx.InvalidArgumentError, match=text):
        drawn.picture(size=(16, 16), **options)
