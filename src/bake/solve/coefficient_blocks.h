// Coefficient vectors that differ from place to place, read in blocks, each in a direction of its own.
#pragma once

#include <span>
#include <vector>

#include "lobelia/basis.h"

namespace lobelia {

/// Floats of a block of up to k_block_size vectors: coefficient i, channel k of vector j is at
/// [(3 * i + k) * k_block_size + j].
[[nodiscard]] constexpr std::size_t block_floats(std::size_t coefficients) { return 3 * coefficients * k_block_size; }

/// Room for one vector of coefficients, read in one direction.
struct CoefficientVector {
    std::vector<Rgb> c;
    Directions direction{1};
    Colours value{1};
};

/// Reads a block through an evaluator, which must outlive the reader. Not to be shared between threads.
class IrradianceReader {
  public:
    IrradianceReader(const Evaluator& evaluator, std::size_t coefficients);
    /// E [W/m^2] of vector j at normal j, as the evaluator means it. Precondition: block_floats(coefficients) floats,
    /// at most k_block_size normals.
    void read(std::span<const float> block, DirectionView normals, MutableColourView out);

  private:
    const Evaluator* evaluator_;
    std::vector<float> rows_;
    CoefficientVector one_;
};

/// Reads a block as radiance of a basis, which must outlive the reader; what is below 0 is left or made 0.
class RadianceReader {
  public:
    RadianceReader(const Basis& basis, Negative negative);
    /// L [W/(m^2 sr)] of vector j in direction j. Preconditions as above.
    void read(std::span<const float> block, DirectionView directions, MutableColourView out);

  private:
    const Basis* basis_;
    Negative negative_;
    std::vector<float> rows_;
    CoefficientVector one_;
};

}  // namespace lobelia
