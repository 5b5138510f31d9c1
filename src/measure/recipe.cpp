// The published comparisons: their samples, order, methods, reference and sums.
#include "measure/recipe.h"

#include <oneapi/tbb/parallel_for.h>

#include <chrono>

#include "lobelia/encoders.h"

namespace lobelia {
namespace {

constexpr std::size_t k_sample_count = 20000;
constexpr std::size_t k_reference_draws = 5000;

/// A recipe names its methods, as a published table does: beside codecs.cpp no other file computes by name.
constexpr const char* k_basis = "sg12";
constexpr const char* k_evaluator = "hill";

struct RecipeMethod {
    const char* name;
    enum Order { in_order, shuffled } order;
};
const std::vector<RecipeMethod>& methods_of(Recipe recipe) {
    static const std::vector<RecipeMethod> published = {{"projection", RecipeMethod::in_order},
                                                        {"least-squares", RecipeMethod::in_order},
                                                        {"running-average", RecipeMethod::shuffled},
                                                        {"nnls", RecipeMethod::in_order},
                                                        {"running-average-nn", RecipeMethod::shuffled}};
    static const std::vector<RecipeMethod> updated = {{"projection", RecipeMethod::in_order},
                                                      {"least-squares", RecipeMethod::in_order},
                                                      {"progressive", RecipeMethod::in_order},
                                                      {"nnls", RecipeMethod::in_order},
                                                      {"progressive-nn", RecipeMethod::in_order}};
    return recipe == Recipe::published ? published : updated;
}

std::shared_ptr<const Encoder> encoder_of(const std::string& name, const std::shared_ptr<const LinearBasis>& basis) {
    // The updated post divides by the running mean of B_i^2 (not the clamped one), and feeds it at first with what it
    // prints as the known mean, 4 standing for 4 lambda in the exponent.
    const ProgressiveOptions sampled{.denominator = ProgressiveOptions::Denominator::sampled,
                                     .first_mean_square = static_cast<float>(-std::expm1(-4.0) / (4 * 6.0))};
    if (name == "progressive") return make_progressive(basis, Sign::any, sampled);
    if (name == "progressive-nn") return make_progressive(basis, Sign::non_negative, sampled);
    return make_encoder(name, basis).value();
}

/// E / pi at every texel's direction from one and the same set of draws by luminance times solid angle.
Colours noisy_irradiance_over_pi(const Image& environment) {
    const LatLong grid = lat_long(environment);
    const std::vector<float> solid_angles = grid.solid_angles();
    std::vector<float> weights(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) weights[i] = luminance(environment.pixels[i]) * solid_angles[i];
    float sum = 0;
    for (float w : weights) sum += w;
    Colours out(grid.size());
    if (!(sum > 0)) return out;

    // Every texel restarts the generator with seed 0, so that all of them draw the same texels.
    const AliasTable table(weights);
    std::mt19937 generator(0);
    Samples draws(k_reference_draws);
    for (std::size_t j = 0; j < k_reference_draws; ++j) {
        const std::size_t column = generator() % grid.size();
        const std::size_t i = table.choose(column, static_cast<double>(generator()) * 0x1p-32);
        // Rounding may let the table choose a texel of zero weight: count it as zero.
        const double share =
            weights[i] > 0 ? solid_angles[i] * (sum / static_cast<double>(weights[i])) / k_reference_draws : 0;
        draws.set(j, {grid.direction(i), environment.pixels[i], static_cast<float>(share)});
    }
    out = lat_long_irradiance(draws, grid);
    scale(out, k_over_pi);
    return out;
}

/// sqrt(mean (a - r)^2) over texels and channels; each channel summed in order in float32, which loses 1e-4 of it.
double float_rms(ColourView a, ColourView reference) {
    float total = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        float sum = 0;
        for (std::size_t i = 0; i < a.size; ++i) {
            const float d = a.channel(k)[i] - reference.channel(k)[i];
            sum += d * d;
        }
        total += sum;
    }
    return std::sqrt(static_cast<double>(total) / (3 * static_cast<double>(a.size)));
}

Errors recipe_errors(ColourView a, ColourView reference, std::span<const float> weights) {
    Errors e = errors(a, reference, weights);
    e.rms_unweighted = float_rms(a, reference);
    return e;
}

Colours irradiance_over_pi(const Codec& codec, std::span<const Rgb> c, DirectionView normals) {
    Colours out(normals.size);
    codec.irradiance(c, normals, out);
    scale(out, k_over_pi);
    return out;
}

/// The reference of every method.
struct Reference {
    Samples texels;
    Colours irradiance_over_pi;
};

Method run_method(const Codec& codec, SampleView samples, const Reference& reference) {
    using Steady = std::chrono::steady_clock;
    const SampleView texels = reference.texels;
    const std::span<const float> weights{texels.solid_angles(), texels.size};
    Method method{codec.name(), Domain::sphere, {}, {}, {}, 0, 0};
    const auto start = Steady::now();
    method.c = codec.encode(samples);
    method.encode_ms = std::chrono::duration<double, std::milli>(Steady::now() - start).count();

    Colours radiance(texels.size);
    codec.radiance(method.c, texels.directions(), radiance);
    method.radiance = recipe_errors(radiance, texels.radiance(), weights);
    const auto read_start = Steady::now();
    const Colours irradiance = irradiance_over_pi(codec, method.c, texels.directions());
    method.evaluate_ns_per_normal =
        std::chrono::duration<double, std::nano>(Steady::now() - read_start).count() / static_cast<double>(texels.size);
    method.irradiance_over_pi = recipe_errors(irradiance, reference.irradiance_over_pi, weights);
    return method;
}

void add_pictures(ComparisonPictures& pictures, const Codec& codec, std::span<const Rgb> c) {
    Colours& picture = pictures.radiance[codec.name().basis + "/" + codec.name().encoder];
    picture = Colours(k_radiance_picture.size());
    codec.radiance(c, k_radiance_picture.directions(), picture);
    pictures.irradiance_over_pi[codec.name().str()] = irradiance_over_pi(codec, c, k_irradiance_picture.directions());
}

}  // namespace

std::string_view recipe_name(Recipe recipe) { return recipe == Recipe::published ? "published" : "updated"; }

Comparison run_recipe(Recipe recipe, const Image& environment, const ComparisonOptions& options,
                      const Progress& progress) {
    const LatLong grid = lat_long(environment);
    Comparison result;
    result.recipe = recipe_name(recipe);
    result.reference = "5000 draws by luminance and solid angle, the same for every normal";
    result.sequence = sequence_name(recipe == Recipe::published ? Sequence::hammersley : Sequence::halton);
    result.samples = k_sample_count;
    result.seed = std::mt19937::default_seed;
    result.grid = grid;
    result.mean_radiance = mean_radiance(environment);
    const Reference reference{texel_samples(environment), noisy_irradiance_over_pi(environment)};
    const Samples ordered = directed_samples(
        environment, uniform_directions(Domain::sphere, *sequence_from_name(result.sequence), k_sample_count, 0),
        Domain::sphere);
    if (options.pictures)
        result.pictures.references[Domain::sphere] = {radiance_of(resize(environment, k_measuring_grid)),
                                                      reference.irradiance_over_pi};

    // Both shuffled methods draw on one generator, one after the other.
    const auto basis = as_linear(make_basis(k_basis).value());
    const auto evaluator = make_evaluator(k_evaluator, *basis).value();
    std::mt19937 generator;
    const auto& methods = methods_of(recipe);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const CodecName name{k_basis, methods[i].name, k_evaluator};
        const Codec codec(name, encoder_of(name.encoder, basis), evaluator);
        const Samples samples = methods[i].order == RecipeMethod::shuffled
                                    ? reordered(ordered, shuffled_order(k_sample_count, generator))
                                    : ordered;
        result.methods.push_back(run_method(codec, samples, reference));
        if (options.pictures) add_pictures(result.pictures, codec, result.methods.back().c);
        if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(methods.size()));
    }
    return result;
}

}  // namespace lobelia
