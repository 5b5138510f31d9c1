// Gives every surface of a glTF scene lightmap UVs: watlas (xatlas) makes the charts, glTF-Transform reads and writes.
//
//   node unwrap.mjs IN OUT.glb '{"layout":"shared","size":1024,"padding":4,"texelsPerMetre":null,"uvSet":1}'
//
// shared: all objects lie in one UV square together. object: each has a square of its own. Prints the result as JSON on
// standard output; messages go to standard error. Exit code 0, or 2 for anything wrong.
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import * as watlas from 'watlas';

const [input, output, optionText] = process.argv.slice(2);
const options = JSON.parse(optionText);
const TRIANGLES = 4, STRIP = 5, FAN = 6;

/// A mesh that several nodes share is copied, for each place has a light of its own. Copies made by an extension become
/// nodes first.
function separateObjects(document) {
  for (const node of document.getRoot().listNodes()) {
    const batch = node.getExtension('EXT_mesh_gpu_instancing');
    if (!batch || !node.getMesh()) continue;
    const count = batch.listAttributes()[0]?.getCount() ?? 0;
    for (let i = 0; i < count; i++) {
      const copy = document.createNode(`${node.getName()} ${i}`).setMesh(node.getMesh());
      const set = (name, target) => {
        const values = batch.getAttribute(name);
        if (values) target.call(copy, values.getElement(i, []));
      };
      set('TRANSLATION', copy.setTranslation);
      set('ROTATION', copy.setRotation);
      set('SCALE', copy.setScale);
      node.addChild(copy);
    }
    node.setMesh(null).setExtension('EXT_mesh_gpu_instancing', null);
  }
  const seen = new Set();
  const objects = [];
  for (const node of document.getRoot().listNodes()) {
    if (!node.getMesh()) continue;
    if (seen.has(node.getMesh())) node.setMesh(copyOf(document, node.getMesh()));
    seen.add(node.getMesh());
    objects.push(node);
  }
  return objects;
}

function copyOf(document, mesh) {
  const copy = mesh.clone();
  for (const primitive of copy.listPrimitives()) {
    copy.removePrimitive(primitive);
    copy.addPrimitive(primitive.clone());
  }
  return copy;
}

/// The vertices of a primitive's triangles, three by three; null where it has none.
function triangleIndices(primitive) {
  const mode = primitive.getMode();
  if (mode !== TRIANGLES && mode !== STRIP && mode !== FAN) return null;
  const accessor = primitive.getIndices();
  const count = accessor ? accessor.getCount() : primitive.getAttribute('POSITION').getCount();
  const at = (i) => (accessor ? accessor.getScalar(i) : i);
  if (mode === TRIANGLES) return Uint32Array.from({ length: count - (count % 3) }, (_, i) => at(i));
  const indices = new Uint32Array(Math.max(0, 3 * (count - 2)));
  for (let t = 0; t + 2 < count; t++) {
    const corners = mode === FAN ? [t + 1, t + 2, 0] : [t, t + 1 + (t % 2), t + 2 - (t % 2)];
    indices.set(corners.map(at), 3 * t);
  }
  return indices;
}

/// Positions in the world, in metres, so that charts are as large as what they show.
function worldPositions(primitive, m) {
  const accessor = primitive.getAttribute('POSITION');
  const positions = new Float32Array(3 * accessor.getCount());
  const p = [];
  for (let i = 0; i < accessor.getCount(); i++) {
    accessor.getElement(i, p);
    for (let row = 0; row < 3; row++)
      positions[3 * i + row] = m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
  }
  return positions;
}

/// An attribute with the vertices in xatlas's order, some of them several times.
function remapped(document, accessor, mesh) {
  const source = accessor.getArray();
  const size = accessor.getElementSize();
  const target = new source.constructor(size * mesh.vertexCount);
  for (let i = 0; i < mesh.vertexCount; i++) {
    const from = mesh.getVertex(i).xref * size;
    for (let k = 0; k < size; k++) target[size * i + k] = source[from + k];
  }
  return document.createAccessor(accessor.getName(), accessor.getBuffer())
    .setType(accessor.getType()).setNormalized(accessor.getNormalized()).setArray(target);
}

/// Packs the charts into one page. Without a density, as dense as fits a page of the size asked for.
function pack(atlas) {
  const packed = (texelsPerUnit) => {
    atlas.packCharts({ padding: options.padding, bilinear: true, resolution: 0, texelsPerUnit });
    return Math.max(atlas.width, atlas.height);
  };
  if (options.texelsPerMetre) {
    const needed = packed(options.texelsPerMetre);
    if (options.size && needed > options.size)
      throw new Error(`at ${options.texelsPerMetre} texels per metre the charts need a page of ${needed} x ${needed} `
        + `texels, which is more than --size ${options.size}; ask for fewer, or use --layout object, whose objects `
        + 'are packed into as many pages as it takes');
    return { size: options.size ?? Math.ceil(needed / 16) * 16, density: options.texelsPerMetre };
  }
  // Bisect: sizes grow with the density, though not evenly.
  const size = options.size ?? 1024;
  packed(0);
  let low = 0, high = Math.max(atlas.texelsPerUnit, 1e-6);
  while (packed(high) <= size && high < 1e9) [low, high] = [high, 2 * high];
  for (let i = 0; i < 8; i++) {
    const middle = low > 0 ? Math.sqrt(low * high) : high / 2;
    if (packed(middle) <= size) low = middle; else high = middle;
  }
  if (!(low > 0)) throw new Error(`the charts do not fit a page of ${size} x ${size} texels`);
  packed(low);
  return { size, density: low };
}

/// Makes charts of all primitives of the nodes, and sets their new vertices.
function unwrap(document, nodes) {
  const parts = [];
  const atlas = new watlas.Atlas();
  for (const node of nodes)
    for (const primitive of node.getMesh().listPrimitives()) {
      const indices = triangleIndices(primitive);
      if (!indices || indices.length === 0) continue;
      const positions = worldPositions(primitive, node.getWorldMatrix());
      atlas.addMesh({ vertexCount: positions.length / 3, vertexPositionData: positions, vertexPositionStride: 12,
        indexCount: indices.length, indexData: indices });
      parts.push(primitive);
    }
  if (parts.length === 0) return null;
  atlas.computeCharts({});
  const page = pack(atlas);
  if (atlas.atlasCount !== 1) throw new Error(`xatlas made ${atlas.atlasCount} pages instead of one`);
  parts.forEach((primitive, i) => setVertices(document, primitive, atlas.getMesh(i), page.size));
  const result = { ...page, charts: atlas.chartCount };
  atlas.delete();
  return result;
}

function setVertices(document, primitive, mesh, size) {
  const semantic = `TEXCOORD_${options.uvSet}`;
  primitive.setAttribute(semantic, null);
  const done = new Map();
  const replace = (owner) => {
    for (const name of owner.listSemantics()) {
      const old = owner.getAttribute(name);
      if (!done.has(old)) done.set(old, remapped(document, old, mesh));
      owner.setAttribute(name, done.get(old));
    }
  };
  replace(primitive);
  primitive.listTargets().forEach(replace);
  const uv = new Float32Array(2 * mesh.vertexCount);
  for (let i = 0; i < mesh.vertexCount; i++) {
    const vertex = mesh.getVertex(i);
    // Triangles without area lie in no chart.
    if (vertex.atlasIndex >= 0) uv.set([vertex.uv[0] / size, vertex.uv[1] / size], 2 * i);
  }
  const buffer = document.getRoot().listBuffers()[0];
  const accessor = document.createAccessor('lightmap', buffer).setType('VEC2').setArray(uv);
  // Sets are numbered without gaps.
  for (let set = 0; set <= options.uvSet; set++)
    if (set === options.uvSet || !primitive.getAttribute(`TEXCOORD_${set}`))
      primitive.setAttribute(`TEXCOORD_${set}`, accessor);
  const indices = new Uint32Array(mesh.indexCount);
  mesh.getIndexArray(indices);
  primitive.setMode(TRIANGLES).setIndices(document.createAccessor('', buffer).setType('SCALAR').setArray(indices));
}

/// Accessors that nothing refers to any more, and all buffers but one, which a .glb may not have.
function tidy(document) {
  const root = document.getRoot();
  const [first, ...others] = root.listBuffers();
  for (const accessor of root.listAccessors()) {
    if (accessor.listParents().every((parent) => parent === root)) accessor.dispose();
    else accessor.setBuffer(first);
  }
  others.forEach((buffer) => buffer.dispose());
}

async function main() {
  await watlas.Initialize();
  const io = new NodeIO().registerExtensions(ALL_EXTENSIONS);
  const document = await io.read(input);
  if (document.getRoot().listBuffers().length === 0) document.createBuffer();
  const objects = separateObjects(document);
  const groups = options.layout === 'shared' ? [objects] : objects.map((object) => [object]);
  const results = groups.map((group) => unwrap(document, group)).filter((result) => result);
  if (results.length === 0) throw new Error('there are no triangles to unwrap');
  tidy(document);
  await io.write(output, document);
  console.log(JSON.stringify({
    objects: objects.length,
    charts: results.reduce((sum, result) => sum + result.charts, 0),
    size: results.reduce((most, result) => Math.max(most, result.size), 0),
    density: results.reduce((least, result) => Math.min(least, result.density), Infinity),
  }));
}

main().catch((error) => {
  console.error(error.message);
  process.exitCode = 2;
});
