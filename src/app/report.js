// SPDX-License-Identifier: MIT
'use strict';
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const byId = (id) => document.getElementById(id);
  const scene = data.scene;

  // Okabe and Ito's palette: told apart by colour-blind readers too; the shape of the mark says the same once more.
  const looks = {
    query: { colour: '#0072b2', mark: 'circle' },
    'query-any': { colour: '#56b4e9', mark: 'triangle' },
    atomic: { colour: '#d55e00', mark: 'rect' },
    subgroup: { colour: '#b8860b', mark: 'rectRot' },
    compute: { colour: '#cc79a7', mark: 'star' },
    cpu: { colour: '#009e73', mark: 'crossRot' },
  };
  const look = (method) => looks[method] || { colour: '#444444', mark: 'circle' };

  function element(tag, text, className) {
    const made = document.createElement(tag);
    if (text !== undefined) made.textContent = text;
    if (className) made.className = className;
    return made;
  }

  const grouped = (value) => Math.round(value).toLocaleString('en-US');
  function short(value) {
    if (value === null || value === undefined) return '–';
    if (value === 0) return '0';
    const size = Math.abs(value);
    if (size >= 1e9) return Number((value / 1e9).toPrecision(3)) + ' G';
    if (size >= 1e6) return Number((value / 1e6).toPrecision(3)) + ' M';
    if (size >= 1000) return grouped(Number(value.toPrecision(3)));
    return String(Number(value.toPrecision(3)));
  }

  function fillTable(table, columns, rows) {
    const head = table.createTHead().insertRow();
    for (const column of columns) head.appendChild(element('th', column.name, column.number ? 'n' : ''));
    const body = table.createTBody();
    for (const row of rows) {
      const line = body.insertRow();
      columns.forEach((column, i) => {
        const cell = line.insertCell();
        if (column.number) cell.className = 'n';
        if (row[i] instanceof Node) cell.appendChild(row[i]);
        else cell.textContent = row[i] ?? '–';
      });
    }
  }
  const words = (...names) => names.map((name) => ({ name }));
  const numbers = (...names) => names.map((name) => ({ name, number: true }));

  function fillHead() {
    const source = (text) => text.replace(/^builtin:/, '').replace(/^.*\//, '');
    byId('title').textContent = `${source(scene.mesh)} against ${source(scene.volume)}, by every method`;
    document.title = `voxtact compare: ${source(scene.mesh)} against ${source(scene.volume)}`;
    byId('subtitle').textContent =
      `${grouped(scene.poses)} poses (${scene.poses_from}), ${grouped(scene.triangles)} triangles, ` +
      `${scene.voxels.join(' × ')} voxels of ${scene.voxel_type}, ${scene.width} × ${scene.height} pixels, ` +
      `opaque from ${scene.threshold}`;
    byId('verdict').textContent = data.agrees ? 'The methods agree.' : 'The methods do not agree.';
    if (!data.agrees) document.querySelector('.summary').classList.add('failed');
    byId('command').textContent = data.command;
    for (const note of data.notes) byId('notes').appendChild(element('li', note));
  }

  function fillMachine() {
    const on = data.machine;
    const cards = [
      ['Device', on.device, `${on.device_type}, Vulkan ${on.api}`],
      ['Driver', on.driver, on.driver_version],
      ['CPU', on.cpu, `${on.cpu_threads} threads`],
      ['Filter', 'hardware: query, query-any, atomic, subgroup', on.hardware_filter],
      ['Filter', 'exact: compute, cpu', 'fp32 in a written order, the same bits everywhere'],
      ['Program', `voxtact ${on.voxtact}`, `revision ${on.git_revision}`],
    ];
    for (const [name, value, more] of cards) {
      const card = element('div', undefined, 'card');
      card.append(element('b', name), element('span', value), element('small', more));
      byId('machine').appendChild(card);
    }
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
    const columns = [...words('Sweep', 'Method', 'Mode'),
      ...numbers('Batch', 'Viewport', 'Triangles', 'Fragments a pair', 'Samples', 'Wall ms', 'p10', 'p90', 'min', 'max', 'GPU ms',
        'Pairs/s', 'Fragments/s')];
    fillTable(byId('series'), columns, data.series.map((s) => [
      s.sweep, s.method, s.mode, grouped(s.batch), `${s.width}×${s.height}`, grouped(s.triangles),
      short(s.fragments_a_pair), s.wall_ms.samples.length, short(s.wall_ms.median), short(s.wall_ms.p10),
      short(s.wall_ms.p90), short(s.wall_ms.min), short(s.wall_ms.max), s.gpu_ms ? short(s.gpu_ms.median) : '–',
      short(s.pairs_per_s), short(s.fragments_per_s),
    ]));
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

  // Spread, 10th to 90th percentile, as a whisker on each point.
  const whiskers = {
    id: 'whiskers',
    beforeDatasetsDraw(chart) {
      const { ctx, scales: { y } } = chart;
      ctx.save();
      chart.data.datasets.forEach((set, i) => {
        ctx.strokeStyle = set.borderColor;
        ctx.lineWidth = 1.5;
        chart.getDatasetMeta(i).data.forEach((point, k) => {
          const { low, high } = set.data[k];
          const top = y.getPixelForValue(high);
          const bottom = y.getPixelForValue(low);
          ctx.beginPath();
          for (const at of [top, bottom]) {
            ctx.moveTo(point.x - 4, at);
            ctx.lineTo(point.x + 4, at);
          }
          ctx.moveTo(point.x, top);
          ctx.lineTo(point.x, bottom);
          ctx.stroke();
        });
      });
      ctx.restore();
    },
  };

  // The name of each line at its right end, moved apart where they would cover each other.
  const endLabels = {
    id: 'endLabels',
    afterDatasetsDraw(chart) {
      const { ctx, chartArea } = chart;
      const labels = chart.data.datasets.map((set, i) => {
        const points = chart.getDatasetMeta(i).data;
        const last = points[points.length - 1];
        return { text: set.label, colour: set.borderColor, x: last.x, at: last.y, y: last.y };
      }).sort((a, b) => a.at - b.at);
      const gap = 16;
      for (let i = 1; i < labels.length; ++i) labels[i].y = Math.max(labels[i].y, labels[i - 1].y + gap);
      const over = labels.length ? labels[labels.length - 1].y - (chartArea.bottom - 4) : 0;
      if (over > 0) {
        labels[labels.length - 1].y -= over;
        for (let i = labels.length - 2; i >= 0; --i) labels[i].y = Math.min(labels[i].y, labels[i + 1].y - gap);
      }
      ctx.save();
      ctx.font = '600 13px system-ui, "DejaVu Sans", sans-serif';
      ctx.textBaseline = 'middle';
      for (const label of labels) {
        ctx.strokeStyle = label.colour;
        ctx.lineWidth = 0.8;
        ctx.beginPath();
        ctx.moveTo(label.x + 7, label.at);
        ctx.lineTo(chartArea.right + 20, label.y);
        ctx.stroke();
        ctx.fillStyle = label.colour;
        ctx.fillText(label.text, chartArea.right + 24, label.y);
      }
      ctx.restore();
    },
  };

  // 1, 2, 5 of each power of ten where there is room; else the powers.
  function logTick(value, index, ticks) {
    const first = Number(value.toExponential()[0]);
    const isPower = Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9;
    const decades = Math.log10(ticks[ticks.length - 1].value / ticks[0].value);
    if (isPower || (decades < 2.2 && (first === 2 || first === 5))) return short(value);
    return '';
  }

  function logAxis(title, ticks) {
    const axis = {
      type: 'logarithmic',
      title: { display: true, text: title, font: { size: 13, weight: '600' }, color: '#1d2430' },
      ticks: { color: '#3a4452', font: { size: 12 }, maxRotation: 0, autoSkip: false, callback: logTick },
      grid: { color: (c) => (c.tick && c.tick.label ? '#dde1e7' : 'transparent') },
    };
    if (!ticks) {
      // Room above the highest mark.
      axis.afterDataLimits = (scale) => { scale.max *= 1.3; };
    } else {
      axis.afterBuildTicks = (scale) => { scale.ticks = ticks.map((value) => ({ value })); };
      axis.ticks.callback = (value) => grouped(value);
      axis.min = ticks[0] * 0.85;
      axis.max = ticks[ticks.length - 1] * 1.15;
    }
    return axis;
  }

  function toDataset(method, points) {
    const { colour, mark } = look(method);
    return {
      label: method,
      data: points,
      borderColor: colour,
      backgroundColor: colour,
      pointStyle: mark,
      pointRadius: 5,
      pointBorderWidth: 2,
      borderWidth: 2,
      borderDash: method === 'query-any' ? [5, 4] : [],
      tension: 0,
    };
  }

  function drawChart(parent, { title, text, xTitle, yTitle, xTicks, sets }) {
    const box = element('div', undefined, 'chart');
    box.append(element('h3', title), element('p', text));
    const plot = element('div', undefined, 'plot');
    const canvas = element('canvas');
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', `${title}: ${yTitle} against ${xTitle}`);
    plot.appendChild(canvas);
    box.appendChild(plot);
    parent.appendChild(box);
    return new Chart(canvas, {
      type: 'line',
      data: { datasets: sets },
      plugins: [whiskers, endLabels],
      options: {
        animation: false,
        maintainAspectRatio: false,
        devicePixelRatio: Math.max(2, window.devicePixelRatio || 1),
        layout: { padding: { right: 104, top: 8 } },
        interaction: { mode: 'nearest', intersect: false },
        scales: { x: logAxis(xTitle, xTicks), y: logAxis(yTitle) },
        plugins: {
          legend: { display: false },
          tooltip: { callbacks: {
            title: (items) => `${items[0].dataset.label}, ${xTitle}: ${short(items[0].parsed.x)}`,
            label: (item) => {
              const p = item.raw;
              const gpu = p.gpu ? `, GPU ${short(p.gpu)} ms` : '';
              return `${short(p.y)} ms (p10 ${short(p.low)}, p90 ${short(p.high)}${gpu}), ${short(p.rate)} pairs/s`;
            },
          } },
        },
      },
    });
  }

  // One line a method; `divide` turns the time of a batch into the time that is shown.
  function datasets(series, xOf, divide) {
    const lines = new Map();
    for (const s of series) {
      if (s.method === 'oracle') continue;
      const by = divide(s);
      const point = { x: xOf(s), y: s.wall_ms.median / by, low: s.wall_ms.p10 / by, high: s.wall_ms.p90 / by,
        gpu: s.gpu_ms ? s.gpu_ms.median / by : null, rate: s.pairs_per_s };
      if (!(point.x > 0) || !(point.y > 0)) continue;
      if (!lines.has(s.method)) lines.set(s.method, []);
      lines.get(s.method).push(point);
    }
    return [...lines].map(([method, points]) => toDataset(method, points.sort((a, b) => a.x - b.x)));
  }

  function drawBatches(parent) {
    const all = data.series.filter((s) => s.sweep === 'batch');
    if (all.length === 0) return;
    const ticks = [...new Set(all.map((s) => s.batch))].sort((a, b) => a - b);
    parent.appendChild(element('h2', 'Time against batch size'));
    parent.appendChild(element('p', 'Median wall time; the whiskers are the 10th and 90th percentile of the samples. Lower is better. ' +
      'query-any answers only yes or no.', 'muted'));
    const pair = element('div', undefined, 'pair');
    parent.appendChild(pair);
    const one = all.filter((s) => s.mode === 'sync');
    const many = all.filter((s) => s.mode === 'pipelined');
    const charts = [
      drawChart(pair, { title: 'Each pair waited for', text: 'One submission and one wait a pair: the paper\'s way.',
        xTitle: 'pairs in a batch', yTitle: 'wall time of a batch, ms', xTicks: ticks, sets: datasets(one, (s) => s.batch, () => 1) }),
      drawChart(pair, { title: 'Pipelined', text: 'One submission a batch, three in flight (cpu: one call a batch).',
        xTitle: 'pairs in a batch', yTitle: 'wall time of a batch, ms', xTicks: ticks, sets: datasets(many, (s) => s.batch, () => 1) }),
    ];
    // The same range on both, so that they can be compared.
    const range = { min: Math.min(...charts.map((c) => c.scales.y.min)), max: Math.max(...charts.map((c) => c.scales.y.max)) };
    for (const chart of charts) {
      Object.assign(chart.options.scales.y, range);
      chart.update();
    }
    drawChart(parent, { title: 'Pipelined, for one pair', text: 'The same times divided by the pairs: what a batch saves.',
      xTitle: 'pairs in a batch', yTitle: 'wall time of a pair, ms', xTicks: ticks, sets: datasets(many, (s) => s.batch, (s) => s.batch) });
  }

  function drawSweep(parent, sweep, heading, text, xTitle, xOf) {
    const series = data.series.filter((s) => s.sweep === sweep);
    if (series.length === 0) return;
    parent.appendChild(element('h2', heading));
    drawChart(parent, { title: `${series[0].batch} pairs a submission`, text, xTitle, yTitle: 'wall time of a pair, ms',
      sets: datasets(series, xOf, (s) => s.batch) });
  }

  function drawCharts() {
    const parent = byId('charts');
    Chart.defaults.font.family = 'system-ui, "Segoe UI", "DejaVu Sans", sans-serif';
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
  fillMachine();
  fillAgreement();
  fillTables();
  drawCharts();
})();
