// Samples an environment and encodes the samples.
#include "coefficients/encode.h"

#include <cmath>
#include <random>

#include "lobelia/environment.h"

namespace lobelia {

Samples environment_samples(const Image& environment, Domain domain, const SamplingOptions& options) {
    const Image reduced = resize(environment, reduced_grid(lat_long(environment), options.most_texels));
    if (!options.sequence) {
        const Samples texels = shuffled_texel_samples(reduced, domain, options.seed);
        return first(texels, options.samples.value_or(texels.size()));
    }
    // Shuffle, with a seed of its own: encoders that learn as they go need samples without an order.
    const std::size_t count = options.samples.value_or(k_default_sequence_samples);
    const Directions directions = uniform_directions(domain, *options.sequence, count, options.seed);
    std::mt19937 generator(~options.seed);
    return reordered(directed_samples(reduced, directions, domain), shuffled_order(count, generator));
}

Result<CoefficientFile> encode(const Image& environment, const std::string& codec_name,
                               const SamplingOptions& options) {
    const auto codec = make_codec(codec_name);
    if (!codec) return codec.error();
    CoefficientFile file{codec->name(),
                         codec->encode(environment_samples(environment, codec->basis().domain(), options))};
    for (const Rgb& c : file.c)
        if (!std::isfinite(c.r + c.g + c.b)) return Error{codec_name + ": the coefficients are not finite"};
    return file;
}

}  // namespace lobelia
