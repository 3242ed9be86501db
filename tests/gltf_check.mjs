#!/usr/bin/env node
// Khronos's glTF validator on head files: `node tests/gltf_check.mjs HEAD.glb …`
// Needs the npm package gltf-validator, in the folder this runs in or in $NODE_PATH. Prints what it
// finds; exit status 0 without errors, 1 with some, 2 where the validator is not installed.
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

const places = [join(process.cwd(), 'x.js'), import.meta.url];
let validator = null;
for (const place of places) {
  try {
    validator = createRequire(place)('gltf-validator');
    break;
  } catch { /* the next place */ }
}
if (!validator) {
  console.error('gltf-validator is not installed: npm install gltf-validator');
  process.exit(2);
}
const files = process.argv.slice(2);
if (files.length === 0) {
  console.error('say which: node tests/gltf_check.mjs HEAD.glb');
  process.exit(2);
}
let errors = 0;
for (const file of files) {
  const { issues, info } = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 1000 });
  errors += issues.numErrors;
  const kinds = new Map();
  for (const { severity, code, message, pointer } of issues.messages) {
    const kind = kinds.get(code) ?? { severity, message, pointer, count: 0 };
    kind.count += 1;
    kinds.set(code, kind);
  }
  console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ${issues.numInfos} infos, `
    + `${issues.numHints} hints; ${info.totalVertexCount} vertices, ${info.totalTriangleCount} triangles`);
  for (const [code, { severity, message, pointer, count }] of kinds) {
    console.log(`  ${['error', 'warning', 'info', 'hint'][severity]} ${code} x${count}: ${message} (${pointer})`);
  }
}
process.exit(errors === 0 ? 0 : 1);
