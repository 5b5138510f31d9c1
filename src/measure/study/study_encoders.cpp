// The study of encoders: tables of excess error for each basis and kind of sampling.
#include "measure/study/study_encoders.h"

#include <algorithm>

namespace lobelia {
namespace {

/// One column group of a table: how samples are drawn, and with how much noise.
struct Sampling {
    std::string title;
    std::optional<Sequence> sequence;
    double noise_variance = 0;
};

std::vector<Sampling> samplings(const EncoderStudyOptions& options) {
    return {{"independent directions", Sequence::random, 0},
            {"stratified", Sequence::stratified, 0},
            {"Owen-scrambled Sobol", Sequence::sobol, 0},
            {"Owen + path noise", Sequence::sobol, options.noise_variance},
            {"the environment's own texels", std::nullopt, 0}};
}

std::string count_list(const std::vector<std::size_t>& counts) {
    std::string text;
    for (std::size_t count : counts) text += (text.empty() ? "" : " / ") + std::to_string(count);
    return text;
}

std::string excess_list(const Convergence& c, double factor) {
    std::string text;
    for (double excess : c.excess) text += (text.empty() ? "" : " / ") + table_number(factor * excess, 3);
    return text;
}

/// All encoders, listed or not, that suit a basis.
std::vector<std::string> all_encoders(const std::shared_ptr<const Basis>& basis) {
    auto names = encoder_names(*basis);
    for (const auto& name : encoder_variant_names())
        if (make_encoder(name, basis)) names.push_back(name);
    return names;
}

/// Adds the tables (relative, absolute) and the plots of one basis.
void add_basis(Study& study, const std::vector<Sampling>& columns,
               const std::vector<std::vector<Convergence>>& by_column, const std::string& basis) {
    const auto& counts = by_column[0][0].samples;
    Study::Table relative{basis + ": excess |b - b*|_G / |b*|_G at N = " + count_list(counts),
                          "b* is the limit of the encoder: least squares, its non-negative form, or the joint norm.",
                          {"encoder"},
                          {}};
    Study::Table absolute{basis + ": excess as root mean square radiance [W/(m^2 sr)] at N = " + count_list(counts),
                          "The same, not divided by |b*|.",
                          {"encoder"},
                          {}};
    for (const auto& column : columns) {
        relative.columns.push_back(column.title);
        absolute.columns.push_back(column.title);
    }
    for (std::size_t e = 0; e < by_column[0].size(); ++e) {
        relative.rows.push_back({by_column[0][e].encoder});
        absolute.rows.push_back({by_column[0][e].encoder});
        for (const auto& column : by_column) {
            relative.rows.back().push_back(excess_list(column[e], 1));
            absolute.rows.back().push_back(excess_list(column[e], column[e].converged_norm));
        }
    }
    study.tables.push_back(std::move(relative));
    study.tables.push_back(std::move(absolute));
    for (std::size_t k = 0; k < columns.size(); ++k) {
        Study::Plot plot{basis + ", " + columns[k].title, "", "samples", "excess error", Study::Axis::logarithmic,
                         Study::Axis::logarithmic,        {}};
        for (const auto& curve : by_column[k])
            plot.series.push_back({curve.encoder, {curve.samples.begin(), curve.samples.end()}, curve.excess});
        study.plots.push_back(std::move(plot));
    }
}

}  // namespace

std::vector<std::string> default_study_bases() {
    std::vector<std::string> names;
    for (Domain domain : {Domain::sphere, Domain::hemisphere})
        for (const auto& name : basis_names())
            if (make_basis(name).value()->domain() == domain) {
                names.push_back(name);
                break;
            }
    return names;
}

Result<Study> study_encoders(const Image& environment, const std::vector<std::string>& bases,
                             const EncoderStudyOptions& options, const Progress& progress) {
    Study study;
    study.name = "encoders";
    study.title = "Encoders at equal samples";
    study.summary = "Distance of each encoder from its limit after N samples, root mean square over " +
                    std::to_string(options.repetitions) +
                    " repetitions. Path noise multiplies each sample by a lognormal factor of mean 1 and variance " +
                    table_number(options.noise_variance) + ".";
    const auto columns = samplings(options);
    const double steps = static_cast<double>(bases.size() * columns.size());
    double done = 0;
    for (const auto& name : bases) {
        const auto basis = make_basis(name);
        if (!basis) return basis.error();
        if (!(*basis)->linear()) return Error{"basis \"" + name + "\" is not linear: its encoders cannot be compared"};
        const auto encoders = all_encoders(*basis);
        std::vector<std::vector<Convergence>> by_column;
        for (const auto& column : columns) {
            // One task for each encoder: they are independent, and so share the processors.
            std::vector<ConvergenceTask> tasks;
            for (const auto& encoder : encoders) tasks.push_back({*basis, {encoder}, {column.sequence}});
            ConvergenceOptions convergence;
            convergence.repetitions = options.repetitions;
            convergence.seed = options.seed;
            convergence.noise_variance = column.noise_variance;
            by_column.push_back(measure_convergence(environment, tasks, convergence));
            if (progress) progress(++done / steps);
        }
        add_basis(study, columns, by_column, name);
    }
    return study;
}

}  // namespace lobelia
