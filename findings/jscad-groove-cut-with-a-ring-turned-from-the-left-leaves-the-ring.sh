#!/usr/bin/env bash
# @jscad/modeling 2.13.0 (npm): extrudeRotate of a unit square whose centre is 2 to the right or to the left of the axis, into a
# whole ring, a half and a quarter; then the ring with a plate of 8 x 8 x 2 round it: cut out, shared and joined.
# Expected: the same solid from either side, and 128 less the ring for the plate with a groove.
# What comes: from the left the same outline with its faces inwards and a negative volume. The plate less the ring is the ring, what
# they share is the plate without it, and both together are nothing, of volume 0. The area is right; nothing warns.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund @jscad/modeling@2.13.0

cat > ring.cjs << 'JAVASCRIPT'
const assert = require('node:assert');
const { booleans, extrusions, measurements, primitives, transforms } = require('@jscad/modeling');

const SEGMENTS = 96;
const PLATE = 128;
const plate = primitives.cuboid({ size: [8, 8, 2] });
// One of the sectors between two radii, of height 1.
const sector = 0.5 * Math.sin((2 * Math.PI) / SEGMENTS) * (2.5 ** 2 - 1.5 ** 2);
const near = (one, other) => Math.abs(one - other) < 1e-4;

for (const parts of [96, 48, 24]) {
  const due = parts * sector;
  for (const [name, x] of [['right', 2], ['left', -2]]) {
    const ring = extrusions.extrudeRotate(
      { segments: SEGMENTS, angle: (2 * Math.PI * parts) / SEGMENTS },
      transforms.translate([x, 0, 0], primitives.square({ size: 1 })),
    );
    const volume = measurements.measureVolume(ring);
    const [less, shared, joined] = ['subtract', 'intersect', 'union'].map((name) => (
      measurements.measureVolume(booleans[name](plate, ring))
    ));
    console.log(
      `${parts} of 96 sectors from the ${name}: volume ${volume.toFixed(3)}, true ${due.toFixed(3)}; plate less the ring ` +
        `${less.toFixed(3)}, shared ${shared.toFixed(3)}, joined ${joined.toFixed(3)}`,
    );
    if (name === 'right') {
      assert.ok(near(volume, due) && near(less, PLATE - due) && near(shared, due) && near(joined, PLATE));
    } else {
      assert.ok(near(volume, -due) && near(less, due) && near(shared, PLATE - due) && near(joined, 0));
    }
    const ends = parts === 96 ? 0 : 2;
    const rims = 4 * parts * Math.sin(Math.PI / SEGMENTS) * 2 + 2 * parts * sector + ends;
    assert.ok(near(measurements.measureArea(ring), rims));
  }
}
JAVASCRIPT
node ring.cjs
