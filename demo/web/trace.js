// Samples of one person's joints, ground reaction and muscles, frame by frame, for plots and the CSV file.
import { constants as c } from 'mobil';

export const groups = ['hamstrings', 'quadriceps', 'triceps surae', 'tibialis anterior'];
const degrees = 180 / Math.PI, keep_s = 60;
const joints = [[3, 'hip_flexion_right_deg'], [4, 'hip_flexion_left_deg'], [5, 'knee_flexion_right_deg'], [6, 'knee_flexion_left_deg'], [7, 'ankle_dorsiflexion_right_deg'], [8, 'ankle_dorsiflexion_left_deg']];
export const columns = ['time_s', ...joints.map(([, name]) => name), 'ground_force_right_n', 'ground_force_left_n',
  ...['elongation_right_mm', 'activation_right'].flatMap((what) => groups.map((g) => `${g.replace(' ', '_')}_${what}`))];

const orNaN = (read) => {
  try { return read(); } catch { return NaN; }
};

export class Trace {
  rows = [];
  clear() { this.rows = []; }
  sample(world, person) {
    const angles = world.read(c.MOBIL_JOINTS, person), row = [world.time_s, ...joints.map(([i]) => degrees * angles[i])];
    const force = orNaN(() => world.read(c.MOBIL_GROUND, person).slice(0, 6));
    row.push(force[1], force[4]);
    for (let g = 0; g < 4; ++g) {
      row.push(orNaN(() => {
        const [length, rest] = world.readMuscle(c.MOBIL_LINE, person, g);
        return 1000 * (length - rest);
      }));
    }
    for (let g = 0; g < 4; ++g) row.push(orNaN(() => world.readMuscle(c.MOBIL_ACTIVATION, person, g)[1]));
    this.rows.push(row.map((v) => v ?? NaN));
    while (this.rows[0][0] < row[0] - keep_s) this.rows.shift();
  }
  column(name) { return columns.indexOf(name); }
  last(name) { return this.rows.at(-1)?.[this.column(name)] ?? NaN; }
  csv() {
    const line = (row) => row.map((v) => (Number.isNaN(v) ? '' : +v.toPrecision(7))).join(',');
    return `${columns.join(',')}\n${this.rows.map(line).join('\n')}\n`;
  }
}
