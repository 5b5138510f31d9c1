// Ambient and highlight direction: a constant and one directional light, found from degree-2 harmonics.
// Mitchell et al. 2006 and Hooker 2016 describe its use in lightmaps; the fit is ours.
#pragma once

#include "lobelia/bases.h"

namespace lobelia {

/// c_0 = ambient radiance, c_1 = irradiance H of the highlight across its direction, c_2 = the direction d, so that
/// E(n) = pi c_0 + H max(0, n . d). Both are >= 0.
class AmbientHighlight final : public FittedBasis {
  public:
    /// ahd. Null if the name is another.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return 3; }
    [[nodiscard]] std::vector<Meaning> meanings() const override {
        return {Meaning::light, Meaning::light, Meaning::shape};
    }
    /// A directional light has no radiance to show: it is spread over a lobe, H (m + 1) / 2 pi max(0, w . d)^m, m = 8.
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const override;
    [[nodiscard]] Result<ShaderCode> radiance_code() const override;
    [[nodiscard]] std::shared_ptr<const LinearBasis> accumulated() const override;
    /// The least error of E over all normals: the direction by search, c_0 and H by non-negative least squares.
    void fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const override;
    [[nodiscard]] std::string name() const override { return "ahd"; }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::sphere; }
    /// punctual: E as above, exactly.
    [[nodiscard]] std::vector<std::string> evaluator_names() const override { return {"punctual"}; }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;
};

}  // namespace lobelia
