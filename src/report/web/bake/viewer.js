// A canvas in a frame, to zoom into and to move about: by buttons, keys, wheel, drag and pinch.

const k_most_zoom = 64;

/// Connects `frame`, whose canvas has one pixel for each texel. `hover(event, x, y)` receives the texel under the
/// pointer; `leave()` is called when the pointer leaves.
export function make_viewer(frame, { hover, leave }) {
    const canvas = frame.querySelector("canvas");
    const state = { zoom: 1, x: 0, y: 0 }; // CSS pixels for each texel beyond what fits; the canvas's corner
    const fit = () => Math.min(frame.clientWidth / canvas.width, frame.clientHeight / canvas.height);

    const apply = () => {
        const scale = fit() * state.zoom,
            width = canvas.width * scale,
            height = canvas.height * scale;
        // Keep the page in the frame, or in its middle where it is smaller.
        const held = (corner, size, room) =>
            size <= room ? (room - size) / 2 : Math.min(0, Math.max(room - size, corner));
        state.x = held(state.x, width, frame.clientWidth);
        state.y = held(state.y, height, frame.clientHeight);
        canvas.style.width = `${width}px`;
        canvas.style.height = `${height}px`;
        canvas.style.transform = `translate(${state.x}px, ${state.y}px)`;
        canvas.style.imageRendering = scale * devicePixelRatio > 1.5 ? "pixelated" : "auto";
        frame.classList.toggle("zoomed", state.zoom > 1);
    };

    /// Zooms by a factor about a point of the frame.
    const zoom_at = (factor, px, py) => {
        const zoom = Math.min(k_most_zoom, Math.max(1, state.zoom * factor));
        const change = zoom / state.zoom;
        state.x = px - (px - state.x) * change;
        state.y = py - (py - state.y) * change;
        state.zoom = zoom;
        apply();
    };
    const zoom_middle = (factor) => zoom_at(factor, frame.clientWidth / 2, frame.clientHeight / 2);
    const show_all = () => {
        state.zoom = 1;
        apply();
    };
    /// Shows the box [x0, x1) x [y0, y1) of texels with some room about it.
    const show_box = ([x0, y0, x1, y1]) => {
        const room = 1.3;
        const zoom = Math.min(frame.clientWidth / ((x1 - x0) * room), frame.clientHeight / ((y1 - y0) * room)) / fit();
        state.zoom = Math.min(k_most_zoom, Math.max(1, zoom));
        const scale = fit() * state.zoom;
        state.x = frame.clientWidth / 2 - ((x0 + x1) / 2) * scale;
        state.y = frame.clientHeight / 2 - ((y0 + y1) / 2) * scale;
        apply();
    };

    const texel_at = (event) => {
        const box = canvas.getBoundingClientRect();
        return [
            Math.floor(((event.clientX - box.left) / box.width) * canvas.width),
            Math.floor(((event.clientY - box.top) / box.height) * canvas.height),
        ];
    };
    const pointers = new Map();
    frame.addEventListener("pointerdown", (event) => {
        if (event.button !== 0) return;
        pointers.set(event.pointerId, [event.clientX, event.clientY]);
        frame.setPointerCapture(event.pointerId);
    });
    frame.addEventListener("pointermove", (event) => {
        const before = pointers.get(event.pointerId);
        if (!before) return hover(event, ...texel_at(event));
        const after = [event.clientX, event.clientY];
        if (pointers.size === 1) {
            state.x += after[0] - before[0];
            state.y += after[1] - before[1];
            apply();
        } else {
            // Two fingers: zoom by how far they part.
            const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
            const apart = ([x, y]) => Math.hypot(x - other[0], y - other[1]);
            const box = frame.getBoundingClientRect();
            zoom_at(apart(after) / Math.max(1, apart(before)), (after[0] + other[0]) / 2 - box.left, (after[1] + other[1]) / 2 - box.top);
        }
        pointers.set(event.pointerId, after);
    });
    for (const type of ["pointerup", "pointercancel"])
        frame.addEventListener(type, (event) => pointers.delete(event.pointerId));
    frame.addEventListener("pointerleave", leave);
    frame.addEventListener(
        "wheel",
        (event) => {
            // The page scrolls as ever, unless a key or the focus says that this is meant.
            if (!event.ctrlKey && !event.metaKey && document.activeElement !== frame) return;
            event.preventDefault();
            const box = frame.getBoundingClientRect();
            zoom_at(Math.exp(-event.deltaY / 300), event.clientX - box.left, event.clientY - box.top);
        },
        { passive: false },
    );
    frame.addEventListener("keydown", (event) => {
        const step = 60;
        const moves = { ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
        if (event.key === "+" || event.key === "=") zoom_middle(1.5);
        else if (event.key === "-") zoom_middle(1 / 1.5);
        else if (event.key === "0") show_all();
        else if (moves[event.key] && state.zoom > 1) {
            state.x += moves[event.key][0];
            state.y += moves[event.key][1];
            apply();
        } else return;
        event.preventDefault();
    });
    new ResizeObserver(apply).observe(frame);
    return { apply, zoom_middle, show_all, show_box };
}
