// Ranges of a job's options.
#include "bake/check_job.h"

#include <fmt/format.h>

#include "lobelia/planes.h"

namespace lobelia {
namespace {

/// Checks values against ranges, and keeps the first error.
class RangeCheck {
  public:
    /// NaN is in no range.
    template <class T>
    void operator()(const char* name, T value, const OptionRange& range) {
        const auto number = static_cast<double>(value);
        if (status_ && !(number >= range.low && number <= range.high))
            status_ = Error{
                fmt::format("{} = {:.10g} is out of range: {:.10g} to {:.10g}", name, number, range.low, range.high)};
    }
    template <class T>
    void operator()(const char* name, const std::optional<T>& value, const OptionRange& range) {
        if (value) (*this)(name, *value, range);
    }
    [[nodiscard]] Status status() const { return status_; }

  private:
    Status status_ = Done{};
};

Status check_probes(const ProbeOptions& probes) {
    RangeCheck check;
    check("probe spacing", probes.spacing, ranges::probe_spacing);
    check("probe levels", probes.levels, ranges::probe_levels);
    check("probe tolerance", probes.tolerance, ranges::probe_tolerance);
    check("probe samples", probes.samples, ranges::probe_samples);
    check("probe visibility", probes.visibility, ranges::probe_visibility);
    if (!probes.box) return check.status();
    const auto& [low, high] = *probes.box;
    if (!(low.x <= high.x && low.y <= high.y && low.z <= high.z))
        return Error{"the box of the probes: the first corner must be the lower one"};
    return check.status();
}

}  // namespace

Status check(const BakeJob& job) {
    const BakeOptions& bake = job.bake;
    RangeCheck check;
    check("width", bake.atlas.width, ranges::side);
    check("height", bake.atlas.height, ranges::side);
    check("texels per metre", bake.atlas.texels_per_metre, ranges::texels_per_metre);
    check("padding", bake.atlas.padding, ranges::padding);
    check("samples", bake.samples, ranges::samples);
    check("samples per pass", bake.samples_per_pass, ranges::samples_per_pass);
    check("bounces", bake.paths.bounces, ranges::bounces);
    check("threads", bake.threads, ranges::threads);
    check("memory", bake.memory, ranges::memory);
    check("time", bake.most_seconds, ranges::seconds);
    check("target error", bake.target_error, ranges::target_error);
    check("number of shards", bake.shard.count, ranges::shards);
    check("samples of the report's pictures", job.report.samples, ranges::picture_samples);
    check("width of the report's pictures", job.report.width, ranges::side);
    check("height of the report's pictures", job.report.height, ranges::side);
    check("mip levels", job.textures.levels, ranges::mip_levels);
    check("uv set", job.scene.uv_set, ranges::uv_set);
    check("scene memory", job.scene.scene_memory, ranges::memory);
    if (!check.status()) return check.status();
    if (bake.samples_per_pass % k_lanes != 0)
        return Error{fmt::format("samples per pass = {} is not a multiple of {}", bake.samples_per_pass, k_lanes)};
    if (bake.shard.index >= bake.shard.count)
        return Error{
            fmt::format("shard {} of {} does not exist: they are counted from 0", bake.shard.index, bake.shard.count)};
    return job.probes ? check_probes(*job.probes) : Done{};
}

}  // namespace lobelia
