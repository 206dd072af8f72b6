#!/usr/bin/env bash
# p2-es==1.2.3 (npm): a body of fixed mass made of N equal discs on a circle of 1 m, and an L of three unit squares, which
# fromPolygon divides into convex parts.
# Expected: the mass is shared, so the inertia of the discs is m (R^2 + r^2 / 2) for any N, and that of the L of 3 kg 11 / 6.
# What comes: N times as much, as if each shape had the whole mass; twice as much for the L.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund p2-es@1.2.3

cat > inertia.mjs << 'JAVASCRIPT'
import assert from 'node:assert';
import { Body, Circle } from 'p2-es';

const RADIUS = 0.1;
for (const mass of [1, 5]) {
  const due = mass * (1 + RADIUS ** 2 / 2);
  for (const n of [1, 2, 3, 4, 8]) {
    const body = new Body({ mass });
    for (let i = 0; i < n; i += 1) {
      const angle = (2 * Math.PI * i) / n;
      body.addShape(new Circle({ radius: RADIUS }), [Math.cos(angle), Math.sin(angle)]);
    }
    console.log(`${mass} kg in ${n} discs: inertia ${body.inertia.toFixed(3)} kg m^2, true ${due.toFixed(3)}`);
    assert.ok(Math.abs(body.inertia / (n * due) - 1) < 1e-6);
  }
}
const angled = new Body({ mass: 3 });
angled.fromPolygon([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]);
console.log(`L of ${angled.shapes.length} shapes: inertia ${angled.inertia.toFixed(4)} kg m^2, true ${(11 / 6).toFixed(4)}`);
assert.equal(angled.shapes.length, 2);
assert.ok(Math.abs(angled.inertia - 11 / 3) < 1e-5);
JAVASCRIPT
node inertia.mjs
