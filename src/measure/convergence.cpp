// Excess error against the number of samples.
#include "measure/convergence.h"

#include <oneapi/tbb/parallel_for.h>

#include <mutex>

namespace lobelia {
namespace {

std::vector<Rgb> encode(const std::string& encoder, const std::shared_ptr<const Basis>& basis, SampleView samples) {
    Accumulator accumulator(make_encoder(encoder, basis).value());
    accumulator.add(samples);
    return accumulator.solve();
}

/// `count` samples: points of a sequence in random order, or the first texels of a spread order.
Samples drawn_samples(const Image& environment, Domain domain, std::optional<Sequence> sequence, std::size_t count,
                      std::uint32_t seed) {
    if (!sequence) {
        return first(shuffled_texel_samples(environment, domain, seed), count);
    }
    std::mt19937 generator(~seed);
    const Samples points = directed_samples(environment, uniform_directions(domain, *sequence, count, seed), domain);
    return reordered(points, shuffled_order(count, generator));
}

/// Multiplies every radiance by a lognormal factor of mean 1.
Samples with_path_noise(const Samples& samples, double variance, std::uint32_t seed) {
    if (!(variance > 0)) return samples;
    const double sigma = std::sqrt(std::log1p(variance));
    std::mt19937 generator(seed);
    const auto uniform = [&] { return (static_cast<double>(generator()) + 0.5) * 0x1p-32; };
    Samples noisy(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        RadianceSample s = samples[i];
        // A normal deviate by Box and Muller, the same on every platform.
        const double radius = std::sqrt(-2 * std::log(uniform()));
        const double normal = radius * std::cos(2 * k_pi * uniform());
        s.radiance = s.radiance * static_cast<float>(std::exp(sigma * normal - sigma * sigma / 2));
        noisy.set(i, s);
    }
    return noisy;
}

/// All encoders of a task under one kind of sampling.
void run_job(const Image& environment, const ConvergenceTask& task, std::optional<Sequence> sequence,
             const ConvergenceOptions& options, std::span<Convergence> results) {
    const Domain domain = task.basis->domain();
    const Samples texels = texel_samples(environment, domain);
    const Matrix gram = task.basis->linear()->gram();
    std::vector<std::shared_ptr<const Encoder>> encoders;
    std::vector<std::vector<Rgb>> converged;
    for (std::size_t e = 0; e < task.encoders.size(); ++e) {
        encoders.push_back(make_encoder(task.encoders[e], task.basis).value());
        converged.push_back(encode(encoder_limit(task.encoders[e]), task.basis, texels));
        results[e].converged_norm = std::sqrt(squared_norm(gram, converged[e]) / (3 * solid_angle(domain)));
    }
    for (std::size_t count : options.counts) {
        std::vector<double> squared(encoders.size());
        for (std::size_t r = 0; r < options.repetitions; ++r) {
            const auto seed = static_cast<std::uint32_t>(options.seed + 7919 * r);
            const Samples samples = with_path_noise(drawn_samples(environment, domain, sequence, count, seed),
                                                    options.noise_variance, seed + 1);
            for (std::size_t e = 0; e < encoders.size(); ++e) {
                Accumulator accumulator(encoders[e]);
                accumulator.add(samples);
                std::vector<Rgb> difference = accumulator.solve();
                for (std::size_t i = 0; i < difference.size(); ++i) difference[i] = difference[i] - converged[e][i];
                const double size = squared_norm(gram, converged[e]);
                squared[e] += size > 0 ? squared_norm(gram, difference) / size : 0;
            }
        }
        for (std::size_t e = 0; e < encoders.size(); ++e)
            results[e].excess.push_back(std::sqrt(squared[e] / static_cast<double>(options.repetitions)));
    }
}

}  // namespace

double squared_norm(const Matrix& gram, std::span<const Rgb> b) {
    double sum = 0;
    for (std::size_t i = 0; i < b.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j)
            sum +=
                gram[i * b.size() + j] * (static_cast<double>(b[i].r) * b[j].r + static_cast<double>(b[i].g) * b[j].g +
                                          static_cast<double>(b[i].b) * b[j].b);
    return std::max(0.0, sum);
}

std::vector<Convergence> measure_convergence(const Image& environment, const std::vector<ConvergenceTask>& tasks,
                                             const ConvergenceOptions& options, const Progress& progress) {
    // List what is to be measured: a job for each basis and kind of sampling, with a result for each encoder.
    std::vector<Convergence> results;
    struct Job {
        const ConvergenceTask* task;
        std::optional<Sequence> sequence;
        std::size_t first;
    };
    std::vector<Job> jobs;
    for (const auto& task : tasks)
        for (const auto& sequence : task.sequences) {
            jobs.push_back({&task, sequence, results.size()});
            for (const auto& encoder : task.encoders)
                results.push_back({task.basis->name(), encoder, sampling_name(sequence), options.counts, {}, 0});
        }

    std::mutex mutex;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
        const Job& job = jobs[i];
        run_job(environment, *job.task, job.sequence, options,
                std::span(results).subspan(job.first, job.task->encoders.size()));
        const std::scoped_lock lock(mutex);
        ++done;
        if (progress) progress(static_cast<double>(done) / static_cast<double>(jobs.size()));
    });
    return results;
}

}  // namespace lobelia
