// Probes of a bake: spherical harmonics at points of a regular grid, for objects that move.
import * as THREE from "three";

import { BakeError, fetched } from "./errors.js";

/// Probes below this validity lie in walls.
const leastValidity = 0.5;

export class ProbeVolume {
    /// description: probes.json; coefficients: of probes.bin.
    constructor(description, coefficients) {
        this.description = description;
        this.coefficients = coefficients;
    }

    static async load(url) {
        const description = await (await fetched(url)).json();
        if (!description.lobelia_probes) throw new BakeError(`${url}: not the probes.json of a bake`);
        const bytes = await (await fetched(new URL(description.file, url).href)).arrayBuffer();
        const floats = 3 * description.coefficients * description.count;
        if (bytes.byteLength !== 4 * floats)
            throw new BakeError(`${description.file}: ${bytes.byteLength} bytes, but ${description.count} probes take ${4 * floats}`);
        return new ProbeVolume(description, new Float32Array(bytes));
    }

    /// Returns the coefficients at a place [m]: trilinear between the valid probes around it, 3 floats each; null
    /// where there are none. Regular grids only.
    at(position) {
        const { grid, validity, coefficients: count } = this.description;
        if (!grid) throw new BakeError("probes of an adaptive subdivision: bake with --probe-levels 0");
        const cell = [0, 1, 2].map((k) => {
            const steps = grid.count[k] > 1 ? (position.getComponent(k) - grid.origin[k]) / grid.spacing[k] : 0;
            const low = Math.min(Math.max(Math.floor(steps), 0), Math.max(grid.count[k] - 2, 0));
            return { low, along: Math.min(Math.max(steps - low, 0), 1) };
        });
        const sum = new Float32Array(3 * count);
        let total = 0;
        for (let corner = 0; corner < 8; ++corner) {
            const steps = cell.map(({ low }, k) => Math.min(low + ((corner >> k) & 1), grid.count[k] - 1));
            const probe = steps[0] + grid.count[0] * (steps[1] + grid.count[1] * steps[2]);
            if (validity[probe] < leastValidity) continue;
            const weight = cell.reduce((product, { along }, k) => product * ((corner >> k) & 1 ? along : 1 - along), 1);
            total += weight;
            for (let i = 0; i < sum.length; ++i) sum[i] += weight * this.coefficients[sum.length * probe + i];
        }
        return total > 0 ? sum.map((value) => value / total) : null;
    }

    /// Returns a light probe of three.js for a place: degree 2, harmonics only. Add it to the scene beside the object.
    lightProbe(position) {
        if (!/^sh[1-8]\//.test(this.description.codec)) throw new BakeError(`${this.description.codec}: three.js's LightProbe holds spherical harmonics`);
        const c = this.at(position), probe = new THREE.LightProbe();
        if (!c) return probe;
        // three.js has the same order and signs, and no (-1)^m.
        for (let i = 0; i < Math.min(9, c.length / 3); ++i) probe.sh.coefficients[i].set(c[3 * i], c[3 * i + 1], c[3 * i + 2]);
        return probe;
    }
}
