#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the pictures of docs/architecture.md and docs/engine.md: flow.svg, passes.svg, engine.svg, spaces.svg. Plain SVG, which follows
the reader's light or dark scheme. Usage: draw.py [FOLDER]"""
import math
import pathlib
import sys

STYLE = """
text { font-family: 'DejaVu Sans', Helvetica, Arial, sans-serif; font-size: 14px; fill: #22303c }
.back { fill: #ffffff } .box { fill: #f3f6f8; stroke: #b9c4cd; stroke-width: 1.2 }
.data { fill: #dce8f5; stroke: #7ba3cf; stroke-width: 1.2 } .ours { fill: #fbe3dd; stroke: #d9816f; stroke-width: 1.2 }
.title { font-weight: bold } .small { font-size: 12.5px } .faint { fill: #66747f } .code { font-family: 'DejaVu Sans Mono', monospace }
.line { fill: none; stroke: #51606c; stroke-width: 1.6 } .thin { fill: none; stroke: #9aa7b2; stroke-width: 1 }
.head { fill: #51606c } .mesh { fill: #4b87c9; fill-opacity: .45; stroke: #2a5d99; stroke-width: 1.6 }
.hot { fill: #c8402a } .grid { fill: none; stroke: #b0bbc4; stroke-width: .8 } .hotline { fill: none; stroke: #c8402a; stroke-width: 2 }
.soft { fill: #c8402a; fill-opacity: .22 }
@media (prefers-color-scheme: dark) {
text { fill: #dde4ea } .back { fill: #171d23 } .box { fill: #222b33; stroke: #4b5a67 }
.data { fill: #1d3550; stroke: #4a7cb3 } .ours { fill: #4a2620; stroke: #b5604e } .faint { fill: #93a1ad }
.line { stroke: #a9b6c1 } .thin { stroke: #5e6c78 } .head { fill: #a9b6c1 } .mesh { stroke: #8fbcee } .hot { fill: #f0745c }
.grid { stroke: #4d5a66 } .hotline { stroke: #f0745c } .soft { fill: #f0745c; fill-opacity: .3 } }
"""


class Picture:
    def __init__(self, width, height, title):
        self.out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
                    f'viewBox="0 0 {width} {height}" role="img">', f"<title>{title}</title>", f"<style>{STYLE}</style>",
                    f'<rect class="back" width="{width}" height="{height}" rx="6"/>']

    def add(self, text):
        self.out.append(text)

    def text(self, x, y, words, kind="", anchor="middle"):
        words = words.replace("&", "&amp;").replace("<", "&lt;")
        self.add(f'<text x="{x:g}" y="{y:g}" class="{kind}" text-anchor="{anchor}">{words}</text>')

    def box(self, x, y, w, h, title, lines=(), kind="box", code=""):
        """A box with a bold title, lines of small text, and a name in the source below them."""
        self.add(f'<rect class="{kind}" x="{x:g}" y="{y:g}" width="{w:g}" height="{h:g}" rx="5"/>')
        self.text(x + w / 2, y + 21, title, "title")
        for number, line in enumerate(lines):
            self.text(x + w / 2, y + 41 + 17 * number, line, "small")
        if code:
            self.text(x + w / 2, y + h - 9, code, "small code faint")

    def arrow(self, *points, label="", at=None, anchor="middle", kind="small faint"):
        path = "M" + " L".join(f"{x:g},{y:g}" for x, y in points)
        self.add(f'<path class="line" d="{path}"/>')
        (ax, ay), (bx, by) = points[-2:]
        angle = math.atan2(by - ay, bx - ax)
        corners = [(bx, by)] + [(bx - 9 * math.cos(angle + turn), by - 9 * math.sin(angle + turn)) for turn in (.45, -.45)]
        self.add('<polygon class="head" points="' + " ".join(f"{x:.1f},{y:.1f}" for x, y in corners) + '"/>')
        if label:
            x, y = at or ((points[0][0] + points[-1][0]) / 2, (points[0][1] + points[-1][1]) / 2 - 7)
            self.text(x, y, label, kind, anchor)

    def polygon(self, points, kind):
        self.add(f'<polygon class="{kind}" points="' + " ".join(f"{x:.1f},{y:.1f}" for x, y in points) + '"/>')

    def line(self, a, b, kind="thin"):
        self.add(f'<path class="{kind}" d="M{a[0]:.1f},{a[1]:.1f} L{b[0]:.1f},{b[1]:.1f}"/>')

    def write(self, path):
        path.write_text("\n".join(self.out + ["</svg>"]) + "\n")


def flow():
    p = Picture(980, 470, "The way of the data: files, io, core, then the device or the host, answers, output")
    p.box(20, 40, 150, 150, "files", ("volume", "mesh", "poses", "transfer function", "label map"), "data")
    p.box(215, 40, 150, 150, "io", ("each file opened and", "decompressed once;", "strict readers;", "LPS, millimetres"), code="src/io")
    p.box(410, 40, 165, 150, "core", ("plain host data:", "checked once, ranges", "kept; the table; clusters", "of triangles; bricks"), code="src/core")
    p.arrow((170, 115), (213, 115))
    p.arrow((365, 115), (408, 115))
    p.box(20, 255, 150, 100, "your renderer", ("images and buffers", "on the device already:", "wrapped, not copied"), "data")
    p.box(215, 255, 150, 100, "the scene", ("Volume, Mesh, …", "on the device"), code="src/vulkan")
    p.arrow((170, 305), (213, 305))
    p.arrow((440, 190), (440, 222), (290, 222), (290, 253), label="cmdUpload()", at=(365, 216), kind="small code faint")
    p.box(410, 255, 165, 100, "a batch", ("meshes, poses, volumes;", "threshold, view"), "data")
    p.arrow((365, 305), (408, 305))
    p.box(620, 255, 150, 100, "detect", ("records the passes in", "your commands"), code="src/device")
    p.arrow((575, 305), (618, 305), label="", at=None)
    p.box(620, 40, 150, 150, "the host engine", ("the same questions,", "the same counts as", "compute, bit for bit;", "no Vulkan"), code="src/host")
    p.arrow((575, 115), (618, 115))
    p.box(815, 255, 145, 100, "results", ("a device buffer:", "one PairResult for", "each pair, outputs"), "data")
    p.arrow((770, 305), (813, 305))
    p.box(815, 40, 145, 150, "answers", ("PairAnswer: touches,", "count, how exact;", "contacts, triangles,", "bounds, labels"), "data")
    p.arrow((770, 115), (813, 115))
    p.arrow((887, 255), (887, 192), label="read back", at=(880, 228), anchor="end")
    p.box(815, 400, 145, 50, "your next pass", ("no copy, no wait",), "data")
    p.arrow((887, 355), (887, 398))
    p.box(410, 400, 165, 50, "pictures", ("the same scene",), code="")
    p.arrow((290, 355), (290, 425), (408, 425))
    p.text(590, 430, "src/render", "small code faint", "start")
    p.text(490, 24, "files or your renderer in, answers out: each file is opened, checked and uploaded once", "faint")
    return p


def passes():
    p = Picture(980, 640, "What cmdDetect() records, by way of counting")
    p.text(20, 30, "every cmdDetect() records", "title", "start")
    p.box(20, 44, 215, 78, "prepare", ("transforms and empty results", "into buffers; queries reset"))
    p.text(20, 150, "and in the middle, by what the detector was made for:", "title", "start")
    p.box(745, 44, 215, 78, "finish", ("query results over the counts;", "all visible to your next pass"))
    p.arrow((235, 83), (310, 83), label="barrier", at=(272, 76))
    p.box(312, 44, 355, 78, "count", ("one of the three below,", "for each item of the batch"), "data")
    p.arrow((667, 83), (743, 83), label="barrier", at=(705, 76))

    def chain(y, name, steps):
        p.text(20, y - 12, name, "title", "start")
        x, gap = 20, 22
        for number, (w, title, lines, kind, code) in enumerate(steps):
            p.box(x, y, w, 112, title, lines, kind, code)
            if number + 1 < len(steps):
                p.arrow((x + w, y + 56), (x + w + gap - 1, y + 56))
            x += w + gap

    chain(190, "query, query-any, atomic, subgroup: the rasteriser, without any attachment", [
        (205, "triangles", ("into the view, or each along", "its own dominant axis"), "box", "view.vert, dominant.vert"),
        (185, "fragments", ("a texture coordinate t", "for each pixel"), "data", "the device"),
        (240, "survives?", ("t in [0,1]³; volume(t); opacity;", "opacity ≥ threshold — else discard"), "box", "view.frag, survives.glsl"),
        (244, "count", ("samples in a query of its own,", "or one addition to the pair"), "ours", "count.glsl")])
    chain(350, "compute: no rasteriser, the same count on every device and on the host", [
        (205, "triangles", ("transformed and clipped,", "corners on 1/256 pixel"), "box", "compute.comp"),
        (185, "pixels", ("top-left rule", "in integers"), "data", "exact.h"),
        (240, "survives?", ("eight voxels, fp32 additions and", "multiplications in a written order"), "box", "exact.h"),
        (244, "count", ("summed over the work group,", "one addition to the pair"), "ours", "count.glsl")])
    chain(510, "certified: no pixel, every voxel cell that a triangle passes through", [
        (160, "clusters, bricks", ("skipped where", "nothing can be opaque"), "box", "certified_cull.comp"),
        (175, "cells", ("listed, where they", "need a decision"), "data", "certified_expand.comp"),
        (190, "bounds", ("the triangle cut to each;", "halved: none, certain, open"), "box", "certified_decide.comp"),
        (140, "what stays open", ("listed; the next is", "an indirect dispatch"), "data", ""),
        (177, "again, precisely", ("none, certain,", "or possible"), "ours", "certified_finish.comp")])
    return p


def engine():
    p = Picture(980, 430, "The passes of the certified engine on a device, and the queues between them")
    p.text(20, 30, "a round: as many clusters of as many pairs as the queues have room for", "title", "start")

    def step(x, y, w, title, lines, name):
        p.box(x, y, w, 96, title, lines, "box", name)

    def queue(x, y, w, title, line):
        p.add(f'<rect class="data" x="{x:g}" y="{y:g}" width="{w:g}" height="44" rx="14"/>')
        p.text(x + w / 2, y + 18, title, "small title")
        p.text(x + w / 2, y + 35, line, "small faint")

    step(20, 50, 180, "cull", ("a lane per cluster:", "does its box meet a brick?"), "certified_cull")
    step(400, 50, 180, "refine", ("a lane a run", "of 16 triangles"), "certified_cull, RUNS")
    step(780, 50, 180, "expand", ("a lane per triangle:", "which cells need a decision"), "certified_expand")
    step(780, 190, 180, "large", ("work groups share", "what has many cells"), "certified_large")
    step(400, 190, 180, "decide", ("a lane per cell: clip,", "bound, halve"), "certified_decide")
    step(20, 190, 180, "finish", ("a lane an open cell, or", "one that had no room"), "certified_finish")
    queue(235, 76, 130, "clusters", "1 each")
    queue(615, 76, 130, "runs", "4 each")
    queue(615, 216, 130, "cells", "32 each")
    queue(235, 216, 130, "open cells", "32 each")
    for x in (200, 365, 580, 745):
        p.arrow((x, 98), (x + 33, 98))
    p.arrow((870, 146), (870, 188), label="large ones", at=(878, 172), anchor="start")
    for x in (780, 615, 400, 235):
        p.arrow((x, 238), (x - 33, 238))
    p.arrow((815, 146), (730, 214))
    p.box(20, 330, 195, 62, "none, certain, possible", ("64-bit counts of the pairs",), "ours")
    p.arrow((110, 286), (110, 328))
    p.arrow((450, 286), (450, 352), (217, 352), label="certain", at=(395, 345))
    p.arrow((910, 286), (910, 310), (160, 310), (160, 288), label="what a full queue cannot take: found again, and decided in place",
            at=(690, 304))
    p.text(235, 388, "A queue's room is a multiple of the clusters of a round. Each arrow into a pass is an indirect dispatch behind a",
           "small faint", "start")
    p.text(235, 406, "barrier; cull is dispatched. For a yes or no, a vertex in opaque matter ends the work on its pair in the first two.", "small faint",
           "start")
    return p


def turned(points, angle, centre, scale=1.0):
    c, s = math.cos(angle), math.sin(angle)
    return [(centre[0] + scale * (c * x - s * y), centre[1] + scale * (s * x + c * y)) for x, y in points]


BLADE = [(-70, -9), (20, -9), (52, 4), (20, 11), (-70, 11)]


def axes(p, x, y, right, up, size=40, flip=False):
    p.arrow((x, y), (x + size, y))
    p.arrow((x, y), (x, y + (size if flip else -size)))
    p.text(x + size + 5, y + 4, right, "small faint", "start")
    p.text(x, y + (size + 16 if flip else -size - 6), up, "small faint")


def grid_of(p, corner, along, across, n, kind="grid"):
    for i in range(n + 1):
        t = i / n
        p.line((corner[0] + along[0] * t, corner[1] + along[1] * t),
               (corner[0] + along[0] * t + across[0], corner[1] + along[1] * t + across[1]), kind)
        p.line((corner[0] + across[0] * t, corner[1] + across[1] * t),
               (corner[0] + across[0] * t + along[0], corner[1] + across[1] * t + along[1]), kind)


def spaces():
    p = Picture(980, 480, "The spaces and the matrices between them")

    def panel(x, y, w, h, title, unit):
        p.add(f'<rect class="box" x="{x}" y="{y}" width="{w}" height="{h}" rx="5"/>')
        p.text(x + w / 2, y + 22, title, "title")
        p.text(x + w / 2, y + h - 12, unit, "small faint")

    panel(20, 120, 220, 210, "object", "the mesh's own coordinates")
    p.polygon(turned(BLADE, 0, (140, 225)), "mesh")
    axes(p, 60, 290, "x", "y")
    panel(380, 105, 250, 240, "world", "mm, LPS; voxels may be oblique")
    angle = -0.22
    corner, along, across = (450, 172), (130 * math.cos(angle), 130 * math.sin(angle)), (-100 * math.sin(angle), 100 * math.cos(angle))
    ball = [(535 + 38 * math.cos(turn / 10), 212 + 38 * math.sin(turn / 10)) for turn in range(63)]
    blade = turned(BLADE, 0.5, (488, 198), 0.75)
    grid_of(p, corner, along, across, 6)
    p.polygon(ball, "soft")
    p.polygon(blade, "mesh")
    axes(p, 402, 262, "left", "back", 30, True)

    def textured(point):
        """texture_from_world, into the panel."""
        x, y = point[0] - corner[0], point[1] - corner[1]
        u = (x * along[0] + y * along[1]) / (along[0] ** 2 + along[1] ** 2)
        v = (x * across[0] + y * across[1]) / (across[0] ** 2 + across[1] ** 2)
        return 790 + 120 * u, 65 + 110 * v

    panel(740, 20, 220, 200, "texture", "[0,1]³ over the whole image")
    grid_of(p, (790, 65), (120, 0), (0, 110), 6)
    p.polygon([textured(point) for point in ball], "soft")
    p.polygon([textured(point) for point in blade], "mesh")
    p.text(786, 63, "0", "small faint", "end")
    p.text(915, 63, "1", "small faint", "start")
    panel(740, 260, 220, 200, "clip", "Vulkan's: y down, depth 0 to 1")
    p.add('<rect class="thin" x="780" y="300" width="140" height="110"/>')
    p.polygon(turned(BLADE, 0.35, (850, 355), 0.8), "mesh")
    axes(p, 786, 306, "x", "y", 30, True)
    p.arrow((240, 225), (378, 225))
    p.text(309, 200, "world_from_object", "small code")
    p.text(309, 216, "the pose", "small faint")
    p.arrow((630, 190), (690, 120), (738, 120))
    p.text(640, 80, "texture_from_world", "small code")
    p.text(640, 97, "of the grid", "small faint")
    p.arrow((630, 270), (690, 360), (738, 360))
    p.text(650, 385, "clip_from_world", "small code")
    p.text(650, 402, "the camera", "small faint")
    p.text(20, 42, "A matrix b_from_a takes points of space a to space b; matrices read from the right:", "", "start")
    p.text(20, 66, "texture_from_object = texture_from_world · world_from_object", "code small", "start")
    p.text(20, 86, "clip_from_object = clip_from_world · world_from_object", "code small", "start")
    p.text(20, 375, "index = texture · n − 0.5: voxel i's centre is at i in index space", "small", "start")
    p.text(20, 395, "and at (i + 0.5) / n in texture space. A cell lies between eight centres.", "small", "start")
    p.text(20, 425, "Products are formed in double precision and rounded to float once.", "small faint", "start")
    return p


def main(arguments):
    folder = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).resolve().parent
    for draw in (flow, passes, engine, spaces):
        draw().write(folder / f"{draw.__name__}.svg")


if __name__ == "__main__":
    main(sys.argv[1:])
