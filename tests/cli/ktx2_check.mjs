// Reads textures that Lobelia wrote with ktx-parse, an independent reader, and compares containers, descriptors, bytes
// and, where a few lines can decode them, numbers.
//   node tests/cli/ktx2_check.mjs MAKE_KTX2
// MAKE_KTX2 FOLDER writes NAME.ktx2 for each pixel format NAME, what it should hold as NAME.f32 and NAME.bin, and bakes
// in folders. Exit code 77 where ktx-parse is not installed.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

let ktx;
try {
  const installed = createRequire(new URL('../../tools/package.json', import.meta.url));
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

// Data format descriptors of each format after the Khronos Data Format Specification 1.3, written here independently.
// Samples are [bit, bits, channel with qualifiers, lower, upper]; decode decodes a texel, allowed is its error.
const minusOne = 0xbf800000, one = 0x3f800000, channels = [0, 1, 2, 15];
const cut = (low, high, v) => Math.max(low, Math.min(high, v));
const unorm8 = (count) => ({
  typeSize: 1, bytes: count, samples: channels.slice(0, count).map((c, i) => [8 * i, 8, c, 0, 255]),
  decode: (view, at) => Array.from({ length: count }, (_, i) => view.getUint8(at + i) / 255),
  allowed: () => 0.5 / 255 + 1e-6, limits: [0, 1],
});
const floats = (count, bits) => ({
  typeSize: bits / 8, bytes: count * bits / 8,
  samples: channels.slice(0, count).map((c, i) => [bits * i, bits, c | 0xc0, minusOne, one]),
  decode: (view, at) => Array.from({ length: count }, (_, i) =>
    bits === 32 ? view.getFloat32(at + 4 * i, true) : half(view.getUint16(at + 2 * i, true))),
  allowed: (v) => bits === 32 ? 0 : Math.max(Math.abs(v) * 2 ** -11, 2 ** -25) * (1 + 1e-6),
  limits: bits === 32 ? [-Infinity, Infinity] : [-65504, 65504],
});
const carried = { ...unorm8(4), decode: null };
const bc6h = (qualifiers, lower) => ({
  typeSize: 1, bytes: 16, block: 4, model: 133, samples: [[0, 128, qualifiers, lower, one]], decode: null,
});
const formats = {
  r8: [9, unorm8(1)], rg8: [16, unorm8(2)], rgba8: [37, unorm8(4)],
  r16f: [76, floats(1, 16)], rg16f: [83, floats(2, 16)], rgba16f: [97, floats(4, 16)],
  r32f: [100, floats(1, 32)], rg32f: [103, floats(2, 32)], rgba32f: [109, floats(4, 32)],
  rgb10a2: [64, {
    typeSize: 4, bytes: 4, samples: [[0, 10, 0, 0, 1023], [10, 10, 1, 0, 1023], [20, 10, 2, 0, 1023], [30, 2, 15, 0, 3]],
    decode: (view, at) => [0, 10, 20].map((bit) => ((view.getUint32(at, true) >>> bit) & 1023) / 1023),
    allowed: () => 0.5 / 1023 + 1e-6, limits: [0, 1],
  }],
  rgb9e5: [123, {
    typeSize: 4, bytes: 4,
    samples: [0, 1, 2].flatMap((i) => [[9 * i, 9, i, 0, 8448], [27, 5, i | 0x20, 15, 31]]),
    decode: (view, at) => [0, 9, 18].map((bit) => {
      const word = view.getUint32(at, true);
      return ((word >>> bit) & 511) * 2 ** ((word >>> 27) - 24);
    }),
    allowed: (v, largest) => Math.max(largest * 2 ** -9, 2 ** -25) * (1 + 1e-6), limits: [0, 65408],
  }],
  rgbe8: [37, carried], rgbm8: [37, carried], logluv32: [37, carried],
  bc6h_unsigned: [143, bc6h(0x80, 0)], bc6h_signed: [144, bc6h(0xc0, minusOne)],
};

function checkContainer(name, format, texture, bytes, size, { layers = 0, levels = 1, zstd = false } = {}) {
  const [vkFormat, facts] = formats[format], block = facts.block ?? 1;
  check(texture.vkFormat === vkFormat, `${name}: format ${texture.vkFormat}`);
  check(texture.typeSize === facts.typeSize, `${name}: type size ${texture.typeSize}`);
  check(texture.pixelWidth === size[0] && texture.pixelHeight === size[1] && texture.pixelDepth === 0, `${name}: size`);
  check(texture.layerCount === layers && texture.faceCount === 1, `${name}: ${texture.layerCount} layers`);
  check(texture.levels.length === levels, `${name}: ${texture.levels.length} levels`);
  check(texture.supercompressionScheme === (zstd ? 2 : 0), `${name}: supercompression`);
  const stated = texture.dataFormatDescriptor[0];
  check(texture.dataFormatDescriptor.length === 1 && stated.vendorId === 0 && stated.descriptorType === 0 &&
    stated.versionNumber === 2, `${name}: descriptor`);
  check(stated.colorModel === (facts.model ?? 1), `${name}: colour model ${stated.colorModel}`);
  check(stated.colorPrimaries === 1 && stated.transferFunction === 1 && stated.flags === 0, `${name}: colour space`);
  check(stated.texelBlockDimension.join() === [block - 1, block - 1, 0, 0].join(), `${name}: block`);
  check(stated.bytesPlane.join() === [zstd ? 0 : facts.bytes, 0, 0, 0, 0, 0, 0, 0].join(), `${name}: planes`);
  check(stated.samples.length === facts.samples.length, `${name}: samples`);
  stated.samples.forEach((sample, i) => {
    const [bit, bits, channel, lower, upper] = facts.samples[i];
    check(sample.bitOffset === bit && sample.bitLength === bits - 1, `${name}: bits of sample ${i}`);
    check(sample.channelType === channel, `${name}: channel of sample ${i}: ${sample.channelType}`);
    // ktx-parse reads the bounds of signed channels as signed integers: the bits of -1.0 and 1.0 as floats.
    check((sample.sampleLower >>> 0) === lower && (sample.sampleUpper >>> 0) === upper, `${name}: bounds of ${i}`);
  });
  check(/^Lobelia \d/.test(texture.keyValue.KTXwriter), `${name}: KTXwriter`);
  check(texture.keyValue.KTXorientation === 'rd', `${name}: KTXorientation`);
  const keys = Object.keys(texture.keyValue);
  check(keys.join() === [...keys].sort().join(), `${name}: order of the keys`);
  // Levels, the smallest first, up to the end of the file.
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const begins = texture.levels.map((_, i) => Number(view.getBigUint64(80 + 24 * i, true)));
  check(zstd || begins.every((begin) => begin % 4 === 0 && begin % facts.bytes === 0), `${name}: alignment`);
  check(begins.every((begin, i) => i === 0 || begin < begins[i - 1]), `${name}: order of the levels`);
  check(begins[0] + texture.levels[0].levelData.length === bytes.length, `${name}: length of the file`);
  texture.levels.forEach((level, i) => {
    const blocks = size.map((side) => Math.ceil(Math.max(side >> i, 1) / block));
    const length = Math.max(layers, 1) * blocks[0] * blocks[1] * facts.bytes;
    check(level.uncompressedByteLength === length, `${name}: bytes of level ${i}`);
    check(zstd || level.levelData.length === length, `${name}: bytes of level ${i}`);
  });
}

function checkNumbers(name, facts, data, expected) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength), count = expected.length / (width * height);
  for (let i = 0; i < width * height; i++) {
    const read = facts.decode(view, i * facts.bytes);
    check(read.length === count, `${name}: ${read.length} channels`);
    const wanted = Array.from(expected.subarray(i * count, (i + 1) * count), (v) => cut(...facts.limits, v));
    const largest = Math.max(...wanted);
    read.forEach((v, k) => check(Math.abs(v - wanted[k]) <= facts.allowed(wanted[k], largest),
      `${name}: texel ${i}, channel ${k}: ${v} for ${wanted[k]}`));
  }
}

function checkFormat(folder, name) {
  const bytes = readFileSync(join(folder, `${name}.ktx2`)), texture = ktx.read(new Uint8Array(bytes));
  checkContainer(name, name, texture, bytes, [width, height]);
  check(textOf(texture.keyValue['lobelia.format']) === name, `${name}: name of the format`);
  const data = texture.levels[0].levelData;
  check(Buffer.compare(Buffer.from(data), readFileSync(join(folder, `${name}.bin`))) === 0, `${name}: bytes`);
  const floats = readFileSync(join(folder, `${name}.f32`));
  const expected = new Float32Array(floats.buffer.slice(floats.byteOffset, floats.byteOffset + floats.length));
  if (formats[name][1].decode) checkNumbers(name, formats[name][1], data, expected);
}

// Levels, layers, faces and slices, as they are and compressed by zstd.
const shapes = {
  levels: { layerCount: 0, faceCount: 1, pixelDepth: 0 }, array: { layerCount: 5, faceCount: 1, pixelDepth: 0 },
  cube: { layerCount: 0, faceCount: 6, pixelDepth: 0 }, volume: { layerCount: 0, faceCount: 1, pixelDepth: 3 },
};
function checkShape(folder, shape, zstd) {
  const name = `${shape}${zstd ? '-zstd' : ''}`, bytes = readFileSync(join(folder, `${name}.ktx2`));
  const texture = ktx.read(new Uint8Array(bytes)), wanted = shapes[shape];
  for (const [key, value] of Object.entries(wanted)) check(texture[key] === value, `${name}: ${key} ${texture[key]}`);
  check(texture.supercompressionScheme === (zstd ? 2 : 0), `${name}: scheme`);
  check(texture.dataFormatDescriptor[0].bytesPlane[0] === (zstd ? 0 : 4), `${name}: bytes of plane 0`);
  check(texture.keyValue.KTXorientation === { cube: undefined, volume: 'rdi' }[shape] ||
    (texture.keyValue.KTXorientation === 'rd' && wanted.faceCount === 1 && wanted.pixelDepth === 0), `${name}: orientation`);
  const width = wanted.faceCount === 6 ? 8 : 12, images = Math.max(wanted.layerCount, 1) * wanted.faceCount;
  const sizes = [0, 1, 2, 3].map((level) => 4 * images * Math.max(width >> level, 1) * Math.max(8 >> level, 1) *
    Math.max(wanted.pixelDepth >> level, 1));
  check(texture.levels.length === 4, `${name}: ${texture.levels.length} levels`);
  check(texture.levels.every((level, i) => level.uncompressedByteLength === sizes[i]), `${name}: sizes of levels`);
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const begins = [0, 1, 2, 3].map((i) => Number(view.getBigUint64(80 + 24 * i, true)));
  check(begins.every((begin, i) => (zstd || begin % 4 === 0) && (i === 0 || begin < begins[i - 1])), `${name}: ${begins}`);
  const decode = zstd ? (data) => execFileSync('zstd', ['-d', '-c'], { input: data }) : (data) => data;
  const expected = readFileSync(join(folder, `${name}.bin`));
  const found = Buffer.concat(texture.levels.map((level) => Buffer.from(decode(level.levelData))));
  check(Buffer.compare(found, expected) === 0, `${name}: bytes`);
}

// Check that a bake's textures match its manifest: files of one texture, and of several as layers.
function checkBake(folder, { levels, zstd }) {
  const { layout } = JSON.parse(readFileSync(join(folder, 'bake.json')));
  const expected = { layers: 0, levels, zstd };
  const files = new Set();
  const read = (name) => {
    const bytes = readFileSync(join(folder, name));
    files.add(name);
    return [ktx.read(new Uint8Array(bytes)), bytes];
  };
  for (const page of layout.pages) {
    for (const name of new Set(page.textures.map((stated) => stated.file))) {
      const sharing = page.textures.filter((stated) => stated.file === name), [texture, bytes] = read(name);
      const first = sharing[0], isArray = 'layer' in first;
      check(isArray === (sharing.length > 1), `${name}: ${sharing.length} textures`);
      const size = [layout.width, layout.height].map((side) => Math.ceil(side / first.subsampling));
      checkContainer(name, first.format, texture, bytes, size, { ...expected, layers: isArray ? sharing.length : 0 });
      const values = (key) => textOf(texture.keyValue[`lobelia.${key}`]).split('\n\n');
      sharing.forEach((stated, i) => {
        check(!isArray || stated.layer === i, `${name}: layer ${stated.layer}`);
        check(texture.vkFormat === stated.vk_format, `${name}: vk_format`);
        check(values('storage')[0] === stated.storage && values('format')[0] === stated.format, `${name}: storage`);
        check(Number(values('scale')[i]) === stated.scale, `${name}: scale`);
        check(Number(values('subsampling')[0]) === stated.subsampling, `${name}: subsampling`);
        const lines = values('channels')[i].split('\n');
        check(lines.length === stated.channels.length, `${name}: channels`);
        stated.channels.forEach((channel, k) => check(lines[k].includes(`c${channel.coefficient}.${channel.component}`) &&
          (channel.form === 'ratio') === lines[k].includes('/'), `${name}: channel ${lines[k]}`));
      });
    }
    const [texture, bytes] = read(page.validity);
    checkContainer(page.validity, 'r8', texture, bytes, [layout.width, layout.height], expected);
  }
  const there = readdirSync(folder).filter((name) => name.startsWith('page-') && name.endsWith('.ktx2')).length;
  check(files.size === there && files.size > 5, `${folder}: ${files.size} textures of ${there}`);
}

const folder = mkdtempSync(join(tmpdir(), 'lobelia-ktx2-'));
try {
  execFileSync(process.argv[2], [folder], { stdio: 'inherit' });
  const there = readdirSync(folder).filter((name) => name.endsWith('.ktx2')).length;
  check(there === Object.keys(formats).length, `${there} formats`);
  for (const name of Object.keys(formats)) {
    check(existsSync(join(folder, `${name}.ktx2`)), `${name}: no file`);
    checkFormat(folder, name);
  }
  for (const shape of Object.keys(shapes)) for (const zstd of [false, true]) checkShape(join(folder, 'shapes'), shape, zstd);
  for (const bake of ['sh1', 'sg12']) checkBake(join(folder, bake), { levels: 1, zstd: false });
  checkBake(join(folder, 'sh1-levels'), { levels: 3, zstd: true });
} finally {
  rmSync(folder, { recursive: true });
}
console.log(`${checks - failures} passed, ${failures} failed`);
process.exit(failures ? 1 : 0);
