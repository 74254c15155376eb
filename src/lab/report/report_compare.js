// SPDX-License-Identifier: MIT
'use strict';
(() => {
  const { data, byId, element, grouped, counted, short, words, numbers, fillTable, fillAbout, fillMachine, fillSeries, drawBatches,
    drawSweep } = report;
  const scene = data.scene;

  function fillHead() {
    const source = (text) => text.replace(/^builtin:/, '').replace(/^.*\//, '');
    byId('title').textContent = `${source(scene.mesh)} against ${source(scene.volume)}, by every method`;
    document.title = `voxtact compare: ${source(scene.mesh)} against ${source(scene.volume)}`;
    byId('subtitle').textContent =
      `${counted(scene.poses, 'pose')} (${scene.poses_from}), ${counted(scene.triangles, 'triangle')}, ` +
      `${scene.voxels.join(' × ')} voxels of ${scene.voxel_type}, ${scene.width} × ${scene.height} pixels, ` +
      `opaque from ${scene.threshold}`;
  }

  function verdictTag(row) {
    if (!row.checked) return element('span', 'not checked', 'tag told');
    if (!row.required) return element('span', 'for information', 'tag told');
    return row.agrees ? element('span', '✓ agree', 'tag') : element('span', '✗ differ', 'tag failed');
  }

  function fillAgreement() {
    const columns = [...words('Verdict', 'Rule'), ...numbers('Compared', 'Differing', 'Largest difference'), ...words('Detail')];
    fillTable(byId('agreement'), columns, data.agreement.map((row) => [
      verdictTag(row), row.rule,
      row.checked ? `${grouped(row.compared)} ${row.unit}` : '–',
      row.checked ? grouped(row.differing) : '–',
      row.checked ? `${grouped(row.largest_difference)} ${row.unit === 'fragments' ? 'on a pose' : 'fragments'}` : '–',
      row.why_not || [row.agrees ? '' : `pose ${row.pose}: ${row.text}`, row.detail].filter(Boolean).join('; '),
    ]));
  }

  function fillTables() {
    const methods = Object.keys(data.counts);
    fillTable(byId('counts'), [...numbers('Pose'), ...numbers(...methods)],
      data.poses.map((pose, i) => [pose, ...methods.map((method) => data.counts[method][i])]));
    const most = 1000;
    const fragments = data.oracle.differing.slice(0, most);
    fillTable(byId('fragments'), [...numbers('Pose', 'Triangle', 'x', 'y'), ...words('Only on', 'Within rounding of'),
      ...numbers('Edge, px', 'Opacity', 'low', 'high')],
    fragments.map((f) => [f.pose, f.triangle, f.x, f.y, f.on, f.reason, short(f.edge_distance_px), short(f.opacity),
      short(f.opacity_low), short(f.opacity_high)]));
    byId('differing').firstElementChild.textContent = data.oracle.differing.length > most
      ? `Fragments of one side only (the first ${grouped(most)} of ${grouped(data.oracle.differing.length)})`
      : `Fragments of one side only (${grouped(data.oracle.differing.length)})`;
  }

  function drawCharts() {
    const parent = byId('charts');
    drawBatches(parent);
    drawSweep(parent, 'fragments', 'Time against fragments',
      'The same poses on viewports of 64 to 2048 pixels. The axis is the surviving fragments of a pair, on average; ' +
      'the methods also work on the ones that do not survive.', 'surviving fragments a pair', (s) => s.fragments_a_pair);
    drawSweep(parent, 'triangles', 'Time against triangles',
      'The same shape from coarse to fine, the same poses and viewport.', 'triangles', (s) => s.triangles);
    drawSweep(parent, 'voxels', 'Time against voxels',
      'The same volume from coarse to fine, the same mesh, poses and viewport.', 'voxels',
      (s) => s.voxels.reduce((product, side) => product * side));
  }

  fillHead();
  fillAbout();
  fillMachine();
  fillAgreement();
  fillTables();
  fillSeries();
  drawCharts();
})();
