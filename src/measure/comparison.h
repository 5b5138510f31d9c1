// Runs codecs on an environment and measures each against exact references: the data behind every report.
#pragma once

#include <map>
#include <optional>

#include "coefficients/encode.h"
#include "lobelia/codec.h"
#include "lobelia/environment.h"
#include "lobelia/metrics.h"
#include "lobelia/sampling.h"
#include "measure/progress.h"
#include "measure/storage_errors.h"

namespace lobelia {

struct ComparisonOptions {
    SamplingOptions sampling = {};
    bool pictures = true;                       ///< evaluate the pictures of the report too
    bool convergence = true;                    ///< measure excess error against sample count too
    std::vector<const Storage*> storages = {};  ///< in which coefficients are stored and measured again
};

/// One codec's result.
struct Method {
    CodecName name;
    Domain domain = Domain::sphere;
    std::vector<Rgb> c;
    Errors radiance;            ///< of L, at the texels of the measuring grid
    Errors irradiance_over_pi;  ///< of E / pi, at the same directions as normals
    double encode_ms = 0;
    double evaluate_ns_per_normal = 0;
    std::vector<StorageErrors> storage = {};  ///< one for each compatible storage of the options
};

/// Excess error |b - b*|_G / |b*|_G against the number of samples; b* is the limit of the encoder, solved from all
/// texels; root mean square over repetitions.
struct Convergence {
    std::string basis, encoder, sequence;
    std::vector<std::size_t> samples;
    std::vector<double> excess;
    double converged_norm = 0;  ///< root mean square radiance of b*: excess times this is in W/(m^2 sr)
};

/// "sphere" or "hemisphere".
[[nodiscard]] std::string_view domain_name(Domain domain);
/// The name of a sequence, or "texels" for none.
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

/// Grids: errors are measured on the first; pictures of radiance and of irradiance have the others.
inline constexpr LatLong k_measuring_grid{256, 128};
inline constexpr LatLong k_radiance_picture{128, 64};
inline constexpr LatLong k_irradiance_picture{64, 32};

struct Comparison {
    std::string recipe;       ///< empty for the default mode
    std::string reference;    ///< how the reference irradiance was computed
    std::string sequence;     ///< "texels" or a sequence's name
    std::size_t samples = 0;  ///< given to each encoder over the sphere
    std::uint32_t seed = 0;
    LatLong grid;  ///< of the environment after reduction
    Rgb mean_radiance;
    std::vector<Method> methods;
    std::vector<Convergence> convergence;
    ComparisonPictures pictures;
};

/// The mean radiance of the environment over directions and channels, which is the mean of E / pi over normals of the
/// sphere, too: errors in per cent are over it.
[[nodiscard]] double mean_value(const Comparison& comparison);

/// Runs the codecs in parallel, with the same figures at any thread count. Error: an unknown codec.
[[nodiscard]] Result<Comparison> compare(const Image& environment, const std::vector<CodecName>& codecs,
                                         const ComparisonOptions& options = {}, const Progress& progress = {});

/// Exact irradiance of `samples` at each normal, as irradiance_sum(); parallel.
[[nodiscard]] Colours exact_irradiance(SampleView samples, DirectionView normals);

/// Irradiance of `samples` at all texel centres of `grid` as the domain sees them; antipodal normals share their work.
/// Parallel.
[[nodiscard]] Colours lat_long_irradiance(SampleView samples, LatLong grid, Domain domain = Domain::sphere);

}  // namespace lobelia
