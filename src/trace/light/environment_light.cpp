// Sampling tables over the environment's texels.
#include "trace/light/environment_light.h"

#include <cassert>
#include <cmath>
#include <numeric>

#include "core/sample/directions.h"

namespace lobelia {
namespace {

constexpr auto k_uniform_pdf = static_cast<float>(1 / (4 * k_pi));

}  // namespace

EnvironmentLight::EnvironmentLight(const Image& image, Choice choice) : image_(&image), choice_(choice) {
    for (std::size_t y = 0; y <= image.height; ++y)
        cosine_.push_back(
            static_cast<float>(std::cos(k_pi * static_cast<double>(y) / static_cast<double>(image.height))));
    std::vector<float> row_weights(image.height), weights(image.width);
    double total = 0;
    columns_.reserve(image.height);
    for (std::size_t y = 0; y < image.height; ++y) {
        for (std::size_t x = 0; x < image.width; ++x) weights[x] = brightness(image.at(x, y));
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        const double share = static_cast<double>(cosine_[y] - cosine_[y + 1]) / 2;
        row_weights[y] = static_cast<float>(sum * share);
        total += sum * share / static_cast<double>(image.width);
        // A black row is never chosen, but its table must exist.
        if (sum == 0) weights.assign(image.width, 1.0f);
        columns_.emplace_back(weights);
    }
    assert(total > 0);
    rows_.emplace_back(row_weights);
    mean_luminance_ = static_cast<float>(total);
    density_ = static_cast<float>(1 / (4 * k_pi * total));
}

EnvironmentLight::Texel EnvironmentLight::texel(Vec3 direction) const {
    // Compute LatLong::index in single precision, with rows separated by the table that directions are sampled from. A
    // row is 2.2e-5 of half a turn or more up to 45,000 rows, hence the guess is off by one at most.
    const auto cell = [](float at, std::size_t n) {
        return std::min(static_cast<std::size_t>(std::max(0.0f, at) * static_cast<float>(n)), n - 1);
    };
    std::size_t y = cell(rough_half_turns_of(direction.y), image_->height);
    if (y > 0 && direction.y > cosine_[y]) --y;
    if (y + 1 < image_->height && direction.y < cosine_[y + 1]) ++y;
    const std::size_t x = cell(0.5f + turns_of(direction.x, -direction.z), image_->width);
    return {x, y, y * image_->width + x};
}

EnvironmentSample EnvironmentLight::evaluate(const Drawn& drawn) const {
    // The probability of a texel is its luminance times its solid angle, over the sum of these products. Dividing by
    // the texel's solid angle for the density cancels that factor.
    const Rgb radiance = image_->pixels[drawn.texel];
    const float pdf = choice_ == Choice::uniform ? k_uniform_pdf : brightness(radiance) * density_;
    return {drawn.direction, radiance, pdf};
}

EnvironmentLight::Drawn EnvironmentLight::draw(Pair point) const {
    if (choice_ == Choice::uniform) {
        const Vec3 direction = around_z(1 - 2 * point.a, point.b);
        return {direction, texel(direction).index};
    }
    const auto [y, row_rest] = rows_[0].sample(static_cast<double>(point.a));
    const auto [x, column_rest] = columns_[y].sample(static_cast<double>(point.b));
    const float height = cosine_[y] + static_cast<float>(row_rest) * (cosine_[y + 1] - cosine_[y]);
    const float r = std::sqrt(std::max(0.0f, 1 - height * height));
    const auto turn = static_cast<float>((static_cast<double>(x) + column_rest) / static_cast<double>(image_->width));
    // Column u has the azimuth pi (2 u - 1) (docs/conventions.md): half a turn is a change of sign.
    const auto [c, s] = cos_sin_turns(turn);
    return {{-r * s, height, r * c}, y * image_->width + x};
}

float EnvironmentLight::pdf(Vec3 direction) const { return at(direction).pdf; }

Pair EnvironmentLight::inverse(Vec3 direction) const {
    if (choice_ == Choice::uniform) {
        const double turn = std::atan2(static_cast<double>(direction.y), static_cast<double>(direction.x)) / (2 * k_pi);
        return {(1 - direction.z) / 2, static_cast<float>(turn < 0 ? turn + 1 : turn)};
    }
    const Texel t = texel(direction);
    const double row_rest = static_cast<double>((direction.y - cosine_[t.y]) / (cosine_[t.y + 1] - cosine_[t.y]));
    const double column = LatLong::position(direction).u * static_cast<double>(image_->width);
    return {static_cast<float>(rows_[0].inverse({t.y, std::clamp(row_rest, 0.0, 1.0)})),
            static_cast<float>(columns_[t.y].inverse({t.x, std::clamp(column - static_cast<double>(t.x), 0.0, 1.0)}))};
}

}  // namespace lobelia
