// Irradiance of a whole page, read from its coefficients.
#include "bake/solve/page_irradiance.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

#include "lobelia/evaluate.h"

namespace lobelia {
std::vector<Rgb> page_irradiance(const LightmapPage& page, const PageChannels& channels, std::span<const Vec3> normals,
                                 Frame frame, const Evaluator& evaluator) {
    assert(normals.size() == page.size() && page.planes.size() == channels.count());
    std::vector<Rgb> result(page.size());
    const auto read = [&](std::size_t begin, std::size_t end) {
        // Use an arbitrary direction where nothing was baked.
        Directions directions(end - begin);
        const auto is_baked = [&](std::size_t i) { return !(normals[i] == Vec3{}); };
        for (std::size_t i = begin; i < end; ++i)
            set_entry(directions.view(), i - begin, frame == Frame::world && is_baked(i) ? normals[i] : Vec3{0, 0, 1});
        std::vector<const float*> c(3 * channels.coefficients);
        for (std::size_t plane = 0; plane < c.size(); ++plane) c[plane] = page.planes[plane].data() + begin;
        Colours values(end - begin);
        irradiance(evaluator, c, directions, values);
        for (std::size_t i = begin; i < end; ++i)
            if (is_baked(i)) result[i] = colour_at(values.view(), i - begin);
    };
    const std::size_t blocks = (page.size() + k_block_size - 1) / k_block_size;
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
        read(block * k_block_size, std::min((block + 1) * k_block_size, page.size()));
    });
    return result;
}

}  // namespace lobelia
