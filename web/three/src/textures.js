// KTX 2.0 files of a bake as textures of three.js: single ones and arrays, with mip levels, compressed by zstd or not.
import * as THREE from "three";
import { read } from "three/addons/libs/ktx-parse.module.js";
import { ZSTDDecoder } from "three/addons/libs/zstddec.module.js";

import { BakeError, fetched } from "./errors.js";

/// What three.js calls each VkFormat that Lobelia writes. `view` reads the bytes; without it, they are blocks.
const formats = {
    9: { format: THREE.RedFormat, type: THREE.UnsignedByteType, view: Uint8Array, channels: 1 },
    16: { format: THREE.RGFormat, type: THREE.UnsignedByteType, view: Uint8Array, channels: 2 },
    37: { format: THREE.RGBAFormat, type: THREE.UnsignedByteType, view: Uint8Array, channels: 4 },
    64: null, // A2B10G10R10: three.js has no such type; widened below
    76: { format: THREE.RedFormat, type: THREE.HalfFloatType, view: Uint16Array, channels: 1 },
    83: { format: THREE.RGFormat, type: THREE.HalfFloatType, view: Uint16Array, channels: 2 },
    97: { format: THREE.RGBAFormat, type: THREE.HalfFloatType, view: Uint16Array, channels: 4 },
    100: { format: THREE.RedFormat, type: THREE.FloatType, view: Float32Array, channels: 1 },
    103: { format: THREE.RGFormat, type: THREE.FloatType, view: Float32Array, channels: 2 },
    109: { format: THREE.RGBAFormat, type: THREE.FloatType, view: Float32Array, channels: 4 },
    123: { format: THREE.RGBFormat, type: THREE.UnsignedInt5999Type, view: Uint32Array, channels: 1 },
    143: { format: THREE.RGB_BPTC_UNSIGNED_Format },
    144: { format: THREE.RGB_BPTC_SIGNED_Format },
};

/// Ten bits of three channels as halves, which three.js can upload and filter.
function widened(bytes) {
    const words = new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.byteLength / 4);
    const halves = new Uint16Array(4 * words.length);
    for (let i = 0; i < words.length; ++i)
        for (let k = 0; k < 4; ++k)
            halves[4 * i + k] = THREE.DataUtils.toHalfFloat(k < 3 ? ((words[i] >>> (10 * k)) & 1023) / 1023 : (words[i] >>> 30) / 3);
    return halves;
}

let zstd;
async function decompressed(level) {
    zstd ??= new ZSTDDecoder();
    await zstd.init();
    return zstd.decode(level.levelData, level.uncompressedByteLength);
}

/// A copy that begins at a multiple of 4 bytes, as typed arrays need it.
const aligned = (bytes) => (bytes.byteOffset % 4 === 0 ? bytes : bytes.slice());

function configured(texture, levels, decoded) {
    const filter = decoded ? THREE.NearestFilter : THREE.LinearFilter;
    texture.magFilter = filter;
    texture.minFilter = levels > 1 && !decoded ? THREE.LinearMipmapLinearFilter : filter;
    texture.wrapS = texture.wrapT = THREE.ClampToEdgeWrapping;
    texture.colorSpace = THREE.NoColorSpace;
    texture.generateMipmaps = false;
    texture.flipY = false;
    texture.unpackAlignment = 1;
    texture.needsUpdate = true;
    return texture;
}

/// Reads a file. Returns { textures, isArray }: one array texture, or one texture for each layer. `decoded`: the bytes
/// are a format that only the shader decodes, so they are not to be filtered.
export async function readTextures(url, decoded) {
    const bytes = new Uint8Array(await (await fetched(url)).arrayBuffer());
    let file;
    try {
        file = read(bytes);
    } catch (error) {
        throw new BakeError(`${url}: not a KTX 2.0 file (${error.message})`);
    }
    if (!(file.vkFormat in formats)) throw new BakeError(`${url}: the format ${file.vkFormat} is not one of a bake's`);
    if (file.supercompressionScheme !== 0 && file.supercompressionScheme !== 2)
        throw new BakeError(`${url}: supercompression scheme ${file.supercompressionScheme} is not supported`);
    const levels = await Promise.all(
        file.levels.map((level) => (file.supercompressionScheme === 2 ? decompressed(level) : level.levelData)));
    const facts = formats[file.vkFormat] ?? { format: THREE.RGBAFormat, type: THREE.HalfFloatType, view: null, channels: 4 };
    const isBlock = "format" in facts && !("channels" in facts);
    const typed = (data) => {
        if (file.vkFormat === 64) return widened(aligned(data));
        if (isBlock || facts.view === Uint8Array) return data;
        const start = aligned(data);
        return new facts.view(start.buffer, start.byteOffset, start.byteLength / facts.view.BYTES_PER_ELEMENT);
    };
    const size = (i) => [Math.max(file.pixelWidth >> i, 1), Math.max(file.pixelHeight >> i, 1)];
    const count = Math.max(file.layerCount, 1), isArray = file.layerCount > 0;
    if (isArray && levels.length === 1) {
        const [width, height] = size(0);
        const texture = isBlock
            ? new THREE.CompressedArrayTexture([{ data: levels[0], width, height }], width, height, count, facts.format, THREE.HalfFloatType)
            : new THREE.DataArrayTexture(typed(levels[0]), width, height, count);
        texture.format = facts.format;
        if (!isBlock) texture.type = facts.type;
        return { textures: [configured(texture, 1, decoded)], isArray: true };
    }

    // three.js uploads no mip levels of array textures that are not blocks: a texture for each layer.
    const textures = [];
    for (let layer = 0; layer < count; ++layer) {
        const mipmaps = levels.map((data, i) => {
            const [width, height] = size(i), length = data.byteLength / count;
            return { data: typed(data.subarray(layer * length, (layer + 1) * length)), width, height };
        });
        const [width, height] = size(0);
        const texture = isBlock
            ? new THREE.CompressedTexture(mipmaps, width, height, facts.format, THREE.HalfFloatType)
            : new THREE.DataTexture(mipmaps[0].data, width, height, facts.format, facts.type);
        if (!isBlock && mipmaps.length > 1) texture.mipmaps = mipmaps;
        textures.push(configured(texture, mipmaps.length, decoded));
    }
    return { textures, isArray: false };
}
