// lobelia_bench: rows named stage.codec.size, medians of several runs. "per_item" is the time of one sample, normal or
// texel. All bases, encoders and evaluators of the lists are measured; new ones are included without further code.
#include <benchmark/benchmark.h>

#include "bench/machine.h"
#include "bench/trace.h"
#include "lobelia/evaluate.h"
#include "lobelia/sky.h"
#include "lobelia/specular.h"
#include "lobelia/storage.h"
#include "measure/comparison.h"

namespace lobelia::bench {
namespace {

constexpr std::size_t k_samples = 20000;
constexpr std::size_t k_normals = 4096;
constexpr LatLong k_grid{256, 128};

void count_items(benchmark::State& state, std::size_t items_per_iteration) {
    state.counters["per_item"] =
        benchmark::Counter(static_cast<double>(items_per_iteration),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const Image& environment() {
    static const Image image = sky(k_grid);
    return image;
}

Samples samples_for(Domain domain, std::size_t count) {
    return directed_samples(environment(), uniform_directions(domain, Sequence::sobol, count, 1), domain);
}

void machine_exp(benchmark::State& state) {
    std::vector<float> x(4096), y(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = -12.0f * static_cast<float>(i) / 4096;
    for (auto _ : state) {
        exp_all(x.data(), y.data(), x.size());
        benchmark::DoNotOptimize(y.data());
        benchmark::ClobberMemory();
    }
    count_items(state, x.size());
}

void machine_fma(benchmark::State& state) {
    constexpr std::size_t count = 160 * 100;
    for (auto _ : state) benchmark::DoNotOptimize(fma_chain(count));
    count_items(state, count);
}

/// Measures function values of a basis or the weights of an evaluator; an item is one value of one function.
void values(benchmark::State& state, const FunctionSet& functions, Domain domain) {
    const Directions directions = uniform_directions(domain, Sequence::sobol, k_normals, 1);
    std::vector<float> rows(functions.size() * k_block_size);
    for (auto _ : state)
        for_each_part(directions.view(), k_block_size, [&](DirectionView block, std::size_t) {
            functions.values(block, rows.data());
            benchmark::DoNotOptimize(rows.data());
            benchmark::ClobberMemory();
        });
    count_items(state, k_normals * functions.size());
}

void encode(benchmark::State& state, const std::shared_ptr<const Encoder>& encoder, std::size_t count) {
    const Samples samples = samples_for(encoder->basis().domain(), count);
    for (auto _ : state) {
        Accumulator accumulator(encoder);
        accumulator.add(samples);
        benchmark::DoNotOptimize(accumulator.solve());
    }
    count_items(state, count);
}

void evaluate_irradiance(benchmark::State& state, const std::shared_ptr<const Basis>& basis,
                         const Evaluator& evaluator) {
    Accumulator accumulator(make_encoder(encoder_names(*basis).back(), basis).value());
    accumulator.add(samples_for(basis->domain(), 1024));
    const std::vector<Rgb> c = accumulator.solve();
    const Directions normals = uniform_directions(basis->domain(), Sequence::sobol, k_normals, 1);
    Colours out(k_normals);
    for (auto _ : state) {
        irradiance(evaluator, c, normals, out);
        benchmark::DoNotOptimize(out.channel(0));
    }
    count_items(state, k_normals);
}

/// An item is one normal, evaluated by a call of its own.
void evaluate_one_normal(benchmark::State& state, const Codec& codec) {
    const std::vector<Rgb> c = codec.encode(samples_for(codec.basis().domain(), 1024));
    const Directions normals = uniform_directions(codec.basis().domain(), Sequence::sobol, k_normals, 1);
    for (auto _ : state)
        for (std::size_t i = 0; i < k_normals; ++i)
            benchmark::DoNotOptimize(codec.irradiance(c, direction_at(normals, i)));
    count_items(state, k_normals);
}

/// An item is one sample, added to a state by a call of its own.
void add_one_sample(benchmark::State& state, const Encoder& encoder) {
    const Samples samples = samples_for(encoder.basis().domain(), k_normals);
    std::vector<float> encoded(encoder.state_size());
    for (auto _ : state)
        for (std::size_t i = 0; i < k_normals; ++i) encoder.add(encoded, samples.view().part(i, 1));
    benchmark::DoNotOptimize(encoded.data());
    count_items(state, k_normals);
}

/// An item is one texel: its own coefficients and its own normal.
void evaluate_texels(benchmark::State& state, const Codec& codec) {
    const std::size_t planes = 3 * codec.basis().size();
    const std::vector<float> values(planes * k_normals, 0.5f);
    std::vector<const float*> c(planes);
    for (std::size_t p = 0; p < planes; ++p) c[p] = values.data() + p * k_normals;
    const Directions normals = uniform_directions(codec.basis().domain(), Sequence::sobol, k_normals, 1);
    Colours out(k_normals);
    for (auto _ : state) {
        irradiance(codec.evaluator(), c, normals, out);
        benchmark::DoNotOptimize(out.channel(0));
    }
    count_items(state, k_normals);
}

/// An item is one point: its own normal, view and roughness.
void evaluate_specular(benchmark::State& state, const std::shared_ptr<const Basis>& basis,
                       const SpecularEvaluator& evaluator) {
    Accumulator accumulator(make_encoder(encoder_names(*basis).back(), basis).value());
    accumulator.add(samples_for(basis->domain(), 1024));
    const std::vector<Rgb> c = accumulator.solve();
    const Directions normals = uniform_directions(basis->domain(), Sequence::sobol, k_normals, 1);
    Directions views(k_normals);
    std::vector<float> alphas(k_normals);
    for (std::size_t i = 0; i < k_normals; ++i) {
        const Vec3 n = direction_at(normals, i), side = direction_at(normals, (i + 1) % k_normals);
        set_entry(views, i, normalize(n + side * 0.8f));
        alphas[i] = 0.1f + 0.8f * static_cast<float>(i) / k_normals;
    }
    Colours out(k_normals);
    for (auto _ : state) {
        evaluator.reflected(c, {normals, views, alphas}, out);
        benchmark::DoNotOptimize(out.channel(0));
    }
    count_items(state, k_normals);
}

/// An item is one texel seen from one normal.
void exact_irradiance(benchmark::State& state) {
    const Samples samples = texel_samples(environment());
    const Directions normals = uniform_directions(Domain::sphere, Sequence::sobol, 256, 1);
    Colours out(normals.size());
    for (auto _ : state) irradiance_sum(samples, normals, out);
    count_items(state, samples.size() * normals.size());
}

void reduce(benchmark::State& state) {
    const Image large(2048, 1024);
    for (auto _ : state) benchmark::DoNotOptimize(resize(large, {512, 256}));
    count_items(state, large.pixels.size());
}

/// Coefficients of a page of texels that every storage supports: smooth over the page, all within the bound of the
/// first coefficient.
class PackedPage {
  public:
    static constexpr std::size_t width = 512, height = 256, coefficients = 4;
    static CoefficientTraits traits() { return {coefficients, true, true, std::vector<float>(coefficients, 1.0f)}; }

    PackedPage() : values_(3 * coefficients, std::vector<float>(width * height)) {
        for (std::size_t p = 0; p < values_.size(); ++p)
            for (std::size_t i = 0; i < values_[p].size(); ++i) {
                const auto x = static_cast<float>(i % width), y = static_cast<float>(i / width);
                const float wave = 0.5f + 0.4f * std::sin(0.03f * x + static_cast<float>(p)) * std::cos(0.05f * y);
                values_[p][i] = p < 3 ? 4 * wave : wave;
            }
    }
    [[nodiscard]] CoefficientPlanes view() const {
        return {width, height, std::span<const std::vector<float>>(values_), coefficients};
    }
    [[nodiscard]] MutableCoefficientPlanes view() {
        return {width, height, std::span<std::vector<float>>(values_), coefficients};
    }

  private:
    std::vector<std::vector<float>> values_;
};

void count_page(benchmark::State& state) {
    count_items(state, PackedPage::width * PackedPage::height);
    // Bytes of the floats that go in or come out.
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(PackedPage::width * PackedPage::height * 12 *
                                                                           PackedPage::coefficients));
}

void pack_page(benchmark::State& state, const Storage& storage) {
    const PackedPage page;
    const TextureLayout layout = storage.layout(PackedPage::traits());
    for (auto _ : state) benchmark::DoNotOptimize(pack(layout, page.view()));
    count_page(state);
}

void unpack_page(benchmark::State& state, const Storage& storage) {
    PackedPage page;
    const TextureLayout layout = storage.layout(PackedPage::traits());
    const auto packed = pack(layout, std::as_const(page).view());
    for (auto _ : state) unpack(layout, packed, page.view());
    count_page(state);
}

void whole_comparison(benchmark::State& state, const ComparisonOptions& options) {
    for (auto _ : state) benchmark::DoNotOptimize(compare(environment(), all_codecs(), options));
    count_items(state, all_codecs().size());
}

std::string named(const std::string& stage, const std::string& codec, std::size_t size) {
    return stage + "." + codec + "." + std::to_string(size);
}

void register_basis(const std::shared_ptr<const Basis>& basis) {
    const std::string name = basis->name();
    if (basis->linear())
        benchmark::RegisterBenchmark(named("weights", name, k_normals).c_str(),
                                     [basis](benchmark::State& s) { values(s, *basis->linear(), basis->domain()); });
    for (const auto& encoder_name : encoder_names(*basis))
        benchmark::RegisterBenchmark(named("encode", name + "/" + encoder_name, k_samples).c_str(),
                                     [encoder = make_encoder(encoder_name, basis).value()](benchmark::State& s) {
                                         encode(s, encoder, k_samples);
                                     });
    for (const auto& encoder_name : encoder_names(*basis))
        benchmark::RegisterBenchmark(named("sample", name + "/" + encoder_name, 1).c_str(),
                                     [encoder = make_encoder(encoder_name, basis).value()](benchmark::State& s) {
                                         add_one_sample(s, *encoder);
                                     });
    for (const auto& evaluator_name : basis->evaluator_names()) {
        const Codec codec = make_codec(basis, encoder_names(*basis).back(), evaluator_name).value();
        benchmark::RegisterBenchmark(named("normal", name + "/" + evaluator_name, 1).c_str(),
                                     [codec](benchmark::State& s) { evaluate_one_normal(s, codec); });
        benchmark::RegisterBenchmark(named("texels", name + "/" + evaluator_name, k_normals).c_str(),
                                     [codec](benchmark::State& s) { evaluate_texels(s, codec); });
    }
    for (const auto& evaluator_name : basis->evaluator_names())
        benchmark::RegisterBenchmark(named("irradiance", name + "/" + evaluator_name, k_normals).c_str(),
                                     [basis, evaluator = basis->evaluator(evaluator_name)](benchmark::State& s) {
                                         evaluate_irradiance(s, basis, *evaluator);
                                     });
    for (const auto& specular_name : specular_names(*basis))
        benchmark::RegisterBenchmark(named("specular", name + "/" + specular_name, k_normals).c_str(),
                                     [basis, specular = make_specular(specular_name, basis).value()](
                                         benchmark::State& s) { evaluate_specular(s, basis, *specular); });
}

/// Measures cost against the number of samples, for the first listed basis; register_basis() measures it against
/// coefficients.
void register_scaling() {
    const auto basis = make_basis(basis_names().front()).value();
    for (const auto& name : encoder_names(*basis))
        for (std::size_t count : {1250u, 5000u, 80000u})
            benchmark::RegisterBenchmark(
                named("scaling", basis->name() + "/" + name, count).c_str(),
                [=, encoder = make_encoder(name, basis).value()](benchmark::State& s) { encode(s, encoder, count); });
}

/// An item is a texel of four coefficients.
void register_storages() {
    for (const Storage& storage : storages()) {
        const std::string name(storage.name);
        benchmark::RegisterBenchmark(("pack." + name).c_str(), [&](benchmark::State& s) { pack_page(s, storage); });
        benchmark::RegisterBenchmark(("unpack." + name).c_str(), [&](benchmark::State& s) { unpack_page(s, storage); });
    }
}

void register_all() {
    benchmark::RegisterBenchmark(named("machine", std::string("exp-") + target_name(), 4096).c_str(), machine_exp);
    benchmark::RegisterBenchmark(named("machine", std::string("fma-") + target_name(), 16000).c_str(), machine_fma);
    for (const auto& name : basis_names()) register_basis(make_basis(name).value());
    register_scaling();
    register_storages();
    register_trace();
    benchmark::RegisterBenchmark(named("reference", "irradiance", k_grid.size()).c_str(), exact_irradiance);
    benchmark::RegisterBenchmark("resize.area.2048x1024", reduce);
    const ComparisonOptions whole, figures{.pictures = false, .convergence = false};
    for (const auto& [name, options] :
         {std::pair{"compare.figures.256x128", figures}, {"compare.whole.256x128", whole}})
        benchmark::RegisterBenchmark(name, [=](benchmark::State& s) { whole_comparison(s, options); })
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace lobelia::bench

int main(int argc, char** argv) {
    // Report medians of five runs, unless the command line sets another number.
    std::vector<char*> arguments(argv, argv + argc);
    std::array<std::string, 3> defaults = {"--benchmark_repetitions=5", "--benchmark_report_aggregates_only=true",
                                           "--benchmark_min_time=0.05"};
    for (auto& argument : defaults) arguments.insert(arguments.begin() + 1, argument.data());
    int count = static_cast<int>(arguments.size());
    lobelia::bench::register_all();
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
