// The handles of lobelia_c.h, and the guard that wraps every call that can fail.
#pragma once

#include <memory>
#include <new>
#include <span>
#include <string>

#include "lobelia/lobelia.h"
#include "lobelia/lobelia_c.h"

struct lob_environment {
    lobelia::Image image;
};

struct lob_codec {
    lobelia::Codec codec;
    std::string name = codec.name().str();
};

struct lob_accumulator {
    lobelia::Accumulator accumulator;
    std::shared_ptr<const lobelia::Encoder> encoder;
    std::string codec;
};

struct lob_textures {
    lobelia::TextureLayout layout;
    std::vector<lobelia::PackedTexture> textures;
    std::size_t width = 0, height = 0;
};

namespace lobelia::c {

/// Keeps the message for lob_error() and returns the status.
lob_status fail(lob_status status, std::string message) noexcept;

/// Calls `body`, which returns a lob_status; exceptions become one.
template <class Body>
lob_status guarded(const Body& body) noexcept {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return fail(LOB_NO_MEMORY, {});
    } catch (const std::exception& e) {
        return fail(LOB_INTERNAL, e.what());
    } catch (...) {
        return fail(LOB_INTERNAL, "unknown exception");
    }
}

/// Refuses null pointers: returns LOB_MISUSE unless all are set.
template <class... Pointers>
[[nodiscard]] lob_status check_pointers(const char* function, const Pointers*... pointers) {
    if ((... && (pointers != nullptr))) return LOB_OK;
    return fail(LOB_MISUSE, std::string(function) + ": a null pointer");
}

/// Refuses an array whose count is not the one required.
[[nodiscard]] inline lob_status check_count(const char* function, std::size_t required, std::size_t given) {
    if (required == given) return LOB_OK;
    return fail(LOB_MISUSE, std::string(function) + ": " + std::to_string(given) + " entries where " +
                                std::to_string(required) + " are required");
}

// Colours are three floats in a row on both sides.
static_assert(sizeof(Rgb) == 3 * sizeof(float) && alignof(Rgb) == alignof(float));
[[nodiscard]] inline std::span<const Rgb> colours(const float* values, std::size_t count) {
    return {reinterpret_cast<const Rgb*>(values), count};
}
[[nodiscard]] inline std::span<Rgb> colours(float* values, std::size_t count) {
    return {reinterpret_cast<Rgb*>(values), count};
}

[[nodiscard]] Samples to_samples(const lob_sample* samples, std::size_t count);

}  // namespace lobelia::c
