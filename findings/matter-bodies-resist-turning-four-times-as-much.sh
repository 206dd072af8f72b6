#!/usr/bin/env bash
# matter-js 0.20.0 (npm): rectangles and a near-disc; the inertia each has, and the spin after a force off its centre.
# Expected: m (w^2 + h^2) / 12 and m r^2 / 2; the rate is arm m / I times the speed. What comes: four times that inertia and
# a quarter of that rate, so that what is pushed off its centre moves aside rather than turns; the speed is right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund matter-js@0.20.0

cat > spin.mjs << 'JAVASCRIPT'
import assert from 'node:assert';
import Matter from 'matter-js';

const { Bodies, Body, Composite, Engine } = Matter;
const ARM = 10;
const cases = {
  'rectangle 30 x 40': [() => Bodies.rectangle(0, 0, 30, 40, { frictionAir: 0 }), (900 + 1600) / 12],
  'rectangle 200 x 10': [() => Bodies.rectangle(0, 0, 200, 10, { frictionAir: 0 }), (40000 + 100) / 12],
  'disc of radius 20': [() => Bodies.circle(0, 0, 20, { frictionAir: 0 }, 400), 200],
};
for (const [name, [make, per_mass]] of Object.entries(cases)) {
  const body = make();
  const engine = Engine.create({ gravity: { x: 0, y: 0 } });
  Composite.add(engine.world, body);
  Body.applyForce(body, { x: 0, y: -ARM }, { x: 0.001, y: 0 });
  Engine.update(engine, 1000 / 60);
  const inertia = body.inertia / (body.mass * per_mass);
  const rate = body.angularVelocity / body.velocity.x / (ARM / per_mass);
  console.log(`${name}: inertia ${inertia.toFixed(3)} of the true one; rate of spin ${rate.toFixed(3)} of the true one`);
  assert.ok(Math.abs(inertia - 4) < 0.1);
  assert.ok(Math.abs(rate - 0.25) < 0.01);
}
JAVASCRIPT
node spin.mjs
