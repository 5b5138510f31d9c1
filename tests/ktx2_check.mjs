// Reads textures that Lobelia wrote with ktx-parse, an independent reader, and compares every number.
//   node tests/ktx2_check.mjs MAKE_KTX2
// MAKE_KTX2 FOLDER writes NAME.ktx2 and what it should hold, NAME.f32. Exit code 77 where ktx-parse is not installed.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

let ktx;
try {
  const installed = createRequire(new URL('../tools/package.json', import.meta.url));
  ktx = await import(pathToFileURL(installed.resolve('ktx-parse')));
} catch {
  console.log('ktx-parse is not installed: npm ci --prefix tools');
  process.exit(77);
}

const width = 21, height = 34;
let failures = 0, checks = 0;
function check(holds, what) {
  checks++;
  if (holds) return;
  if (failures++ < 20) console.error(`FAIL: ${what}`);
}

// Values of keys that ktx-parse does not know are bytes, and end with a zero.
const textOf = (value) => typeof value === 'string' ? value : new TextDecoder().decode(value).replace(/\0$/, '');

function half(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24);
}
// Rounded to the nearest of 11 bits, or of multiples of 2^-24.
function fitsHalf(stored, value) {
  const cut = Math.max(-65504, Math.min(65504, value));
  return Math.abs(half(stored) - cut) <= Math.max(Math.abs(cut) * 2 ** -11, 2 ** -25) * (1 + 1e-6);
}
function fitsByte(stored, value) {
  return Math.abs(stored - 255 * Math.max(0, Math.min(1, value))) <= 0.5 + 1e-4;
}

function checkContainer(name, texture, bytes, layers) {
  const isHalf = texture.vkFormat === ktx.VK_FORMAT_R16G16B16A16_SFLOAT;
  check(isHalf || texture.vkFormat === ktx.VK_FORMAT_R8G8B8A8_UNORM, `${name}: format ${texture.vkFormat}`);
  check(texture.typeSize === (isHalf ? 2 : 1), `${name}: type size`);
  check(texture.pixelWidth === width && texture.pixelHeight === height && texture.pixelDepth === 0, `${name}: size`);
  check(texture.layerCount === layers && texture.faceCount === 1, `${name}: ${texture.layerCount} layers`);
  check(texture.levels.length === 1 && texture.supercompressionScheme === 0, `${name}: levels`);
  const format = texture.dataFormatDescriptor[0];
  check(texture.dataFormatDescriptor.length === 1 && format.colorModel === 1, `${name}: colour model`);
  check(format.colorPrimaries === 1 && format.transferFunction === 1 && format.flags === 0, `${name}: colour space`);
  check(format.bytesPlane[0] === (isHalf ? 8 : 4) && format.bytesPlane[1] === 0, `${name}: plane`);
  check(format.samples.length === 4, `${name}: samples`);
  format.samples.forEach((sample, i) => {
    const bits = isHalf ? 16 : 8;
    check(sample.bitOffset === i * bits && sample.bitLength === bits - 1, `${name}: bits of sample ${i}`);
    check(sample.channelType === ([0, 1, 2, 15][i] | (isHalf ? 0xc0 : 0)), `${name}: channel of sample ${i}`);
    // ktx-parse reads the bounds of signed channels as signed integers: the bits of -1.0 and 1.0 as floats.
    check((sample.sampleLower >>> 0) === (isHalf ? 0xbf800000 : 0), `${name}: lower bound`);
    check((sample.sampleUpper >>> 0) === (isHalf ? 0x3f800000 : 255), `${name}: upper bound`);
  });
  check(/^Lobelia \d/.test(texture.keyValue.KTXwriter), `${name}: KTXwriter`);
  check(texture.keyValue.KTXorientation === 'rd', `${name}: KTXorientation`);
  check(textOf(texture.keyValue['lobelia.layers']).split('\n').length === layers, `${name}: names of layers`);
  const view = new DataView(bytes.buffer, bytes.byteOffset), begin = Number(view.getBigUint64(80, true));
  check(begin % (isHalf ? 8 : 4) === 0, `${name}: alignment of the texels`);
  check(begin + texture.levels[0].levelData.length === bytes.length, `${name}: length of the file`);
  const keys = Object.keys(texture.keyValue);
  check(keys.join() === [...keys].sort().join(), `${name}: order of the keys`);
}

function checkTexels(name, texture, expected) {
  const data = texture.levels[0].levelData, isHalf = texture.typeSize === 2;
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  check(data.byteLength === expected.length * texture.typeSize, `${name}: ${data.byteLength} bytes of texels`);
  for (let i = 0; i < expected.length; i++) {
    const stored = isHalf ? view.getUint16(2 * i, true) : view.getUint8(i);
    check((isHalf ? fitsHalf : fitsByte)(stored, expected[i]), `${name}: value ${i}: ${stored} for ${expected[i]}`);
  }
}

const folder = mkdtempSync(join(tmpdir(), 'lobelia-ktx2-'));
try {
  execFileSync(process.argv[2], [folder], { stdio: 'inherit' });
  const files = readdirSync(folder).filter((name) => name.endsWith('.ktx2'));
  check(files.length === 5, `${files.length} files`);
  for (const name of files) {
    const bytes = readFileSync(join(folder, name));
    const floats = readFileSync(join(folder, name.replace('.ktx2', '.f32')));
    const expected = new Float32Array(floats.buffer.slice(floats.byteOffset, floats.byteOffset + floats.length));
    const texture = ktx.read(new Uint8Array(bytes));
    checkContainer(name, texture, bytes, expected.length / (4 * width * height));
    checkTexels(name, texture, expected);
  }
} finally {
  rmSync(folder, { recursive: true });
}
console.log(`${checks - failures} passed, ${failures} failed`);
process.exit(failures ? 1 : 0);
