#!/usr/bin/env bash
# three==0.187.0 (npm): Capsule.intersectsBox for a cube of 1 m and rods of radius 0.1 m aslant before one of its edges, and
# for 20000 capsules at random.
# Expected: true where the distance of the axis from the cube is at most the radius, as Box3.intersectsSphere tells of balls
# along the axis. What comes: true for rods as far as half a metre from the edge, and for more than a quarter of the
# random ones that are apart, by up to 0.9 m, as it looks at intervals along x, y and z alone. No capsule that touches is missed.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund three@0.187.0

cat > rods.mjs << 'JAVASCRIPT'
import assert from 'node:assert';
import { Box3, Sphere, Vector3 } from 'three';
import { Capsule } from 'three/examples/jsm/math/Capsule.js';

const PARTS = 1000;
const cube = new Box3(new Vector3(-0.5, -0.5, -0.5), new Vector3(0.5, 0.5, 0.5));
const point = new Vector3();
const gap = (start, end, radius) => {
  let least = Infinity;
  for (let i = 0; i <= PARTS; i += 1) least = Math.min(least, cube.distanceToPoint(point.lerpVectors(start, end, i / PARTS)));
  return least - radius;
};

for (const reach of [1.1, 1.3, 1.5, 1.8]) {
  const [start, end] = [new Vector3(reach, 0, 0), new Vector3(0, reach, 0)];
  const apart = gap(start, end, 0.1);
  const balls = Array.from({ length: PARTS + 1 }, (_, i) => new Sphere(new Vector3().lerpVectors(start, end, i / PARTS), 0.1));
  const touches = balls.some((ball) => cube.intersectsSphere(ball));
  const says = new Capsule(start, end, 0.1).intersectsBox(cube);
  console.log(`rod from (${reach}, 0, 0) to (0, ${reach}, 0): ${apart.toFixed(3)} m apart; capsule ${says}, balls ${touches}`);
  assert.ok(Math.abs(apart - ((reach - 1) / Math.SQRT2 - 0.1)) < 1e-3);
  assert.ok(says && touches === apart < 0);
}

let seed = 1;
const random = () => {
  seed = (seed * 16807) % 2147483647;
  return seed / 2147483647;
};
const place = () => new Vector3(4 * random() - 2, 4 * random() - 2, 4 * random() - 2);
const count = { apart: 0, wrong: 0, farthest: 0 };
for (let i = 0; i < 20000; i += 1) {
  const [start, end, radius] = [place(), place(), 0.1 + 0.5 * random()];
  const apart = gap(start, end, radius);
  const says = new Capsule(start, end, radius).intersectsBox(cube);
  assert.ok(says || apart > -1e-3);
  if (apart > 1e-3) {
    count.apart += 1;
    if (says) {
      count.wrong += 1;
      count.farthest = Math.max(count.farthest, apart);
    }
  }
}
console.log(`${count.wrong} of ${count.apart} capsules that are apart meet the cube, up to ${count.farthest.toFixed(2)} m away`);
assert.ok(count.wrong > count.apart / 4 && count.farthest > 0.8);
JAVASCRIPT
node rods.mjs
