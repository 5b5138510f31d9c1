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

/// The visible nodes of the default scene, parents first: all others are never baked and take no room on a page.
function shownNodes(document) {
  const root = document.getRoot();
  const scene = root.getDefaultScene() ?? root.listScenes()[0];
  if (!scene) return root.listNodes();
  const shown = [];
  const visit = (node) => {
    if (node.getExtension('KHR_node_visibility')?.getVisible() === false) return;
    shown.push(node);
    node.listChildren().forEach(visit);
  };
  scene.listChildren().forEach(visit);
  return shown;
}

/// A mesh that several nodes share is copied, for each place has a light of its own. Copies made by an extension become
/// nodes first.
function separateObjects(document) {
  for (const node of shownNodes(document)) {
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
  const objects = shownNodes(document).filter((node) => node.getMesh());
  // Meshes of nodes that are not shown stay as they are.
  const seen = new Set(document.getRoot().listNodes().filter((node) => !objects.includes(node)).map((node) => node.getMesh()));
  for (const node of objects) {
    if (seen.has(node.getMesh())) node.setMesh(copyOf(document, node.getMesh()));
    seen.add(node.getMesh());
  }
  return objects;
}

/// The set of texture coordinates that a texture uses.
const setOf = (info) => info.getExtension('KHR_texture_transform')?.getTexCoord() ?? info.getTexCoord();

/// All texture infos of a material, those of its extensions, too.
function textureInfos(document, material) {
  const children = document.getGraph().listChildren(material);
  const extended = children.filter((child) => child.propertyType !== 'Texture' && child.propertyType !== 'TextureInfo')
    .flatMap((child) => document.getGraph().listChildren(child));
  return [...children, ...extended].filter((child) => child.propertyType === 'TextureInfo');
}

/// Moves the coordinates of textures that use the lightmap's set to a set that nothing uses.
function makeRoom(document) {
  const materials = document.getRoot().listMaterials();
  const primitives = document.getRoot().listMeshes().flatMap((mesh) => mesh.listPrimitives());
  const semantic = `TEXCOORD_${options.uvSet}`;
  const moved = new Set(primitives.filter((primitive) => primitive.getAttribute(semantic) && primitive.getMaterial())
    .map((primitive) => primitive.getMaterial())
    .filter((material) => textureInfos(document, material).some((info) => setOf(info) === options.uvSet
      && hasTexture(document, info))));
  if (moved.size === 0) return;
  const sets = primitives.flatMap((primitive) => primitive.listSemantics())
    .filter((name) => name.startsWith('TEXCOORD_')).map((name) => Number(name.slice(9)));
  const free = 1 + Math.max(options.uvSet, ...sets);
  for (const material of moved)
    for (const info of textureInfos(document, material)) {
      if (setOf(info) !== options.uvSet) continue;
      info.setTexCoord(free);
      info.getExtension('KHR_texture_transform')?.setTexCoord(null);
    }
  for (const primitive of primitives)
    if (moved.has(primitive.getMaterial()) && primitive.getAttribute(semantic))
      primitive.setAttribute(`TEXCOORD_${free}`, primitive.getAttribute(semantic));
}

/// False for the texture info of a slot without a texture.
function hasTexture(document, info) {
  return document.getGraph().listParents(info).some((owner) =>
    document.getGraph().listChildren(owner).some((child) => child.propertyType === 'Texture'));
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
  if (!primitive.getAttribute('POSITION')) return null;
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

/// Positions in the world, so that charts are as large as what they show.
function worldPositions(primitive, m) {
  const accessor = primitive.getAttribute('POSITION');
  const positions = new Float64Array(3 * accessor.getCount());
  const p = [];
  for (let i = 0; i < accessor.getCount(); i++) {
    accessor.getElement(i, p);
    for (let row = 0; row < 3; row++)
      positions[3 * i + row] = m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
  }
  return positions;
}

/// xatlas drops edges and triangles below fixed lengths and areas. Moves all parts near zero, and scales them up where the
/// shortest edge is shorter than a centimetre. Returns the scale.
function normalise(parts) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  let shortest = Infinity;
  for (const { positions, indices } of parts) {
    for (let i = 0; i < positions.length; i++) {
      low[i % 3] = Math.min(low[i % 3], positions[i]);
      high[i % 3] = Math.max(high[i % 3], positions[i]);
    }
    for (let i = 0; i < indices.length; i++) {
      const a = 3 * indices[i], b = 3 * indices[i % 3 === 2 ? i - 2 : i + 1];
      const edge = Math.hypot(...[0, 1, 2].map((k) => positions[a + k] - positions[b + k]));
      if (edge > 0) shortest = Math.min(shortest, edge);
    }
  }
  const size = Math.max(...high.map((x, k) => x - low[k]));
  const scale = Math.max(1, Math.min(0.01 / shortest, 1e6 / size));
  for (const part of parts)
    part.positions = Float32Array.from(part.positions, (x, i) => (x - low[i % 3]) * scale);
  return scale;
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

/// Packs the charts into one page, of a scene that was scaled. Without a density, as dense as fits a page of the size
/// asked for.
function pack(atlas, scale) {
  const packed = (texelsPerMetre) => {
    const texelsPerUnit = texelsPerMetre / scale;
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
  let low = 0, high = Math.max(atlas.texelsPerUnit * scale, 1e-6);
  while (packed(high) <= size && high < 1e9) [low, high] = [high, 2 * high];
  for (let i = 0; i < 8; i++) {
    const middle = low > 0 ? Math.sqrt(low * high) : high / 2;
    if (packed(middle) <= size) low = middle; else high = middle;
  }
  if (!(low > 0)) {
    const needed = Math.ceil(packed(1e-6) / 16) * 16;
    throw new Error(`${atlas.chartCount} charts do not fit a page of ${size} x ${size} texels, for each takes at least `
      + `one texel and its padding; they fit one of ${needed} x ${needed} (--size ${needed})`);
  }
  packed(low);
  return { size, density: low };
}

function makeAtlas(parts, scale) {
  const atlas = new watlas.Atlas();
  for (const { positions, indices } of parts)
    atlas.addMesh({ vertexCount: positions.length / 3, vertexPositionData: positions, vertexPositionStride: 12,
      indexCount: indices.length, indexData: indices });
  atlas.computeCharts({});
  const page = pack(atlas, scale);
  if (atlas.atlasCount !== 1) throw new Error(`xatlas made ${atlas.atlasCount} pages instead of one`);
  return { atlas, page };
}

/// xatlas may put charts far below the size of a texel onto others: their parts are enlarged to some texels. Returns
/// whether there are any.
function enlargeTinyParts(parts, atlas, density) {
  const tiny = parts.filter((_, i) => {
    const mesh = atlas.getMesh(i);
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    for (let v = 0; v < mesh.vertexCount; v++) {
      const { atlasIndex, uv } = mesh.getVertex(v);
      for (let k = 0; k < 2 && atlasIndex >= 0; k++) {
        low[k] = Math.min(low[k], uv[k]);
        high[k] = Math.max(high[k], uv[k]);
      }
    }
    return Math.max(high[0] - low[0], high[1] - low[1]) < 0.5;
  });
  const texels = 3;
  for (const part of tiny) {
    const corner = part.positions.slice(0, 3);
    let size = 0;
    part.positions.forEach((x, i) => { size = Math.max(size, Math.abs(x - corner[i % 3])); });
    if (size > 0) part.positions = part.positions.map((x, i) => (x - corner[i % 3]) * texels / (size * density));
  }
  return tiny.length > 0;
}

/// Makes charts of all primitives of the nodes, and sets their new vertices.
function unwrap(document, nodes) {
  const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  const parts = [];
  for (const node of nodes)
    for (const primitive of node.getMesh().listPrimitives()) {
      const indices = triangleIndices(primitive);
      if (!indices || indices.length === 0) continue;
      // The transform of a skinned node is ignored.
      const positions = worldPositions(primitive, node.getSkin() ? identity : node.getWorldMatrix());
      parts.push({ name: node.getName(), primitive, positions, indices });
    }
  if (parts.length === 0) return null;
  const scale = normalise(parts);
  let { atlas, page } = makeAtlas(parts, scale);
  if (enlargeTinyParts(parts, atlas, page.density / scale)) {
    atlas.delete();
    ({ atlas, page } = makeAtlas(parts, scale));
  }
  parts.forEach(({ name, primitive }, i) => setVertices(document, name, primitive, atlas.getMesh(i), page.size));
  const result = { ...page, charts: atlas.chartCount };
  atlas.delete();
  return result;
}

function setVertices(document, name, primitive, mesh, size) {
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
  let inCharts = 0;
  for (let i = 0; i < mesh.vertexCount; i++) {
    const vertex = mesh.getVertex(i);
    // Triangles without area lie in no chart.
    if (vertex.atlasIndex < 0) continue;
    uv.set([vertex.uv[0] / size, vertex.uv[1] / size], 2 * i);
    inCharts++;
  }
  if (inCharts === 0)
    throw new Error(`xatlas made no charts of "${name}": its triangles have no area, or one that is too small beside the `
      + 'scene');
  const buffer = document.getRoot().listBuffers()[0];
  const accessor = document.createAccessor('lightmap', buffer).setType('VEC2').setArray(uv);
  // Sets are numbered without gaps.
  const sets = primitive.listSemantics().filter((set) => set.startsWith('TEXCOORD_')).map((set) => Number(set.slice(9)));
  for (let set = 0; set <= Math.max(options.uvSet, ...sets); set++)
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
  makeRoom(document);
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
