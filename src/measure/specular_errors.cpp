// Sums the reflection of all texels at all points once, then evaluates every coefficient vector there.
#include "measure/specular_errors.h"

#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>

#include "coefficients/encode.h"
#include "core/math/ggx.h"
#include "lobelia/environment.h"
#include "lobelia/sampling.h"
#include "lobelia/specular.h"

namespace lobelia {
namespace {

/// Surface points that face their viewer, and their reference reflection.
struct SpecularSurfaces {
    Directions normals;
    std::vector<float> alphas;
    Colours reference;
    double mean = 0;  ///< of the reference's channels

    [[nodiscard]] SpecularPoints points() const { return {normals, normals, alphas}; }
};

SpecularSurfaces points_for(SampleView texels, const SpecularErrorOptions& options) {
    const Directions around = uniform_directions(Domain::sphere, Sequence::hammersley, options.directions, 0);
    const std::size_t count = options.directions * options.alphas.size();
    SpecularSurfaces result{Directions(count), std::vector<float>(count), Colours(count)};
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const Vec3 normal = direction_at(around, i % options.directions);
        const float alpha = options.alphas[i / options.directions];
        set_entry(result.normals.view(), i, normal);
        result.alphas[i] = alpha;
        const ggx::View view = ggx::make_view(normal, normal, alpha);
        double sum[3] = {};
        for (std::size_t k = 0; k < texels.size; ++k) {
            const double weight =
                ggx::reflection(view, view.to_local(direction_at(texels.directions(), k))) * texels.solid_angles()[k];
            for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * texels.radiance().channel(c)[k];
        }
        set_entry(result.reference.view(), i,
                  Rgb{static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])});
    });
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < count; ++i)
            result.mean += result.reference.channel(c)[i] / (3 * static_cast<double>(count));
    return result;
}

struct Evaluated {
    double error = 0, nanoseconds = 0;
};

Evaluated evaluate(const SpecularEvaluator& evaluator, std::span<const Rgb> c, const SpecularSurfaces& at) {
    Colours out(at.alphas.size());
    const auto start = std::chrono::steady_clock::now();
    evaluator.reflected(c, at.points(), out);
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    double squares = 0;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < out.size(); ++i)
            squares += std::pow(double{out.channel(k)[i]} - at.reference.channel(k)[i], 2);
    const auto count = static_cast<double>(out.size());
    return {std::sqrt(squares / (3 * count)) / at.mean, time.count() / count};
}

/// All specular evaluators of one basis.
class BasisReflection {
  public:
    BasisReflection(std::shared_ptr<const Basis> basis, SampleView texels, const SpecularSurfaces& points)
        : basis_(std::move(basis)), points_(points) {
        for (const auto& name : encoder_names(*basis_)) {
            auto encoder = make_encoder(name, basis_).value();
            Accumulator accumulator(encoder);
            accumulator.add(texels);
            encodings_.push_back({name, std::move(encoder), accumulator.solve()});
        }
    }

    void add_errors(std::span<const Storage* const> storages, std::vector<SpecularError>& errors) const {
        for (const auto& name : specular_names(*basis_)) {
            const auto evaluator = make_specular(name, basis_).value();
            // Choose the encoder of the least error: all take as many bytes.
            const Encoding* best = nullptr;
            double least = HUGE_VAL;
            for (const Encoding& e : encodings_)
                if (const double error = evaluate(*evaluator, e.c, points_).error; error < least) {
                    best = &e;
                    least = error;
                }
            if (best == nullptr) continue;
            const auto traits = coefficient_traits(*best->encoder);
            for (const Storage* storage : storages) {
                if (!suits(*storage, traits)) continue;
                const auto [error, time] = evaluate(*evaluator, stored_and_read(*storage, traits, best->c), points_);
                errors.push_back({basis_->name(), best->name, std::string(storage->name), name,
                                  bytes_per_texel(storage->layout(traits)), error, time});
            }
        }
    }

  private:
    struct Encoding {
        std::string name;
        std::shared_ptr<const Encoder> encoder;
        std::vector<Rgb> c;
    };
    std::shared_ptr<const Basis> basis_;
    const SpecularSurfaces& points_;
    std::vector<Encoding> encodings_;
};

}  // namespace

std::vector<SpecularError> specular_errors(const Image& environment, const SpecularErrorOptions& options) {
    const Samples texels = environment_samples(environment, Domain::sphere);
    const SpecularSurfaces points = points_for(texels, options);
    std::vector<std::shared_ptr<const Basis>> bases;
    for (const auto& name : basis_names())
        if (auto basis = make_basis(name).value(); basis->domain() == Domain::sphere) bases.push_back(std::move(basis));
    std::vector<std::vector<SpecularError>> of_basis(bases.size());
    tbb::parallel_for(std::size_t{0}, bases.size(), [&](std::size_t i) {
        BasisReflection(bases[i], texels, points).add_errors(options.storages, of_basis[i]);
    });
    std::vector<SpecularError> all;
    for (auto& errors : of_basis) all.insert(all.end(), errors.begin(), errors.end());
    return all;
}

}  // namespace lobelia
