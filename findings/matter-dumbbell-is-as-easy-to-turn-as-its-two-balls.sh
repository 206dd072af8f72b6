#!/usr/bin/env bash
# matter-js==0.20.0 (npm): a body of two parts, discs of radius 10, at distances of 10 to 500 from their common centre.
# Expected: an inertia that grows with the square of the distance, by Steiner's theorem, in units of what a lone disc gets.
# What comes: at any distance the sum of the two discs' own; at 500 it is less than a thousandth of what is due.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund matter-js@0.20.0

cat > dumbbell.mjs << 'JAVASCRIPT'
import assert from 'node:assert';
import Matter from 'matter-js';

const { Bodies, Body, Composite, Engine } = Matter;
const RADIUS = 10;
const disc = (x) => Bodies.circle(x, 0, RADIUS, {}, 400);
const scale = disc(0).inertia / (disc(0).mass * (RADIUS ** 2 / 2));
for (const distance of [10, 50, 500]) {
  const body = Body.create({ parts: [disc(-distance), disc(distance)], frictionAir: 0 });
  const due = scale * body.mass * (RADIUS ** 2 / 2 + distance ** 2);
  const engine = Engine.create({ gravity: { x: 0, y: 0 } });
  Composite.add(engine.world, body);
  body.torque = 0.001;
  Engine.update(engine, 1000 / 60);
  const rate = body.angularVelocity / ((0.001 * (1000 / 60) ** 2) / due);
  console.log(`discs at ${distance}: inertia ${body.inertia.toFixed(1)}, due ${due.toFixed(1)}; spins ${rate.toFixed(1)} times too fast`);
  assert.ok(Math.abs(body.mass / (2 * disc(0).mass) - 1) < 1e-6);
  assert.ok(Math.abs(body.inertia / (2 * disc(0).inertia) - 1) < 1e-6);
  assert.ok(rate > 2.9);
}
JAVASCRIPT
node dumbbell.mjs
