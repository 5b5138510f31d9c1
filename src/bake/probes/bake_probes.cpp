// Places and bakes probes, level by level.
#include "bake/probes/bake_probes.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "bake/gather/pass.h"
#include "bake/probes/probe_visibility.h"
#include "lobelia/sampling.h"

namespace lobelia {
namespace {

/// A point of the finest lattice.
using Place = std::array<std::int32_t, 3>;

/// Probes that see back faces in more than this fraction of directions are inside something.
constexpr float k_most_back_faces = 0.25f;
/// From outside a room, at the corner of three walls, an eighth of all directions hits back faces.
constexpr float k_back_faces_to_move = 1.0f / 16;
constexpr std::size_t k_feelers = 256;
constexpr std::uint32_t k_samples_per_pass = 64;

std::array<Vec3, 2> box_of(const ProbeOptions& options, const World& world) {
    return options.box.value_or(std::array<Vec3, 2>{world.lowest, world.highest});
}

/// Returns the number of coarse cells per axis: the fewest that cover the box, none longer than the spacing.
std::array<std::int32_t, 3> cells_of(const ProbeOptions& options, const World& world) {
    const auto [low, high] = box_of(options, world);
    const auto count = [&](float length) {
        const double cells = std::ceil(std::max(0.0f, length) / options.spacing - 1e-6);
        return static_cast<std::int32_t>(std::clamp(cells, 1.0, 1e6));
    };
    return {count(high.x - low.x), count(high.y - low.y), count(high.z - low.z)};
}

class ProbeBaker {
  public:
    ProbeBaker(const PathTracer& tracer, const ProbeOptions& options, Codec codec, const BakeSession& session)
        : tracer_(tracer),
          options_(options),
          codec_(std::move(codec)),
          layout_(codec_.encoder().get()),
          session_(session),
          fine_(std::int32_t{1} << options.levels),
          cells_(cells_of(options, tracer.world())),
          feelers_(uniform_directions(Domain::sphere, Sequence::hammersley, k_feelers, 0)) {
        // Cells are cubes; centre them on the box.
        const auto [low, high] = box_of(options, tracer.world());
        const auto spacing = static_cast<float>(options.spacing);
        step_ = spacing / static_cast<float>(fine_);
        const auto first = [&](float from, float to, std::int32_t cells) {
            return 0.5f * (from + to - spacing * static_cast<float>(cells));
        };
        low_ = {first(low.x, high.x, cells_[0]), first(low.y, high.y, cells_[1]), first(low.z, high.z, cells_[2])};
    }

    [[nodiscard]] Status run() {
        // Bake the coarse grid first, x fastest.
        std::vector<Place> wanted;
        for (std::int32_t z = 0; z <= cells_[2]; ++z)
            for (std::int32_t y = 0; y <= cells_[1]; ++y)
                for (std::int32_t x = 0; x <= cells_[0]; ++x) wanted.push_back({x * fine_, y * fine_, z * fine_});
        if (auto status = bake(wanted, 0); !status) return status;
        std::vector<Place> cells;
        for (std::int32_t z = 0; z < cells_[2]; ++z)
            for (std::int32_t y = 0; y < cells_[1]; ++y)
                for (std::int32_t x = 0; x < cells_[0]; ++x) cells.push_back({x * fine_, y * fine_, z * fine_});

        // Divide cells whose corners do not predict the light in their middle.
        for (int level = 0; level <= options_.levels; ++level) {
            const std::int32_t size = fine_ >> level;
            std::vector<Place> divided;
            if (level < options_.levels) {
                if (auto status = bake(middles(cells, size), level + 1); !status) return status;
                for (const Place& cell : cells) {
                    StopFlag(session_.stop).check();
                    if (error_in(cell, size) > options_.tolerance) divided.push_back(cell);
                }
            }
            keep_cells(cells, divided, size);
            if (divided.empty()) break;
            cells = children(divided, size / 2);
            if (auto status = bake(corners(cells, size / 2), level + 1); !status) return status;
        }
        return Done{};
    }

    /// Returns the probes that cells use, in the order in which they were made.
    [[nodiscard]] ProbeSet result() const;

  private:
    struct Cell {
        Place corner;
        std::int32_t size;
    };

    static Place moved(Place p, std::int32_t x, std::int32_t y, std::int32_t z) {
        return {p[0] + x, p[1] + y, p[2] + z};
    }
    static Place corner_of(Place cell, std::int32_t size, unsigned k) {
        return moved(cell, (k & 1) != 0 ? size : 0, (k & 2) != 0 ? size : 0, (k & 4) != 0 ? size : 0);
    }
    static std::vector<Place> middles(std::span<const Place> cells, std::int32_t size) {
        std::vector<Place> result;
        for (const Place& cell : cells) result.push_back(moved(cell, size / 2, size / 2, size / 2));
        return result;
    }
    static std::vector<Place> children(std::span<const Place> cells, std::int32_t half) {
        std::vector<Place> result;
        for (const Place& cell : cells)
            for (unsigned k = 0; k < 8; ++k) result.push_back(corner_of(cell, half, k));
        return result;
    }
    static std::vector<Place> corners(std::span<const Place> cells, std::int32_t size) { return children(cells, size); }

    [[nodiscard]] Vec3 position_of(Place p) const {
        return low_ + Vec3{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])} * step_;
    }

    [[nodiscard]] Status bake(std::span<const Place> wanted, int level);
    void bake_one(std::size_t probe, PassWorker& worker);
    [[nodiscard]] std::optional<Vec3> way_out(Vec3 position, float reach) const;
    [[nodiscard]] Vec3 pushed_out(Vec3 position) const;
    [[nodiscard]] std::array<Rgb, 6> irradiances(std::uint32_t probe) const;
    [[nodiscard]] double error_in(Place cell, std::int32_t size) const;
    void keep_cells(std::span<const Place> cells, std::span<const Place> divided, std::int32_t size) {
        // `divided` is a part of `cells`, in the same order.
        auto next = divided.begin();
        for (const Place& cell : cells) {
            if (next != divided.end() && *next == cell)
                ++next;
            else
                kept_.push_back({cell, size});
        }
    }

    const PathTracer& tracer_;
    const ProbeOptions& options_;
    Codec codec_;
    StateLayout layout_;
    const BakeSession& session_;
    std::int32_t fine_;  ///< lattice steps along a coarse cell
    std::array<std::int32_t, 3> cells_;
    Directions feelers_;
    Vec3 low_;
    float step_;  ///< of the lattice [m]
    std::map<Place, std::uint32_t> at_;
    std::vector<Receiver> probes_;
    std::vector<ReceiverSummary> summaries_;
    std::vector<Rgb> coefficients_;
    std::vector<Cell> kept_;
};

/// Returns the way through the nearest back face and a little beyond, so that the wall does not fill half of the view.
/// Nothing if too few directions hit back faces, or the nearest is farther than `reach`.
std::optional<Vec3> ProbeBaker::way_out(Vec3 position, float reach) const {
    std::array<PathTracer::Ray, k_feelers> rays;
    std::array<PathTracer::Hit, k_feelers> hits;
    for (std::size_t i = 0; i < k_feelers; ++i)
        rays[i] = {position, direction_at(feelers_, i), std::numeric_limits<float>::infinity()};
    tracer_.closest(rays, hits);
    std::size_t backs = 0, nearest = k_feelers;
    for (std::size_t i = 0; i < k_feelers; ++i) {
        if (!hits[i].back_face || !std::isfinite(hits[i].distance)) continue;
        ++backs;
        if (nearest == k_feelers || hits[i].distance < hits[nearest].distance) nearest = i;
    }
    if (static_cast<float>(backs) <= k_back_faces_to_move * k_feelers || hits[nearest].distance > reach) return {};
    return rays[nearest].direction * (hits[nearest].distance + 0.05f * step_ * static_cast<float>(fine_));
}

Vec3 ProbeBaker::pushed_out(Vec3 position) const {
    // The corner of a grid around a room lies up to half a cell's diagonal outside, perhaps behind several walls.
    float left = 0.5f * std::sqrt(3.0f) * step_ * static_cast<float>(fine_);
    for (int step = 0; step < 3; ++step) {
        const auto way = way_out(position, left);
        if (!way) break;
        position = position + *way;
        left = std::max(0.0f, left - length(*way));
    }
    return position;
}

/// Traces and encodes all samples of one probe.
void ProbeBaker::bake_one(std::size_t probe, PassWorker& worker) {
    Receiver& receiver = probes_[probe];
    receiver.positions[0] = pushed_out(receiver.positions[0]);
    std::vector<float> state(layout_.floats());
    PassOptions pass;
    for (std::uint32_t s = 0; s < options_.samples; s += k_samples_per_pass) {
        StopFlag(session_.stop).check();
        pass.samples = {s, k_samples_per_pass};
        worker.run({&receiver, 1}, layout_, codec_.encoder().get(), state, pass);
    }
    const std::size_t n = codec_.basis().size();
    summaries_[probe] = summary(layout_.record(std::span<const float>(state)), k_samples_per_pass);
    codec_.encoder()->solve(layout_.encoder(std::span<const float>(state)),
                            std::span(coefficients_).subspan(probe * n, n));
}

Status ProbeBaker::bake(std::span<const Place> wanted, int level) {
    const std::size_t first = probes_.size();
    for (const Place& place : wanted) {
        if (!at_.try_emplace(place, static_cast<std::uint32_t>(probes_.size())).second) continue;
        if (probes_.size() >= options_.most_probes)
            return Error{fmt::format("--probes: more than {} probes; choose a larger spacing", options_.most_probes)};
        Receiver receiver;
        receiver.positions[0] = position_of(place);
        receiver.position_count = 1;
        receiver.domain = Domain::sphere;
        // Texels' keys count from 0.
        receiver.key = 0x80000000u + static_cast<std::uint32_t>(probes_.size());
        probes_.push_back(receiver);
    }
    const std::size_t count = probes_.size() - first;
    summaries_.resize(probes_.size());
    coefficients_.resize(probes_.size() * codec_.basis().size());

    tbb::enumerable_thread_specific<PassWorker> workers([&] { return PassWorker(tracer_); });
    std::atomic<std::size_t> done = 0;
    std::mutex mutex;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        StopFlag(session_.stop).check();
        bake_one(first + i, workers.local());
        ++done;
        if (!session_.progress || !mutex.try_lock()) return;
        BakeProgress is;
        is.stage = BakeProgress::Stage::probes;
        is.done = static_cast<double>(done) / static_cast<double>(count);
        is.pass = static_cast<std::uint32_t>(level) + 1;
        is.passes = static_cast<std::uint32_t>(options_.levels) + 1;
        session_.progress(is);
        mutex.unlock();
    });
    return Done{};
}

std::array<Rgb, 6> ProbeBaker::irradiances(std::uint32_t probe) const {
    Directions normals(6);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t sign = 0; sign < 2; ++sign) normals.channel(axis)[2 * axis + sign] = sign == 0 ? 1.0f : -1.0f;
    Colours out(6);
    codec_.irradiance(std::span(coefficients_).subspan(probe * codec_.basis().size(), codec_.basis().size()), normals,
                      out);
    std::array<Rgb, 6> result;
    for (std::size_t i = 0; i < 6; ++i) result[i] = colour_at(out, i);
    return result;
}

double ProbeBaker::error_in(Place cell, std::int32_t size) const {
    // Compare the mean of the valid corners, the interpolated value in the middle, with the probe there.
    const std::uint32_t middle = at_.at(moved(cell, size / 2, size / 2, size / 2));
    if (summaries_[middle].validity < 1 - k_most_back_faces) return 0;
    std::array<Rgb, 6> mean{};
    float valid = 0;
    for (unsigned k = 0; k < 8; ++k) {
        const std::uint32_t probe = at_.at(corner_of(cell, size, k));
        if (summaries_[probe].validity < 1 - k_most_back_faces) continue;
        const auto e = irradiances(probe);
        for (std::size_t i = 0; i < 6; ++i) mean[i] = mean[i] + e[i];
        ++valid;
    }
    if (valid == 0) return std::numeric_limits<double>::infinity();
    double off = 0, all = 0;
    const auto there = irradiances(middle);
    for (std::size_t i = 0; i < 6; ++i) {
        const float y = luminance(there[i]);
        off += std::abs(luminance(mean[i] * (1 / valid)) - y);
        all += y;
    }
    return all > 0 ? off / all : 0;
}

ProbeSet ProbeBaker::result() const {
    const std::size_t n = codec_.basis().size();
    ProbeSet set;
    set.codec = options_.codec;
    set.coefficients_per_probe = n;

    // Drop middles of cells that were not divided; the rest keep their order.
    std::vector<std::uint32_t> index(probes_.size(), 0);
    for (const Cell& cell : kept_)
        for (unsigned k = 0; k < 8; ++k) index[at_.at(corner_of(cell.corner, cell.size, k))] = 1;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        if (index[i] == 0) continue;
        index[i] = static_cast<std::uint32_t>(set.positions.size());
        set.positions.push_back(probes_[i].positions[0]);
        set.validity.push_back(summaries_[i].validity);
        set.back_faces.push_back(1 - summaries_[i].validity);
        set.coefficients.insert(set.coefficients.end(), coefficients_.begin() + static_cast<std::ptrdiff_t>(i * n),
                                coefficients_.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
    }

    // Describe a regular grid by its spacing, a subdivision by its cells.
    if (options_.levels == 0) {
        const auto count = [](std::int32_t cells) { return static_cast<std::uint32_t>(cells + 1); };
        set.grid = ProbeGrid{{count(cells_[0]), count(cells_[1]), count(cells_[2])}, low_, Vec3{step_, step_, step_}};
        return set;
    }
    for (const Cell& cell : kept_) {
        ProbeCell& is = set.cells.emplace_back();
        is.lowest = position_of(cell.corner);
        is.size = step_ * static_cast<float>(cell.size);
        for (unsigned k = 0; k < 8; ++k) is.corners[k] = index[at_.at(corner_of(cell.corner, cell.size, k))];
    }
    return set;
}

}  // namespace

Status check(const ProbeOptions& options, const World& world) {
    if (!(options.spacing > 0)) return Error{"--probe-spacing must be above 0"};
    auto codec = make_codec(options.codec);
    if (!codec) return codec.error();
    if (codec->basis().domain() != Domain::sphere)
        return Error{"--probe-codec: must be spherical; " + codec->basis().name() + " is a hemispherical basis"};
    const auto cells = cells_of(options, world);
    double probes = 1;
    for (const std::int32_t n : cells) probes *= n + 1.0;
    if (probes > static_cast<double>(options.most_probes))
        return Error{fmt::format("--probe-spacing: {} needs {} x {} x {} probes; the maximum is {}", options.spacing,
                                 cells[0] + 1, cells[1] + 1, cells[2] + 1, options.most_probes)};
    return Done{};
}

Result<ProbeSet> bake_probes(const PathTracer& tracer, const ProbeOptions& options, const BakeSession& session) {
    if (auto status = check(options, tracer.world()); !status) return status.error();
    ProbeBaker baker(tracer, options, make_codec(options.codec).value(), session);
    if (auto status = baker.run(); !status) return status.error();
    ProbeSet probes = baker.result();
    dilate_probes(probes);
    // A place is never farther from a corner of its cell than the diagonal, and its bias.
    if (options.visibility > 0)
        measure_visibility(probes, tracer, options.visibility,
                           1.5f * std::sqrt(3.0f) * static_cast<float>(options.spacing), session.stop);
    return probes;
}

}  // namespace lobelia
