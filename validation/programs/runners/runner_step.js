// Layer 8 of the reference vectors, a whole step, of balls, boxes and clouds on half-spaces and of balls on balls.
// Other pairs of shapes are not supported: their distances are 280 lines more. What the layers before offer is handed in.
"use strict";

const SAME = 1e-9; // candidates nearer than that repeat each other

module.exports = (parts) => {
  const { add, column, coefficients, cross, dot, integrate, jacobian, kinematics, places, product, qpAnswer, range,
    rotation, rows, scale, sub, times, unit, coneTable, wrench, zeros } = parts;
  const transpose = (R) => range(3).map((j) => column(R, j));

  // The points of a body that come nearest to a plane, of outward normal n: of a ball its lowest, of a box its corners.
  const corners = ({ size }) => range(8).map((i) => size.map((s, a) => ((i >> a) & 1 ? s : -s) / 2));
  function nearest({ shape, R, t }, n) {
    if (shape.kind === "sphere") return [sub(t, scale(n, shape.radius))];
    const points = (shape.kind === "cloud" ? shape.points : corners(shape)).map((p) => add(times(R, p), t));
    if (shape.kind === "cloud") return points;
    return [points.reduce((best, p) => (dot(n, p) < dot(n, best) ? p : best))];
  }

  // phi, alpha, beta, n of a half-space and a body; `turned` if the half-space is beta's.
  function onPlane(plane, points, turned) {
    const length = Math.hypot(...plane.shape.normal);
    const m = times(plane.R, scale(plane.shape.normal, 1 / length));
    const offset = plane.shape.offset / length + dot(m, plane.t);
    return points(m).map((p) => {
      const phi = dot(m, p) - offset, foot = sub(p, scale(m, phi));
      return turned ? { phi, alpha: p, beta: foot, n: scale(m, -1) } : { phi, alpha: foot, beta: p, n: m };
    });
  }

  function closest(alpha, beta) {
    const kinds = [alpha.shape.kind, beta.shape.kind];
    const known = ["sphere", "box", "cloud"];
    if (kinds[0] === "halfspace" && known.includes(kinds[1])) return onPlane(alpha, (m) => nearest(beta, m), false);
    if (kinds[1] === "halfspace" && known.includes(kinds[0])) return onPlane(beta, (m) => nearest(alpha, m), true);
    if (kinds[0] !== "sphere" || kinds[1] !== "sphere") throw new Error(`unsupported: ${kinds.join(" and ")}`);
    const apart = sub(beta.t, alpha.t), n = unit(apart);
    const phi = Math.hypot(...apart) - alpha.shape.radius - beta.shape.radius;
    return [{ phi, alpha: add(alpha.t, scale(n, alpha.shape.radius)), beta: sub(beta.t, scale(n, beta.shape.radius)), n }];
  }

  const repeats = (a, b) => [a.phi - b.phi, ...sub(a.alpha, b.alpha), ...sub(a.n, b.n)].every((x) => Math.abs(x) <= SAME);

  function chosen(alpha, beta, k) {
    const clouds = [alpha, beta].some(({ shape }) => shape.kind === "cloud");
    const asCloud = (one) => ({ ...one, shape: { kind: "cloud", points: corners(one.shape) } });
    let all = [];
    if (k > 1 && !clouds && alpha.shape.kind === "box") all = all.concat(closest(asCloud(alpha), beta));
    if (k > 1 && !clouds && beta.shape.kind === "box") all = all.concat(closest(alpha, asCloud(beta)));
    all = all.concat(closest(alpha, beta)).map((one, index) => ({ ...one, index }));
    const late = all.map((one, i) => k > 1 && !clouds && all.slice(0, i).some((other) => repeats(one, other)));
    const last = all.length - 1;
    const level = all.filter((one, i) => i < last && !late[i] && one.phi <= all[last].phi + SAME).length;
    if (k > 1 && !clouds && level >= k) late[last] = true;
    const order = range(all.length).sort((i, j) => late[i] - late[j] || all[i].phi - all[j].phi || i - j);
    return order.slice(0, k).sort((i, j) => i - j).map((i) => all[i]);
  }

  // d1 is the world axis with the least |n_i|, less its part along n.
  function tangents(n) {
    const i = range(3).reduce((best, k) => (Math.abs(n[k]) < Math.abs(n[best]) ? k : best), 0);
    const d1 = unit(range(3).map((k) => (k === i ? 1 : 0) - n[i] * n[k]));
    return { d1, d2: cross(n, d1) };
  }

  function contactsOf(input, at) {
    return input.pairs.flatMap((pair) => {
      const [alpha, beta] = [pair.alpha, pair.beta].map((name) => {
        const { body, pose, shape } = input.shapes[name];
        const { R, t } = at[body];
        return { body, shape, R: product(R, rotation(pose.quaternion)), t: add(times(R, pose.xyz), t) };
      });
      const { mu_v, mu_omega } = pair;
      return chosen(alpha, beta, pair.k).map((one) => ({
        pair: pair.name, ...one, ...tangents(one.n), mu_v, mu_omega, rows: pair.rows,
        alpha_body: alpha.body, beta_body: beta.body,
      }));
    });
  }

  // Velocity of a point of a body, and the angular velocity, by delta_q: 3 x n_v each.
  function motion({ t, J }, point) {
    const arm = sub(point, t), nV = J[0].length;
    const columns = range(nV).map((k) => {
      const both = column(J, k), w = both.slice(3);
      return [add(both.slice(0, 3), cross(w, arm)), w];
    });
    return [columns.map((c) => c[0]), columns.map((c) => c[1])];
  }

  // M, and tau of gravity (un-actuated only) and of the wrenches.
  function masses(input, at, nA, nV) {
    const M = zeros(nV, nV), centre = {};
    const tau = new Array(nV).fill(0);
    for (const body of input.mechanism.bodies) {
      const { R, t } = at[body.name];
      centre[body.name] = add(times(R, body.com || [0, 0, 0]), t);
      if (!body.mass) continue;
      const [v, w] = motion(at[body.name], centre[body.name]);
      const inertia = product(product(R, body.inertia), transpose(R));
      for (const i of range(nV)) {
        for (const j of range(nV)) M[i][j] += body.mass * dot(v[i], v[j]) + dot(w[i], times(inertia, w[j]));
        if (i >= nA) tau[i] += body.mass * dot(v[i], input.gravity);
      }
    }
    for (const given of input.wrenches || []) {
      const [v, w] = motion(at[given.body], centre[given.body]);
      for (const i of range(nV)) tau[i] += dot(v[i], given.force) + dot(w[i], given.torque);
    }
    return [M, tau];
  }

  // Rows of 3 x 3 equations, by Cramer's rule.
  const determinant = ([a, b, c]) => dot(a, cross(b, c));
  const solved = (V, x) => range(3).map((j) =>
    determinant(V.map((row, i) => row.map((v, k) => (k === j ? x[i] : v)))) / determinant(V));

  // The d with q (+) d = target, of one joint.
  function difference(body, target, q) {
    if (body.joint === "floating") {
      const [p, o] = [unit(target.slice(3)), unit(q.slice(3))];
      const pv = p.slice(0, 3), ov = scale(o.slice(0, 3), -1);
      const vector = add(add(scale(pv, o[3]), scale(ov, p[3])), cross(ov, pv));
      const real = o[3] * p[3] - dot(ov, pv), sign = real < 0 ? -1 : 1, s = Math.hypot(...vector);
      const w = scale(vector, sign * (s > 0 ? (2 * Math.atan2(s, Math.abs(real))) / s : 2));
      const [, b, c] = coefficients(Math.hypot(...w));
      const V = transpose(range(3).map((k) => {
        const e = range(3).map((i) => (i === k ? 1 : 0));
        return add(add(e, scale(cross(w, e), b)), scale(cross(w, cross(w, e)), c));
      }));
      return [...solved(V, times(transpose(rotation(o)), sub(target.slice(0, 3), q.slice(0, 3)))), ...w];
    }
    if (body.joint === "planar" || body.joint === "continuous") {
      const [c, s] = unit(q.slice(-2)), [c1, s1] = target.slice(-2);
      const w = Math.atan2(c * s1 - s * c1, c * c1 + s * s1);
      if (body.joint === "continuous") return [w];
      const [a, b0] = coefficients(Math.abs(w)), b = b0 * w;
      const [x, y] = sub(target.slice(0, 2), q.slice(0, 2)), X = c * x + s * y, Y = c * y - s * x;
      return [(a * X + b * Y) / (a * a + b * b), (a * Y - b * X) / (a * a + b * b), w];
    }
    return sub(target, q);
  }

  return function step(input) {
    const { mechanism, q, h } = input, at = kinematics(mechanism, q);
    const [place, nV] = places(mechanism), nA = input.K_q.length;
    const contacts = contactsOf(input, at);
    const { J } = jacobian({ mechanism, q, contacts });
    contacts.forEach((contact, j) => { contact.J = J[j]; });
    const [M, tau] = masses(input, at, nA, nV);
    const away = new Array(nA).fill(0);
    for (const body of mechanism.bodies.filter((one) => one.actuated && !one.mimic && one.joint !== "fixed")) {
      const at = place[body.name];
      const d = difference(body, input.q_bar_a.slice(...at.q), q.slice(...at.q));
      away.splice(at.v[0], d.length, ...d);
    }
    const H = range(nV).map((i) => range(nV).map((j) => {
      if (i < nA && j < nA) return h * input.K_q[i][j];
      return i >= nA && j >= nA ? M[i][j] / h : 0;
    }));
    const g = tau.map((x, i) => h * (i < nA ? x + dot(input.K_q[i], away) : x));
    const { A, b } = rows({ cone: input.cone, contacts });
    const shown = contacts.map(({ pair, index, phi, alpha, beta, n, d1, d2, J: block }) =>
      ({ pair, index, phi, alpha, beta, n, d1, d2, J: block }));
    const found = qpAnswer(H, g, A, b);
    if (found.farkas) return { contacts: shown, H, g, A, b, farkas: found.farkas };
    const { delta_q, lam, A_lam } = found;
    let first = 0;
    for (const contact of contacts) {
      const count = coneTable(input.cone, contact.rows).length;
      contact.lam = lam.slice(first, first += count);
    }
    const loads = wrench({ h, cone: input.cone, contacts, bodies: {} }).wrench;
    const after = integrate({ mechanism, q, delta_q }).q;
    return { contacts: shown, H, g, A, b, delta_q, lam, A_lam, wrench: loads, q_next: after };
  };
};
