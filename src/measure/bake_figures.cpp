// Sums over the texels of each object.
#include "measure/bake_figures.h"

#include <cassert>
#include <cmath>

namespace lobelia {
namespace {

/// Sums over an object's valid texels.
struct ObjectSums {
    std::array<double, 3> irradiance{};
    double squared_error = 0, squared_codec_error = 0;
};

double over(double a, double b) { return b > 0 ? a / b : 0; }

void include(TexelBox& box, std::size_t x, std::size_t y, bool is_first) {
    const auto column = static_cast<int>(x), row = static_cast<int>(y);
    if (is_first) {
        box = {column, row, column + 1, row + 1};
        return;
    }
    box = {std::min(box.x0, column), std::min(box.y0, row), std::max(box.x1, column + 1), std::max(box.y1, row + 1)};
}

}  // namespace

std::vector<ObjectFigures> object_figures(const Scene& scene, const BakedLight& light,
                                          std::span<const std::uint32_t> object_of_chart,
                                          std::span<const std::vector<Rgb>> codec_irradiance) {
    std::vector<ObjectFigures> figures;
    for (const Object& object : scene.objects) figures.emplace_back().name = object.name;
    std::vector<ObjectSums> sums(figures.size());
    for (std::size_t p = 0; p < light.pages.size(); ++p) {
        const LightmapPage& page = light.pages[p];
        for (std::size_t i = 0; i < page.size(); ++i) {
            if (page.chart[i] == 0 || page.chart[i] > object_of_chart.size()) continue;
            const std::uint32_t number = object_of_chart[page.chart[i] - 1];
            assert(number < figures.size());
            ObjectFigures& object = figures[number];
            include(object.box, i % page.width, i / page.width, object.texels == 0);
            object.page = static_cast<std::uint32_t>(p);
            object.texels += 1;
            if (page.validity[i] < 0.5f) {
                object.invalid += 1;
                continue;
            }
            const auto plane = [&](std::size_t k) { return page.planes[light.channels.irradiance(k)][i]; };
            const Rgb e{plane(0), plane(1), plane(2)};
            const double error = static_cast<double>(page.planes[light.channels.error()][i]);
            ObjectSums& sum = sums[number];
            sum.irradiance[0] += static_cast<double>(e.r);
            sum.irradiance[1] += static_cast<double>(e.g);
            sum.irradiance[2] += static_cast<double>(e.b);
            sum.squared_error += error * error;
            if (codec_irradiance.empty()) continue;
            const double off = static_cast<double>(luminance(codec_irradiance[p][i] - e));
            sum.squared_codec_error += off * off;
        }
    }
    for (std::size_t k = 0; k < figures.size(); ++k) {
        const auto valid = static_cast<double>(figures[k].texels - figures[k].invalid);
        if (valid == 0) continue;
        const auto mean = [&](std::size_t c) { return static_cast<float>(sums[k].irradiance[c] / valid); };
        figures[k].irradiance = {mean(0), mean(1), mean(2)};
        const auto y = static_cast<double>(luminance(figures[k].irradiance));
        figures[k].standard_error = over(std::sqrt(sums[k].squared_error / valid), y);
        figures[k].codec_error = over(std::sqrt(sums[k].squared_codec_error / valid), y);
    }
    return figures;
}

}  // namespace lobelia
