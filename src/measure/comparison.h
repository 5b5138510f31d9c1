// Runs codecs on an environment and measures each against exact references: the data behind every report.
#pragma once

#include <functional>
#include <map>
#include <optional>

#include "lobelia/codec.h"
#include "lobelia/environment.h"
#include "lobelia/metrics.h"
#include "lobelia/sampling.h"
#include "measure/storage_errors.h"

namespace lobelia {

/// Told now and then how much of the work is done, in [0, 1]; from any thread, one call at a time.
using Progress = std::function<void(double)>;

struct ComparisonOptions {
    std::optional<Sequence> sequence = {};      ///< none: every texel is one sample, once
    std::optional<std::size_t> samples = {};    ///< none: all texels, or 20,000 of a sequence; else that many
    std::uint32_t seed = 1;                     ///< of the sequence and of the shuffle
    std::size_t most_texels = 131072;           ///< larger environments are reduced first, energy kept
    bool pictures = true;                       ///< evaluate the pictures of a page too
    bool convergence = true;                    ///< and measure excess error against sample count
    std::vector<const Storage*> storages = {};  ///< in which coefficients are stored and judged again
};

/// One codec's result.
struct Method {
    CodecName name;
    Domain domain = Domain::sphere;
    std::vector<Rgb> c;
    Errors radiance;            ///< of L, at the texels of the judging grid
    Errors irradiance_over_pi;  ///< of E / pi, at the same directions as normals
    double encode_ms = 0;
    double evaluate_ns_per_normal = 0;
    std::vector<StorageErrors> storage = {};  ///< one for each of the options' storages that suits
};

/// Excess error |b - b*|_G / |b*|_G against the number of samples; b* is what the encoder strives for, solved from all
/// texels; root mean square over repetitions.
struct Convergence {
    std::string basis, encoder, sequence;
    std::vector<std::size_t> samples;
    std::vector<double> excess;
    double converged_norm = 0;  ///< root mean square radiance of b*: excess times this is in W/(m^2 sr)
};

/// "texels" for none.
[[nodiscard]] std::string sampling_name(std::optional<Sequence> sequence);

/// Latitude-longitude pictures by name.
struct ComparisonPictures {
    struct Reference {
        Colours radiance, irradiance_over_pi;
    };
    std::map<Domain, Reference> references;
    std::map<std::string, Colours> radiance;            ///< by "basis/encoder"
    std::map<std::string, Colours> irradiance_over_pi;  ///< by the whole name
};

inline constexpr std::size_t k_default_sequence_samples = 20000;

/// Grids: errors are judged on the first; pictures of radiance and of irradiance have the others.
inline constexpr LatLong k_judging_grid{256, 128};
inline constexpr LatLong k_radiance_picture{128, 64};
inline constexpr LatLong k_irradiance_picture{64, 32};

struct Comparison {
    std::string recipe;       ///< empty for the default mode
    std::string reference;    ///< what the reference irradiance is
    std::string sequence;     ///< "texels" or a sequence's name
    std::size_t samples = 0;  ///< given to each encoder over the sphere
    std::uint32_t seed = 0;
    LatLong grid;  ///< of the environment after reduction
    Rgb mean_radiance;
    std::vector<Method> methods;
    std::vector<Convergence> convergence;
    ComparisonPictures pictures;
};

/// Samples of a domain as the options ask for them, in the order in which encoders see them; the environment is
/// reduced to options.most_texels first.
[[nodiscard]] Samples arriving_samples(const Image& environment, Domain domain, const ComparisonOptions& options);

/// Runs the codecs; each name is to be known (make_codec). Parallel, with the same figures at any thread count.
[[nodiscard]] Result<Comparison> compare(const Image& environment, const std::vector<CodecName>& codecs,
                                         const ComparisonOptions& options = {}, const Progress& progress = {});

/// Exact irradiance of `samples` at each normal, as irradiance_sum(); parallel.
[[nodiscard]] Colours exact_irradiance(SampleView samples, DirectionView normals);

/// Irradiance of `samples` at all texel centres of `grid` as the domain sees them; antipodal normals share their work.
/// Parallel.
[[nodiscard]] Colours lat_long_irradiance(SampleView samples, LatLong grid, Domain domain = Domain::sphere);

}  // namespace lobelia
