// Light between probes, as a renderer reads it: trilinear, without what lies in walls or behind them.
// Majercik et al. 2019 (visibility by moments of distance); Cigolle et al. 2014 (octahedral maps).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/lightmap.h"
#include "lobelia/render.h"
#include "lobelia/result.h"

namespace lobelia {

struct ProbeReading {
    /// Moves the place along the normal by this fraction of a cell, away from the surface that it lies on.
    float normal_bias = 0.2f;
    Switch visibility = Switch::on;  ///< off: probes behind walls count, too
};

/// Evaluates probes of a regular grid or of cells at places [m]. Places beside the grid are read at its border. Between
/// cells of different size light is not continuous. Reads without allocating, from several threads at once.
class ProbeVolume {
  public:
    /// Errors: neither grid nor cells; arrays that do not fit; an unknown codec.
    [[nodiscard]] static Result<ProbeVolume> make(ProbeSet probes, const ProbeReading& reading = {});

    /// The probes around a place and what each counts for; the weights add up to 1.
    struct Corners {
        std::array<std::uint32_t, 8> probe{};
        std::array<float, 8> weight{};
    };
    /// Precondition: a unit normal.
    [[nodiscard]] Corners corners(Vec3 position, Vec3 normal) const;
    /// Computes the coefficients at a place for a surface with this normal. Precondition: c.size() = coefficients().
    void coefficients(Vec3 position, Vec3 normal, std::span<Rgb> c) const;
    [[nodiscard]] std::size_t coefficients() const { return probes_.coefficients_per_probe; }
    /// Evaluates E [W/m^2] at a place and normal, by the codec's evaluator.
    [[nodiscard]] Rgb irradiance(Vec3 position, Vec3 normal) const;

    [[nodiscard]] const ProbeSet& probes() const { return probes_; }
    [[nodiscard]] const Codec& codec() const { return codec_; }

  private:
    /// A cell, and the place in it: fractions along its sides, in [0, 1].
    struct Place {
        std::array<std::uint32_t, 8> probe{};
        Vec3 along;
        float size = 0;
    };
    ProbeVolume(ProbeSet probes, const ProbeReading& reading, Codec codec);
    [[nodiscard]] Place place_in_grid(Vec3 position) const;
    [[nodiscard]] Place place_in_cells(Vec3 position) const;

    ProbeSet probes_;
    ProbeReading reading_;
    Codec codec_;
    /// Cells sorted by size, the smallest first, then by place: for each size a range to search.
    struct Level {
        float size = 0;
        std::size_t begin = 0, end = 0;
    };
    std::vector<Level> levels_;
    std::vector<std::array<std::int64_t, 3>> keys_;  ///< of the sorted cells, in units of their size from lowest_
    std::vector<std::uint32_t> order_;
    Vec3 lowest_, highest_;
};

/// What a probe counts for at a place, before the weights of all eight are divided by their sum: its share by place;
/// times how much its direction faces the normal; times Chebyshev's bound on the share of light that travels as far as
/// the place, from the moments of distance that the probe sees there.
struct ProbeAt {
    float trilinear = 0;
    Vec3 to_probe;                                ///< from the surface [m]
    Vec3 from_probe;                              ///< to the place moved along the normal [m]
    std::optional<std::array<float, 2>> moments;  ///< absent: no map
    float validity = 1;
};
[[nodiscard]] float probe_weight(const ProbeAt& at, Vec3 normal);

/// Returns the moments that a probe sees in a unit direction, bilinear in its octahedral map of side x side texels.
[[nodiscard]] std::array<float, 2> probe_moments(std::span<const std::array<float, 2>> map, std::size_t side,
                                                 Vec3 direction);

}  // namespace lobelia
