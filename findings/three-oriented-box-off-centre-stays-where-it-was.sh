#!/usr/bin/env bash
# three==0.187.0 (npm): an oriented box (OBB) of a part whose middle is 3 m from its own origin, and the Box3 and the Sphere around
# the same part, are brought along by applyMatrix4 ("to keep both entities in sync") while the part moves, turns or grows.
# Expected: the same middle from all three. What comes: the middle of the oriented box moves by the matrix's translation alone,
# neither turned nor scaled (its axes and size are), so that after a quarter turn it is 4.2 m from the part, and meets an
# obstacle that the part has left.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund three@0.187.0

cat > turn.mjs << 'JAVASCRIPT'
import assert from 'node:assert';
import { Box3, Matrix4, Sphere, Vector3 } from 'three';
import { OBB } from 'three/examples/jsm/math/OBB.js';

const HALF = new Vector3(0.5, 0.5, 0.5);
const MIDDLE = new Vector3(3, 0, 0);
const part = new OBB(MIDDLE, HALF);
const obstacle = new OBB(MIDDLE, HALF);
const text = (v) => `(${v.toArray().map((c) => c.toFixed(2)).join(', ')})`;
const cases = [
  ['moved by (0, 2, 0)', new Matrix4().makeTranslation(0, 2, 0), 0],
  ['turned by 90 degrees about z', new Matrix4().makeRotationZ(Math.PI / 2), Math.hypot(3, 3)],
  ['grown to twice its size', new Matrix4().makeScale(2, 2, 2), 3],
];
for (const [name, matrix, gap] of cases) {
  const oriented = part.clone().applyMatrix4(matrix).center;
  const aligned = new Box3().setFromCenterAndSize(MIDDLE, new Vector3(1, 1, 1)).applyMatrix4(matrix).getCenter(new Vector3());
  const { center } = new Sphere(MIDDLE.clone(), 1).applyMatrix4(matrix);
  const true_ = MIDDLE.clone().applyMatrix4(matrix);
  console.log(`${name}: OBB ${text(oriented)}, Box3 ${text(aligned)}, Sphere ${text(center)}, true ${text(true_)}`);
  assert.ok(aligned.distanceTo(true_) < 1e-9 && center.distanceTo(true_) < 1e-9);
  assert.ok(Math.abs(oriented.distanceTo(true_) - gap) < 1e-9);
}
const turned = part.clone().applyMatrix4(cases[1][1]);
console.log(`the turned part and an obstacle where it was: ${turned.intersectsOBB(obstacle)} (true false)`);
assert.ok(turned.intersectsOBB(obstacle));
assert.ok(!turned.containsPoint(new Vector3(0, 3, 0)));
JAVASCRIPT
node turn.mjs
