#!/usr/bin/env bash
# p2-es==1.2.3 (npm): a disc and a box of 0.1 to 50 kg under a torque of 1 N m for 1 s, without gravity and damping; and the
# force that moves them for comparison.
# Expected: a rate of t T / I, which falls with the mass, as the speed does. What comes: body.inertia is right, but the rate
# is that of 1 kg for every mass, as invInertia is not 1 / inertia; so a heavy body is turned too easily by each contact.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund p2-es@1.2.3

cat > spin.mjs << 'JAVASCRIPT'
import assert from 'node:assert';
import { Body, Box, Circle, World } from 'p2-es';

const STEPS = 100;
const shapes = { disc: [() => new Circle({ radius: 0.5 }), 0.125], box: [() => new Box({ width: 1, height: 1 }), 1 / 6] };
for (const [name, [make, per_mass]] of Object.entries(shapes)) {
  for (const mass of [0.1, 1, 5, 50]) {
    const world = new World({ gravity: [0, 0] });
    const body = new Body({ mass, damping: 0, angularDamping: 0 });
    body.addShape(make());
    world.addBody(body);
    for (let i = 0; i < STEPS; i += 1) {
      body.force[0] = 1;
      body.angularForce = 1;
      world.step(1 / STEPS);
    }
    const due = 1 / (per_mass * mass);
    console.log(
      `${name} of ${mass} kg: speed ${body.velocity[0].toFixed(3)} m/s (true ${(1 / mass).toFixed(3)}),`,
      `rate ${body.angularVelocity.toFixed(3)} rad/s (true ${due.toFixed(3)})`,
    );
    assert.ok(Math.abs(body.velocity[0] * mass - 1) < 1e-3);
    assert.ok(Math.abs(body.inertia / (per_mass * mass) - 1) < 1e-6);
    assert.ok(Math.abs(body.angularVelocity * per_mass - 1) < 1e-3);
  }
}
JAVASCRIPT
node spin.mjs
