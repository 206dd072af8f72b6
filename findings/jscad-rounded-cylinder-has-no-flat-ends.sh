#!/usr/bin/env bash
# @jscad/modeling 2.13.0 (npm): roundedCylinder, whose roundRadius is said to be that of the rounded edges, for a coin, a puck
# and a can; beside roundedCuboid.
# Expected: flat ends of radius R - r with a quarter of a circle of radius r round them, as roundedCuboid has flat faces.
# What comes: each end is half of an ellipsoid of half-axes R, R and r, so no end is flat and the solid stands on one point.
# The coin is a fifth lighter than with that edge; the volume is pi R^2 (h - 2 r) + 4 / 3 pi R^2 r to the last facet.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund @jscad/modeling@2.13.0

cat > rounded.cjs << 'JAVASCRIPT'
const assert = require('node:assert');
const { geometries, measurements, primitives } = require('@jscad/modeling');
assert.ok(require('@jscad/modeling/package.json').version === '2.13.0');

const close = (one, other, relative) => Math.abs(one / other - 1) < relative;
const highest = (solid) => {
  const points = geometries.geom3.toPolygons(solid).flatMap((polygon) => polygon.vertices);
  const top = points.reduce((most, point) => Math.max(most, point[2]), -Infinity);
  const level = points.filter((point) => top - point[2] < 1e-9);
  return level.reduce((most, point) => Math.max(most, Math.hypot(point[0], point[1])), 0);
};
// Volume of a disc of radius R - r, grown by a ball of radius r, and of the wall between: by slices of the two rims.
const due = (R, h, r, slices = 20000) => {
  let rims = 0;
  for (let i = 0; i < slices; i += 1) {
    const z = (r * (i + 0.5)) / slices;
    rims += (2 * Math.PI * (R - r + Math.sqrt(r * r - z * z)) ** 2 * r) / slices;
  }
  return Math.PI * R * R * (h - 2 * r) + rims;
};

for (const [name, R, h, r] of [['coin', 1, 0.3, 0.1], ['puck', 1, 1, 0.2], ['can', 1, 4, 0.5]]) {
  const solid = primitives.roundedCylinder({ radius: R, height: h, roundRadius: r, segments: 256 });
  const volume = measurements.measureVolume(solid);
  const ellipsoid = Math.PI * R * R * (h - 2 * r) + (4 / 3) * Math.PI * R * R * r;
  console.log(
    `${name}: volume ${volume.toFixed(4)}, due ${due(R, h, r).toFixed(4)}, with ellipsoids as ends ${ellipsoid.toFixed(4)}; ` +
      `flat at the top to a radius of ${highest(solid).toFixed(4)}, due ${(R - r).toFixed(4)}`,
  );
  assert.ok(close(volume, ellipsoid, 1e-3));
  assert.ok(volume < 0.97 * due(R, h, r));
  assert.ok(highest(solid) < 1e-4);
  const limit = primitives.roundedCylinder({ radius: R, height: 4 * R, roundRadius: 0.999999 * R, segments: 256 });
  assert.ok(close(measurements.measureVolume(limit), Math.PI * R ** 3 * (2 + 4 / 3), 1e-3));
  const cuboid = primitives.roundedCuboid({ size: [2 * R, 2 * R, 3 * r], roundRadius: r, segments: 128 });
  const [a, b] = [2 * R - 2 * r, r];
  const grown = a * a * b + 2 * r * (a * a + 2 * a * b) + Math.PI * r * r * (2 * a + b) + (4 / 3) * Math.PI * r ** 3;
  assert.ok(close(measurements.measureVolume(cuboid), grown, 1e-3));
  assert.ok(close(highest(cuboid), Math.SQRT2 * (R - r), 1e-3));
}
JAVASCRIPT
node rounded.cjs
