// Storages: coefficients of texels to textures and back.
#include "c/handles.h"

using namespace lobelia;
using namespace lobelia::c;

namespace {

/// Planes of the coefficients of `texels` texels, and their views.
struct PlaneBuffer {
    std::vector<std::vector<float>> planes;

    PlaneBuffer(std::size_t coefficients, std::size_t texels) : planes(3 * coefficients, std::vector<float>(texels)) {}
    template <class View>
    [[nodiscard]] View view(std::size_t width, std::size_t height) {
        return {width, height, std::span(planes), planes.size() / 3};
    }
};

}  // namespace

lob_status lob_pack(const lob_codec* codec, const char* storage, const float* coefficients, size_t width, size_t height,
                    lob_textures** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_pack", codec, storage, coefficients, out)) return status;
        if (width < 1 || height < 1 || width > 16384 || height > 16384)
            return fail(LOB_BAD_INPUT, "lob_pack: width and height must be in 1 to 16384");
        const CoefficientTraits traits = coefficient_traits(*codec->codec.encoder());
        const std::string name = storage;
        const auto found = find_storages({&name, 1}, traits);
        if (!found) return fail(LOB_BAD_INPUT, found.error().message);

        // Transpose: texel after texel to plane after plane.
        const std::size_t texels = width * height;
        PlaneBuffer buffer(traits.count, texels);
        for (std::size_t k = 0; k < buffer.planes.size(); ++k)
            for (std::size_t t = 0; t < texels; ++t) buffer.planes[k][t] = coefficients[buffer.planes.size() * t + k];

        auto textures = std::make_unique<lob_textures>();
        textures->layout = found->front()->layout(traits);
        textures->textures = pack(textures->layout, buffer.view<CoefficientPlanes>(width, height));
        textures->width = width;
        textures->height = height;
        *out = textures.release();
        return LOB_OK;
    });
}

lob_status lob_unpack(const lob_textures* textures, float* coefficients, size_t float_count) {
    return guarded([&] {
        if (auto status = check_pointers("lob_unpack", textures, coefficients)) return status;
        const auto& [layout, packed, width, height] = *textures;
        const std::size_t texels = width * height;
        if (auto status = check_count("lob_unpack", 3 * layout.coefficients * texels, float_count)) return status;
        PlaneBuffer buffer(layout.coefficients, texels);
        unpack(layout, packed, buffer.view<MutableCoefficientPlanes>(width, height));
        for (std::size_t k = 0; k < buffer.planes.size(); ++k)
            for (std::size_t t = 0; t < texels; ++t) coefficients[buffer.planes.size() * t + k] = buffer.planes[k][t];
        return LOB_OK;
    });
}

size_t lob_textures_count(const lob_textures* textures) { return textures == nullptr ? 0 : textures->textures.size(); }

lob_status lob_textures_get(const lob_textures* textures, size_t index, lob_texture* out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_textures_get", textures, out)) return status;
        if (index >= textures->textures.size())
            return fail(LOB_MISUSE, "lob_textures_get: index beyond lob_textures_count()");
        const PackedTexture& texture = textures->textures[index];
        *out = {texture.name.c_str(), info(texture.format).vk_format,
                texture.width,        texture.height,
                texture.scale,        texture.data.data(),
                texture.data.size()};
        return LOB_OK;
    });
}

void lob_textures_free(lob_textures* textures) { delete textures; }
