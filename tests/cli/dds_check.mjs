// Reads the DDS files of a bake with three.js's loader, an independent reader, and compares them with the KTX2 files of the
// same bake, as ktx-parse reads those: size, levels, format and every byte.
//   node tests/cli/dds_check.mjs LOBELIA
// That loader knows BC6H only. Exit code 77 where three or ktx-parse is not installed.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const lobelia = resolve(process.argv[2]);
const installed = fileURLToPath(new URL('../../tools/node_modules/', import.meta.url));
if (!existsSync(join(installed, 'three')) || !existsSync(join(installed, 'ktx-parse'))) {
  console.log('skipped: three or ktx-parse is not installed: npm ci --prefix tools');
  process.exit(77);
}
const load = (path) => import(pathToFileURL(join(installed, path)));
const { DDSLoader } = await load('three/examples/jsm/loaders/DDSLoader.js');
const { RGB_BPTC_SIGNED_Format } = await load('three/build/three.module.js');
const ktx = await load('ktx-parse/dist/ktx-parse.modern.js');

const work = mkdtempSync(join(tmpdir(), 'lobelia-dds-'));
try {
  const bake = (container) => {
    const options = ['--size', '192x192', '--samples', '4', '--codec', 'sh1/moments/convolution', '--no-report'];
    const textures = ['--storage', 'bc6h-signed', '--no-texture-arrays', '--mip-levels', '3', '--container', container];
    execFileSync(lobelia, ['bake', 'cornell', ...options, ...textures, '-o', container], { cwd: work, stdio: 'pipe' });
    const folder = join(work, container);
    const { layout } = JSON.parse(readFileSync(join(folder, 'bake.json'), 'utf8'));
    return layout.pages[0].textures.map((texture) => readFileSync(join(folder, texture.file)));
  };
  const dds = bake('dds'), ktx2 = bake('ktx2');
  assert.equal(dds.length, 4); // one for each coefficient of degree-1 SH
  assert.equal(ktx2.length, dds.length);
  dds.forEach((bytes, i) => {
    const read = new DDSLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), true);
    const expected = ktx.read(new Uint8Array(ktx2[i]));
    assert.equal(read.format, RGB_BPTC_SIGNED_Format);
    assert.equal(expected.vkFormat, 144); // VK_FORMAT_BC6H_SFLOAT_BLOCK
    assert.equal(read.isCubemap, false);
    assert.equal(read.mipmaps.length, 3);
    assert.equal(expected.levels.length, 3);
    read.mipmaps.forEach((level, k) => {
      assert.deepEqual([level.width, level.height], [192 >> k, 192 >> k]);
      assert.ok(Buffer.from(level.data).equals(Buffer.from(expected.levels[k].levelData)), `texture ${i}, level ${k}`);
    });
  });
  console.log(`${dds.length} textures of 3 levels: the same bytes as in KTX2`);
} finally {
  rmSync(work, { recursive: true, force: true });
}
