// Excess error against the number of samples.
#include "report/convergence.h"

#include <oneapi/tbb/parallel_for.h>

namespace lobelia {
namespace {

double norm_squared(const Matrix& gram, std::span<const Rgb> v) {
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i)
        for (std::size_t j = 0; j < v.size(); ++j)
            sum += gram[i * v.size() + j] * (static_cast<double>(v[i].r) * v[j].r + static_cast<double>(v[i].g) * v[j].g +
                                             static_cast<double>(v[i].b) * v[j].b);
    return sum;
}

std::vector<Rgb> encode(const std::string& encoder, const std::shared_ptr<const Basis>& basis, SampleView samples) {
    Accumulator accumulator(make_encoder(encoder, basis).value());
    accumulator.add(samples);
    return accumulator.solve();
}

}  // namespace

double excess_error(const Matrix& gram, std::span<const Rgb> b, std::span<const Rgb> converged) {
    std::vector<Rgb> difference(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) difference[i] = b[i] - converged[i];
    const double size = norm_squared(gram, converged);
    return size > 0 ? std::sqrt(std::max(0.0, norm_squared(gram, difference)) / size) : 0;
}

std::vector<Convergence> measure_convergence(const Image& environment, const std::vector<ConvergenceTask>& tasks,
                                             const ConvergenceOptions& options) {
    std::vector<Convergence> results;
    struct Job {
        const ConvergenceTask* task;
        Sequence sequence;
        std::size_t first;  ///< of its results, one per encoder
    };
    std::vector<Job> jobs;
    for (const auto& task : tasks)
        for (Sequence sequence : task.sequences) {
            jobs.push_back({&task, sequence, results.size()});
            for (const auto& encoder : task.encoders)
                results.push_back({task.basis->name(), encoder, sequence, options.counts, {}});
        }

    tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t job_index) {
        const auto& [task, sequence, first] = jobs[job_index];
        const Domain domain = task->basis->domain();
        const Samples texels = texel_samples(environment, domain);
        const Matrix gram = task->basis->gram();
        std::vector<std::shared_ptr<const Encoder>> encoders;
        std::vector<std::vector<Rgb>> converged;
        for (const auto& name : task->encoders) {
            encoders.push_back(make_encoder(name, task->basis).value());
            converged.push_back(encode(encoder_limit(name), task->basis, texels));
        }
        for (std::size_t count : options.counts) {
            std::vector<double> squared(encoders.size());
            for (std::size_t r = 0; r < options.repetitions; ++r) {
                // Shuffle: encoders that learn as they go need samples without an order.
                const auto seed = static_cast<std::uint32_t>(options.seed + 7919 * r);
                const Samples points =
                    directed_samples(environment, uniform_directions(domain, sequence, count, seed), domain);
                std::mt19937 generator(seed);
                const Samples samples = reordered(points, shuffled_order(count, generator));
                for (std::size_t e = 0; e < encoders.size(); ++e) {
                    Accumulator accumulator(encoders[e]);
                    accumulator.add(samples);
                    squared[e] += std::pow(excess_error(gram, accumulator.solve(), converged[e]), 2);
                }
            }
            for (std::size_t e = 0; e < encoders.size(); ++e)
                results[first + e].excess.push_back(
                    std::sqrt(squared[e] / static_cast<double>(options.repetitions)));
        }
    });
    return results;
}

}  // namespace lobelia
