#!/usr/bin/env bash
# gl-matrix 3.4.4 (npm): mat4.decompose and mat4.getRotation of a pose that fromRotationTranslationScale made of a turn by one radian
# about (0, 0.6, 0.8), a shift and a scale of each axis.
# Expected: the turn, shift and scale that went in, for the scale is of the columns and each is divided by its own.
# What comes: so where all three scales are equal. Otherwise each entry is divided by the scale of its row: for (1, 1, 2) the turn
# is 13 degrees off and its quaternion 1.027 long. The scale and the shift are right, so a pose that is taken apart and put
# together again is another one.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund gl-matrix@3.4.4

cat > pose.cjs << 'JAVASCRIPT'
const assert = require('node:assert');
const { glMatrix, mat4, quat } = require('gl-matrix');

glMatrix.setMatrixArrayType(Array);
const turn = [0, 0.6 * Math.sin(0.5), 0.8 * Math.sin(0.5), Math.cos(0.5)];
const shift = [1, 2, 3];
const apart = (one, other) => Math.max(...one.map((value, i) => Math.abs(value - other[i])));

for (const scale of [[1, 1, 1], [2, 2, 2], [1, 1, 2], [1, 1, 0.5], [2, 3, 4]]) {
  const pose = mat4.fromRotationTranslationScale(mat4.create(), turn, shift, scale);
  const [rotation, translation, scaling] = [quat.create(), [0, 0, 0], [0, 0, 0]];
  mat4.decompose(rotation, translation, scaling, pose);
  const again = mat4.fromRotationTranslationScale(mat4.create(), rotation, translation, scaling);
  const length = Math.hypot(...rotation);
  const cosine = rotation.reduce((sum, value, i) => sum + (value * turn[i]) / length, 0);
  const degrees = (2 * Math.acos(Math.min(1, cosine)) * 180) / Math.PI;
  console.log(
    `scale ${scale}: turn ${degrees.toFixed(2)} degrees off, quaternion ${length.toFixed(4)} long; ` +
      `put together again the pose is ${apart(again, pose).toFixed(4)} off`,
  );
  assert.ok(apart(translation, shift) < 1e-12 && apart(scaling, scale) < 1e-12);
  assert.deepStrictEqual(mat4.getRotation(quat.create(), pose), rotation);
  // The columns divided by their own lengths are the turn.
  const columns = [0, 1, 2].flatMap((i) => [0, 1, 2].map((j) => pose[4 * i + j] / scale[i]));
  const real = Math.sqrt(1 + columns[0] + columns[4] + columns[8]) / 2;
  const due = [columns[5] - columns[7], columns[6] - columns[2], columns[1] - columns[3]].map((value) => value / (4 * real));
  assert.ok(apart([...due, real], turn) < 1e-12);
  if (new Set(scale).size === 1) {
    assert.ok(apart(rotation, turn) < 1e-12 && apart(again, pose) < 1e-12);
  } else {
    assert.ok(degrees > 8 && length > 1.02 && apart(again, pose) > 0.1);
  }
}
JAVASCRIPT
node pose.cjs
