// Pages read as light.
#include "baker/page_reader.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cassert>

namespace lobelia {

CoefficientReader::CoefficientReader(const Codec& codec)
    : codec_(&codec), size_(codec.basis().size()), rows_(size_ * k_block_size), c_(size_) {}

void CoefficientReader::sum(const FunctionSet& functions, std::span<const float> block, DirectionView directions,
                            MutableColourView out) {
    assert(functions.size() == size_ && block.size() == block_floats());
    assert(directions.size <= k_block_size && out.size == directions.size);
    functions.values(directions, rows_.data());
    for (std::size_t k = 0; k < 3; ++k) {
        float* const to = out.channel(k);
        std::fill(to, to + out.size, 0.0f);
        for (std::size_t i = 0; i < size_; ++i) {
            const float* const c = block.data() + (3 * i + k) * k_block_size;
            const float* const row = rows_.data() + i * k_block_size;
            for (std::size_t j = 0; j < out.size; ++j) to[j] += c[j] * row[j];
        }
    }
}

void CoefficientReader::irradiance(std::span<const float> block, DirectionView normals, MutableColourView out) {
    const Evaluator& evaluator = codec_->evaluator();
    if (const FunctionSet* weights = evaluator.weights()) {
        sum(*weights, block, normals, out);
    } else {
        // Such an evaluator wants one vector of coefficients at a time.
        for (std::size_t j = 0; j < normals.size; ++j) {
            const auto at = [&](std::size_t plane) { return block[plane * k_block_size + j]; };
            for (std::size_t i = 0; i < size_; ++i) c_[i] = {at(3 * i), at(3 * i + 1), at(3 * i + 2)};
            set_entry(one_.view(), 0, direction_at(normals, j));
            evaluator.signed_irradiance(c_, one_, value_);
            set_entry(out, j, colour_at(value_.view(), 0));
        }
    }
    if (evaluator.negative() == Negative::clamped) clamp_negative(out);
}

void CoefficientReader::radiance(std::span<const float> block, DirectionView directions, MutableColourView out) {
    sum(codec_->basis(), block, directions, out);
    if (codec_->evaluator().negative() == Negative::clamped) clamp_negative(out);
}

namespace {

/// Texels [begin, end) of a page, at most k_block_size.
struct TexelRange {
    std::size_t begin = 0, end = 0;
};

void read_range(const Page& page, const BakedLight& light, std::span<const Vec3> normals, TexelRange range,
                CoefficientReader& reader, std::span<Rgb> out) {
    const std::size_t count = range.end - range.begin;
    std::vector<float> block(reader.block_floats());
    for (std::size_t plane = 0; plane < 3 * light.layout.coefficients; ++plane)
        for (std::size_t j = 0; j < count; ++j) block[plane * k_block_size + j] = page.planes[plane][range.begin + j];
    Directions directions(count);
    for (std::size_t j = 0; j < count; ++j) {
        // In its tangent frame every normal is z; where there is none, any direction does.
        const Vec3 n = normals[range.begin + j];
        set_entry(directions.view(), j, light.in_tangent_frame || n == Vec3{} ? Vec3{0, 0, 1} : n);
    }
    Colours values(count);
    reader.irradiance(block, directions, values);
    for (std::size_t j = 0; j < count; ++j)
        if (normals[range.begin + j] != Vec3{}) out[range.begin + j] = colour_at(values.view(), j);
}

std::vector<Rgb> path_irradiance(const Page& page, const PageLayout& layout) {
    std::vector<Rgb> result(page.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = {page.planes[layout.irradiance(0)][i], page.planes[layout.irradiance(1)][i],
                     page.planes[layout.irradiance(2)][i]};
    return result;
}

}  // namespace

std::vector<std::vector<Rgb>> texel_irradiance(const BakedLight& light, std::span<const std::vector<Vec3>> normals) {
    assert(normals.size() == light.pages.size());
    std::vector<std::vector<Rgb>> result;
    for (std::size_t p = 0; p < light.pages.size(); ++p) {
        const Page& page = light.pages[p];
        if (light.codec == nullptr) {
            result.push_back(path_irradiance(page, light.layout));
            continue;
        }
        assert(normals[p].size() == page.size());
        std::vector<Rgb> values(page.size());
        const std::size_t blocks = (page.size() + k_block_size - 1) / k_block_size;
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, 16), [&](const auto& range) {
            CoefficientReader reader(*light.codec);
            for (std::size_t b = range.begin(); b < range.end(); ++b)
                read_range(page, light, normals[p], {b * k_block_size, std::min(page.size(), (b + 1) * k_block_size)},
                           reader, values);
        });
        result.push_back(std::move(values));
    }
    return result;
}

}  // namespace lobelia
