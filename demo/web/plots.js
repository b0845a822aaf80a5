// Plots of the last seconds, and of error over cost of every way to deform a muscle.
import { columns, groups } from './trace.js';

const span_s = 2.4, tint = ['#2f7ed8', '#e0812b', '#7a5cc4', '#3f9b57'];

function begin(id) {
  const canvas = document.getElementById(id), scale = Math.min(devicePixelRatio, 2);
  const [w, h] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== w * scale) Object.assign(canvas, { width: w * scale, height: h * scale });
  const x = canvas.getContext('2d'), style = getComputedStyle(document.documentElement);
  x.setTransform(scale, 0, 0, scale, 0, 0);
  x.clearRect(0, 0, w, h);
  x.font = '11px system-ui';
  x.lineJoin = 'round';
  const colour = (name) => style.getPropertyValue(name);
  return { canvas, x, w, h, ink: colour('--ink'), faint: colour('--faint'), line: colour('--line') };
}
function frame({ x, w, h, ink, line }, title, names) {
  x.fillStyle = ink;
  x.fillText(title, 2, 11);
  let at = w - 4;
  [...names.entries()].reverse().forEach(([i, name]) => {
    x.fillStyle = tint[i];
    at -= x.measureText(name).width + 8;
    x.fillText(name, at, 11);
  });
  x.strokeStyle = line;
  x.lineWidth = 1;
  x.strokeRect(32.5, 18.5, w - 36, h - 36);
}

function overTime(id, trace, title, names, series, low, high, said) {
  const to = begin(id), { x, w, h, faint, line } = to, t1 = trace.rows.at(-1)?.[0] ?? 0;
  frame(to, title, names);
  const Y = (v) => h - 18 - ((h - 36) * (v - low)) / (high - low), X = (t) => w - 4 + ((t - t1) / span_s) * (w - 36);
  x.fillStyle = faint;
  for (const v of [low, high]) x.fillText(String(v), 2, Y(v) + (v === high ? 8 : 0));
  x.fillText(`${span_s} s ago`, 32, h - 5);
  x.fillText('now', w - 24, h - 5);
  if (low < 0) {
    x.strokeStyle = line;
    x.beginPath();
    x.moveTo(32, Y(0));
    x.lineTo(w - 4, Y(0));
    x.stroke();
  }
  const shown = trace.rows.filter((row) => row[0] > t1 - span_s);
  x.save();
  x.beginPath();
  x.rect(32, 18, w - 36, h - 36);
  x.clip();
  x.lineWidth = 1.8;
  series.forEach(({ of, scale = 1, dashed = false, colour }) => {
    const k = columns.indexOf(of);
    x.strokeStyle = tint[colour];
    x.setLineDash(dashed ? [4, 3] : []);
    x.beginPath();
    let pen = false;
    for (const row of shown) {
      const v = row[k] * scale;
      if (Number.isNaN(v)) pen = false;
      else { x[pen ? 'lineTo' : 'moveTo'](X(row[0]), Y(v)); pen = true; }
    }
    x.stroke();
  });
  x.restore();
  to.canvas.setAttribute('aria-label', said);
}

const now = (trace, name) => trace.last(name).toFixed(0);

export function drawTrace(trace, weight_n) {
  overTime('angles', trace, 'Right leg, °', ['hip', 'knee', 'ankle'], ['hip_flexion', 'knee_flexion', 'ankle_dorsiflexion'].map((n, i) => ({ of: `${n}_right_deg`, colour: i })), -40, 80,
    `Angles of the right leg now: hip ${now(trace, 'hip_flexion_right_deg')}, knee ${now(trace, 'knee_flexion_right_deg')}, ankle ${now(trace, 'ankle_dorsiflexion_right_deg')} degrees`);
  overTime('loads', trace, 'On the ground, of weight', ['right', 'left'], ['right', 'left'].map((n, i) => ({ of: `ground_force_${n}_n`, scale: 1 / weight_n, colour: i })), 0, 1.5,
    `Vertical force now: right ${now(trace, 'ground_force_right_n')}, left ${now(trace, 'ground_force_left_n')} newtons`);
  overTime('bellies', trace, 'Bellies, mm', ['hamstr.', 'quadr.', 'triceps', 'tibialis'], groups.map((g, i) => ({ of: `${g.replace(' ', '_')}_elongation_right_mm`, colour: i })), -60, 60,
    `Right bellies now: ${groups.map((g) => `${g} ${now(trace, `${g.replace(' ', '_')}_elongation_right_mm`)}`).join(', ')} millimetres longer than at rest`);
}

/** `curves`: methods of each group, [{name, error_m, cost_us}]; `chosen`: name of each group's method now, or ''. */
export function drawWays(curves, chosen) {
  const to = begin('ways'), { x, w, h, faint } = to;
  frame(to, 'Error, mm, over cost, µs', []);
  const [c0, c1, e0, e1] = [0.05, 10, 0.03, 60];
  const X = (c) => 33 + ((w - 37) * Math.log(Math.max(c, c0) / c0)) / Math.log(c1 / c0);
  const Y = (e) => h - 18 - ((h - 36) * Math.log(Math.min(Math.max(e, e0), e1) / e0)) / Math.log(e1 / e0);
  x.fillStyle = faint;
  for (const e of [0.1, 1, 10]) x.fillText(String(e), 6, Y(e) + 4);
  for (const c of [0.1, 1]) x.fillText(String(c), X(c), h - 5);
  curves.forEach((ways, i) => {
    x.strokeStyle = x.fillStyle = tint[i];
    x.lineWidth = 1.2;
    x.beginPath();
    let least = Infinity;  // the line connects the Pareto frontier
    for (const way of [...ways].sort((a, b) => a.cost_us - b.cost_us)) {
      if (way.error_m >= least) continue;
      least = way.error_m;
      x.lineTo(X(way.cost_us), Y(1000 * way.error_m));
    }
    x.stroke();
    for (const way of ways) {
      x.beginPath();
      x.arc(X(way.cost_us), Y(1000 * way.error_m), way.name === chosen[i] ? 5 : 1.6, 0, 7);
      x.fill();
    }
  });
  to.canvas.setAttribute('aria-label', `Predicted error and cost of the methods in use: ${curves.map((ways, i) => {
    const way = ways.find((of) => of.name === chosen[i]);
    return way ? `${groups[i]} ${way.name}, ${(1000 * way.error_m).toFixed(2)} mm for ${way.cost_us.toFixed(1)} microseconds` : `${groups[i]} not measured`;
  }).join('; ')}`);
}
