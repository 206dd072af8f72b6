#!/usr/bin/env bash
# three==0.187.0 (npm): a closed prism on a regular polygon of n corners, in a PLY file and in an OBJ file with the same faces.
# Expected: the prism's area and volume from both, as PLY's list of a face may have any length.
# What comes: PLYLoader leaves out both ends of the prism, without a word, as soon as they have five corners, so that the part
# is an open tube of two thirds of its volume; OBJLoader reads all of it.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund three@0.187.0

cat > prism.mjs << 'JAVASCRIPT'
import assert from 'node:assert';
import { Vector3 } from 'three';
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';

function measure(geometry) {
  const { position } = (geometry.index ? geometry.toNonIndexed() : geometry).attributes;
  let area = 0;
  let volume = 0;
  for (let i = 0; i < position.count; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => new Vector3().fromBufferAttribute(position, i + k));
    volume += a.dot(b.clone().cross(c)) / 6;
    area += b.sub(a).cross(c.sub(a)).length() / 2;
  }
  return { area, volume };
}

for (const n of [3, 4, 5, 6, 8]) {
  const ring = [...Array(n).keys()];
  const corners = [0, 1].flatMap((z) => ring.map((i) => [Math.cos((2 * Math.PI * i) / n), Math.sin((2 * Math.PI * i) / n), z]));
  const sides = ring.map((i) => [i, (i + 1) % n, n + ((i + 1) % n), n + i]);
  const faces = [[...ring].reverse(), ring.map((i) => n + i), ...sides];
  const header = [
    'ply', 'format ascii 1.0', `element vertex ${2 * n}`, 'property float x', 'property float y', 'property float z',
    `element face ${faces.length}`, 'property list uchar int vertex_indices', 'end_header',
  ];
  const lists = faces.map((face) => `${face.length} ${face.join(' ')}`);
  const ply = [...header, ...corners.map((corner) => corner.join(' ')), ...lists, ''].join('\n');
  const of_obj = faces.map((face) => `f ${face.map((i) => i + 1).join(' ')}`);
  const obj = [...corners.map((corner) => `v ${corner.join(' ')}`), ...of_obj, ''].join('\n');
  const end = (n / 2) * Math.sin((2 * Math.PI) / n);
  const walls = 2 * n * Math.sin(Math.PI / n);
  const from_ply = measure(new PLYLoader().parse(ply));
  const from_obj = measure(new OBJLoader().parse(obj).children[0].geometry);
  console.log(
    `${n} corners: true area ${(walls + 2 * end).toFixed(3)}, volume ${end.toFixed(3)};`,
    `PLY ${from_ply.area.toFixed(3)}, ${from_ply.volume.toFixed(3)}; OBJ ${from_obj.area.toFixed(3)}, ${from_obj.volume.toFixed(3)}`,
  );
  assert.ok(Math.abs(from_obj.area - walls - 2 * end) < 1e-5);
  assert.ok(Math.abs(from_obj.volume - end) < 1e-5);
  assert.ok(Math.abs(from_ply.area - walls - (n < 5 ? 2 * end : 0)) < 1e-5);
  assert.ok(Math.abs(from_ply.volume - (n < 5 ? 1 : 2 / 3) * end) < 1e-5);
}
JAVASCRIPT
node prism.mjs
