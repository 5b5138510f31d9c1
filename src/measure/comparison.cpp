// The comparison: encode all, evaluate all, measure all, in parallel over codecs.
#include "measure/comparison.h"

#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>

#include "measure/convergence.h"

namespace lobelia {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Samples and references of one domain.
struct Stage {
    Samples samples;   ///< in the order in which encoders see them
    Samples measured;  ///< directions, reference radiance and weights of the measuring grid
    Colours reference_irradiance_over_pi;
};

constexpr std::size_t k_normals_at_once = 512;

/// Restricts colours of a whole grid to the texels of a domain, in their order.
Colours restricted(const Colours& grid_colours, LatLong grid, Domain domain) {
    const auto kept = grid.texels_of(domain);
    Colours result(kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) set_entry(result.view(), i, colour_at(grid_colours, kept[i]));
    return result;
}

/// A basis with the encoders and evaluators to run.
struct BasisRun {
    std::shared_ptr<const Basis> basis;
    std::vector<std::string> encoders;
    std::vector<std::string> evaluators;
};

/// One (basis, encoder): coefficients and radiance.
struct Encoding {
    const BasisRun* run = nullptr;
    std::string encoder = {};
    std::shared_ptr<const Encoder> made = {};
    std::vector<Rgb> c = {};
    double milliseconds = 0;
    std::map<Negative, Errors> radiance = {};
    Colours picture = {};
};

/// One (basis, evaluator): irradiance of all encodings of the basis at once.
struct Evaluation {
    const BasisRun* run = nullptr;
    std::string evaluator = {};
    Negative negative = Negative::kept;
    double nanoseconds = 0;
    std::map<std::string, Errors> irradiance = {};  ///< by encoder
    std::map<std::string, Colours> pictures = {};
};

/// The whole comparison as it runs.
class Run {
  public:
    Run(const Image& environment, const ComparisonOptions& options, const Progress& progress)
        : environment_(resize(environment, reduced_grid(lat_long(environment), options.sampling.most_texels))),
          options_(options),
          progress_(progress) {}

    [[nodiscard]] Result<Comparison> operator()(const std::vector<CodecName>& codecs) {
        if (auto status = collect(codecs); !status) return status.error();
        prepare_stages();
        encode_all();
        evaluate_all();
        Comparison result = assemble(codecs);
        store_all(result.methods);
        if (options_.convergence) result.convergence = converge();
        return result;
    }

  private:
    /// Groups the codecs by basis, makes each basis once.
    Status collect(const std::vector<CodecName>& codecs) {
        const auto add_once = [](std::vector<std::string>& list, const std::string& name) {
            if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
        };
        for (const CodecName& name : codecs) {
            auto found = std::find_if(runs_.begin(), runs_.end(),
                                      [&](const BasisRun& run) { return run.basis->name() == name.basis; });
            if (found == runs_.end()) {
                auto basis = make_basis(name.basis);
                if (!basis) return basis.error();
                found = runs_.insert(runs_.end(), {*basis, {}, {}});
            }
            add_once(found->encoders, name.encoder);
            add_once(found->evaluators, name.evaluator);
        }
        for (const BasisRun& run : runs_) {
            for (const auto& encoder : run.encoders) encodings_.push_back({.run = &run, .encoder = encoder});
            for (const auto& evaluator : run.evaluators) evaluations_.push_back({.run = &run, .evaluator = evaluator});
        }
        return Done{};
    }

    void prepare_stages() {
        const Image measured = resize(environment_, k_measuring_grid);
        for (const BasisRun& run : runs_) {
            const Domain domain = run.basis->domain();
            if (stages_.contains(domain)) continue;
            Stage& stage = stages_[domain];
            stage.samples = environment_samples(environment_, domain, options_.sampling);
            stage.measured = texel_samples(measured, domain);
            const Samples texels = texel_samples(environment_, domain);
            Colours irradiance = lat_long_irradiance(texels, k_measuring_grid, domain);
            scale(irradiance, k_over_pi);
            stage.reference_irradiance_over_pi = restricted(irradiance, k_measuring_grid, domain);
            if (options_.pictures) {
                auto& pictures = pictures_.references[domain];
                pictures.radiance = radiance_of(measured);
                pictures.irradiance_over_pi = lat_long_irradiance(texels, k_irradiance_picture, domain);
                scale(pictures.irradiance_over_pi, k_over_pi);
            }
        }
        step(0.1);
    }

    void encode_all() {
        tbb::parallel_for(std::size_t{0}, encodings_.size(), [&](std::size_t i) {
            Encoding& e = encodings_[i];
            const Stage& stage = stages_.at(e.run->basis->domain());
            e.made = make_encoder(e.encoder, e.run->basis).value();
            const auto start = Clock::now();
            Accumulator accumulator(e.made);
            accumulator.add(stage.samples);
            e.c = accumulator.solve();
            e.milliseconds = milliseconds_since(start);

            const SampleView measured = stage.measured;
            Colours radiance(measured.size);
            e.run->basis->radiance(e.c, measured.directions(), radiance);
            const std::span weights{measured.solid_angles(), measured.size};
            e.radiance[Negative::kept] = errors(radiance, measured.radiance(), weights);
            clamp_negative(radiance);
            e.radiance[Negative::clamped] = errors(radiance, measured.radiance(), weights);
            if (options_.pictures) {
                e.picture = Colours(k_radiance_picture.size());
                e.run->basis->radiance(e.c, k_radiance_picture.directions(e.run->basis->domain()), e.picture);
            }
            step(0.3 / static_cast<double>(encodings_.size()));
        });
    }

    void evaluate_all() {
        tbb::parallel_for(std::size_t{0}, evaluations_.size(), [&](std::size_t i) {
            evaluate(evaluations_[i]);
            step(0.2 / static_cast<double>(evaluations_.size()));
        });
    }

    void evaluate(Evaluation& evaluation) const {
        const auto evaluator = make_evaluator(evaluation.evaluator, *evaluation.run->basis).value();
        evaluation.negative = evaluator->negative();
        const Stage& stage = stages_.at(evaluation.run->basis->domain());
        const SampleView measured = stage.measured;
        std::vector<const Encoding*> encodings;
        for (const Encoding& e : encodings_)
            if (e.run == evaluation.run) encodings.push_back(&e);

        auto outputs = signed_irradiance_over_pi(*evaluator, encodings, measured.directions());
        for (std::size_t k = 0; k < encodings.size(); ++k) {
            const std::span weights{measured.solid_angles(), measured.size};
            const double negative = negative_share(outputs[k], weights);
            if (evaluation.negative == Negative::clamped) clamp_negative(outputs[k]);
            Errors& e = evaluation.irradiance[encodings[k]->encoder];
            e = errors(outputs[k], stage.reference_irradiance_over_pi, weights);
            e.negative_share = negative;
        }
        if (options_.pictures) {
            auto pictures = signed_irradiance_over_pi(*evaluator, encodings,
                                                      k_irradiance_picture.directions(evaluation.run->basis->domain()));
            for (std::size_t k = 0; k < encodings.size(); ++k)
                evaluation.pictures[encodings[k]->encoder] = std::move(pictures[k]);
        }

        evaluation.nanoseconds = nanoseconds_per_normal(*evaluator, encodings[0]->c, measured.directions(), outputs[0]);
    }

    /// Times one set of coefficients on enough normals for the clock: the least of a few runs, since other programs may
    /// take the processor in between.
    static double nanoseconds_per_normal(const Evaluator& evaluator, std::span<const Rgb> c, DirectionView normals,
                                         MutableColourView out) {
        const DirectionView timed = normals.part(0, std::min<std::size_t>(normals.size, 4096));
        double least = std::numeric_limits<double>::infinity();
        for (int repeat = 0; repeat < 3; ++repeat) {
            const auto start = Clock::now();
            irradiance(evaluator, c, timed, out.part(0, timed.size));
            least = std::min(least, milliseconds_since(start));
        }
        return 1e6 * least / static_cast<double>(timed.size);
    }

    /// E / pi of several encodings of one basis, negative values kept; the weights of a linear evaluator are computed
    /// once for all.
    static std::vector<Colours> signed_irradiance_over_pi(const Evaluator& evaluator,
                                                          const std::vector<const Encoding*>& encodings,
                                                          DirectionView normals) {
        std::vector<Colours> outputs(encodings.size(), Colours(normals.size));
        std::vector<std::span<const Rgb>> c;
        std::vector<MutableColourView> views;
        for (std::size_t k = 0; k < encodings.size(); ++k) {
            c.emplace_back(encodings[k]->c);
            views.push_back(outputs[k].view());
        }
        signed_irradiance_many(evaluator, c, normals, views);
        for (auto& view : views) scale(view, k_over_pi);
        return outputs;
    }

    /// Stores and measures every method's coefficients in every requested storage.
    void store_all(std::vector<Method>& methods) const {
        if (options_.storages.empty()) return;
        tbb::parallel_for(std::size_t{0}, methods.size(), [&](std::size_t i) {
            Method& method = methods[i];
            const Encoding& e = encoding(method.name);
            const Codec codec(method.name, e.made, make_evaluator(method.name.evaluator, *e.run->basis).value());
            const Stage& stage = stages_.at(method.domain);
            method.storage =
                storage_errors(codec, method.c, options_.storages, stage.measured, stage.reference_irradiance_over_pi);
        });
    }

    [[nodiscard]] Comparison assemble(const std::vector<CodecName>& codecs) {
        Comparison result;
        result.reference = "exact sum over texels";
        result.sequence = sampling_name(options_.sampling.sequence);
        result.samples = stages_.begin()->second.samples.size();
        result.seed = options_.sampling.seed;
        result.grid = lat_long(environment_);
        result.mean_radiance = mean_radiance(environment_);
        for (const CodecName& name : codecs) {
            const Encoding& e = encoding(name);
            const Evaluation& r = evaluation(name);
            Errors radiance = e.radiance.at(r.negative);
            radiance.negative_share = e.radiance.at(Negative::kept).negative_share;
            result.methods.push_back({name,
                                      e.run->basis->domain(),
                                      e.c,
                                      radiance,
                                      r.irradiance.at(name.encoder),
                                      e.milliseconds,
                                      r.nanoseconds,
                                      {}});
        }
        if (options_.pictures) {
            for (auto& evaluation : evaluations_)
                for (auto& [encoder, picture] : evaluation.pictures)
                    pictures_.irradiance_over_pi[CodecName{evaluation.run->basis->name(), encoder, evaluation.evaluator}
                                                     .str()] = std::move(picture);
            for (auto& e : encodings_)
                pictures_.radiance[e.run->basis->name() + "/" + e.encoder] = std::move(e.picture);
            result.pictures = std::move(pictures_);
        }
        return result;
    }

    [[nodiscard]] std::vector<Convergence> converge() {
        std::vector<ConvergenceTask> tasks;
        for (const BasisRun& run : runs_)
            if (run.basis->linear() && card_of(*run.basis).encoders.empty() &&
                run.basis->size() <= k_most_converging_size)
                tasks.push_back({run.basis, run.encoders, {k_sequences.begin(), k_sequences.end()}});
        return measure_convergence(environment_, tasks, {.seed = options_.sampling.seed}, [&](double done) {
            report(k_before_convergence + done * (1 - k_before_convergence));
        });
    }

    [[nodiscard]] const Encoding& encoding(const CodecName& name) const {
        return *std::find_if(encodings_.begin(), encodings_.end(), [&](const Encoding& e) {
            return e.run->basis->name() == name.basis && e.encoder == name.encoder;
        });
    }
    [[nodiscard]] const Evaluation& evaluation(const CodecName& name) const {
        return *std::find_if(evaluations_.begin(), evaluations_.end(), [&](const Evaluation& r) {
            return r.run->basis->name() == name.basis && r.evaluator == name.evaluator;
        });
    }

    /// Counts a share of the work before the convergence plots, all of which is k_before_convergence.
    void step(double share) {
        const std::scoped_lock lock(progress_mutex_);
        done_ += options_.convergence ? share : share / k_before_convergence;
        if (progress_) progress_(std::min(done_, 1.0));
    }
    void report(double done) {
        const std::scoped_lock lock(progress_mutex_);
        if (progress_) progress_(done);
    }

    static constexpr double k_before_convergence = 0.6;

    /// Bases beyond this many coefficients are left out of the convergence plots, as are those with a few encoders
    /// only: they take long and show the same.
    static constexpr std::size_t k_most_converging_size = 16;

    Image environment_;
    ComparisonOptions options_;
    const Progress& progress_;
    std::mutex progress_mutex_;
    double done_ = 0;
    std::vector<BasisRun> runs_;
    std::map<Domain, Stage> stages_;
    std::vector<Encoding> encodings_;
    std::vector<Evaluation> evaluations_;
    ComparisonPictures pictures_;
};

}  // namespace

std::string_view domain_name(Domain domain) { return domain == Domain::sphere ? "sphere" : "hemisphere"; }

std::string sampling_name(std::optional<Sequence> sequence) {
    return sequence ? std::string(sequence_name(*sequence)) : "texels";
}

double mean_value(const Comparison& comparison) {
    const Rgb mean = comparison.mean_radiance;
    return (double{mean.r} + mean.g + mean.b) / 3;
}

Result<Comparison> compare(const Image& environment, const std::vector<CodecName>& codecs,
                           const ComparisonOptions& options, const Progress& progress) {
    return Run(environment, options, progress)(codecs);
}

Colours exact_irradiance(SampleView samples, DirectionView normals) {
    Colours out(normals.size);
    tbb::parallel_for(std::size_t{0}, (normals.size + k_normals_at_once - 1) / k_normals_at_once, [&](std::size_t i) {
        const std::size_t begin = i * k_normals_at_once, count = std::min(k_normals_at_once, normals.size - begin);
        irradiance_sum(samples, normals.part(begin, count), out.view().part(begin, count));
    });
    return out;
}

Colours lat_long_irradiance(SampleView samples, LatLong grid, Domain domain) {
    const Directions normals = grid.directions(domain);
    if (grid.width % 2 != 0 || grid.height % 2 != 0) return exact_irradiance(samples, normals);

    // A grid of even size holds the antipode of each of its texels: visit the upper half only.
    const std::size_t half = grid.size() / 2;
    Colours out(grid.size()), opposite(half);
    tbb::parallel_for(std::size_t{0}, (half + k_normals_at_once - 1) / k_normals_at_once, [&](std::size_t i) {
        const std::size_t begin = i * k_normals_at_once, count = std::min(k_normals_at_once, half - begin);
        irradiance_sums(samples, normals.view().part(begin, count), out.view().part(begin, count),
                        opposite.view().part(begin, count));
    });
    for (std::size_t i = 0; i < half; ++i) {
        const std::size_t x = i % grid.width, y = i / grid.width;
        const std::size_t antipode = (grid.height - 1 - y) * grid.width + (x + grid.width / 2) % grid.width;
        set_entry(out.view(), antipode, colour_at(opposite.view(), i));
    }
    return out;
}

}  // namespace lobelia
