// One set of samples for each texel, handed to every encoder; the reference is the sum over many more of them.
#include "measure/study/study_bake.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <tuple>

#include "bake/place/texels.h"
#include "lobelia/environment.h"
#include "lobelia/sampling.h"

namespace lobelia {
namespace {

/// The shading normal, and normals tilted from it by up to 60 degrees.
constexpr std::size_t k_normals = 16;
constexpr std::uint32_t k_batch = 64;

Directions tilted_normals() {
    Directions normals(k_normals);
    const Directions around = uniform_directions(Domain::hemisphere, Sequence::hammersley, 2 * (k_normals - 1), 0);
    // Hammersley's heights fall from 1: the first half lies within 60 degrees.
    set_entry(normals.view(), 0, Vec3{0, 0, 1});
    for (std::size_t j = 1; j < k_normals; ++j) set_entry(normals.view(), j, direction_at(around, j - 1));
    return normals;
}

/// One basis with one encoder, all its storages and evaluators.
struct Subject {
    CodecName name;  ///< without evaluator
    std::shared_ptr<const Encoder> encoder;
    std::vector<const Storage*> storages;  ///< null first: as solved
    std::vector<std::shared_ptr<const Evaluator>> evaluators;
    std::size_t first_evaluation = 0;  ///< of its storages and evaluators, among all
};

/// Sums over texels, for each evaluation and normal class.
struct Sums {
    double at_normal = 0, tilted = 0;
    std::size_t negative = 0;
};

/// The coefficients of each method at a texel, and the reference.
struct Encoded {
    std::vector<std::vector<Rgb>> c;
    Colours reference{k_normals};
    bool valid = true;
};

/// Texels that are measured together: those of a block, row by row, or one alone.
using Unit = std::vector<std::size_t>;
constexpr std::size_t k_block_side = 4, k_block_texels = k_block_side * k_block_side;

/// One for each texel, or the whole blocks.
std::vector<Unit> all_units(const TexelMap& map, bool blocks) {
    std::vector<Unit> units;
    if (!blocks) {
        for (std::size_t i = 0; i < map.texels.size(); ++i) units.push_back({i});
        return units;
    }
    std::map<std::tuple<std::size_t, std::size_t, std::size_t>, Unit> found;
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        const CoveredTexel& at = map.texels[i];
        found[{at.page, at.y / k_block_side, at.x / k_block_side}].push_back(i);
    }
    for (auto& [place, unit] : found)
        if (unit.size() == k_block_texels) units.push_back(std::move(unit));
    return units;
}

/// Packs and unpacks the coefficients of a block.
std::vector<std::vector<Rgb>> through_storage(const Storage& storage, const CoefficientTraits& traits,
                                              std::span<const std::vector<Rgb>> c) {
    std::vector<std::vector<float>> planes(3 * traits.count, std::vector<float>(k_block_texels));
    for (std::size_t t = 0; t < c.size(); ++t)
        for (std::size_t i = 0; i < traits.count; ++i) {
            planes[3 * i][t] = c[t][i].r;
            planes[3 * i + 1][t] = c[t][i].g;
            planes[3 * i + 2][t] = c[t][i].b;
        }
    const TextureLayout layout = storage.layout(traits);
    const MutableCoefficientPlanes block(k_block_side, k_block_side, std::span(planes), traits.count);
    unpack(layout, pack(layout, block), block);
    std::vector<std::vector<Rgb>> read(c.size(), std::vector<Rgb>(traits.count));
    for (std::size_t t = 0; t < c.size(); ++t)
        for (std::size_t i = 0; i < traits.count; ++i)
            read[t][i] = {planes[3 * i][t], planes[3 * i + 1][t], planes[3 * i + 2][t]};
    return read;
}

class BakeStudy {
  public:
    BakeStudy(const BakeSetup& setup, const BakeStudyOptions& options) : setup_(setup), options_(options) {}

    [[nodiscard]] Status find_methods() {
        for (const auto& basis_name : options_.bases.empty() ? basis_names() : options_.bases) {
            const auto basis = make_basis(basis_name);
            if (!basis) return basis.error();
            for (const auto& encoder_name : encoder_names(**basis)) {
                Subject method{{basis_name, encoder_name, {}},
                               make_encoder(encoder_name, *basis).value(),
                               {nullptr},
                               {},
                               evaluations_};
                for (const Storage* storage : options_.storages)
                    if (suits(*storage, coefficient_traits(*method.encoder))) method.storages.push_back(storage);
                for (const auto& evaluator : (*basis)->evaluator_names())
                    method.evaluators.push_back(make_evaluator(evaluator, **basis).value());
                evaluations_ += method.storages.size() * method.evaluators.size();
                methods_.push_back(std::move(method));
            }
        }
        return Done{};
    }

    void run(const std::atomic<bool>& stop, const std::function<void(double)>& progress) {
        const bool blocks = !options_.storages.empty();
        const auto units = all_units(setup_.map, blocks);
        const std::size_t wanted = blocks ? (options_.texels + k_block_texels - 1) / k_block_texels : options_.texels;
        const std::size_t count = std::min(wanted, units.size());
        parts_.resize(count);
        std::atomic<std::size_t> done = 0;
        std::mutex mutex;
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
            if (stop) return;
            measure(units[k * units.size() / count], parts_[k]);
            ++done;
            if (!progress || !mutex.try_lock()) return;
            progress(static_cast<double>(done) / static_cast<double>(count));
            mutex.unlock();
        });
    }

    [[nodiscard]] BakedCodecs result() const;

  private:
    /// The contribution of a unit to the result.
    struct Part {
        std::size_t texels = 0;  ///< valid ones
        double mean = 0;         ///< sum of their irradiances
        std::vector<Sums> sums;  ///< for each evaluation
    };

    [[nodiscard]] Encoded encode(std::size_t texel) const;
    void measure(const Unit& unit, Part& part) const;
    /// Adds to the sums of each evaluator.
    void compare(const Subject& method, std::span<const Rgb> c, ColourView reference, std::span<Sums> sums) const;

    const BakeSetup& setup_;
    const BakeStudyOptions& options_;
    Directions normals_ = tilted_normals();
    std::vector<Subject> methods_;
    std::size_t evaluations_ = 0;
    std::vector<Part> parts_;
};

Encoded BakeStudy::encode(std::size_t index) const {
    std::vector<Receiver> texel;
    const PathTracer& tracer = *setup_.tracer;
    make_receivers(setup_.atlas, setup_.map, index, index + 1, tracer, Switch::on, texel);
    Receiver& receiver = texel[0];
    receiver.key = static_cast<std::uint32_t>(index);
    GatherOptions gathering;
    gathering.frame = Frame::tangent;
    gathering.dark_below = Switch::on;

    // The same samples for all: the first of them go to the encoders, all of them to the reference.
    Encoded result;
    std::vector<std::vector<float>> states;
    for (const Subject& method : methods_) states.emplace_back(method.encoder->state_size());
    const auto scratch = tracer.make_scratch();
    GatherBuffer buffer;
    Colours part(k_normals);
    std::uint32_t back_faces = 0;
    for (std::uint32_t first = 0; first < options_.reference_samples; first += k_batch) {
        gather(tracer, {&receiver, 1}, {first, k_batch}, gathering, buffer, *scratch);
        back_faces += buffer.gathered(0).back_faces;
        const SampleView above{buffer.directions(0).part(0, k_batch)};
        for (const SampleView& view : {above, buffer.sources(0)}) {
            irradiance_sum(view, normals_, part);
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t j = 0; j < k_normals; ++j) result.reference.channel(c)[j] += part.channel(c)[j];
        }
        if (first >= options_.samples) continue;
        for (std::size_t m = 0; m < methods_.size(); ++m) {
            const Encoder& encoder = *methods_[m].encoder;
            encoder.add(states[m], encoder.basis().domain() == Domain::sphere ? buffer.directions(0) : above);
            encoder.add_sources(states[m], buffer.sources(0));
        }
    }
    scale(result.reference, static_cast<float>(2 * k_pi / options_.reference_samples));
    result.valid = 2 * back_faces <= options_.reference_samples && luminance(colour_at(result.reference, 0)) > 0;
    for (std::size_t m = 0; m < methods_.size(); ++m) {
        result.c.emplace_back(methods_[m].encoder->basis().size());
        methods_[m].encoder->solve(states[m], result.c.back());
    }
    return result;
}

void BakeStudy::measure(const Unit& unit, Part& part) const {
    part.sums.resize(evaluations_);
    std::vector<Encoded> texels;
    for (const std::size_t texel : unit) texels.push_back(encode(texel));
    for (const Encoded& texel : texels)
        if (texel.valid) {
            ++part.texels;
            part.mean += luminance(colour_at(texel.reference, 0));
        }
    for (std::size_t m = 0; m < methods_.size(); ++m) {
        std::vector<std::vector<Rgb>> solved;
        for (Encoded& texel : texels) solved.push_back(std::move(texel.c[m]));
        const auto traits = coefficient_traits(*methods_[m].encoder);
        std::span<Sums> rest = std::span(part.sums).subspan(methods_[m].first_evaluation);
        for (const Storage* storage : methods_[m].storages) {
            const auto read = storage == nullptr ? solved : through_storage(*storage, traits, solved);
            for (std::size_t t = 0; t < texels.size(); ++t)
                if (texels[t].valid) compare(methods_[m], read[t], texels[t].reference, rest);
            rest = rest.subspan(methods_[m].evaluators.size());
        }
    }
}

void BakeStudy::compare(const Subject& method, std::span<const Rgb> c, ColourView reference,
                        std::span<Sums> sums) const {
    Colours read(k_normals);
    for (std::size_t e = 0; e < method.evaluators.size(); ++e) {
        Sums& sum = sums[e];
        method.evaluators[e]->signed_irradiance(c, normals_, read);
        for (std::size_t j = 0; j < k_normals; ++j)
            if (luminance(colour_at(read, j)) < 0) ++sum.negative;
        irradiance(*method.evaluators[e], c, normals_, read);
        for (std::size_t j = 0; j < k_normals; ++j) {
            const double off = luminance(colour_at(read, j) - colour_at(reference, j));
            (j == 0 ? sum.at_normal : sum.tilted) += off * off;
        }
    }
}

BakedCodecs BakeStudy::result() const {
    BakedCodecs result;
    double mean = 0;
    std::vector<Sums> totals(evaluations_);
    for (const Part& part : parts_) {
        result.texels += part.texels;
        mean += part.mean;
        for (std::size_t r = 0; r < part.sums.size(); ++r) {
            totals[r].at_normal += part.sums[r].at_normal;
            totals[r].tilted += part.sums[r].tilted;
            totals[r].negative += part.sums[r].negative;
        }
    }
    const auto count = static_cast<double>(result.texels);
    mean /= count;
    for (const Subject& method : methods_) {
        const Sums* sum = totals.data() + method.first_evaluation;
        const auto traits = coefficient_traits(*method.encoder);
        for (const Storage* storage : method.storages) {
            const double bytes = storage == nullptr ? 12.0 * static_cast<double>(method.encoder->basis().size())
                                                    : bytes_per_texel(storage->layout(traits));
            for (const auto& evaluator : method.evaluators) {
                result.codecs.push_back({{method.name.basis, method.name.encoder, evaluator->name()},
                                         storage,
                                         bytes,
                                         std::sqrt(sum->at_normal / count) / mean,
                                         std::sqrt(sum->tilted / (count * (k_normals - 1))) / mean,
                                         static_cast<double>(sum->negative) / (count * k_normals)});
                ++sum;
            }
        }
    }
    return result;
}

/// The best evaluator of each basis and encoder, ordered by error at tilted normals.
std::vector<BakedCodec> best_evaluators(std::vector<BakedCodec> codecs) {
    std::stable_sort(codecs.begin(), codecs.end(),
                     [](const BakedCodec& a, const BakedCodec& b) { return a.tilted < b.tilted; });
    std::set<std::pair<std::string, std::string>> seen;
    std::erase_if(codecs, [&](const BakedCodec& c) { return !seen.emplace(c.name.basis, c.name.encoder).second; });
    return codecs;
}

}  // namespace

Result<BakedCodecs> measure_baked_codecs(const Scene& scene, const BakeOptions& bake, const BakeStudyOptions& options,
                                         const std::atomic<bool>& stop, const std::function<void(double)>& progress) {
    const auto setup = BakeSetup::make(scene, bake);
    if (!setup) return setup.error();
    BakeStudy study(**setup, options);
    if (auto status = study.find_methods(); !status) return status.error();
    study.run(stop, progress);
    if (stop) return Error{"stopped", Error::Kind::stopped};
    BakedCodecs measured = study.result();
    if (measured.texels == 0) return Error{"no texel of the scene is valid and lit"};
    return measured;
}

Result<Study> study_bake(const Scene& scene, const BakeOptions& bake, const BakeStudyOptions& options,
                         const std::atomic<bool>& stop, const std::function<void(double)>& progress) {
    BakeStudyOptions as_solved = options;
    as_solved.storages.clear();
    const auto measured = measure_baked_codecs(scene, bake, as_solved, stop, progress);
    if (!measured) return measured.error();
    Study study;
    study.name = "bake";
    study.title = "Irradiance of baked codecs against a long reference";
    study.summary = fmt::format(
        "{} texels, {} samples each for the codecs and {} for the reference; RMS over texels of the "
        "luminance of E, over its mean. Normals are tilted by up to 60 degrees.",
        measured->texels, options.samples, options.reference_samples);
    Study::Table& table = study.tables.emplace_back();
    table.title = study.title;
    table.columns = {"codec", "floats", "E at the normal", "E at tilted normals", "negative"};
    for (const BakedCodec& c : best_evaluators(measured->codecs))
        table.rows.push_back({c.name.str(), fmt::format("{:.0f}", c.bytes / 4), table_number(c.at_normal, 3),
                              table_number(c.tilted, 3), fmt::format("{:.2f} %", 100 * c.negative_share)});
    return study;
}

}  // namespace lobelia
