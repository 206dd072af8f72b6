#!/usr/bin/env bash
# jolt-physics==1.1.0 (npm, JoltPhysics): capsules of 2 m between two centres, of radius 0.5 m at one end and 0.4999 to 0.25 m at
# the other, with the density of 1000 kg/m^3 that each shape has.
# Expected: a mass that is density times volume and goes over into that of the straight capsule, 2094 kg, as the radii become
# equal, as the inertia does. What comes: 2999 kg and twice the inertia about the axis for 0.4999 m, since a tapered capsule has
# the mass of a box; 1547 kg for 0.25 m, where GetVolume says 2.75 m^3, and 1.22 m^3 would be right.
# Tapered cylinders weigh what they should.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund jolt-physics@1.1.0

cat > weigh.mjs << 'JAVASCRIPT'
import assert from 'node:assert';
import init from 'jolt-physics';

const Jolt = await init();
const [TOP, HALF, STEPS] = [0.5, 1, 200000];

/** Volume of two balls and the cone that touches both. */
function capsule(bottom) {
  const sine = (TOP - bottom) / (2 * HALF);
  const cosine = Math.sqrt(1 - sine * sine);
  const [low, high] = [-HALF - bottom * sine, HALF - TOP * sine];
  const [first, last] = [-HALF - bottom, HALF + TOP];
  let volume = 0;
  for (let i = 0; i < STEPS; i += 1) {
    const z = first + ((i + 0.5) * (last - first)) / STEPS;
    let square = (cosine * (bottom + ((TOP - bottom) * (z - low)) / (high - low))) ** 2;
    if (z > high) square = TOP ** 2 - (z - HALF) ** 2;
    if (z < low) square = bottom ** 2 - (z + HALF) ** 2;
    volume += (Math.PI * square * (last - first)) / STEPS;
  }
  return volume;
}

function weigh(shape) {
  const properties = shape.GetMassProperties();
  return { tonnes: properties.get_mMass() / 1000, volume: shape.GetVolume(), axial: properties.get_mInertia().GetAxisY().GetY() };
}

const straight = weigh(new Jolt.CapsuleShape(HALF, TOP));
console.log(`straight capsule: ${straight.tonnes.toFixed(3)} t, about its axis ${straight.axial.toFixed(0)} kg m^2`);
assert.ok(Math.abs(straight.tonnes - 2.0944) < 1e-3);
for (const bottom of [0.4999, 0.4, 0.25]) {
  const tapered = weigh(new Jolt.TaperedCapsuleShapeSettings(HALF, TOP, bottom).Create().Get());
  const volume = capsule(bottom);
  console.log(
    `ends of ${TOP} and ${bottom} m: ${tapered.tonnes.toFixed(3)} t (true ${volume.toFixed(3)}),`,
    `${tapered.volume.toFixed(3)} m^3, about its axis ${tapered.axial.toFixed(0)} kg m^2`,
  );
  const [width, length] = [TOP + bottom, 2 * HALF + TOP + bottom];
  assert.ok(Math.abs(tapered.tonnes - width ** 2 * length) < 1e-3 && tapered.tonnes > 1.25 * volume);
  assert.ok(Math.abs(tapered.volume - 4 * TOP ** 2 * length) < 1e-3);
  assert.ok(bottom < 0.49 || tapered.axial > 2 * straight.axial);

  const cylinder = weigh(new Jolt.TaperedCylinderShapeSettings(HALF, TOP, bottom, 0).Create().Get());
  const frustum = ((2 * HALF * Math.PI) / 3) * (TOP ** 2 + TOP * bottom + bottom ** 2);
  assert.ok(Math.abs(cylinder.tonnes - frustum) < 1e-3);
}
JAVASCRIPT
node weigh.mjs
