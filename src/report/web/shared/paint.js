// Paints canvases: only those on the screen, and once per frame at most.

const painters = new Map(); // canvas -> function that paints it
const on_screen = new Set();
const to_paint = new Set();
let frame_asked = false;

function ask_for_frame() {
    if (frame_asked) return;
    frame_asked = true;
    requestAnimationFrame(() => {
        frame_asked = false;
        for (const canvas of to_paint) {
            if (!on_screen.has(canvas)) continue;
            to_paint.delete(canvas);
            painters.get(canvas)?.(canvas);
        }
    });
}

const screen_observer = new IntersectionObserver(
    (entries) => {
        for (const { target, isIntersecting } of entries) {
            if (isIntersecting) on_screen.add(target);
            else on_screen.delete(target);
        }
        ask_for_frame();
    },
    { rootMargin: "200px" },
);

export function painted(canvas, paint) {
    painters.set(canvas, paint);
    to_paint.add(canvas);
    screen_observer.observe(canvas);
    return canvas;
}

/// Call before the canvases under `root` are thrown away.
export function forget_canvases(root) {
    for (const canvas of root.querySelectorAll("canvas")) {
        screen_observer.unobserve(canvas);
        for (const set of [painters, on_screen, to_paint]) set.delete(canvas);
    }
}

/// Paints again what the view has changed: all canvases, or those of one class.
export function repaint(selector = "canvas") {
    for (const canvas of painters.keys()) if (canvas.matches(selector)) to_paint.add(canvas);
    ask_for_frame();
}
