#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws idea.svg: a volume, a transfer function, and the fragments of a mesh that pass. Everything in the picture is
computed, the count too. It follows the reader's light or dark scheme. Usage: idea.py > idea.svg"""
import math

VOXELS, CELL = 15, 20          # voxels per side, and pixels of the picture a voxel
SIDE = VOXELS * CELL
FRAGMENT = CELL // 2           # two fragments per voxel
BLADE = [(-40, 92), (205, 120), (222, 136), (205, 146), (-40, 168)]
LOW, HIGH, THRESHOLD = 0.42, 0.62, 0.5
INK, FAINT, OPAQUE, BAD = "#22303c", "#8a97a3", "#c8402a", "#9aa5ae"


def voxel(i, j):
    """A soft ball, lower right of the middle."""
    x, y = (i + 0.5) * CELL, (j + 0.5) * CELL
    distance = math.hypot(x - 178, (y - 152) * 1.08)
    return max(0.0, min(1.0, 1.25 - distance / 118 + 0.06 * math.sin(i * 1.7 + j * 2.3)))


def scalar(x, y):
    """Linear between voxel centres; voxel i's centre is at (i + 0.5) voxels."""
    u, v = x / CELL - 0.5, y / CELL - 0.5
    i, j = math.floor(u), math.floor(v)
    a, b = u - i, v - j
    at = lambda p, q: voxel(min(max(p, 0), VOXELS - 1), min(max(q, 0), VOXELS - 1))
    return ((at(i, j) * (1 - a) + at(i + 1, j) * a) * (1 - b) + (at(i, j + 1) * (1 - a) + at(i + 1, j + 1) * a) * b)


def opacity(s):
    return min(1.0, max(0.0, (s - LOW) / (HIGH - LOW)))


def inside(x, y):
    hit = False
    for (ax, ay), (bx, by) in zip(BLADE, BLADE[1:] + BLADE[:1]):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            hit = not hit
    return hit


STYLE = f"""
.back {{ fill: #ffffff }} .ink {{ fill: {INK} }} .line {{ fill: none; stroke: {INK} }} .hot {{ fill: {OPAQUE} }}
.mark {{ fill: {OPAQUE} }}
@media (prefers-color-scheme: dark) {{
.back {{ fill: #171d23 }} .ink {{ fill: #dde4ea }} .line {{ stroke: #a9b6c1 }} .hot {{ fill: #f0745c }} }}
"""

out = []
say = out.append
text = lambda x, y, words, size=15, kind="ink", anchor="middle", weight="normal": say(
    f'<text x="{x}" y="{y}" font-size="{size}" class="{kind}" text-anchor="{anchor}" font-weight="{weight}">{words}</text>')

blade = " ".join(f"{x},{y}" for x, y in BLADE)


def visible():
    """Tints what is opaque, in runs of pixels along x."""
    for y in range(0, SIDE, 2):
        start = None
        for x in range(0, SIDE + 2, 2):
            opaque = x < SIDE and opacity(scalar(x + 1, y + 1)) >= THRESHOLD
            if opaque and start is None:
                start = x
            if not opaque and start is not None:
                say(f'<rect x="{start}" y="{y}" width="{x - start}" height="2" fill="{OPAQUE}" fill-opacity="0.2"/>')
                start = None


def voxels():
    for j in range(VOXELS):
        for i in range(VOXELS):
            grey = round(250 - 165 * voxel(i, j))
            say(f'<rect x="{i * CELL}" y="{j * CELL}" width="{CELL}" height="{CELL}" fill="rgb({grey},{grey},{grey})"/>')
    say(f'<rect width="{SIDE}" height="{SIDE}" fill="none" stroke="{FAINT}"/>')


say('<svg xmlns="http://www.w3.org/2000/svg" width="1000" height="430" viewBox="0 0 1000 430" '
    'font-family="DejaVu Sans, Helvetica, Arial, sans-serif">')
say(f"<style>{STYLE}</style>")
say('<rect class="back" width="1000" height="430" rx="6"/>')

say('<g transform="translate(50,60)">')
text(SIDE / 2, -22, "1  a raw volume, a mesh at a pose", 16, weight="bold")
voxels()
say(f'<polygon points="{blade}" fill="#4b87c9" fill-opacity="0.35" stroke="#2a5d99" stroke-width="2"/>')
text(SIDE / 2, SIDE + 28, "nothing is meshed,")
text(SIDE / 2, SIDE + 48, "no distance field is made")
say('</g>')

say('<g transform="translate(405,130)">')
W, H = 190, 160
text(W / 2, -92, "2  scalar to opacity", 16, weight="bold")
edge = LOW + THRESHOLD * (HIGH - LOW)
say(f'<rect x="{edge * W:.1f}" y="0" width="{W - edge * W:.1f}" height="{H}" fill="{OPAQUE}" fill-opacity="0.15"/>')
text((edge + 1) / 2 * W, H - 12, "opaque", 14, "hot")
say(f'<polyline points="0,{H} {LOW * W:.1f},{H} {HIGH * W:.1f},0 {W},0" class="line" stroke-width="3"/>')
say(f'<line x1="0" x2="{W}" y1="{H * (1 - THRESHOLD)}" y2="{H * (1 - THRESHOLD)}" stroke="{OPAQUE}" stroke-width="1.5" '
    'stroke-dasharray="6 4"/>')
text(6, H * (1 - THRESHOLD) - 7, "threshold &#964;", 14, "hot", "start")
say(f'<path d="M0,-12 V{H} H{W + 12}" class="line"/>')
text(W / 2, H + 22, "scalar, in the image's units", 14)
say(f'<text transform="translate(-12,{H / 2}) rotate(-90)" font-size="14" class="ink" text-anchor="middle">opacity</text>')
text(W / 2, 258, "edit it: the next")
text(W / 2, 278, "query uses the edit")
say('</g>')

say('<g transform="translate(650,60)">')
text(SIDE / 2, -22, "3  the fragments of the mesh", 16, weight="bold")
say(f'<rect width="{SIDE}" height="{SIDE}" fill="white"/>') # what the voxels are paled against
say('<g opacity="0.4">')
voxels()
say('</g>')
visible()
say(f'<polygon points="{blade}" fill="none" stroke="#2a5d99" stroke-width="1.5"/>')
count = 0
for row in range(-4, SIDE // FRAGMENT):
    for column in range(-4, SIDE // FRAGMENT):
        x, y = (column + 0.5) * FRAGMENT, (row + 0.5) * FRAGMENT
        if not inside(x, y):
            continue
        passes = x >= 0 and opacity(scalar(x, y)) >= THRESHOLD
        count += passes
        paint = f'fill="{OPAQUE}"' if passes else f'fill="white" stroke="{BAD}" stroke-width="1.2"'
        say(f'<circle cx="{x}" cy="{y}" r="{3.8 if passes else 3.1}" {paint}/>')
text(0, SIDE + 28, f'<tspan class="hot">&#9679;</tspan> in the opaque region: passes', anchor="start")
text(0, SIDE + 48, f'<tspan fill="{BAD}">&#9675;</tspan> transparent or outside: discarded', anchor="start")
text(12, 26, f"{count} pass: the mesh touches", 15, "mark", "start", "bold")
say('</g>')
say('</svg>')
print("\n".join(out))
