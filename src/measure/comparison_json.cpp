// A comparison as report.json.
#include "measure/comparison_json.h"

#include <nlohmann/json.hpp>

namespace lobelia {
namespace {

using nlohmann::json;

constexpr const char* k_version = LOBELIA_VERSION;
constexpr int k_report_format = 2;

json triple(Rgb c) { return {c.r, c.g, c.b}; }

json coefficients(std::span<const Rgb> c) {
    json list = json::array();
    for (const Rgb& value : c) list.push_back(triple(value));
    return list;
}

json to_json(const StorageErrors& s) {
    return {{"name", s.storage},
            {"bytes", s.bytes},
            {"radiance_rms", s.radiance_rms},
            {"irradiance_over_pi_rms", s.irradiance_over_pi_rms},
            {"largest_error", s.largest_error},
            {"bound", s.bound},
            {"bound_used", s.bound_used},
            {"cut", s.cut}};
}

json to_json(const Method& m, DirectionView measured) {
    const std::size_t floats = 3 * m.c.size();
    const Vec3 worst = world_from_domain(m.domain, direction_at(measured, m.irradiance_over_pi.worst_index));
    json method = {
        {"name", m.name.str()},
        {"basis", m.name.basis},
        {"encoder", m.name.encoder},
        {"evaluator", m.name.evaluator},
        {"domain", domain_name(m.domain)},
        {"floats", floats},
        {"bytes", floats * sizeof(float)},
        {"radiance_rms", m.radiance.rms},
        {"radiance_rms_unweighted", m.radiance.rms_unweighted},
        {"radiance_smape", m.radiance.smape},
        {"radiance_relmse", m.radiance.relmse},
        {"irradiance_over_pi_rms", m.irradiance_over_pi.rms},
        {"irradiance_over_pi_rms_unweighted", m.irradiance_over_pi.rms_unweighted},
        {"irradiance_smape", m.irradiance_over_pi.smape},
        {"irradiance_relmse", m.irradiance_over_pi.relmse},
        {"irradiance_worst", {{"error", m.irradiance_over_pi.worst}, {"direction", {worst.x, worst.y, worst.z}}}},
        {"negative_share", m.radiance.negative_share},
        {"irradiance_negative_share", m.irradiance_over_pi.negative_share},
        {"encode_ms", m.encode_ms},
        {"evaluate_ns_per_normal", m.evaluate_ns_per_normal},
        {"coefficients", coefficients(m.c)}};
    if (!m.storage.empty()) {
        json stored = json::array();
        for (const StorageErrors& s : m.storage) stored.push_back(to_json(s));
        method["storage"] = std::move(stored);
    }
    return method;
}

json to_json(const Convergence& c) {
    return {{"basis", c.basis},
            {"encoder", c.encoder},
            {"sequence", c.sequence},
            {"samples", c.samples},
            {"excess", c.excess}};
}

}  // namespace

json to_json(const Comparison& comparison, const EnvironmentInfo& environment) {
    json methods = json::array();
    std::map<Domain, Samples> measured;
    const LatLong grid = comparison.recipe.empty() ? k_measuring_grid : comparison.grid;
    for (const Method& method : comparison.methods) {
        if (!measured.contains(method.domain))
            measured[method.domain] = texel_samples(Image(grid.width, grid.height), method.domain);
        methods.push_back(to_json(method, measured[method.domain].view().directions()));
    }
    json report = {{"lobelia", k_version},
                   {"format", k_report_format},
                   {"environment",
                    {{"name", environment.name},
                     {"source_width", environment.source.width},
                     {"source_height", environment.source.height},
                     {"width", comparison.grid.width},
                     {"height", comparison.grid.height},
                     {"mean_radiance", triple(comparison.mean_radiance)},
                     {"sanitized_texels", environment.sanitized_texels},
                     {"warnings", environment.warnings}}},
                   {"settings",
                    {{"recipe", comparison.recipe.empty() ? json(nullptr) : json(comparison.recipe)},
                     {"samples", comparison.samples},
                     {"sequence", comparison.sequence},
                     {"seed", comparison.seed},
                     {"reference", comparison.reference},
                     {"measured_width", grid.width},
                     {"measured_height", grid.height}}},
                   {"methods", std::move(methods)}};
    if (!comparison.convergence.empty()) {
        json curves = json::array();
        for (const auto& curve : comparison.convergence) curves.push_back(to_json(curve));
        report["convergence"] = std::move(curves);
    }
    return report;
}

}  // namespace lobelia
