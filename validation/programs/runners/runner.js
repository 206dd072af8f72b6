// Layers 2 to 7 of the reference vectors in plain JavaScript, from their README alone.
// Usage: node runner.js VECTORS ANSWERS [LAYER ...]; without arguments it answers a challenge, line by line.
// Quadratic programs are in runner_qp.js, whole steps (of simple shapes, in challenges alone) in runner_step.js.
"use strict";
const fs = require("fs");
const path = require("path");
const { add, conicAnswer, dot, qpAnswer, range, scale, sub, times } = require("./runner_qp.js");

const ENTRIES = {
  fixed: [0, 0], revolute: [1, 1], prismatic: [1, 1], continuous: [2, 1], floating: [7, 6], planar: [4, 3],
};

const zeros = (m, n) => range(m).map(() => new Array(n).fill(0));
const unit = (a) => scale(a, 1 / Math.hypot(...a));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const product = (A, B) => A.map((row) => B[0].map((_, j) => row.reduce((sum, x, k) => sum + x * B[k][j], 0)));
const column = (R, j) => R.map((row) => row[j]);

// Rotation of q/|q|, q = [x, y, z, w].
function rotation(quaternion) {
  const [x, y, z, w] = unit(quaternion);
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
  ];
}

// Rotation about an axis by the angle of cosine c and sine s.
function turn(axis, c, s) {
  const a = unit(axis);
  const K = [[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]];
  return range(3).map((i) => range(3).map((j) => (i === j ? c : 0) + s * K[i][j] + (1 - c) * a[i] * a[j]));
}

function jointPose(body, q) {
  const still = [0, 0, 0];
  switch (body.joint) {
    case "floating": return [rotation(q.slice(3)), q.slice(0, 3)];
    case "planar": return [turn([0, 0, 1], ...unit(q.slice(2))), [q[0], q[1], 0]];
    case "revolute": return [turn(body.axis, Math.cos(q[0]), Math.sin(q[0])), still];
    case "continuous": return [turn(body.axis, ...unit(q)), still];
    case "prismatic": return [turn([1, 0, 0], 1, 0), scale(unit(body.axis), q[0])];
    default: return [turn([1, 0, 0], 1, 0), still];
  }
}

// First and last entry of q and of delta_q of each body: actuated first, each in file order.
function places(mechanism) {
  const found = {};
  let i = 0, k = 0;
  for (const actuated of [true, false]) {
    for (const body of mechanism.bodies.filter((b) => Boolean(b.actuated) === actuated && !b.mimic)) {
      const [sizeQ, sizeV] = ENTRIES[body.joint];
      found[body.name] = { q: [i, i + sizeQ], v: [k, k + sizeV] };
      i += sizeQ;
      k += sizeV;
    }
  }
  return [found, k];
}

// Of each body R, t and J (6 x n_v): velocity of its origin, and angular velocity.
function kinematics(mechanism, q) {
  const [at, nV] = places(mechanism);
  const found = { null: { R: turn([1, 0, 0], 1, 0), t: [0, 0, 0], J: zeros(6, nV) } };
  for (const body of mechanism.bodies) {
    const parent = found[body.parent];
    const Rp = product(parent.R, rotation(body.placement.quaternion));
    const tp = add(times(parent.R, body.placement.xyz), parent.t);
    const mimic = body.mimic || { of: body.name, multiplier: 1, offset: 0 };
    const entries = at[mimic.of], pace = mimic.multiplier;
    const position = q.slice(...entries.q).map((x) => (body.mimic ? pace * x + mimic.offset : x));
    const [Rq, tq] = jointPose(body, position);
    const R = product(Rp, Rq), t = add(times(Rp, tq), tp);
    const J = zeros(6, nV);
    const put = (k, v, w) => [...v, ...w].forEach((x, i) => { J[i][k] = x; });
    for (const k of range(nV)) {
      const [v, w] = [column(parent.J, k).slice(0, 3), column(parent.J, k).slice(3)];
      put(k, add(v, cross(w, sub(t, parent.t))), w);
    }
    const k = entries.v[0], still = [0, 0, 0];
    // A mimic moves along the column of the joint that it follows.
    const move = (v, w) => put(k, add(column(J, k).slice(0, 3), scale(v, pace)), add(column(J, k).slice(3), scale(w, pace)));
    if (body.joint === "floating") {
      for (const i of range(3)) {
        put(k + i, column(R, i), still);
        put(k + 3 + i, still, column(R, i));
      }
    } else if (body.joint === "planar") {
      put(k, column(R, 0), still);
      put(k + 1, column(R, 1), still);
      put(k + 2, still, column(R, 2));
    } else if (body.joint === "prismatic") {
      move(times(Rp, unit(body.axis)), still);
    } else if (body.joint !== "fixed") {
      move(still, times(Rp, unit(body.axis)));
    }
    found[body.name] = { R, t, J };
  }
  return found;
}

function jacobian(input) {
  const at = kinematics(input.mechanism, input.q);
  const [, nV] = places(input.mechanism);
  const J = input.contacts.map((contact) => {
    const block = zeros(4, nV);
    for (const [side, sign] of [["beta", 1], ["alpha", -1]]) {
      const body = at[contact[`${side}_body`]];
      const arm = sub(contact[side], body.t);
      for (const k of range(nV)) {
        const motion = column(body.J, k);
        const w = motion.slice(3);
        const v = add(motion.slice(0, 3), cross(w, arm));
        [...v, dot(contact.n, w)].forEach((x, i) => { block[i][k] += sign * x; });
      }
    }
    return block;
  });
  return { J };
}

function selection(input) {
  // Of two solids only candidates about the closest pair's normal, which is the last; others fill the number.
  const bears = (n) => n === undefined ? () => true : (i) => dot(n[i], n[n.length - 1]) >= Math.cos(0.25);
  const chosen = (phi, g) => {
    const left = range(phi.length).filter(bears(input.normals && input.normals[g]));
    const filling = range(phi.length - left.length).map((i) => phi.length + i);
    return left.sort((i, j) => phi[i] - phi[j] || i - j).concat(filling).slice(0, input.k);
  };
  return { indices: input.phi.map(chosen) };
}

// t of each row of a contact, in units of (mu_v, mu_v, mu_omega).
function coneTable(cone, rows) {
  const sides = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]];
  const spins = rows === 6 ? [[0, 0, 1], [0, 0, -1]] : [];
  if (cone === "frictionless") return [[0, 0, 0]];
  if (cone === "product") {
    return rows === 6 ? [1, -1].flatMap((s) => sides.map(([a, b]) => [a, b, s])) : sides;
  }
  if (cone === "pyramid") return [...sides, ...spins];
  const K = Number(cone.split("-")[1]);
  const angles = range(K).map((k) => (2 * Math.PI * k) / K);
  return [...angles.map((a) => [Math.cos(a), Math.sin(a), 0]), ...spins];
}

function rows(input) {
  const A = [], b = [];
  for (const c of input.contacts) {
    const along = (d) => c.J[0].map((_, k) => d[0] * c.J[0][k] + d[1] * c.J[1][k] + d[2] * c.J[2][k]);
    for (const [t1, t2, t3] of coneTable(input.cone, c.rows)) {
      const d = add(c.n, scale(add(scale(c.d1, t1), scale(c.d2, t2)), c.mu_v));
      A.push(add(along(d), scale(c.J[3], t3 * c.mu_omega)));
      b.push(-c.phi);
    }
  }
  return { A, b };
}

function qp(input) {
  if (input.second_order) return conicAnswer(input.H, input.g, input.second_order);
  return qpAnswer(input.H, input.g, input.A, input.b);
}

function wrench(input) {
  const net = Object.fromEntries(Object.keys(input.bodies).map((name) => [name, [0, 0, 0, 0, 0, 0]]));
  const found = input.contacts.map((c) => {
    let [fn, f1, f2, tau] = c.lam;
    if (input.cone !== "ellipsoid") {
      const T = coneTable(input.cone, c.rows);
      fn = c.lam.reduce((sum, x) => sum + x, 0);
      [f1, f2, tau] = [c.mu_v, c.mu_v, c.mu_omega].map((mu, i) => mu * dot(c.lam, column(T, i)));
    }
    [fn, f1, f2, tau] = [fn, f1, f2, tau].map((x) => x / input.h);
    const force = add(add(scale(c.d1, f1), scale(c.d2, f2)), scale(c.n, fn));
    for (const [side, sign] of [["beta", 1], ["alpha", -1]]) {
      const name = c[`${side}_body`];
      if (!(name in net)) continue;
      const arm = sub(c[side], input.bodies[name].point);
      const torque = add(cross(arm, force), scale(c.n, tau));
      net[name] = add(net[name], scale([...force, ...torque], sign));
    }
    return [f1, f2, fn, tau];
  });
  return { wrench: found, net };
}

// sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3, by series where they would cancel.
function coefficients(t) {
  if (t > 0.3) return [Math.sin(t) / t, (1 - Math.cos(t)) / t ** 2, (t - Math.sin(t)) / t ** 3];
  return [1, 1 / 2, 1 / 6].map((first, i) => {
    let term = first, sum = first;
    for (let k = i + 2; k < i + 18; k += 2) sum += term *= (-t * t) / (k * (k + 1));
    return sum;
  });
}

function moved(body, q, d) {
  if (body.joint === "floating") {
    const v = d.slice(0, 3), w = d.slice(3), p = unit(q.slice(3));
    const t = Math.hypot(...w);
    const [, b, c] = coefficients(t);
    const shift = add(add(v, scale(cross(w, v), b)), scale(cross(w, cross(w, v)), c));
    const h = scale(w, coefficients(t / 2)[0] / 2), hw = Math.cos(t / 2), pv = p.slice(0, 3);
    const vector = add(add(scale(h, p[3]), scale(pv, hw)), cross(pv, h));
    return [...add(q.slice(0, 3), times(rotation(p), shift)), ...unit([...vector, p[3] * hw - dot(pv, h)])];
  }
  if (body.joint === "planar" || body.joint === "continuous") {
    const [c, s] = unit(q.slice(-2)), w = d[d.length - 1];
    const turned = unit([c * Math.cos(w) - s * Math.sin(w), s * Math.cos(w) + c * Math.sin(w)]);
    if (body.joint === "continuous") return turned;
    const [a, b] = coefficients(Math.abs(w));
    const x = a * d[0] - b * w * d[1], y = a * d[1] + b * w * d[0];
    return [q[0] + c * x - s * y, q[1] + s * x + c * y, ...turned];
  }
  return add(q, d);
}

function integrate(input) {
  const [at] = places(input.mechanism);
  const q = [...input.q];
  for (const body of input.mechanism.bodies.filter((b) => !b.mimic)) {
    const place = at[body.name];
    const next = moved(body, input.q.slice(...place.q), input.delta_q.slice(...place.v));
    q.splice(place.q[0], next.length, ...next);
  }
  return { q };
}

const step = require("./runner_step.js")({ add, column, coefficients, cross, dot, integrate, jacobian, kinematics,
  places, product, qpAnswer, range, rotation, rows, scale, sub, times, unit, coneTable, wrench, zeros });

const LAYERS = { selection, jacobian, rows, qp, wrench, integrate, step };
const IMPLEMENTATION = "runner.js";

// Answer one case of a challenge, a line in and a line out.
function answered(text) {
  const { id, layer, input } = JSON.parse(text);
  if (!(layer in LAYERS)) return { id, unsupported: true };
  try {
    return { id, output: LAYERS[layer](input) };
  } catch (error) {
    return error.message.startsWith("unsupported") ? { id, unsupported: true } : { id, error: error.message };
  }
}

function challenged() {
  const say = (record) => process.stdout.write(`${JSON.stringify(record)}\n`);
  say({ protocol: 1, implementation: IMPLEMENTATION, layers: Object.keys(LAYERS) });
  const lines = require("readline").createInterface({ input: process.stdin });
  lines.on("line", (text) => say(answered(text)));
}

function files(vectors, out, ...asked) {
  fs.mkdirSync(out, { recursive: true });
  for (const layer of asked.length ? asked : Object.keys(LAYERS).slice(0, -1)) {
    const { cases } = JSON.parse(fs.readFileSync(path.join(vectors, "inputs", `${layer}.json`), "utf8"));
    const answers = cases.map(({ id, input }) => ({ id, output: LAYERS[layer](input) }));
    const head = { format: "quasistatic-ref/vectors-answers", version: 1, layer, implementation: IMPLEMENTATION };
    fs.writeFileSync(path.join(out, `${layer}.json`), `${JSON.stringify({ ...head, answers })}\n`);
  }
}

if (process.argv.length > 2) files(...process.argv.slice(2));
else challenged();
