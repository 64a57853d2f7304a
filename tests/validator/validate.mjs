// Holds every .glb and .gltf below a folder against the Khronos validator: no error, no
// warning, no info, no hint.   node validate.mjs NODE_MODULES FOLDER
import { createRequire } from 'node:module';
import fs from 'node:fs';
import path from 'node:path';

const [modules, folder] = process.argv.slice(2).map((p) => path.resolve(p));
const validator = createRequire(path.join(modules, '_'))('gltf-validator');

const files = fs.readdirSync(folder, { recursive: true })
  .filter((name) => /\.(glb|gltf)$/.test(name))
  .map((name) => path.join(folder, name));
let bad = 0;
for (const file of files) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
    uri: path.basename(file),
    maxIssues: 20,
    externalResourceFunction: async (uri) =>
      new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri)))),
  });
  for (const { code, message, pointer } of report.issues.messages) {
    console.error(`${path.relative(folder, file)}: ${code} at ${pointer}: ${message}`);
  }
  bad += report.issues.messages.length > 0 ? 1 : 0;
}
console.log(`${files.length - bad} of ${files.length} files without a word from the Khronos validator`);
process.exit(files.length === 0 || bad > 0 ? 1 : 0);
