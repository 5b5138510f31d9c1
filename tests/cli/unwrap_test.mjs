// lobelia unwrap's script, on scenes that have misled such tools. Exit code 77 without the packages that it uses.
//
//   node unwrap_test.mjs FOLDER-OF-UNWRAP.MJS
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import assert from 'node:assert/strict';

const tools = resolve(process.argv[2]);
let Document, NodeIO;
try {
  ({ Document, NodeIO } = await import(createRequire(join(tools, 'unwrap.mjs')).resolve('@gltf-transform/core')));
} catch {
  console.log('the packages that unwrap.mjs uses are missing (setup/packages node)');
  process.exit(77);
}
const folder = mkdtempSync(join(tmpdir(), 'lobelia-unwrap-'));

/// A scene, and functions that fill it.
class Maker {
  constructor() {
    this.document = new Document();
    this.buffer = this.document.createBuffer();
    this.scene = this.document.createScene();
    this.document.getRoot().setDefaultScene(this.scene);
  }
  accessor(type, array) { return this.document.createAccessor().setType(type).setArray(array).setBuffer(this.buffer); }
  /// A square of this side in the plane y = height, as a node of this name in the scene.
  square(name, side, { height = 0, scene = this.scene, at = [0, 0, 0] } = {}) {
    const h = side / 2;
    const primitive = this.document.createPrimitive()
      .setAttribute('POSITION', this.accessor('VEC3', new Float32Array([-h, height, -h, -h, height, h, h, height, h, h, height, -h])))
      .setIndices(this.accessor('SCALAR', new Uint16Array([0, 1, 2, 0, 2, 3])));
    const node = this.document.createNode(name).setMesh(this.document.createMesh().addPrimitive(primitive)).setTranslation(at);
    scene?.addChild(node);
    return primitive;
  }
}

async function unwrapped(maker, options = {}) {
  const [input, output] = [join(folder, 'in.glb'), join(folder, 'out.glb')];
  await new NodeIO().write(input, maker.document);
  const all = { layout: 'shared', size: 64, padding: 2, texelsPerMetre: null, uvSet: 1, ...options };
  const printed = execFileSync('node', [join(tools, 'unwrap.mjs'), input, output, JSON.stringify(all)], { stdio: ['ignore', 'pipe', 'pipe'] });
  return { result: JSON.parse(printed), document: await new NodeIO().read(output) };
}

/// The area of a node's lightmap triangles in the unit square.
function lightmapArea(document, name, semantic = 'TEXCOORD_1') {
  const primitive = document.getRoot().listNodes().find((node) => node.getName() === name).getMesh().listPrimitives()[0];
  const uv = primitive.getAttribute(semantic), indices = primitive.getIndices();
  let area = 0;
  for (let i = 0; i < indices.getCount(); i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => uv.getElement(indices.getScalar(i + k), []));
    area += Math.abs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2;
  }
  return area;
}

const tests = {
  async 'coordinates that a texture uses are kept'() {
    const maker = new Maker();
    const texture = maker.document.createTexture().setImage(new Uint8Array([137, 80, 78, 71])).setMimeType('image/png');
    const lamp = maker.square('lamp', 4);
    const own = new Float32Array([0, 0, 0, 9, 9, 9, 9, 0]);
    lamp.setAttribute('TEXCOORD_0', maker.accessor('VEC2', new Float32Array(8)))
      .setAttribute('TEXCOORD_1', maker.accessor('VEC2', own))
      .setMaterial(maker.document.createMaterial('lamp').setEmissiveTexture(texture));
    lamp.getMaterial().getEmissiveTextureInfo().setTexCoord(1);
    const { document } = await unwrapped(maker);
    const set = document.getRoot().listMaterials()[0].getEmissiveTextureInfo().getTexCoord();
    const primitive = document.getRoot().listMeshes()[0].listPrimitives()[0];
    assert.notEqual(set, 1);
    const seen = new Set(), uv = primitive.getAttribute(`TEXCOORD_${set}`);
    for (let i = 0; i < uv.getCount(); i++) seen.add(uv.getElement(i, []).join());
    assert.deepEqual([...seen].sort(), ['0,0', '0,9', '9,0', '9,9']);
    assert.ok(lightmapArea(document, 'lamp') <= 1);
    for (let i = 0; i < set; i++) assert.ok(primitive.getAttribute(`TEXCOORD_${i}`), `TEXCOORD_${i}`);
  },
  async 'nodes outside of the scene take no room'() {
    const maker = new Maker();
    maker.square('floor', 2);
    maker.square('orphan', 100, { scene: null });
    const { result, document } = await unwrapped(maker);
    assert.equal(result.objects, 1);
    assert.ok(lightmapArea(document, 'floor') > 0.6);
  },
  async 'small objects beside large ones get charts'() {
    const maker = new Maker();
    maker.square('floor', 10);
    maker.square('tiny', 0.0003, { height: 1 });
    const { result, document } = await unwrapped(maker);
    assert.equal(result.charts, 2);
    assert.ok(lightmapArea(document, 'tiny') > 0);
  },
  async 'scenes far from the origin keep their shape'() {
    const maker = new Maker();
    maker.square('floor', 1, { at: [6378000, 0, 0] });
    const { document } = await unwrapped(maker);
    assert.ok(lightmapArea(document, 'floor') > 0.6);
  },
  async 'a page that is too small is told with one that fits'() {
    const maker = new Maker();
    for (let i = 0; i < 400; i++) maker.square(`tile ${i}`, 1, { at: [2 * i, 0, 0] });
    await assert.rejects(unwrapped(maker, { size: 16 }), /400 charts do not fit a page of 16 x 16 .*--size \d+/);
  },
};

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    await test();
    console.log(`ok: ${name}`);
  } catch (error) {
    failed++;
    console.log(`FAILED: ${name}: ${error.message}${error.stderr ?? ''}`);
  }
}
rmSync(folder, { recursive: true });
process.exit(failed ? 1 : 0);
