// What a basis and an evaluator are: functions of a direction, read in blocks, and what encoders ask of them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lobelia/sample.h"
#include "lobelia/texture_packing.h"

namespace lobelia {

/// Directions are handled in blocks of this many: enough to hide the virtual call, small enough that the rows of a
/// dozen functions stay in the first-level cache.
inline constexpr std::size_t k_block_size = 256;

/// `size()` real functions of a direction.
class FunctionSet {
  public:
    virtual ~FunctionSet() = default;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// rows[i * k_block_size + j] = f_i(direction j), for block.size <= k_block_size directions. `rows` has
    /// size() * k_block_size floats; within a row, entries past block.size up to whole lanes may be overwritten.
    virtual void values(DirectionView block, float* rows) const = 0;
};

/// out_j = sum_i c_i f_i(direction j): radiance for a basis, irradiance for a linear evaluator.
void evaluate(const FunctionSet& functions, std::span<const Rgb> c, DirectionView directions, MutableColourView out);

/// The same for many coefficient vectors at once; each function is computed only once per direction.
void evaluate_many(const FunctionSet& functions, std::span<const std::span<const Rgb>> c, DirectionView directions,
                   std::span<const MutableColourView> out);

/// The known accuracy of an evaluator, as its documentation and its tests state it.
struct Accuracy {
    std::string range;  ///< where it is valid, such as "sharpness 1 to 1000"
    std::string error;  ///< the largest error there
};

/// What becomes of a radiance or irradiance below 0, which no light has but a fit may: it stays, or is read as 0.
enum class Negative { kept, clamped };

/// How coefficients are read as irradiance E(n) [W/m^2] at a unit normal n.
class Evaluator {
  public:
    virtual ~Evaluator() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual Accuracy accuracy() const = 0;
    /// E as the coefficients give it; what is below 0 is still there.
    virtual void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const = 0;
    /// What this reading does with negative values of L and E.
    [[nodiscard]] virtual Negative negative() const { return Negative::kept; }
    /// The weights e_i(n) with E = sum c_i e_i where the evaluator is linear in the coefficients; else null.
    [[nodiscard]] virtual const FunctionSet* weights() const { return nullptr; }
};

/// An evaluator that is a vector of weights at a normal.
class LinearEvaluator : public Evaluator, public FunctionSet {
  public:
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const final {
        evaluate(*this, c, normals, out);
    }
    [[nodiscard]] const FunctionSet* weights() const final { return this; }
};

/// Irradiance as the evaluator means it: signed, then clamped where it clamps.
void irradiance(const Evaluator& evaluator, std::span<const Rgb> c, DirectionView normals, MutableColourView out);

/// Signed irradiance of many coefficient vectors; a linear evaluator's weights are computed only once per normal.
void signed_irradiance_many(const Evaluator& evaluator, std::span<const std::span<const Rgb>> c, DirectionView normals,
                            std::span<const MutableColourView> out);

/// Every channel below 0 becomes 0.
void clamp_negative(MutableColourView colours);

/// A symmetric K x K matrix, row by row, and so on: small dense tables in double precision.
using Matrix = std::vector<double>;

/// A linear basis over the sphere or the hemisphere: radiance L(w) = sum_i c_i B_i(w), one RGB coefficient each.
class Basis : public FunctionSet {
  public:
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual std::string description() const = 0;
    [[nodiscard]] virtual Domain domain() const = 0;
    /// Whether every B_i >= 0, so that coefficients >= 0 give a radiance >= 0 everywhere.
    [[nodiscard]] virtual bool is_non_negative() const = 0;
    /// G_ij = integral of B_i B_j over the domain [sr].
    [[nodiscard]] virtual Matrix gram() const = 0;
    /// Integral of each B_i over the domain [sr].
    [[nodiscard]] virtual std::vector<double> integrals() const = 0;
    /// Names of the ways to read irradiance from this basis, and one of them (null if unknown).
    [[nodiscard]] virtual std::vector<std::string> evaluator_names() const = 0;
    [[nodiscard]] virtual std::shared_ptr<const Evaluator> evaluator(std::string_view name) const = 0;

    /// The ways to store coefficients in textures; the first is plain_packing.
    [[nodiscard]] virtual std::vector<std::shared_ptr<const TexturePacking>> packings() const {
        return {plain_packing(size())};
    }

    /// The same radiance seen in a rotated frame, L'(R w) = L(w): a basis and coefficients that give it exactly.
    struct Rotated {
        std::shared_ptr<const Basis> basis;
        std::vector<Rgb> c;
    };
    /// For the hemisphere, `r` turns about z.
    [[nodiscard]] virtual Rotated rotated(const Rotation& r, std::span<const Rgb> c) const = 0;

    /// The degree of the spherical harmonics that the coefficients belong to, where they are such: orthonormal, real,
    /// all-plus, from degree 0 on.
    [[nodiscard]] virtual std::optional<std::size_t> harmonics_degree() const { return std::nullopt; }

    // What a storage may make use of.
    /// Whether each coefficient is a colour, so that its chroma may be kept more coarsely than its luma.
    [[nodiscard]] virtual bool has_colours() const { return true; }
    /// Bounds b_i with |c_i| <= b_i c_0, channel by channel, for the coefficients of any light that is >= 0; empty
    /// where the first coefficient bounds nothing. b_0 = 1.
    [[nodiscard]] virtual std::vector<float> lead_bounds() const { return {}; }
};

}  // namespace lobelia
